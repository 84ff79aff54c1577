"""A figure that a notebook shows and that can be written to a file, whatever the plotting backend."""

from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure

_DOTS_PER_INCH = 110


class Picture:
    """figure: matplotlib's, to be changed at will."""

    def __init__(self, figure: Figure) -> None:
        self.figure = figure

    def save(self, path: str | Path) -> Path:
        """Write it; the file's ending (.png, .svg, .pdf) says as what."""
        self.figure.savefig(path, dpi=2 * _DOTS_PER_INCH)
        return Path(path)

    def _repr_png_(self) -> bytes:
        buffer = BytesIO()
        self.figure.savefig(buffer, format="png", dpi=_DOTS_PER_INCH)
        return buffer.getvalue()
