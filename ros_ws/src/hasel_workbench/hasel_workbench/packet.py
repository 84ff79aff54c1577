"""A header and an array of 32-bit numbers as bytes: what a page fetches."""

import json

import numpy as np


def packet(header: dict, numbers: np.ndarray) -> bytes:
    """Length of the header (little-endian, 4 bytes), the header as JSON padded with blanks to a multiple of four bytes,
    and the numbers, little-endian, row by row.
    """
    text = json.dumps(header, ensure_ascii=False, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    return len(text).to_bytes(4, "little") + text + np.ascontiguousarray(numbers, dtype="<f4").tobytes()
