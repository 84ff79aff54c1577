# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import shutil
from pathlib import Path

import build_workspace
import pytest


@pytest.fixture
def root(tmp_path: Path, monkeypatch) -> Path:
    """A workspace of two packages whose builds are listed instead of run."""
    for name in ("alpha", "beta"):
        package = tmp_path / "ros_ws" / "src" / name
        (package / name).mkdir(parents=True)
        (package / "test").mkdir()
        (package / "package.xml").write_text("<package/>")
        (package / name / "module.py").write_text("A = 1\n")
    (tmp_path / "built").write_text("")

    def colcon_build(root: Path, packages: list[str]) -> int:
        (root / "install").mkdir(exist_ok=True)
        for name in packages:
            (root / "build" / name).mkdir(exist_ok=True)
            installed = [
                root / "install" / f"{name}_{file.name}"
                for file in (root / "ros_ws/src" / name / name).glob("*.py")
            ]
            for file in installed:
                file.write_text("")
            (root / "build" / name / "install.log").write_text("\n".join(map(str, installed)))
        with (root / "built").open("a") as log:
            log.write(" ".join(packages) + "\n")
        return 1 if (root / "broken").exists() else 0

    monkeypatch.setattr(build_workspace, "colcon_build", colcon_build)
    return tmp_path


def built(root: Path) -> list[str]:
    """Return what was built since it was last asked for."""
    lines = (root / "built").read_text().splitlines()
    (root / "built").write_text("")
    return lines


def test_only_what_changed_is_built(root):
    """First all, then nothing, then the package with a changed, a new or a deleted file."""
    module = root / "ros_ws" / "src" / "beta" / "beta"
    build_workspace.build(root)
    assert built(root) == ["alpha beta"]
    build_workspace.build(root)
    assert built(root) == []
    for change in (
        lambda: (module / "module.py").write_text("A = 2\n"),
        lambda: (module / "new.py").write_text(""),
        (module / "new.py").unlink,
    ):
        change()
        build_workspace.build(root)
        assert built(root) == ["beta"]


def test_touching_and_testing_build_nothing(root):
    """A new time stamp, a changed test and Python's caches are no change."""
    build_workspace.build(root)
    built(root)
    package = root / "ros_ws" / "src" / "alpha"
    (package / "alpha" / "module.py").touch()
    (package / "test" / "test_module.py").write_text("")
    (package / "alpha" / "__pycache__").mkdir()
    (package / "alpha" / "__pycache__" / "module.pyc").write_text("")
    build_workspace.build(root)
    assert built(root) == []


def test_failed_build_is_tried_again(root):
    """A package that failed to build counts as changed, and the failure is the exit code."""
    (root / "broken").write_text("")
    assert build_workspace.build(root) == 1
    (root / "broken").unlink()
    assert build_workspace.build(root) == 0
    assert built(root) == ["alpha beta", "alpha beta"]


def test_removed_install_builds_all(root):
    """Without install/ everything is built again."""
    build_workspace.build(root)
    built(root)
    shutil.rmtree(root / "install")
    build_workspace.build(root)
    assert built(root) == ["alpha beta"]


def test_deleted_module_is_uninstalled(root):
    """A module that was deleted is gone after the next build; those of other packages stay."""
    build_workspace.build(root)
    (root / "ros_ws" / "src" / "beta" / "beta" / "module.py").rename(root / "ros_ws/src/beta/beta/renamed.py")
    build_workspace.build(root)
    assert sorted(path.name for path in (root / "install").iterdir()) == [
        "alpha_module.py",
        "beta_renamed.py",
    ]


def test_of_two_versions_the_former_is_uninstalled(root):
    """Else the executables would be told that they are of both."""
    build_workspace.build(root)
    former = root / "install" / "lib" / "python3.11" / "site-packages" / "beta-0.1.0-py3.11.egg-info"
    former.mkdir(parents=True)
    (former / "PKG-INFO").write_text("Version: 0.1.0\n")
    (root / "ros_ws" / "src" / "beta" / "package.xml").write_text("<package>0.2.0</package>")
    build_workspace.build(root)
    assert not former.exists()


def test_what_a_failed_build_removed_is_built_again(root):
    """Also when the change that made it fail is taken back."""
    build_workspace.build(root)
    module = root / "ros_ws" / "src" / "alpha" / "alpha" / "module.py"
    module.write_text("A = (\n")
    (root / "broken").touch()
    assert build_workspace.build(root) == 1
    module.write_text("A = 1\n")
    (root / "broken").unlink()
    built(root)
    assert build_workspace.build(root) == 0
    assert built(root) == ["alpha"]


def test_files_of_another_checkout_stay(root, tmp_path):
    """A build folder that was copied lists what the other workspace installed."""
    build_workspace.build(root)
    foreign = tmp_path / "elsewhere" / "install" / "module.py"
    foreign.parent.mkdir(parents=True)
    foreign.touch()
    (root / "build" / "alpha" / "install.log").write_text(str(foreign))
    (root / "ros_ws" / "src" / "alpha" / "alpha" / "module.py").write_text("A = 2\n")
    build_workspace.build(root)
    assert foreign.exists()
