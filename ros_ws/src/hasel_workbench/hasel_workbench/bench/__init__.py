"""What a page of the workbench takes, measured in a real browser."""
