"""For tests: supplies in software that tell the truth about their output, and users of the driver."""
