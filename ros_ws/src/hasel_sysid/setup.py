from setuptools import find_packages, setup

PACKAGE = "hasel_sysid"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    zip_safe=True,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="Compare the model with measurements, fit it, and learn which physical effect it lacks.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "sysid = hasel_sysid.sysid_node:main",
        ]
    },
)
