"""A file that leads a browser to an address: every user can read a browser's command line, and only the owner this."""

from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory

_PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><meta http-equiv="refresh" content="0; url={0}"><title>HASEL workbench</title></head>
<body><a href="{0}">To the workbench</a></body>
</html>
"""


class RedirectFile:
    """uri: its address; below: where it is, in a folder of its own, as a browser in a snap sees no temporary files."""

    def __init__(self, address: str, below: Path) -> None:
        self._folder = TemporaryDirectory(prefix="open_", dir=below)
        path = Path(self._folder.name).resolve() / "workbench.html"
        path.touch(0o600)
        path.write_text(_PAGE.format(escape(address)), encoding="utf-8")
        self.uri = path.as_uri()

    def remove(self) -> None:
        """With its folder."""
        self._folder.cleanup()
