"""What stands in for the hardware: the swimmer as a camera sees it, the camera, and the rig."""
