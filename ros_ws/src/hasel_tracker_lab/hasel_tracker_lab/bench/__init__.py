"""Accuracy, speed and robustness of the tracker against rendered truth."""
