# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

PACKAGE = "hasel_tracker"

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
        "av>=12",
        "numpy>=1.26",
        "opencv-contrib-python-headless>=4.10",
        "PyYAML",
        "scipy",
    ],
    extras_require={
        "test": ["hypothesis", "pytest", "pytest-timeout"],
    },
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="From a camera or a video to three markers and the bending angle.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "tracker_node = hasel_tracker.tracker_commands:tracker_node",
            "track = hasel_tracker.tracker_commands:track",
            "calibrate = hasel_tracker.tracker_commands:calibrate",
        ]
    },
)
