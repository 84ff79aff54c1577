# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

PACKAGE = "hasel_sim"

setup(
    name=PACKAGE,
    version="0.2.0",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml", "CHANGELOG.rst"]),
    ],
    install_requires=[
        "setuptools",
        "llvmlite",
        "matplotlib",
        "numba>=0.60",
        "numpy>=1.26",
        "pydantic>=2",
        "rich",
        "scipy>=1.11",
        "threadpoolctl",
    ],
    extras_require={
        "cluster": ["distributed"],
        "gradients": ["torch>=2"],
        "test": ["distributed", "pytest", "pytest-timeout", "scikit-fem", "torch>=2"],
    },
    package_data={PACKAGE: ["py.typed", "models/*.yaml", "muscle/muscles/*.yaml", "swimming/*.yaml"]},
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="Planar finite elements of the swimmer, its muscles and the physical effects on it.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "bench = hasel_sim.commands.entry:bench",
            "effects = hasel_sim.commands.entry:effects",
            "optimise = hasel_sim.commands.entry:optimise",
            "show_mesh = hasel_sim.commands.entry:show_mesh",
            "simulator = hasel_sim.live.start_simulator:main",
            "swim = hasel_sim.commands.entry:swim",
        ]
    },
)
