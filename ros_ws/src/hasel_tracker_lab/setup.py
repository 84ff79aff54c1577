# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

PACKAGE = "hasel_tracker_lab"

setup(
    name=PACKAGE,
    version="0.2.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml", "CHANGELOG.rst"]),
    ],
    install_requires=[
        "setuptools",
        "numpy>=1.26",
        "opencv-contrib-python-headless>=4.10",
        "rich",
        "scipy",
    ],
    extras_require={
        "bench": ["scikit-image"],
        "test": ["PyYAML", "pytest", "pytest-timeout", "scikit-image"],
    },
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="Pictures with a known truth, and how exact, fast and honest the tracker is on them.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "bench = hasel_tracker_lab.lab_commands:bench",
            "render = hasel_tracker_lab.lab_commands:render",
        ]
    },
)
