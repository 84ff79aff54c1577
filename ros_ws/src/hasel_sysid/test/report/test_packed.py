"""Text that is packed into a page."""

import base64
import zlib

import pytest
from hasel_sysid.report.packed import packed


@pytest.mark.parametrize("text", ["", "a", "<&>\"'", "θ" * 5000, "".join(map(chr, range(32, 3000)))])
def test_python_s_own_decoder_gets_it_back(text):
    """Length, deflated text and padding in base 85, the characters that mean something in HTML replaced."""
    page = packed(text)
    assert not set(page) & set("<>&\"'")
    raw = base64.b85decode(page.translate(str.maketrans("/,.", "&<>")))
    length = int.from_bytes(raw[:4], "big")
    assert zlib.decompress(raw[4 : 4 + length]).decode() == text
    assert len(raw) - 4 - length < 4
