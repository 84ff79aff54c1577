# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

PACKAGE = "hasel_common"

setup(
    name=PACKAGE,
    version="0.2.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml", "CHANGELOG.rst"]),
    ],
    install_requires=["PyYAML", "rich", "setuptools"],
    extras_require={"test": ["pytest", "pytest-timeout"]},
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="What every package needs around its own work.",
    license="Apache-2.0",
)
