from hasel_sysid.command_line.parsers import improve_parser
from hasel_sysid.time_limit import TimeLimit


def test_it_is_over_after_so_many_seconds_and_remembers_that_it_mattered():
    """Of a clock of its own; nobody who did not ask was held up by it."""
    now = [100.0]
    limit = TimeLimit(5.0, clock=lambda: now[0])
    now[0] = 104.9
    assert not limit.is_over()
    now[0] = 105.1
    assert not limit.left_something_out
    assert limit.is_over()
    assert limit.left_something_out
    assert str(limit) == "the limit of 5 s"


def test_it_is_an_option_that_must_be_positive(capsys):
    """None by default; nothing and less are refused."""
    assert improve_parser().parse_args(["run.csv"]).seconds == float("inf")
    assert improve_parser().parse_args(["run.csv", "--seconds", "90"]).seconds == 90.0
    for refused in ("0", "-3", "soon"):
        try:
            improve_parser().parse_args(["run.csv", "--seconds", refused])
        except SystemExit as error:
            assert error.code == 2
    assert capsys.readouterr().err.count("--seconds") >= 3
