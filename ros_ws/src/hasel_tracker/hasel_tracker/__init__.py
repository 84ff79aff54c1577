"""From a camera or a video to three markers and the bending angle."""
