# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import ast
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from functools import cache
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest
from ament_index_python.packages import get_packages_with_prefixes
from catkin_pkg.package import parse_package

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = sorted(path.parent for path in (ROOT / "ros_ws" / "src").glob("*/package.xml"))
BELOW = {"hasel_interfaces", "hasel_common", "hasel_recording"}
SIDE_BY_SIDE = {"hasel_driver", "hasel_tracker", "hasel_sim"}
MAY_IMPORT = {
    "hasel_common": {"hasel_interfaces"},
    "hasel_recording": {"hasel_interfaces", "hasel_common"},
    "hasel_driver": BELOW,
    "hasel_tracker": BELOW,
    "hasel_sim": BELOW,
    "hasel_tracker_lab": BELOW | {"hasel_tracker"},
    "hasel_sysid": BELOW | SIDE_BY_SIDE,
    "hasel_muscle": BELOW | SIDE_BY_SIDE | {"hasel_sysid"},
    "hasel_workbench": BELOW | SIDE_BY_SIDE | {"hasel_sysid", "hasel_muscle"},
    "hasel_bringup": BELOW
    | SIDE_BY_SIDE
    | {"hasel_tracker_lab", "hasel_sysid", "hasel_muscle", "hasel_workbench"},
}
ROSDEP_KEYS = {
    "cv2": "python3-opencv",
    "h5py": "python3-h5py",
    "hypothesis": "python3-hypothesis",
    "jinja2": "python3-jinja2",
    "matplotlib": "python3-matplotlib",
    "mcap": "mcap-ros2-support",
    "mcap_ros2": "mcap-ros2-support",
    "numba": "python3-numba",
    "numpy": "python3-numpy",
    "psutil": "python3-psutil",
    "pydantic": "python3-pydantic",
    "pytest": "python3-pytest",
    "rich": "python3-rich",
    "rosbags": "python3-rosbags-pip",
    "scipy": "python3-scipy",
    "serial": "python3-serial",
    "skimage": "python3-skimage",
    "torch": "python3-torch",
    "yaml": "python3-yaml",
}
WITHOUT_ROSDEP_KEY = {
    "av", "distributed", "fastapi", "llvmlite", "nicegui", "plotly", "skfem", "statsmodels", "threadpoolctl",
    "websockets",
}  # fmt: skip
NOT_ON_PYPI = {
    "diagnostic_aggregator",
    "launch",
    "launch_ros",
}  # ROS 2 from apt brings them; who uses them elsewhere skips with the reason
OPTIONAL_MODULES = {
    "torch",
    "nicegui",
    "fastapi",
    "starlette",
}  # the adjoint and Adam, and the workbench's page: extras
OWN = {path.name for path in PACKAGES}
each_package = pytest.mark.parametrize("package", PACKAGES, ids=lambda path: path.name)


@cache
def parsed(file: Path) -> ast.Module:
    """Return a file's syntax tree."""
    return ast.parse(file.read_text(encoding="utf-8"))


def imported(folder: Path, at_once: bool = False) -> Iterator[tuple[str, Path]]:
    """Yield the top name of every import below a folder and its file; at_once: not those within functions."""
    for file in folder.rglob("*.py"):
        tree = parsed(file)
        for node in tree.body if at_once else ast.walk(tree):
            if isinstance(node, ast.Import):
                for alias in node.names:
                    yield alias.name.split(".")[0], file
            elif isinstance(node, ast.ImportFrom) and not node.level:
                yield node.module.split(".")[0], file


def imported_at_run_time(package: Path, at_once: bool = False) -> set[str]:
    """Return what a package imports without its aids to testing; at_once: when its modules are imported."""
    return {
        name
        for name, file in imported(package / package.name, at_once)
        if "testing" not in file.relative_to(package).parts
    }


def imported_by_tests(package: Path) -> set[str]:
    """Return what tests and aids to testing import."""
    folders = (package / "test", package / package.name / "testing")
    own = {path.stem for path in (package / "test").rglob("*.py")} | {package.name, "_pytest", "test"}
    return {name for folder in folders for name, _ in imported(folder)} - own


