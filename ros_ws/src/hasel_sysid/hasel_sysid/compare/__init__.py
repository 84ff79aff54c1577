"""Simulate recordings with a model and say how far and where it is off."""

from hasel_sysid.compare.compare import compare
from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.compare.run_comparison import RunComparison

__all__ = ["Comparison", "RunComparison", "compare"]
