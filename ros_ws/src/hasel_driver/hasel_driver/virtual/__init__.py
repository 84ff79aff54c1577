"""Supplies that exist only in software, with the same protocol and faults as real ones."""
