import pytest
from hasel_bringup import bench
from hasel_bringup.errors import BringupError


@pytest.fixture
def installed(monkeypatch, tmp_path):
    """Stand-ins for the three packages' executables, each writing its name and returning a code of its own."""
    codes = {"hasel_sim": 0, "hasel_driver": 2, "hasel_tracker_lab": 0}
    for package, code in codes.items():
        path = tmp_path / "lib" / package / "bench"
        path.parent.mkdir(parents=True)
        path.write_text(f"#!/bin/sh\necho bench of {package}\nexit {code}\n")
        path.chmod(0o755)
    monkeypatch.setattr(bench, "get_package_prefix", lambda package: str(tmp_path))
    monkeypatch.setattr(bench.start_up, "measure", lambda: print("bench of starting") or True)
    return tmp_path


def test_runs_all_even_if_one_misses_its_bars(installed, capfd):
    """The driver misses a bar: the tracker is measured all the same, and the exit code tells."""
    assert bench.main([]) == 2
    lines = capfd.readouterr().out.split("\n")
    assert [line for line in lines if line.startswith("bench of")] == [
        "bench of hasel_sim",
        "bench of hasel_driver",
        "bench of hasel_tracker_lab",
        "bench of starting",
    ]


def test_missing_executable_is_one_sentence(installed):
    """What is not built is named, with what to do."""
    (installed / "lib" / "hasel_driver" / "bench").unlink()
    with pytest.raises(BringupError, match=r"hasel_driver has no executable bench.*make build"):
        bench.bench_executable("hasel_driver")
