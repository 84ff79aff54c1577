"""The tracker's own exception: one sentence that says what was found, what was expected and what to do."""


class TrackerError(Exception):
    """Bad input or an unusable device; the text is meant to be shown to the user as it is."""
