"""Lens and perspective from a board, marker colours from a frame."""
