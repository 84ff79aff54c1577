"""Which model is meant: the one of --model, else the one that all recordings name, else the swimmer."""

from collections.abc import Sequence
from pathlib import Path

from hasel_recording import Recording
from hasel_sim.errors import OwnCodeError
from hasel_sim.model import Model, load_model

from hasel_sysid.command_line.options import DEFAULT_MODEL
from hasel_sysid.errors import SysidError


def chosen_model(asked: str | None, recordings: Sequence[Recording]) -> tuple[str, Model]:
    """What to call the model, and the model. Raises SysidError where code would run that --model did not ask for."""
    named = {recording.metadata.get("model") for recording in recordings}
    name = asked or (named.pop() if len(named) == 1 else None) or DEFAULT_MODEL
    try:
        model = load_model(name, own_code=bool(asked))
    except OwnCodeError as error:
        raise SysidError(f"named by the recordings, {error}: give --model {name} if that is meant") from None
    return Path(name).stem if Path(name).suffix in (".yaml", ".yml") else name, model
