"""Pictures of a moving swimmer with known truth, as a camera would take them."""

CODECS = ("mjpeg", "h264")
