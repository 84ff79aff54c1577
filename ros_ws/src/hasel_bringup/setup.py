from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "hasel_bringup"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml", "CHANGELOG.rst"]),
        (f"share/{PACKAGE}/launch", [str(path) for path in sorted(Path("launch").glob("*.launch.py"))]),
        (f"share/{PACKAGE}/config", [str(path) for path in sorted(Path("config").glob("*.yaml"))]),
    ],
    install_requires=[
        "setuptools",
        "numpy>=1.26",
        "opencv-contrib-python-headless>=4.10",
        "rich",
        "ruamel.yaml",
        "scipy>=1.11",
        "threadpoolctl",
    ],
    extras_require={"test": ["pytest", "pytest-timeout", "PyYAML"]},
    zip_safe=False,
    maintainer="HASEL swimmer maintainers",
    maintainer_email="maintainers@example.org",
    description="Launch files, configurations and the demonstration of the HASEL swimmer stack.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "bench = hasel_bringup.bench:main",
            "bench_far = hasel_bringup.bench_far.command:main",
            "bench_hidden = hasel_bringup.bench_hidden.command:main",
            "demo = hasel_bringup.demo.command:main",
            "live_demo = hasel_bringup.live_demo.command:main",
            "recorder = hasel_bringup.recorder.recorder_node:main",
            "replay = hasel_bringup.replay.command:main",
            "soak = hasel_bringup.soak.command:main",
            "virtual_camera = hasel_bringup.virtual_camera.camera_node:main",
            "virtual_rig = hasel_bringup.virtual_rig.command:main",
        ]
    },
)
