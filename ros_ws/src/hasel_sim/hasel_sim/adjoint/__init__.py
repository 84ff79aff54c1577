# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Gradients of a run by everything at once: the activation series, the parameters and the outline (adjoint method)."""

from hasel_sim.adjoint.differentiable_run import DifferentiableRun

__all__ = ["DifferentiableRun"]
