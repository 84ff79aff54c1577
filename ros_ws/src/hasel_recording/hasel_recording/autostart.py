"""The parameter that nodes with a lifecycle share; known without ROS, for --help."""

AUTOSTART = "autostart", True, "configure and activate at the start; false: wait for the lifecycle's services"
"""Name, default and meaning."""
