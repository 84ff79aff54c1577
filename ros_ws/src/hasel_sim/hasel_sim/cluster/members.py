"""Which workers of a Dask cluster compute what this process would: each is asked before it gets work."""

import inspect
import sys
import threading
import time
from collections.abc import Mapping, Sequence

from hasel_sim.cluster import environment
from hasel_sim.errors import ClusterError

JOIN_S = 10.0
"""So long the first worker may take to join a scheduler, and another one to come when all are lost."""

SILENCE_S = 20.0
"""A scheduler that has not answered for so long is given up; one that is busy with a large result answers in a few."""

_STEP_S = 0.05
_START_THEM = "in an environment of this workspace (. setup/environment.bash), of the same revision"


class Members:
    """The workers of a cluster, asked for their sources and libraries as they join; thread-safe."""

    def __init__(self, client, address: str, packages: Sequence[str]) -> None:
        """client: a `distributed.Client` of the scheduler at `address`; packages: whose sources must be the same."""
        self.address, self._client = address, client
        self._own = environment.environment(tuple(packages))
        self._question = _as_text(tuple(packages))
        self._lock = threading.Lock()
        self._asked: set[str] = set()
        self._unlike: dict[str, str | None] = {}
        self._told: set[str] = set()

    @property
    def fitting(self) -> frozenset[str]:
        """Addresses of the workers that may get work."""
        with self._lock:
            return frozenset(worker for worker, unlike in self._unlike.items() if unlike is None)

    def look(self) -> None:
        """Forget who is gone and ask who is new, without waiting for answers; tells of those that do not fit.

        Raises OSError or TimeoutError when the scheduler is gone or silent.
        """
        self._look()
        self._tell()

    def _look(self) -> None:
        present = set(self._client.sync(self._client.scheduler.ncores, callback_timeout=SILENCE_S))
        with self._lock:
            new = present - self._asked
            self._asked = present
            self._unlike = {worker: unlike for worker, unlike in self._unlike.items() if worker in present}
        for worker in new:
            # each by itself: one that hangs would keep the others from being asked
            threading.Thread(target=self._ask, args=(worker,), daemon=True).start()

    def wait(self) -> None:
        """Wait until every worker has answered and one fits, for `JOIN_S` at most; leaves out those that do not.

        Raises ClusterError when there is none that fits.
        """
        end = time.monotonic() + JOIN_S
        while True:
            self._look()
            with self._lock:
                waiting = self._asked - set(self._unlike)
                known = dict(self._unlike)
            if (known and not waiting) or time.monotonic() > end:
                break
            time.sleep(_STEP_S)
        self._tell()
        if None not in known.values():
            raise ClusterError(self._none_fits(known, waiting))

    def _none_fits(self, unlike: Mapping[str, str | None], silent: set[str]) -> str:
        if unlike:
            worker, found = next(iter(unlike.items()))
            return (
                f"none of the workers of {self.address} (there are {len(unlike)}) fits this command: {worker} {found}; "
                f"start them {_START_THEM}"
            )
        if silent:
            return (
                f"{len(silent)} workers of {self.address} have not answered for {JOIN_S:g} s, such as {min(silent)}: "
                "restart them"
            )
        return (
            f"the scheduler at {self.address} has no worker after {JOIN_S:g} s; start one with "
            f"`dask worker {self.address} --nthreads 1` {_START_THEM}"
        )

    def _ask(self, worker: str) -> None:
        found = self._answer(worker)
        if found is None:
            with self._lock:
                self._asked.discard(worker)  # to be asked again, if it is still there
            return
        with self._lock:
            if worker in self._asked:
                self._unlike[worker] = difference(self._own, found)

    def _tell(self) -> None:
        """Say once of every worker why it is left out, where others are not."""
        with self._lock:
            unlike = {worker: found for worker, found in self._unlike.items() if found is not None}
            if len(unlike) == len(self._unlike):
                return
            told, self._told = self._told, self._told | set(unlike)
        for worker in sorted(set(unlike) - told):
            print(
                f"warning: {worker} gets no work: it {unlike[worker]}; start it {_START_THEM}",
                file=sys.stderr,
                flush=True,
            )

    def _answer(self, worker: str) -> dict[str, str] | None:
        try:
            return self._client.run(eval, self._question, workers=[worker])[worker]
        except Exception:  # noqa: BLE001  whatever a worker answers that is going or gone, it is asked again
            return None


def difference(own: Mapping[str, str], found: Mapping[str, str]) -> str | None:
    """What another environment has in place of this one's, for a sentence about it; None where both are the same."""
    unlike = [name for name in own if found.get(name) != own[name]]
    if not unlike:
        return None
    missing = [name for name in unlike if found.get(name, environment.MISSING) == environment.MISSING]
    if missing:
        return f"lacks {', '.join(missing)}; expected {missing[0]} {own[missing[0]]}"
    has = ", ".join(f"{name} {found[name]}" for name in unlike)
    return f"has {has}; expected {', '.join(f'{name} {own[name]}' for name in unlike)}"


def _as_text(packages: tuple[str, ...]) -> str:
    """An expression whose value is the environment where it is evaluated."""
    source = inspect.getsource(environment)
    return f"(lambda names: exec({source!r}, names) or names['environment']({packages!r}))({{}})"
