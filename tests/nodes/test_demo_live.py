# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The demonstration's simulator goes on with a model that was written into its output folder."""

from pathlib import Path

import pytest
from hasel_bringup.demonstrations.demo import LiveError
from hasel_sim.model import load_model, save_model


@pytest.mark.timeout(300)
def test_a_fitted_model_is_loaded_from_a_relative_output_folder(tmp_path, monkeypatch):
    """As `make demo` has it: the node, which runs in that folder, takes the path from where the command was given."""
    monkeypatch.chdir(tmp_path)
    output = Path("output") / "demo"
    fitted = output / "fit" / "fitted_model.yaml"
    fitted.parent.mkdir(parents=True)
    save_model(load_model("swimmer"), fitted)
    with LiveError(fitted, output) as live:
        live.load(fitted)
