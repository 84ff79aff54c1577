"""Compare the model with measurements, fit it, and learn which physical effect it lacks."""
