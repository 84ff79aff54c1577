"""What a user can choose between, without anything that takes time to import."""

METHODS = ("contour", "moment", "midline", "apriltag", "csrt")
DEFAULT_METHOD = "contour"
BODY_KINDS = ("auto", "light", "dark")
VIEWS_FOR_LENS = 4
"""Fewest pictures of a board from which the lens is calibrated."""
