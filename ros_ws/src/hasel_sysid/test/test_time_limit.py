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


def test_work_is_done_in_batches_until_it_is_over():
    """Nothing is lost while there is time; the batch that is being done is the last once time is over."""
    now = [0.0]
    limit = TimeLimit(5.0, clock=lambda: now[0])
    assert [piece for batch in limit.in_batches(range(20)) for piece in batch] == list(range(20))
    done = []
    for batch in limit.in_batches(range(20)):
        done += batch
        now[0] += 3.0
    assert done == list(range(16))


def test_the_first_batch_may_be_done_in_any_case():
    """Where time is over before anything began: the first alone, or none."""
    limit = TimeLimit(5.0, clock=iter([0.0, 6.0, 6.0]).__next__)
    assert list(limit.in_batches("abc")) == []
    assert list(limit.in_batches("abcdefghij", even_late=True)) == ["abcdefgh"]


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
