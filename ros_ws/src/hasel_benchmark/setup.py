# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

PACKAGE = "hasel_benchmark"

setup(
    name=PACKAGE,
    version="0.2.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml", "CHANGELOG.rst"]),
    ],
    install_requires=["setuptools", "distributed", "numpy>=1.26", "psutil", "scipy>=1.11"],
    extras_require={"test": ["pytest", "pytest-timeout", "statsmodels"]},
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="The naming benchmark of the HASEL swimmer stack: is the right hidden effect named?",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "bench_cluster = hasel_benchmark.benchmark_commands:bench_cluster",
            "bench_far = hasel_benchmark.benchmark_commands:bench_far",
            "bench_fits = hasel_benchmark.benchmark_commands:bench_fits",
            "bench_hidden = hasel_benchmark.benchmark_commands:bench_hidden",
            "bench_recordings = hasel_benchmark.benchmark_commands:bench_recordings",
        ]
    },
)
