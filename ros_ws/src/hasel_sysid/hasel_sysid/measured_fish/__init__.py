"""A filmed fish: how its tail beats, and whether the forces of the fluid make it as fast as it was."""
