# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_benchmark.bench_hidden.unlisted_effects import UNLISTED
from hasel_bringup.hidden_truth.plan import BoxRun
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import load_model
from hasel_sim.simulate import simulate

RUN = BoxRun(3500.0, 2.0).run()


def series(model):
    """Angle of one short run on a coarse mesh."""
    return simulate(model.with_numerics(mesh_density=0.5), RUN).sin_theta


@pytest.fixture(scope="module")
def swimmer():
    """The default swimmer with an amplitude for the run's voltage."""
    return (
        load_model("swimmer")
        .with_levels(np.array([3500.0]))
        .with_values({"amplitude_3500": 0.027, "slope": 0.26})
    )


@pytest.mark.parametrize(("identity", "source"), UNLISTED.items(), ids=list(UNLISTED))
def test_does_nothing_at_null_and_something_at_its_typical_size(swimmer, identity, source):
    """A user's own effect from its own file: none of the catalogue's, exact at null, felt above the noise when on."""
    assert identity not in catalogue()
    with_effect = swimmer.with_effects(source)
    effect = with_effect.effects[-1]
    typical = {f"{effect.id}.{name}": value for name, value in effect.typical().items()}
    without = series(swimmer)
    np.testing.assert_allclose(series(with_effect), without, atol=1e-7)
    assert np.abs(series(with_effect.with_values(typical)) - without).max() > 0.003
