"""High-voltage supply: protocol, limits, watchdog, waveforms, virtual supply."""
