# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The stored-charge figure."""

import math
import subprocess
import sys

import pytest
from hasel_driver.tools.stored_charge import StoredCharge


def test_the_published_bound():
    """45 µC at 10 kV are 4.5 nF and 0.225 J."""
    charge = StoredCharge(4.5e-9, 10_000.0, 1e9)
    assert charge.charge_c == pytest.approx(45e-6)
    assert charge.energy_j == pytest.approx(0.225)
    assert charge.largest_capacitance_f == pytest.approx(4.5e-9)
    assert charge.wait_s == pytest.approx(4.5 * math.log(200))


@pytest.mark.parametrize(("capacitance", "word"), [("1", "below"), ("10", "ABOVE")])
def test_command_says_on_which_side_of_the_bound(capacitance, word):
    """The command prints charge, energy, verdict and waiting time."""
    command = [sys.executable, "-m", "hasel_driver.tools.stored_charge", "--capacitance-nf", capacitance]
    answer = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert f"{word} the 45 µC" in answer


@pytest.mark.parametrize(
    "option", [("--voltage-v", "nan"), ("--voltage-v", "99999"), ("--capacitance-nf", "-1")]
)
def test_command_refuses_nonsense_in_one_sentence(option):
    """Values outside the rule's range are no figure at all."""
    command = [sys.executable, "-m", "hasel_driver.tools.stored_charge", *option]
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    assert answer.returncode != 0
    assert answer.stderr.count("\n") == 1
