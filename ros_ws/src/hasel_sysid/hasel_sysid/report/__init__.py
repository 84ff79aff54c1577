"""One self-contained HTML page about a comparison, a fit or an improvement."""
