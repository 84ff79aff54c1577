"""Ways to search for missing effects, by the name that `--search` takes."""

SEARCHES = ("greedy", "sets")
"""greedy: one effect after the other; sets: among sets of effects, by what runs left out say of each."""
