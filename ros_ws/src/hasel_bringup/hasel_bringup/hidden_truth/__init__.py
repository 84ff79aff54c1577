"""The simulated swimmer that plays the measured one: other mesh, time step and muscles, and effects nobody is told."""
