"""The workbench: load runs, see where the model fails, try an effect by hand, watch the error fall."""

from hasel_sysid.workbench.workbench import Workbench

__all__ = ["Workbench"]