def requirements(setup: Path) -> tuple[set[str], dict[str, set[str]]]:
    """Return the normalised names of install_requires and of every extra."""
    (call,) = (
        node
        for node in ast.walk(ast.parse(setup.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "setup"
    )
    given = {keyword.arg: keyword.value for keyword in call.keywords}
    required = {normalised(each) for each in ast.literal_eval(given["install_requires"])}
    extras = ast.literal_eval(given["extras_require"])
    return required, {name: {normalised(each) for each in names} for name, names in extras.items()}


def declared(package: Path, *tags: str) -> set[str]:
    """Return what a package.xml names under these tags."""
    root = ElementTree.parse(package / "package.xml").getroot()
    return {element.text for tag in tags for element in root.iter(tag)}


@cache
def distributions() -> dict[str, list[str]]:
    """Return the distributions that bring each module."""
    return dict(packages_distributions())


@cache
def pinned() -> set[str]:
    """Return the normalised names in requirements.txt."""
    lines = (ROOT / "requirements.txt").read_text(encoding="utf-8").splitlines()
    return {normalised(line) for line in lines if re.match(r"\w", line)}


def normalised(requirement: str) -> str:
    """Return a distribution's name in the one spelling that pip compares."""
    return re.sub(r"[-_.]+", "-", re.match(r"[\w.-]+", requirement)[0]).lower()


@each_package
def test_imports_go_downwards(package):
    """Interfaces < common < recording < driver, tracker, sim < tracker_lab, sysid < muscle < workbench < bringup <
    benchmark.
    """
    allowed = MAY_IMPORT.get(package.name, {path.name for path in PACKAGES}) | {package.name}
    upward = {
        f"{file.relative_to(ROOT)} imports {name}"
        for name, file in imported(package / package.name)
        if name.startswith("hasel_") and name not in allowed
    }
    assert not upward


@each_package
def test_tests_import_downwards_too(package):
    """No test of a package needs one above it: package.xml could not say so without a circle."""
    allowed = MAY_IMPORT.get(package.name, OWN) | {package.name}
    assert {name for name in imported_by_tests(package) if name in OWN} - allowed == set()


def test_the_tracker_runs_at_a_rig_without_its_laboratory():
    """Every module of it is imported where, of ours, only what stands below it is installed."""
    program = f"""
import importlib, pkgutil, sys
absent = {sorted(OWN - BELOW - {"hasel_tracker"})}
class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in absent:
            raise ModuleNotFoundError(name)
sys.meta_path.insert(0, Absent())
import hasel_tracker
for each in pkgutil.walk_packages(hasel_tracker.__path__, "hasel_tracker."):
    importlib.import_module(each.name)
print(sum(name.startswith("hasel_tracker.") for name in sys.modules))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.stderr == ""
    assert int(done.stdout) > 20


@each_package
def test_imports_are_declared(package):
    """Each is a key of package.xml, one that only tests import at least for tests, or known to have no rosdep key."""
    run_time = declared(package, "depend", "exec_depend") | {package.name}
    for names, known in (
        (imported_at_run_time(package), run_time),
        (imported_by_tests(package), run_time | declared(package, "test_depend")),
    ):
        keys = {ROSDEP_KEYS.get(name, name) for name in names - sys.stdlib_module_names - WITHOUT_ROSDEP_KEY}
        assert keys - known == set()


@each_package
def test_manifest_is_valid(package):
    """The parser of the ROS tools finds no fault, and every key is one of ROS 2 or of those that rosdep has."""
    manifest = parse_package(package / "package.xml")
    manifest.validate()
    keys = {d.name for d in manifest.exec_depends + manifest.test_depends + manifest.build_depends}
    rosdep = set(ROSDEP_KEYS.values()) | {"python3-pytest-timeout"}
    assert keys - OWN - rosdep - NOT_ON_PYPI - get_packages_with_prefixes().keys() == set()
    assert not any(d.name.startswith("python3-pytest") for d in manifest.exec_depends)


@pytest.mark.skipif(
    sys.version_info < (3, 11), reason="Python 3.10 cannot tell which distribution brings a module"
)
@each_package
def test_imports_are_requirements_of_the_distribution(package):
    """Modules import what is in install_requires, functions what may be an extra, tests what is in the extra `test`."""
    if not (package / "setup.py").exists():
        return
    required, extras = requirements(package / "setup.py")
    optional = required.union(*extras.values())
    lazily = imported_at_run_time(package) - imported_at_run_time(package, at_once=True)
    for names, known in (
        (imported_at_run_time(package, at_once=True) - OPTIONAL_MODULES, required),
        (lazily | (OPTIONAL_MODULES & imported_at_run_time(package)), optional),
        (imported_by_tests(package), required | extras["test"]),
    ):
        missing = {
            name
            for name in names
            - sys.stdlib_module_names
            - get_packages_with_prefixes().keys()
            - NOT_ON_PYPI
            - OWN
            if not known & {normalised(each) for each in distributions().get(name, [name])}
        }
        assert missing == set()


@pytest.mark.skipif(
    sys.version_info < (3, 11), reason="Python 3.10 cannot tell which distribution brings a module"
)
@each_package
def test_python_imports_are_pinned(package):
    """Every other package that code or tests import has its version in requirements.txt."""
    own = {path.stem for path in package.rglob("*.py")} | {package.name}
    unpinned = {
        f"{file.relative_to(ROOT)} imports {name}"
        for name, file in imported(package)
        if name
        not in sys.stdlib_module_names
        | own
        | get_packages_with_prefixes().keys()
        | NOT_ON_PYPI
        | {"setuptools"}
        and not pinned() & {normalised(distribution) for distribution in distributions().get(name, [])}
    }
    assert not unpinned


@each_package
def test_manifest(package):
    """Each package has the licence, a maintainer, and the version of the citation and of the newest changelog entry."""
    root = ElementTree.parse(package / "package.xml").getroot()
    assert root.findtext("license") == "Apache-2.0"
    assert f"\nversion: {root.findtext('version')}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    newest = re.search(
        r"^(\d+\.\d+\.\d+) \(\d{4}-\d\d-\d\d\)$", (package / "CHANGELOG.rst").read_text("utf-8"), re.M
    )
    assert newest[1] == root.findtext("version")
    assert root.find("maintainer").get("email")
    if (package / "setup.py").exists():
        assert f'version="{root.findtext("version")}"' in (package / "setup.py").read_text(encoding="utf-8")
