# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

PACKAGE = "hasel_recording"

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
        "mcap>=1.1",
        "mcap-ros2-support>=0.5",
        "numpy>=1.26",
        "PyYAML",
        "rosbags>=0.11",
        "scipy>=1.11",
    ],
    extras_require={"test": ["hypothesis", "pytest", "pytest-timeout"]},
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="Crash-safe recordings of experiments: MCAP and CSV.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "convert = hasel_recording.command_line:convert_main",
            "info = hasel_recording.command_line:info_main",
        ]
    },
)
