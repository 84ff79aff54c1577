"""High-voltage supply on a serial port: protocol, limits, watchdog, waveforms, virtual supply, ROS 2 node."""
