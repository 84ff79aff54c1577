# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The one body that stands out from the ground, lighter or darker, or the reason why none is taken."""

from dataclasses import dataclass

import cv2
import numpy as np

from hasel_tracker.tracking.doubt import Doubt

GROUND_PIXELS = 3000
GROUND_ROUNDS = 6
SMOOTHING_PX = 1.0
LEVEL_PERIOD = 3
NOISE_FACTOR = 6.0
LEAST_STEP = 8.0
PLATEAU_PERCENTILE = 85.0
LARGEST_EDGE_PX = 3.0
LEAST_AREA_SHARE = 2e-4
RIVAL_SHARE = 0.1
SIGNS = {"auto": (1, -1), "light": (1,), "dark": (-1,)}  # of a body's step from the ground, by its kind


@dataclass(frozen=True)
class Silhouette:
    """A body in a part of the picture.

    step: how far each pixel (h, w) is from the ground towards the body [grey levels], holes filled. mask: (h, w), 255
    where that is over `threshold`, half-way to the body. corner: (2,) where the part lies in the picture [px].
    light: whether the body is lighter than the ground.
    """

    step: np.ndarray
    mask: np.ndarray
    threshold: float
    corner: np.ndarray
    light: bool

    @property
    def area_px(self) -> int:
        """Pixels of the body."""
        return cv2.countNonZero(self.mask)

    @property
    def edge_px(self) -> float:
        """Mean width of the edge: from 35 to 65 % of the way from the ground to the body."""
        outline = cv2.findContours(self.mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
        between = (self.step > 0.7 * self.threshold) & (self.step < 1.3 * self.threshold)
        return float(between.sum()) / sum(len(each) for each in outline)


@dataclass(frozen=True)
class SilhouetteSearch:
    """What one picture gives: a silhouette, or None and why."""

    silhouette: Silhouette | None
    doubt: Doubt = Doubt.NONE
    note: str = ""


@dataclass(frozen=True)
class _Piece:
    box: tuple[int, int, int, int]
    area: int
    label: int
    sign: int


def find_silhouette(image: np.ndarray, body: str = "auto") -> SilhouetteSearch:
    """Look for the one body in an 8-bit BGR image; `body`: auto, light or dark against the ground.

    The ground's light may fall off as a polynomial of second degree; what is nearer to it than six times its scatter
    is taken for ground.
    """
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    step = cv2.GaussianBlur(grey.astype(np.float32), (0, 0), SMOOTHING_PX) - _ground(grey)
    coarse = step[::4, ::4]
    floor = max(NOISE_FACTOR * 1.4826 * float(np.median(np.abs(coarse - np.median(coarse)))), LEAST_STEP)
    pieces, layers = [], {}
    for sign in SIGNS[body]:
        threshold = _half_level(sign * step, floor)
        if threshold is not None:
            layers[sign] = (threshold, *_pieces(sign * step > threshold, sign))
            pieces += layers[sign][2]
    pieces.sort(key=lambda piece: -piece.area)
    if not pieces:
        return SilhouetteSearch(None, note="no body stands out from the ground")
    first, *others = [piece for piece in pieces if piece.area > RIVAL_SHARE * pieces[0].area]
    if _touches_edge(first, grey.shape):
        return SilhouetteSearch(None, note="the silhouette touches the edge of the picture or the region")
    if others:
        return SilhouetteSearch(None, Doubt.AMBIGUOUS, _several(first, others))
    threshold, labels, _ = layers[first.sign]
    found = _cut_out(first.sign * step, labels, first, threshold)
    if found.edge_px > LARGEST_EDGE_PX:
        return SilhouetteSearch(
            None, Doubt.AMBIGUOUS, "the silhouette has no clear edge (a shadow, or out of focus)"
        )
    return SilhouetteSearch(found)


def _several(first: _Piece, others: list[_Piece]) -> str:
    if any(each.sign != first.sign for each in others):
        return "something lighter and something darker stands out (a shadow?); say --body light or dark, or --roi"
    return f"{1 + len(others)} things stand out from the ground; say with --roi where the swimmer is"


def _ground(grey: np.ndarray) -> np.ndarray:
    """The ground's light (h, w): a polynomial of second degree through what most of the picture agrees on."""
    height, width = grey.shape
    shrink = np.sqrt(min(GROUND_PIXELS / grey.size, 1.0))
    small = cv2.resize(
        grey, (max(int(width * shrink), 8), max(int(height * shrink), 8)), interpolation=cv2.INTER_AREA
    ).astype(float)
    rows, columns = (np.linspace(-1.0, 1.0, n) for n in small.shape)
    y, x = (each.ravel() for each in np.meshgrid(rows, columns, indexing="ij"))
    terms, light = np.column_stack([np.ones_like(x), x, y, x * x, x * y, y * y]), small.ravel()
    fitted = np.full_like(light, np.median(light))
    for _ in range(GROUND_ROUNDS):
        apart = np.abs(light - fitted)
        used = apart <= 3.0 * 1.4826 * np.median(apart) + 1.0
        factors = np.linalg.solve(terms[used].T @ terms[used], terms[used].T @ light[used])
        fitted = terms @ factors
    down, across = (np.linspace(-1.0, 1.0, n, dtype=np.float32) for n in grey.shape)
    a, b, c, d, e, f = factors.astype(np.float32)
    return (
        (a + b * across + d * across**2)[None, :]
        + (c * down + f * down**2)[:, None]
        + e * down[:, None] * across[None, :]
    )


def _half_level(step: np.ndarray, floor: float) -> float | None:
    """Half of what the largest thing over `floor` stands out by; None where that is not clear of the ground."""
    step = step[::LEVEL_PERIOD, ::LEVEL_PERIOD]
    labels, pieces = _pieces(step > floor, 1)
    if not pieces:
        return None
    x, y, width, height = pieces[0].box
    inside = labels[y : y + height, x : x + width] == pieces[0].label
    level = np.percentile(step[y : y + height, x : x + width][inside], PLATEAU_PERCENTILE)
    return 0.5 * float(level) if level > 2.0 * floor else None


def _pieces(over: np.ndarray, sign: int) -> tuple[np.ndarray, list[_Piece]]:
    """Labels (h, w) and the pieces that are no specks, largest first."""
    _, labels, stats, _ = cv2.connectedComponentsWithStats(over.astype(np.uint8), connectivity=8)
    kept = np.flatnonzero(stats[:, cv2.CC_STAT_AREA] > LEAST_AREA_SHARE * over.size)
    pieces = [_Piece(_box(stats[n]), int(stats[n, 4]), int(n), sign) for n in kept if n > 0]
    return labels, sorted(pieces, key=lambda piece: -piece.area)


def _touches_edge(piece: _Piece, shape: tuple[int, ...]) -> bool:
    x, y, width, height = piece.box
    return min(x, y) <= 1 or x + width >= shape[1] - 1 or y + height >= shape[0] - 1


def _cut_out(step: np.ndarray, labels: np.ndarray, piece: _Piece, threshold: float) -> Silhouette:
    """The piece with some ground around it; its holes (dots, electrodes, gloss) belong to the body."""
    x, y, width, height = piece.box
    left, top = max(x - 12, 0), max(y - 12, 0)
    part = np.s_[top : y + height + 12, left : x + width + 12]
    own = (labels[part] == piece.label).astype(np.uint8)
    outline = cv2.findContours(own, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
    mask = cv2.drawContours(np.zeros_like(own), outline, -1, 255, cv2.FILLED)
    filled = step[part].copy()
    filled[(mask > 0) & (own == 0)] = 2.0 * threshold
    return Silhouette(filled, mask, threshold, np.array([left, top], float), piece.sign > 0)


def _box(row: np.ndarray) -> tuple[int, int, int, int]:
    left, top, width, height = (int(value) for value in row[:4])
    return left, top, width, height
