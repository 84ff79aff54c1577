"""Launch files, configurations and the demonstration of the HASEL swimmer stack."""
