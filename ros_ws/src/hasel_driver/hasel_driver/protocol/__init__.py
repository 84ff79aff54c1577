"""What driver and board know in common: the lines on the wire, states, faults, limits, waveforms, calibration."""
