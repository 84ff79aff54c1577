"""How well `improve` finds its way from far off: truths of another mesh whose ringing is up to 60 % off."""
