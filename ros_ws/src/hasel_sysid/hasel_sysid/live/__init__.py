"""The node `sysid`: the error while it is heard, and the fit and the diagnosis that its services give."""
