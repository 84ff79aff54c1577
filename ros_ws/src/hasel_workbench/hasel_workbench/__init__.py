"""The workbench: load runs, see where the model fails, try an effect by hand, watch the error fall."""
