# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

PACKAGE = "hasel_muscle"

setup(
    name=PACKAGE,
    version="0.2.0",
    packages=find_packages(exclude=["test", "test.*"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml", "CHANGELOG.rst"]),
    ],
    install_requires=[
        "setuptools",
        "jinja2",
        "matplotlib",
        "numpy>=1.26",
        "rich",
        "scipy>=1.11",
    ],
    extras_require={
        "mat": ["h5py"],
        "test": ["h5py", "pytest", "pytest-timeout"],
    },
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="One muscle on its bench: compare its stroke and force with the law, and learn what that lacks.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "bench_muscle = hasel_muscle.entry:bench_muscle",
        ]
    },
)
