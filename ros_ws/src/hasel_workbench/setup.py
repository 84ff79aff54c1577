# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

PACKAGE = "hasel_workbench"

setup(
    name=PACKAGE,
    version="0.2.0",
    packages=find_packages(exclude=["test", "test.*"]),
    package_data={PACKAGE: ["py.typed", "page/static/*"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml", "CHANGELOG.rst"]),
    ],
    install_requires=[
        "setuptools",
        "numpy>=1.26",
        "plotly>=6",
        "pydantic>=2",
    ],
    extras_require={
        "page": ["nicegui>=3,<4", "fastapi", "websockets"],
        "test": ["fastapi", "pytest", "pytest-timeout", "websockets"],
    },
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="The four steps by hand, in a browser.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "workbench = hasel_workbench.entry:workbench",
        ]
    },
)
