# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The name of a virtual port is a link, and nothing else is touched."""

import pytest
from hasel_driver.protocol.faults import PortError
from hasel_driver.virtual.pseudo_terminal import PseudoTerminal


@pytest.mark.parametrize("what", ["file", "folder", "another link"])
def test_what_is_there_is_left_alone(tmp_path, what):
    """A file, a folder, and a link that leads to something that exists."""
    link = tmp_path / "supply"
    if what == "file":
        link.write_text("precious")
    elif what == "folder":
        link.mkdir()
    else:
        link.symlink_to("/dev/null")
    with pytest.raises(PortError, match="where nothing is"):
        PseudoTerminal(link)
    assert link.exists()


def test_its_own_link_comes_and_goes(tmp_path):
    """One that a killed supply left behind is replaced; at the end only its own is taken away."""
    link = tmp_path / "supply"
    link.symlink_to("/dev/pts/99999")
    port = PseudoTerminal(link)
    assert str(link.readlink()) == port.path
    link.unlink()
    link.write_text("precious")
    port.unplug()
    assert link.read_text() == "precious"
