"""Which effects a model lacks: a choice among sets of effects, by one currency.

The numbers are in `hasel_sysid.policy`. Read in this order: `sets` (what is chosen among), `likelihood` (the currency),
`missing` (is anything missing?), `proposals`, `promises` and `search` (add, drop, swap), `stand_ins` (what looks like
what was chosen), `worth` (what runs left out say of a set), `choice` (where to stop, and what cannot be told apart).
None of these knows a simulator; `simulated_sets` joins them to one.
"""

from hasel_sysid.policy import POLICY, Policy
from hasel_sysid.selection.choice import Choice, choose
from hasel_sysid.selection.search import search
from hasel_sysid.selection.searched import Searched
from hasel_sysid.selection.sets import FittedSet, Prospect, Sets

__all__ = [
    "POLICY",
    "Choice",
    "FittedSet",
    "Policy",
    "Prospect",
    "Searched",
    "Sets",
    "choose",
    "search",
]
