# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Real schedulers and workers, as processes of this machine."""

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from distributed import Client

MODULES = {"scheduler": "distributed.cli.dask_scheduler", "worker": "distributed.cli.dask_worker"}


class Processes:
    """A scheduler, and workers of it with a search path each; all are killed in the end."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._all = folder, []
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.scheduler = self._start("scheduler", "--host", "127.0.0.1", "--port", str(self.port))

    def worker(self, path: str | None = None) -> subprocess.Popen:
        """Another worker; path: where it finds packages, without it where this process does."""
        options = ("--no-nanny", "--nthreads", "1", "--local-directory", str(self._folder))
        return self._start("worker", self.address, *options, path=path)

    def wait_for(self, workers: int) -> None:
        """Until so many have joined."""
        with Client(self.address) as client:
            client.wait_for_workers(workers, timeout=20)

    def _start(self, kind: str, *options: str, path: str | None = None) -> subprocess.Popen:
        environment = os.environ | ({} if path is None else {"PYTHONPATH": path})
        process = subprocess.Popen(
            [sys.executable, "-m", MODULES[kind], *options, "--no-dashboard"],
            env=environment,
            cwd=self._folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self._all.append(process)
        return process

    def end(self) -> None:
        """Kill whatever still runs."""
        for process in self._all:
            with suppress(ProcessLookupError):
                process.send_signal(signal.SIGKILL)
            process.wait()


@pytest.fixture
def processes(tmp_path) -> Iterator[Processes]:
    """A scheduler without workers."""
    started = Processes(tmp_path)
    yield started
    started.end()
