import numpy as np
import pytest
from hasel_benchmark.bench_hidden.case import Case, draw_values
from hasel_benchmark.bench_hidden.case_list import PAIRS, list_cases, listed_effects
from hasel_benchmark.bench_hidden.generate import measure
from hasel_benchmark.errors import BenchmarkError
from hasel_bringup.hidden_truth.drawn_values import both_signs
from hasel_bringup.hidden_truth.plan import BoxRun
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import load_model
from hasel_sim.parallel import SerialExecutor
from hasel_sysid.dataset import load_experiments

FITTED, UNSEEN = [BoxRun(5500.0, 3.5)], [BoxRun(5200.0, 3.5, unseen=True)]
DRAG = Case("single", ("quadratic_drag",), 1.0, 3, "white", "near")
NOTHING = Case("nothing", (), 0.0, 3, "white", "near")


def laboratory(case, **keywords):
    """Two short runs of a case."""
    return measure(case, SerialExecutor(), fitted=FITTED, unseen=UNSEEN, **keywords)


@pytest.fixture(scope="module")
def drag():
    """Two short runs with drag hidden."""
    return laboratory(DRAG)


def test_a_case_is_the_same_each_time_and_differs_by_seed(drag):
    """Seeded: to the last digit the same data for the same case, others for another seed."""
    again = laboratory(DRAG)
    other = laboratory(Case("single", ("quadratic_drag",), 1.0, 4, "white", "near"))
    np.testing.assert_array_equal(again.fitted[0].sin_theta, drag.fitted[0].sin_theta)
    assert again.values == drag.values
    assert np.abs(other.fitted[0].sin_theta - drag.fitted[0].sin_theta).max() > 0.003


def test_hidden_drag_changes_what_is_measured(drag):
    """The hidden effect is really in the data: by more than the noise and the drawn muscles' offsets."""
    rms = [np.std(e.sin_theta) for e in (drag.fitted[0], laboratory(NOTHING).fitted[0])]
    assert rms[0] < rms[1] - 0.003
    assert 0 < drag.values["quadratic_drag"]["coefficient"] <= 0.33


def test_floor_is_the_mean_of_the_noise_alone(drag):
    """Mean |noise| of normal noise of 0.003 rms is 0.0024."""
    assert drag.floor_fitted == pytest.approx(0.0024, rel=0.25)
    assert drag.floor_unseen == pytest.approx(0.0024, rel=0.25)


def test_csv_files_hold_a_truth_that_switches_on_frames(tmp_path):
    """Written and read back, each run has the same frames, angles and switching instants."""
    made = laboratory(DRAG, switch_on_frames=True)
    made.write(tmp_path)
    back = load_experiments([tmp_path / "fit_5500V_3.5Hz.csv", tmp_path / "val_5200V_3.5Hz.csv"])
    for one, two in zip((*made.fitted, *made.unseen), back, strict=True):
        np.testing.assert_array_equal(one.sin_theta, two.sin_theta)
        np.testing.assert_array_equal(one.run.schedule.switches(), two.run.schedule.switches())


def test_measured_drive_switches_at_true_instants(drag):
    """In memory the recording keeps the exact switches, which no frame coincides with."""
    time, _ = drag.fitted[0].recording.drive()
    np.testing.assert_allclose(time, np.arange(5) / 7.0)


@pytest.mark.parametrize("identity", list(catalogue()))
def test_hidden_values_are_plausible_and_not_null(identity):
    """Every effect of the catalogue can be hidden at half, one and two typical sizes, within its range."""
    for size in (0.5, 1.0, 2.0, -1.0):
        case = Case("single", (identity,), size, 0, "white", "near")
        values = draw_values(case, np.random.default_rng(0))[identity]
        effect = catalogue()[identity]
        assert all(p.lower <= values[p.name] <= p.upper for p in effect.parameters)
        assert any(values[p.name] != p.null for p in effect.parameters)
        first = effect.parameters[0]
        assert np.sign(values[first.name] - first.null) == (np.sign(size) if both_signs(identity) else 1)


def test_whole_benchmark_covers_what_it_must():
    """Every effect five times or more, nothing hidden forty times or more in both noises, pairs, unlisted effects."""
    cases = list_cases(("nothing", "single", "pair", "unlisted"), range(5), (), "near")
    assert len({case.name for case in cases}) == len(cases)
    for identity in listed_effects():
        sizes = [abs(case.size) for case in cases if case.kind == "single" and case.effects == (identity,)]
        assert len(sizes) >= 5
        assert set(sizes) == {0.5, 1.0, 2.0}
    nothing = [case.colour for case in cases if case.kind == "nothing"]
    assert len(nothing) >= 40
    assert nothing.count("white") == nothing.count("coloured")
    assert {case.effects for case in cases if case.kind == "pair"} == set(PAIRS)
    unlisted = [(case.effects, abs(case.size)) for case in cases if case.kind == "unlisted"]
    assert len({effects for effects, _ in unlisted}) >= 5
    assert all(unlisted.count((effects, size)) == 1 for effects, _ in unlisted for size in (0.5, 1.0, 2.0))


def test_every_single_effect_can_be_hidden_in_the_swimmer():
    """All of the catalogue but forces of a fluid that the swimmer's model file does not name."""
    for identity in listed_effects():
        load_model("swimmer").with_effects(identity)
    assert "quadratic_drag" in listed_effects()
    assert "finite_depth_added_mass" not in listed_effects()


def test_pairs_can_stand_side_by_side():
    """No pair holds two effects that the model refuses together."""
    for pair in PAIRS:
        assert len(load_model("swimmer").with_effects(*pair).effects) == 2


def test_unknown_effect_is_named_with_the_nearest():
    """A typing error in --effects is answered with the nearest effect."""
    with pytest.raises(BenchmarkError, match="quadratic_drag"):
        list_cases(("single",), [0], ("quadratic_drg",), "near")
