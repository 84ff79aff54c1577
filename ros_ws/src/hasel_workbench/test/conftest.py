# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A session with three short runs, its simulations in this process."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hasel_sim.parallel import executor
from hasel_workbench.workbench import Workbench

EFFECTS = ("quadratic_drag", "linear_drag")


@pytest.fixture(scope="session")
def unseen_rig() -> Path:
    """The recordings of an independent simulator with an effect hidden in each folder."""
    return Path(__file__).resolve().parents[4] / "data" / "unseen_rig"


@pytest.fixture
def short_runs(unseen_rig) -> tuple[list[Path], list[Path]]:
    """Two runs to fit and one that is not fitted, of an independent simulator with quadratic drag hidden in it."""
    rig = unseen_rig / "quadratic_drag"
    return [rig / "fit_4500V_3.5Hz.csv", rig / "fit_5500V_2.0Hz.csv"], [rig / "val_5200V_2.5Hz.csv"]


@pytest.fixture(scope="session")
def pool() -> Iterator:
    """Simulates in this process: nothing has to start."""
    with executor(1) as one:
        yield one


@pytest.fixture
def new_session(pool, tmp_path) -> Callable[..., Workbench]:
    """Make a session in an empty folder."""
    return lambda **options: Workbench(pool, pool, tmp_path / "session", effects=EFFECTS, **options)


@pytest.fixture
def loaded(new_session, short_runs) -> Workbench:
    """A session with the runs loaded and compared."""
    session = new_session()
    fitted, unseen = short_runs
    session.load(unseen, unseen=True)
    session.load(fitted)
    return session
