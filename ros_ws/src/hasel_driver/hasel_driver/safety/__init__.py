"""The process that alone talks to the supply, without ROS: what it decides, checks, drives, and tells the node."""
