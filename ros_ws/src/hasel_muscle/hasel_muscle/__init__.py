"""One muscle on its bench: compare stroke and force with the law, see where it fails, learn what is missing, add it."""
