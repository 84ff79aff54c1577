"""The newest part of a growing series."""

import numpy as np


class Window:
    """Rows of any shape with their times [s], kept for `span` seconds before the newest."""

    def __init__(self, span: float) -> None:
        self.span = span
        self.time = np.empty(0)
        self.rows = np.empty(0)

    def __len__(self) -> int:
        return len(self.time)

    def add(self, time: np.ndarray, rows: np.ndarray) -> None:
        """Append rows [n, …] at ascending times [s] [n] and drop what is too old."""
        if len(self.time) == 0:
            self.rows = np.empty((0, *rows.shape[1:]))
        first = np.searchsorted(self.time, time[-1] - self.span)
        self.time = np.concatenate([self.time[first:], time])
        self.rows = np.concatenate([self.rows[first:], rows])
