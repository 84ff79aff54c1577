"""Track a camera as it runs: capture, decoding, tracking and video recording in threads."""
