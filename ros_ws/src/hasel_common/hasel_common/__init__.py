"""What every package needs around its own work: commands, nodes, parameters, topics and provenance."""
