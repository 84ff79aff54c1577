"""Where the noise of a measured angle can be seen without any model being right."""
