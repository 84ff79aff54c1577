# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The façade behind `import hasel_sysid as h`: h.load, h.model, h.simulate, h.fit, h.diagnose, h.improve.

Results print as sentences and plot; docs/reference/python.md lists them.
"""

from hasel_sysid.api.results import Diagnosed, Fitted, Improved, Recordings, Simulated
from hasel_sysid.api.steps import diagnose, fit, improve, load, model, save, simulate

__all__ = [
    "Diagnosed",
    "Fitted",
    "Improved",
    "Recordings",
    "Simulated",
    "diagnose",
    "fit",
    "improve",
    "load",
    "model",
    "save",
    "simulate",
]
