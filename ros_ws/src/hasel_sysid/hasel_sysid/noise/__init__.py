"""The noise of the measured angle: its model, where it is measured, and how it is bounded elsewhere."""
