# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Who made a recording, in its header lines."""

from hasel_common.provenance import provenance, without_provenance


def test_what_the_run_is_about_is_told_from_who_recorded_it():
    """The lines of the user's stay, those of the recorder become one sentence."""
    own = {"frequency_hz": "2", "operator": "Ann"}
    made = provenance(
        "/hasel/hasel_driver", ["hasel_recording"], {"port": "/dev/ttyACM0", "slew_rate": 250.0}
    )
    others, said = without_provenance({**own, **made})
    assert others == own
    assert said.startswith(f"by /hasel/hasel_driver at {made['recorded_by.time']}; ")
    assert said.endswith(f"{len(made)} lines")
    assert made["recorded_by.parameter.slew_rate"] == "250.0"
    assert without_provenance(own) == (own, "")
