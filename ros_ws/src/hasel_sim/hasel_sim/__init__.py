"""Planar finite elements of the swimmer, its muscles and the physical effects on it."""
