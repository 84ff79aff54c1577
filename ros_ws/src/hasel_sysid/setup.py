from setuptools import find_packages, setup

PACKAGE = "hasel_sysid"

setup(
    name=PACKAGE,
    version="0.2.0",
    packages=find_packages(exclude=["test", "test.*"]),
    package_data={PACKAGE: ["py.typed", "report/templates/*"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml", "CHANGELOG.rst"]),
    ],
    install_requires=[
        "setuptools",
        "jinja2",
        "matplotlib",
        "numba>=0.60",
        "numpy>=1.26",
        "plotly>=6",
        "rich",
        "ruamel.yaml",
        "scipy>=1.11",
    ],
    extras_require={
        "adam": ["torch>=2"],
        "cluster": ["distributed"],
        "test": ["fastapi", "pytest", "pytest-timeout", "statsmodels", "websockets"],
    },
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="Compare the model with measurements, fit it, and learn which physical effect it lacks.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "sysid = hasel_sysid.start_sysid:main",
            "check = hasel_sysid.command_line.entry:check",
            "compare = hasel_sysid.command_line.entry:compare",
            "fit = hasel_sysid.command_line.entry:fit",
            "diagnose = hasel_sysid.command_line.entry:diagnose",
            "improve = hasel_sysid.command_line.entry:improve",
            "suggest = hasel_sysid.command_line.entry:suggest",
            "measured_fish = hasel_sysid.command_line.entry:measured_fish",
            "add = hasel_sysid.command_line.entry:add",
            "remove = hasel_sysid.command_line.entry:remove",
            "convert = hasel_sysid.command_line.convert:main",
        ]
    },
)
