"""Where a model fails: what its residual holds, run by run, in all runs, and over the cycle of the drive."""
