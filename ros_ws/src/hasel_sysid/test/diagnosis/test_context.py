"""Which effect wins."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np


def test_the_best_full_fit_wins_over_what_looks_much_like_it(context):
    """If what it removes is not noise."""
    assert context(0.01).winner == "sine"
    assert context(0.01, chance=0.5).winner is None


def test_what_stopped_at_the_edge_of_its_range_does_not_win(context):
    """Its null is no edge."""
    whole = context(0.01)
    whole.finals["sine"].at_bound = ("sine.size",)
    assert whole.winner == "much_alike"
    whole.finals["sine"].model.values["sine.size"] = 0.0
    assert replace(whole).winner == "sine"


def test_what_every_run_wants_of_another_size_does_not_win(context):
    """It fits all together a little better, and foretells each by the others worse than the model without it."""
    whole = context(0.01)
    fit, base = whole.finals["sine"], whole.fit.evaluation
    shape = base.residual / np.linalg.norm(base.residual)
    residual = 0.95 * np.sqrt(base.sum_of_squares) * shape * np.where(base.runs % 2, 1.0, -1.0)
    evaluation = SimpleNamespace(residual=residual, jacobian=shape[:, None], runs=base.runs)
    refuted = SimpleNamespace(**{**vars(fit), "evaluation": evaluation})
    assert replace(whole, finals={**whole.finals, "sine": refuted}).winner == "much_alike"


def test_of_two_that_fit_alike_the_one_with_fewer_values_wins(context):
    """The other one is a hair better, which its second value does not pay for."""
    whole = context(0.01)
    double = whole.signatures["sine"]
    columns = np.column_stack([double.columns, double.change])
    signatures = {**whole.signatures, "sine": replace(double, columns=columns)}
    squares = {**whole.squares, "much_alike": whole.squares["sine"] * (1 + 1e-9)}
    assert replace(whole, squares=squares).winner == "sine"
    assert replace(whole, squares=squares, signatures=signatures).winner == "much_alike"
