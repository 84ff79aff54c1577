"""The bench's report: one HTML page with its picture inside."""

import base64
from importlib import resources
from pathlib import Path

from hasel_sim.muscle.effect import muscle_catalogue
from hasel_sysid.report.content import provenance
from jinja2 import Environment, FunctionLoader, StrictUndefined

from hasel_muscle.result import BenchImprovement
from hasel_muscle.shown import quantity, sentences, stage_name
from hasel_muscle.stroke_table import Rival
from hasel_muscle.swinging import Swinging


def write_report(
    found: BenchImprovement,
    fails: tuple[str, ...],
    rival: Rival | None,
    swings: Swinging | None,
    picture: Path,
    path: Path,
) -> None:
    """Write the page; fails: where the fitted law failed; picture: a PNG that is taken into it."""
    environment = Environment(
        loader=FunctionLoader(_template), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    page = environment.get_template("bench_muscle.html").render(
        muscle=found.muscle.name,
        status=found.status.value.replace("_", " "),
        sentences=sentences(found),
        fails=fails,
        stages=[(stage_name(stage, number), stage) for number, stage in enumerate(found.stages)],
        findings=found.findings,
        catalogue=muscle_catalogue(),
        parameters=found.muscle.parameters.values(),
        rival=rival,
        swings=swings,
        quantity=quantity,
        picture=base64.b64encode(picture.read_bytes()).decode(),
        style=_template("style.css"),
        made=provenance(),
    )
    path.write_text(page, encoding="utf-8")


def _template(name: str) -> str:
    return (resources.files("hasel_sysid") / "report" / "templates" / name).read_text(encoding="utf-8")
