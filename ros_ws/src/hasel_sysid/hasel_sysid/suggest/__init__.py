"""The next experiment that would best tell the remaining explanations apart."""

from hasel_sysid.suggest.manoeuvre import Manoeuvre, manoeuvres
from hasel_sysid.suggest.rivals import fitted_briefly, in_doubt, rivals
from hasel_sysid.suggest.suggest import Suggestion, suggest

__all__ = ["Manoeuvre", "Suggestion", "fitted_briefly", "in_doubt", "manoeuvres", "rivals", "suggest"]
