"""High-voltage supplies at a serial port, each behind one interface."""
