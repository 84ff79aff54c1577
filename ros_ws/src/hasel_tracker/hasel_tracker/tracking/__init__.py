"""From an image to three markers and the bending angle."""
