"""What can be wrong with a recording; every message is one sentence that ends with what to do."""


class _OneLine:
    """What a message quotes from a file may hold any sign: what cannot be printed is shown as in a Python string."""

    def __str__(self) -> str:
        return "".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in super().__str__())


class RecordingError(_OneLine, Exception):
    """A recording cannot be read or written."""


class RecordingWarning(_OneLine, UserWarning):
    """A recording was read or written, but something in it was left out."""
