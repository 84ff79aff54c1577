"""How fast the simulator is, and how exact, measured beside the bars it must meet."""
