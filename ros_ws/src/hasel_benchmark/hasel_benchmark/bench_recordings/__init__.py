"""What `improve` costs for more and more recordings."""
