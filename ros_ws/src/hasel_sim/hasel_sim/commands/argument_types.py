"""What the options of the commands take, read from text; each raises ArgumentTypeError with what is expected."""

import argparse


def numbers(text: str) -> tuple[float, ...]:
    """Numbers from "1,2.5,4" or from "first:last:step", last included. Raises ArgumentTypeError."""
    try:
        if ":" not in text:
            found = [float(part) for part in text.split(",")]
        else:
            first, last, step = (float(part) for part in text.split(":"))
            found = [first + n * step for n in range(int((last - first) / step + 1e-9) + 1)]
    except (ValueError, ZeroDivisionError):
        found = []
    if not found or not all(0 < number < float("inf") for number in found):
        raise argparse.ArgumentTypeError(
            f"'{text}' is neither a list nor a range; expected numbers above 0, such as 1,2,3 or 1:10:0.5"
        )
    return tuple(round(number, 12) for number in found)


def voltages(text: str) -> tuple[tuple[float, float], ...]:
    """Pairs of voltages [V] from "3500,5500/4800". Raises ArgumentTypeError."""
    pairs = []
    for part in text.split(","):
        first, _, second = part.partition("/")
        found = (*numbers(first), *numbers(second or first))
        if len(found) != 2:
            raise argparse.ArgumentTypeError(
                f"'{text}' is no list of voltages; expected such as 3500,4500 or 5500/4800, in V"
            )
        pairs.append((found[0], found[1]))
    return tuple(pairs)


def positive(text: str) -> float:
    """A number above 0. Raises ArgumentTypeError."""
    found = numbers(text)
    if len(found) != 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not one number; expected one above 0")
    return found[0]


def assignment(text: str) -> tuple[str, float]:
    """Name and value from "name=value". Raises ArgumentTypeError."""
    name, _, value = text.partition("=")
    try:
        return name.strip(), float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"'{text}' sets nothing; expected PARAMETER=VALUE, such as body.depth_m=0.04"
        ) from None


def free_range(text: str) -> tuple[str, tuple[float, ...]]:
    """Name and values from "name=low:high" or "name=low:high:count". Raises ArgumentTypeError."""
    name, _, values = text.partition("=")
    try:
        low, high, *count = values.split(":")
        pieces = int(count[0]) - 1 if count else 2
        first, last = float(low), float(high)
        if pieces < 1 or not first < last or len(count) > 1:
            raise ValueError
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"'{text}' is no range of a parameter; expected PARAMETER=LOW:HIGH or PARAMETER=LOW:HIGH:COUNT, such as "
            "body.depth_m=0.03:0.06"
        ) from None
    return name.strip(), tuple(first + (last - first) * n / pieces for n in range(pieces + 1))


def varied(text: str) -> dict[str, tuple[float, float] | None]:
    """Names with their ranges, None for the usual one, from "name,name=low:high". Raises ArgumentTypeError."""
    found: dict[str, tuple[float, float] | None] = {}
    for part in text.split(","):
        name, given, values = part.strip().partition("=")
        try:
            low, high = map(float, values.split(":")) if given else (0.0, 1.0)
            if not low < high:
                raise ValueError
        except ValueError:
            raise argparse.ArgumentTypeError(
                f"'{part}' is no range; expected NAME or NAME=LOW:HIGH, such as body.depth_m=0.03:0.06"
            ) from None
        found[name] = (low, high) if given else None
    return found
