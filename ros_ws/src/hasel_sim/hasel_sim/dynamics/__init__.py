"""The equation of motion, its solution step by step, and what parameters change in it."""
