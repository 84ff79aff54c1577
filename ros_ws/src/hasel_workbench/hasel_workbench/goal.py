"""A proposed run as a line for the terminal."""

from hasel_recording import HASEL_PAIR
from hasel_sysid.answer.next_run import Manoeuvre


def goal_line(manoeuvre: Manoeuvre) -> str:
    """`ros2 action send_goal …`; empty where no rig of this kind can make the run."""
    if manoeuvre.load_factor is not None or manoeuvre.channels != HASEL_PAIR:
        return ""
    fields = ", ".join(f"{name}: {_yaml(value)}" for name, value in manoeuvre.goal().items())
    action = "/hasel/run_experiment hasel_interfaces/action/RunExperiment"
    return f'ros2 action send_goal --feedback {action} "{{{fields}}}"'


def _yaml(value: object) -> str:
    return (
        f"'{value}'" if isinstance(value, str) else f"{value:g}" if isinstance(value, float) else str(value)
    )
