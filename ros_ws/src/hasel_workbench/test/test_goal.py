"""The proposed run as a line for the terminal."""

from hasel_common.yaml_text import read_yaml
from hasel_recording import DriveChannel
from hasel_sysid.answer.next_run import Manoeuvre
from hasel_workbench.goal import goal_line


def test_the_line_sends_the_goal_of_the_run():
    """What stands in braces is the goal of RunExperiment, field by field."""
    run = Manoeuvre(4500.0, 1.5, 3, "box", "both")
    line = goal_line(run)
    assert line.startswith("ros2 action send_goal --feedback /hasel/run_experiment ")
    assert read_yaml(line[line.index('"') :].strip('"')) == run.goal()


def test_what_no_rig_can_make_has_no_line():
    """A release of a passive body, and a drive that is no voltage."""
    assert goal_line(Manoeuvre(0.0, 0.0, 0, "none", "both", load_factor=2.0)) == ""
    pressure = (DriveChannel("arm", "pressure", "Pa"),)
    assert goal_line(Manoeuvre(2e4, 1.0, 3, "box", "both", channels=pressure)) == ""
