"""How often the right physical effect is named when one is hidden in data of a simulator that is not the model."""
