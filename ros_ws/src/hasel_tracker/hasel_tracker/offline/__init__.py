"""From a video to a recording of the run."""
