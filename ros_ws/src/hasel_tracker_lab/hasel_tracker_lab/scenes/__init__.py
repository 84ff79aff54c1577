"""Pictures of a laboratory, drawn apart from `render`: what the tracker must not be fooled by."""
