# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What can go wrong when a model is described or simulated; every message is one sentence with a next step."""

from concurrent.futures import BrokenExecutor


class HaselSimError(Exception):
    """Base of every error this package raises on purpose."""


class ModelError(HaselSimError):
    """A model file, effect or parameter that cannot be used as written."""


class OwnCodeError(ModelError):
    """A model with an effect that is code, where nobody chose to run any."""


class SimulationError(HaselSimError):
    """A simulation that could not be carried out or did not converge."""


class ClusterError(BrokenExecutor):
    """A Dask cluster that cannot compute; no HaselSimError, which says of one model that it cannot be simulated."""
