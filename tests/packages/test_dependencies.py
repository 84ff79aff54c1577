import ast
import re
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from functools import cache
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest
from ament_index_python.packages import get_packages_with_prefixes

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = sorted(path.parent for path in (ROOT / "ros_ws" / "src").glob("*/package.xml"))
MAY_IMPORT = {
    "hasel_recording": {"hasel_interfaces"},
    "hasel_driver": {"hasel_interfaces", "hasel_recording"},
    "hasel_tracker": {"hasel_interfaces", "hasel_recording"},
    "hasel_sim": {"hasel_interfaces", "hasel_recording"},
    "hasel_sysid": {"hasel_interfaces", "hasel_recording", "hasel_driver", "hasel_tracker", "hasel_sim"},
}
ROSDEP_KEYS = {
    "cv2": "python3-opencv",
    "hypothesis": "python3-hypothesis",
    "jinja2": "python3-jinja2",
    "matplotlib": "python3-matplotlib",
    "numpy": "python3-numpy",
    "psutil": "python3-psutil",
    "pydantic": "python3-pydantic",
    "pytest": "python3-pytest",
    "rich": "python3-rich",
    "rosbags": "python3-rosbags-pip",
    "ruamel": "python3-ruamel.yaml",
    "scipy": "python3-scipy",
    "serial": "python3-serial",
    "skimage": "python3-skimage",
    "yaml": "python3-yaml",
}
NOT_ON_PYPI = {
    "launch",
    "launch_ros",
}  # ROS 2 from apt brings them; who uses them elsewhere skips with the reason
each_package = pytest.mark.parametrize("package", PACKAGES, ids=lambda path: path.name)


def imported(folder: Path) -> Iterator[tuple[str, Path]]:
    """Yield the top name of every import below a folder, and the file it stands in."""
    for file in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                for alias in node.names:
                    yield alias.name.split(".")[0], file
            elif isinstance(node, ast.ImportFrom) and not node.level:
                yield node.module.split(".")[0], file


def declared(package: Path, *tags: str) -> set[str]:
    """Return what a package.xml names under these tags."""
    root = ElementTree.parse(package / "package.xml").getroot()
    return {element.text for tag in tags for element in root.iter(tag)}


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
    """interfaces < recording < driver, tracker, sim < sysid < bringup; those in the middle are strangers."""
    allowed = MAY_IMPORT.get(package.name, {path.name for path in PACKAGES}) | {package.name}
    upward = {
        f"{file.relative_to(ROOT)} imports {name}"
        for name, file in imported(package / package.name)
        if name.startswith("hasel_") and name not in allowed
    }
    assert not upward


@each_package
def test_imports_are_declared(package):
    """What rosdep knows of the imports is in package.xml; what only tests import, at least for tests."""
    run_time = declared(package, "depend", "exec_depend") | {package.name}
    ros_packages = get_packages_with_prefixes()
    for folder, known in ((package.name, run_time), ("test", run_time | declared(package, "test_depend"))):
        names = {name for name, _ in imported(package / folder)}
        keys = {ROSDEP_KEYS.get(name, name) for name in names if name in ROSDEP_KEYS or name in ros_packages}
        assert keys - known == set()


@pytest.mark.skipif(
    sys.version_info < (3, 11), reason="Python 3.10 cannot tell which distribution brings a module"
)
@each_package
def test_python_imports_are_pinned(package):
    """Every other package that code or tests import has its version in requirements.txt."""
    own = {path.stem for path in package.rglob("*.py")} | {package.name}
    distributions = packages_distributions()
    unpinned = {
        f"{file.relative_to(ROOT)} imports {name}"
        for name, file in imported(package)
        if name
        not in sys.stdlib_module_names
        | own
        | get_packages_with_prefixes().keys()
        | NOT_ON_PYPI
        | {"setuptools"}
        and not pinned() & {normalised(distribution) for distribution in distributions.get(name, [])}
    }
    assert not unpinned


@each_package
def test_manifest(package):
    """Each package has the licence, the version of all others and a maintainer."""
    root = ElementTree.parse(package / "package.xml").getroot()
    assert (root.findtext("license"), root.findtext("version")) == ("Apache-2.0", "0.1.0")
    assert root.find("maintainer").get("email")
    if (package / "setup.py").exists():
        assert f'version="{root.findtext("version")}"' in (package / "setup.py").read_text(encoding="utf-8")
