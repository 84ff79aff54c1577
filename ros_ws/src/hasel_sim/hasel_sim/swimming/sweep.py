"""Swims under many drives: in parallel, kept in a file as they end, so that a sweep that was broken off goes on."""

import csv
import hashlib
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, as_completed
from dataclasses import astuple, dataclass, fields
from pathlib import Path

from hasel_sim.errors import HaselSimError, ModelError
from hasel_sim.model import Model
from hasel_sim.model.model_file import model_text
from hasel_sim.parallel import side_by_side
from hasel_sim.simulate import simulate_many
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.free_swim import check_swimmer, measured


@dataclass(frozen=True)
class Swam:
    """One line of a sweep: the drive and how the body swam; NaN throughout for a motion that could not be followed."""

    first_v: float
    second_v: float
    frequency_hz: float
    speed_m_per_s: float
    earlier_m_per_s: float
    distance_m: float
    heading_rad: float
    turning_rad_per_s: float
    power_w: float
    cost_of_transport_j_per_kg_m: float

    @property
    def has_settled(self) -> bool:
        """Whether the speed no longer changes by more than a twentieth between the last two windows."""
        return abs(self.speed_m_per_s - self.earlier_m_per_s) <= 0.05 * abs(self.speed_m_per_s)

    @property
    def drive(self) -> Boxes:
        """The drive."""
        return Boxes(self.first_v, self.second_v, self.frequency_hz)


def swim_together(model: Model, drives: Sequence[Boxes], duration: float) -> list[Swam]:
    """Swims side by side in one process."""
    cases = [(model, drive.run(model, duration)) for drive in drives]
    out = []
    for drive, result in zip(drives, simulate_many(cases, keep_shapes=True), strict=True):
        key = (drive.first, drive.second, drive.frequency)
        if isinstance(result, HaselSimError):
            out.append(Swam(*key, *[float("nan")] * (len(fields(Swam)) - len(key))))
            continue
        swim = measured(model, result, drive.frequency)
        out.append(
            Swam(
                *key,
                swim.speed,
                swim.earlier,
                swim.distance,
                swim.heading,
                swim.turning,
                swim.power,
                swim.cost_of_transport,
            )
        )
    return out


class SweepLedger:
    """The file of a sweep: a line per drive, written when it ends; only for one model and one duration [s]."""

    def __init__(self, path: Path, model: Model, duration: float) -> None:
        self.path = path
        self._key = f"#model: {fingerprint(model)}, duration_s: {duration:g}"
        self.known: dict[Boxes, Swam] = {}
        if path.exists():
            self._read()
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f"{self._key}\n{','.join(field.name for field in fields(Swam))}\n")

    def _read(self) -> None:
        text = self.path.read_text()
        lines = text.splitlines()
        if not lines or lines[0] != self._key:
            raise ModelError(
                f"'{self.path}' holds swims of another model or duration; expected one of these or none: name another "
                "--output, or remove it"
            )
        whole = lines if text.endswith("\n") else lines[:-1]
        for row in csv.reader(whole[2:]):
            swam = Swam(*map(float, row))
            self.known[swam.drive] = swam
        if whole is not lines:
            self.path.write_text("\n".join(whole) + "\n")

    def add(self, swam: Sequence[Swam]) -> None:
        """Keep further swims."""
        with self.path.open("a") as file:
            for one in swam:
                self.known[one.drive] = one
                file.write(",".join(repr(value) for value in astuple(one)) + "\n")


def fingerprint(model: Model) -> str:
    """What tells a model from another: of all that its file says but its name."""
    unnamed = model.description.model_copy(update={"name": ""})
    return hashlib.sha256(model_text(model, unnamed).encode()).hexdigest()[:16]


def check_drives(model: Model, drives: Sequence[Boxes], duration: float) -> None:
    """Refuse what cannot swim, or not so short, with a SimulationError."""
    check_swimmer(model)
    for drive in drives:
        drive.run(model, duration)


def sweep(
    pool: Executor,
    model: Model,
    drives: Sequence[Boxes],
    duration: float,
    ledger: SweepLedger | None = None,
    done: Callable[[int], None] = lambda count: None,
) -> list[Swam]:
    """Every drive's swim, in the order of the drives; done: called with how many have ended."""
    check_drives(model, drives, duration)
    known = dict(ledger.known) if ledger else {}
    missing = [drive for drive in dict.fromkeys(drives) if drive not in known]
    done(len(set(drives)) - len(missing))
    share = -(-len(missing) // getattr(pool, "workers", 1))
    batches = [pool.submit(swim_together, model, part, duration) for part in side_by_side(missing, share)]
    for batch in as_completed(batches):
        swam = batch.result()
        known |= {one.drive: one for one in swam}
        if ledger:
            ledger.add(swam)
        done(len([drive for drive in set(drives) if drive in known]))
    return [known[drive] for drive in drives]
