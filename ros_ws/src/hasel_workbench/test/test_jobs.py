# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Long work in a thread of its own."""

import threading

import pytest
from hasel_workbench.jobs import Jobs


@pytest.mark.filterwarnings("error::pytest.PytestUnhandledThreadExceptionWarning")
def test_work_that_was_cancelled_is_no_failure():
    """Also where what it needs is closed before it looks: no traceback, one sentence."""
    jobs, closed = Jobs(), threading.Event()

    def work(_progress):
        closed.wait(10.0)
        raise RuntimeError("cannot schedule new futures after shutdown")

    jobs.start("load", work)
    jobs.cancel()
    closed.set()
    assert jobs.wait(10.0)
    assert [each.text for each in jobs.said] == ["load: cancelled, nothing was changed"]
