# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
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
            "sysid = hasel_sysid.live.start_sysid:main",
            "check = hasel_sysid.command_line.options:check",
            "compare = hasel_sysid.command_line.options:compare",
            "fit = hasel_sysid.command_line.options:fit",
            "diagnose = hasel_sysid.command_line.options:diagnose",
            "improve = hasel_sysid.command_line.options:improve",
            "suggest = hasel_sysid.command_line.options:suggest",
            "measured_fish = hasel_sysid.command_line.options:measured_fish",
            "add = hasel_sysid.command_line.options:add",
            "remove = hasel_sysid.command_line.options:remove",
            "convert = hasel_recording.command_line:convert_main",
        ]
    },
)
