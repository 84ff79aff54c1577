"""Writing video, and pictures that show what the tracker sees."""
