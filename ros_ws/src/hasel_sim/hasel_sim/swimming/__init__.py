"""Swimming: bodies whose shape is given, how far and how well a free body swims, sweeps, and what swims best."""
