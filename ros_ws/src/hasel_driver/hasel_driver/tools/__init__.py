"""Commands for people: console, calibration, benchmark, proof, stored charge."""
