# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

PACKAGE = "hasel_driver"

setup(
    name=PACKAGE,
    version="0.2.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed", "nodes/*.xml"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml", "README.md", "CHANGELOG.rst"]),
        (f"share/{PACKAGE}/launch", ["launch/driver.launch.py"]),
        (f"share/{PACKAGE}/security", ["security/policy.xml"]),
    ],
    install_requires=["setuptools", "numpy>=1.26", "pyserial>=3.5", "PyYAML"],
    extras_require={"test": ["hypothesis", "pytest", "pytest-timeout"]},
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="High-voltage supply: protocol, limits, watchdog, waveforms, virtual supply.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "bench = hasel_driver.start:bench",
            "console = hasel_driver.start:console",
            "calibrate = hasel_driver.tools.calibrate_supply:main",
            "driver_node = hasel_driver.start:driver_node",
            "prove = hasel_driver.tools.prove:main",
            "stored_charge = hasel_driver.tools.stored_charge:main",
            "virtual_shvps = hasel_driver.virtual.virtual_shvps:main",
            "virtual_supply = hasel_driver.virtual.virtual_supply:main",
        ]
    },
)
