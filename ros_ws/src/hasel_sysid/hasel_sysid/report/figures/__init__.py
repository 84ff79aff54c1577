"""The report's figures, one per file, each a function from content to a plotly figure."""
