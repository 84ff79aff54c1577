"""A figure that a notebook shows and that can be written to a file, whatever the plotting backend."""

from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure

from hasel_sysid.api.writing import path_of, written
from hasel_sysid.errors import SysidError
from hasel_sysid.report.numbers import count_text

_DOTS_PER_INCH = 110


class Picture:
    """figure: matplotlib's, to be changed at will."""

    def __init__(self, figure: Figure) -> None:
        self.figure = figure

    def save(self, path: str | Path) -> Path:
        """Write it; the file's ending (.png, .svg, .pdf) says as what. Raises SysidError."""
        path, kinds = path_of(path), self.figure.canvas.get_supported_filetypes()
        if path.suffix.lower().removeprefix(".") not in kinds:
            raise SysidError(
                f"'{path}' does not say which kind of picture; expected a name that ends in .png, .svg or .pdf: choose "
                "one"
            )
        return written(path, lambda path: self.figure.savefig(path, dpi=2 * _DOTS_PER_INCH))

    def __str__(self) -> str:
        panels = len([axes for axes in self.figure.axes if axes.get_visible()])
        return f"A picture of {count_text(panels, 'panel')}: a notebook shows it, and save('picture.png') writes it."

    __repr__ = __str__

    def _repr_png_(self) -> bytes:
        buffer = BytesIO()
        self.figure.savefig(buffer, format="png", dpi=_DOTS_PER_INCH)
        return buffer.getvalue()
