"""The naming benchmark: how often `improve` names what was hidden from it."""
