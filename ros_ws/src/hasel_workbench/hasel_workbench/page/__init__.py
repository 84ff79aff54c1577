"""The page: a thin layer over the session, on NiceGUI and plain canvases."""
