"""The error waterfall as a picture within the page, which follows its colours."""

from collections.abc import Sequence
from html import escape

from hasel_sysid.report.wording import change_text, error_text

from hasel_workbench.waterfall import Waterfall

_WIDTH, _HEIGHT, _LEFT, _TOP, _BOTTOM = 360, 210, 6, 36, 42


def waterfall_svg(falling: Waterfall) -> str:
    """Fitted and, where there are any, unseen runs at one scale; what is being tried is hatched."""
    groups = [("fitted runs", "fitted", [s.error for s in falling.stages])]
    if all(stage.error_unseen is not None for stage in falling.stages):
        groups.append(("unseen runs", "unseen", [s.error_unseen for s in falling.stages]))
    highest = max(error for *_, errors in groups for error in errors)
    labels = [stage.label for stage in falling.stages]
    drawn = "".join(_group(*group, labels, highest, falling) for group in groups)
    return f'<div class="wb-waterfalls">{drawn}</div>'


def _group(
    title: str, kind: str, errors: Sequence[float], labels: Sequence[str], highest: float, falling: Waterfall
) -> str:
    count = len(errors) + (1 if len(errors) > 1 else 0)
    pitch = (_WIDTH - 2 * _LEFT) / max(count, 3)
    scale = (_HEIGHT - _TOP - _BOTTOM) / (1.06 * highest)

    def y(error: float) -> float:
        return _HEIGHT - _BOTTOM - scale * error

    said = "; ".join(f"{label} {error_text(error)}" for label, error in zip(labels, errors, strict=True))
    parts = [
        f'<svg class="waterfall" viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img" '
        f'aria-label="Mean error on {title}, step by step: {escape(said)}">',
        f'<text class="title" x="{_LEFT}" y="14">{title}</text>',
    ]
    bars = [(0.0, errors[0], f"total {kind}", error_text(errors[0]), labels[0])]
    for number, (before, after) in enumerate(zip(errors, errors[1:], strict=False), start=1):
        sort = "drop" if after <= before else "rise"
        tried = " tried" if falling.tried and number == len(errors) - 1 else ""
        bars.append((before, after, sort + tried, change_text(after - before), labels[number]))
    if len(errors) > 1:
        bars.append((0.0, errors[-1], f"total {kind}", error_text(errors[-1]), "left over"))
    for number, (before, after, css, text, label) in enumerate(bars):
        left, top = _LEFT + number * pitch, y(max(before, after))
        height = max(1.0, abs(before - after) * scale)
        middle = left + 0.45 * pitch
        parts.append(
            f'<rect class="{css}" x="{left:.1f}" y="{top:.1f}" width="{0.9 * pitch:.1f}" height="{height:.1f}"/>'
            f'<text class="number" x="{middle:.1f}" y="{top - 4:.1f}">{text}</text>'
            f'<text class="label" x="{middle:.1f}" y="{_HEIGHT - _BOTTOM + 14}">'
            f"{escape(_short(label, pitch))}<title>{escape(label)}</title></text>"
        )
    floor = y(falling.noise_floor)
    if floor > _TOP:
        parts.append(
            f'<line class="noise" x1="{_LEFT}" x2="{_WIDTH - _LEFT}" y1="{floor:.1f}" y2="{floor:.1f}"/>'
        )
    note = f"dashed: noise floor {error_text(falling.noise_floor)}"
    parts.append(f'<text class="noise" x="{_LEFT}" y="{_HEIGHT - 4}">{note}</text>')
    return "".join(parts) + "</svg>"


def _short(label: str, pitch: float) -> str:
    most = max(4, int(pitch / 6.2))
    return label if len(label) <= most else label[: most - 1] + "…"
