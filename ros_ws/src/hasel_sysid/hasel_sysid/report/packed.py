"""Text packed into a page: deflated, in 85 characters that mean nothing in HTML; `unpack.js` is the way back."""

import string
import zlib

import numpy as np

ALPHABET = f"{string.digits}{string.ascii_uppercase}{string.ascii_lowercase}!#$%/()*+-;,=.?@^_`{{|}}~"
"""That of RFC 1924 with / , . in the place of & < >."""


def packed(text: str) -> str:
    """A third of the text's size or less, without any of < > & and quotes."""
    raw = zlib.compress(text.encode(), 6)
    counted = len(raw).to_bytes(4, "big") + raw
    words = np.frombuffer(counted + bytes(-len(counted) % 4), dtype=">u4").astype(np.uint32)
    places = np.array([85**4, 85**3, 85**2, 85, 1], dtype=np.uint32)
    digits = words[:, None] // places % 85
    return np.frombuffer(ALPHABET.encode(), dtype=np.uint8)[digits].tobytes().decode("ascii")
