"""The workbench on a running rig: what is heard, the stop, runs that are asked for; arming is the driver's."""
