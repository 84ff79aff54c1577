"""The commands of this package; each module's `main` is one executable."""
