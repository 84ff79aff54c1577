"""Choosing among sets of effects: what may be added, dropped or exchanged, by one score."""

from hasel_sysid.selection.moves import Move, moves
from hasel_sysid.selection.neighbours import best_neighbour

__all__ = ["Move", "best_neighbour", "moves"]
