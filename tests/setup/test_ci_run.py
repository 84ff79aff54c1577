# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = """
import pathlib, pytest, time
COUNT = pathlib.Path(__file__).with_name("count")

def again():
    COUNT.write_text(COUNT.read_text() + "x" if COUNT.exists() else "x")
    return len(COUNT.read_text())

@pytest.fixture(scope="session")
def of_session(): return object()

@pytest.fixture(scope="module")
def of_module(of_session): return [of_session]
"""
PASSES_AT_THE_SECOND_TRY = """
def test_before(of_module): pass
def test_shaky(of_module, of_session): assert of_module[0] is of_session and again() == 2
"""
IS_SLOW_THE_FIRST_TIME = """
@pytest.mark.timeout(1)
def test_late(of_module):
    if again() == 1: time.sleep(30)
"""
SHAKY_FIXTURE = """
@pytest.fixture(scope="module")
def shaky(of_session): assert again() == 2
def test_of_shaky(shaky): pass
"""
ALWAYS_FAILS = "def test_broken(of_module): assert False"


@pytest.fixture
def environment() -> dict[str, str]:
    """The environment that .ci/run gives to `make test`."""
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    (options,) = re.findall(r'^export PYTEST_ADDOPTS="(.*) \$\{PYTEST_ADDOPTS:-\}"$', script, re.MULTILINE)
    return {**os.environ, "PYTEST_ADDOPTS": options}


@pytest.mark.parametrize(
    ("tests", "outcome"),
    [
        (PASSES_AT_THE_SECOND_TRY, "2 passed, 1 rerun"),
        (IS_SLOW_THE_FIRST_TIME, "1 passed, 1 rerun"),
        (SHAKY_FIXTURE, "1 passed, 1 rerun"),
        (ALWAYS_FAILS, "1 failed, 1 rerun"),
    ],
    ids=["shaky test", "timeout", "shaky fixture", "broken test"],
)
def test_a_failing_test_is_run_once_more_and_listed(tests, outcome, environment, tmp_path):
    """Continuous integration forgives one failure of a test, names it, and does not forgive a second."""
    file = tmp_path / "test_it.py"
    file.write_text(FIXTURES + tests)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(file)]
    run = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False, timeout=100
    )
    assert outcome in run.stdout
    assert re.search(r"^RERUN test_it\.py::test_\w+", run.stdout, re.MULTILINE)
    assert run.returncode == (1 if "failed" in outcome else 0)
