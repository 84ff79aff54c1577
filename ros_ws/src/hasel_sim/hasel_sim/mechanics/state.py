"""State of the body between two steps, and its derivatives by parameters in the same shape."""

from dataclasses import dataclass

import numpy as np


@dataclass
class State:
    """Positions [m], velocities [m/s], accelerations [m/s^2] [nodes, 2].

    branch: stresses of the internal branches [Pa] [branches, elements, points, 3], None where there are none;

    green: C : E [Pa] at this state's strain [elements, points, 3], likewise.
    """

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    branch: np.ndarray | None = None
    green: np.ndarray | None = None


@dataclass
class StateSlopes:
    """Derivatives of a `State` by parameters: the same arrays with a leading axis of columns."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    branch: np.ndarray | None = None
    green: np.ndarray | None = None
