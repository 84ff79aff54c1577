# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Build with colcon the packages of ros_ws/src whose source files changed since they were last built."""

import fcntl
import hashlib
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
NO_SOURCE = ("__pycache__", ".pytest_cache", ".ruff_cache", ".hypothesis")


def source_files(package: Path) -> Iterator[Path]:
    """Yield the files that a package is built from, in a fixed order."""
    for path in sorted(package.rglob("*")):
        parts = path.relative_to(package).parts
        if (
            path.is_file()
            and parts[0] != "test"
            and not any(part in NO_SOURCE or part.endswith(".egg-info") for part in parts)
        ):
            yield path


def fingerprint(package: Path) -> str:
    """Return a digest of a package's source files, names and contents, and of the Python that builds it."""
    digest = hashlib.sha256(sys.version.encode() + sys.prefix.encode())
    for path in source_files(package):
        content = path.read_bytes()
        digest.update(f"{path.relative_to(package)} {len(content)}\n".encode() + content)
    return digest.hexdigest()


def changed_packages(source: Path, build: Path) -> dict[str, str]:
    """Return the fingerprint of every package that differs from the one recorded at its last build."""
    changed = {}
    for manifest in sorted(source.glob("*/package.xml")):
        name, current = manifest.parent.name, fingerprint(manifest.parent)
        record = build / name / "source-fingerprint"
        if not record.exists() or record.read_text() != current:
            changed[name] = current
    return changed


def remove_old_files(root: Path, name: str) -> None:
    """Remove what the last build of a Python package installed, so that deleted modules do not live on.

    From then on the package counts as changed until it is built; a folder copied from elsewhere is none of this one's.
    """
    folder = root / "build" / name
    (folder / "source-fingerprint").unlink(missing_ok=True)
    shutil.rmtree(folder / "build", ignore_errors=True)
    for metadata in (root / "install").glob(f"lib/python*/site-packages/{name}-*.egg-info"):
        shutil.rmtree(metadata)  # of whatever version
    record = folder / "install.log"
    if record.exists():
        for path in map(Path, record.read_text(encoding="utf-8").splitlines()):
            if path.is_relative_to(root / "install"):
                path.unlink(missing_ok=True)


def colcon_build(root: Path, packages: list[str]) -> int:
    """Build the packages into root/install and return colcon's exit code."""
    python = sys.executable  # colcon's too: it becomes the interpreter of the executables
    command = [python, "-m", "colcon", "--log-level", "error", "--log-base", "log", "build"]
    command += ["--base-paths", "ros_ws/src", "--merge-install", "--packages-select", *packages]
    command += [
        "--cmake-args",
        "-DCMAKE_BUILD_TYPE=Release",
        "-DBUILD_TESTING=OFF",
        "-Wno-dev",
        "--no-warn-unused-cli",
    ]
    command += [f"-DPython3_EXECUTABLE={python}", f"-DPYTHON_EXECUTABLE={python}"]
    environment = {
        k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"
    }  # nodes start faster
    return subprocess.run(command, cwd=root, env=environment, check=False).returncode


def build(root: Path = ROOT) -> int:
    """Build what changed and return an exit code; two builds at once wait for each other."""
    build_folder = root / "build"
    build_folder.mkdir(exist_ok=True)
    with (build_folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (root / "install").exists():
            shutil.rmtree(build_folder, ignore_errors=True)
            build_folder.mkdir()
        changed = changed_packages(root / "ros_ws" / "src", build_folder)
        if not changed:
            return 0
        print("Building", ", ".join(changed), flush=True)
        for name in changed:
            remove_old_files(root, name)
        code = colcon_build(root, list(changed))
        if code == 0:
            for name, digest in changed.items():
                (build_folder / name / "source-fingerprint").write_text(digest)
        return code


if __name__ == "__main__":
    sys.exit(build())
