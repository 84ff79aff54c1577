"""The whole way from measuring to knowing what is missing, on recordings or live on a virtual rig."""
