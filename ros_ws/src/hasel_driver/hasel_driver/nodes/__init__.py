"""The lifecycle node: services, topics and actions in front of the safety process."""
