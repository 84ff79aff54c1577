"""Names of nodes as the graph knows them."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.topic_endpoint_info import TopicEndpointInfo

UNNAMED = "a node whose name is not known yet"
_NOT_KNOWN_YET = "_NODE_NAME_UNKNOWN_"


def full_name(info: "TopicEndpointInfo") -> str:
    """With its namespace."""
    if info.node_name == _NOT_KNOWN_YET:
        return UNNAMED
    return f"{info.node_namespace.rstrip('/')}/{info.node_name}"
