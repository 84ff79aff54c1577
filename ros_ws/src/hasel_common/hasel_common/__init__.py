"""What every package needs around its own work: commands, nodes, parameters, topics and provenance."""

from hasel_common.lazy_version import lazy_version

__getattr__ = lazy_version(__name__)
