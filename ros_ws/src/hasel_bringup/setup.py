# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "hasel_bringup"

setup(
    name=PACKAGE,
    version="0.2.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml", "CHANGELOG.rst"]),
        (f"share/{PACKAGE}/launch", [str(path) for path in sorted(Path("launch").glob("*.launch.py"))]),
        (f"share/{PACKAGE}/layouts", [str(path) for path in sorted(Path("layouts").iterdir())]),
        (f"share/{PACKAGE}/config", [str(path) for path in sorted(Path("config").glob("*.yaml"))]),
    ],
    install_requires=[
        "setuptools",
        "numpy>=1.26",
        "opencv-contrib-python-headless>=4.10",
        "psutil",
        "rich",
        "threadpoolctl",
    ],
    extras_require={"test": ["hypothesis", "pytest", "pytest-timeout", "PyYAML"]},
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="Launch files, configurations and the demonstration of the HASEL swimmer stack.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "bench = hasel_bringup.bench_all:main",
            "demo = hasel_bringup.bringup_commands:demo",
            "lifecycle_manager = hasel_bringup.bringup_commands:lifecycle_manager",
            "live_demo = hasel_bringup.bringup_commands:live_demo",
            "recorder = hasel_bringup.bringup_commands:recorder",
            "replay = hasel_bringup.bringup_commands:replay",
            "soak = hasel_bringup.bringup_commands:soak",
            "virtual_camera = hasel_bringup.bringup_commands:virtual_camera",
            "virtual_rig = hasel_bringup.bringup_commands:virtual_rig",
        ]
    },
)
