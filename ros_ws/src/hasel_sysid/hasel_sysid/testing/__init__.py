"""A made-up world for tests of the search: what every effect does is known, and nothing is simulated."""
