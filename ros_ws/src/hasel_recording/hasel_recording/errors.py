"""What can be wrong with a recording; every message is one sentence that ends with what to do."""


class RecordingError(Exception):
    """A recording cannot be read or written."""


class RecordingWarning(UserWarning):
    """A recording was read or written, but something in it was left out."""
