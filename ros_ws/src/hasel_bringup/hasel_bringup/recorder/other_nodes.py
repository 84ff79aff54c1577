"""The parameters of the rig's other nodes, asked for in the background."""

from rcl_interfaces.srv import GetParameters, ListParameters
from rclpy.client import Client
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python

_PERIOD_S = 1.0
_INTERNAL = ("qos_overrides.", "start_type_description_service", "use_sim_time")
_SECRETIVE = "hasel_virtual_camera"  # what it hides is not for recordings


class OtherNodes:
    """`known()` gives what the nodes of this node's namespace answered last, as {node.parameter: value}."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients: dict[str, tuple[Client, Client]] = {}  # kept: a new one needs time to find its service
        self._values: dict[str, dict[str, object]] = {}
        node.create_timer(_PERIOD_S, self._ask)

    def known(self) -> dict[str, object]:
        """The values, at most some seconds old."""
        return {
            f"{node}.{name}": value
            for node, values in sorted(self._values.items())
            for name, value in sorted(values.items())
        }

    def _ask(self) -> None:
        here = self._node.get_namespace()
        for name, namespace in self._node.get_node_names_and_namespaces():
            if (
                namespace == here
                and name.startswith("hasel_")
                and name not in (self._node.get_name(), _SECRETIVE)
            ):
                self._list(name)

    def _list(self, name: str) -> None:
        if name not in self._clients:
            self._clients[name] = (
                self._node.create_client(ListParameters, f"{name}/list_parameters"),
                self._node.create_client(GetParameters, f"{name}/get_parameters"),
            )
        lister, getter = self._clients[name]
        if not (lister.service_is_ready() and getter.service_is_ready()):
            return

        def listed(future) -> None:
            names = [n for n in future.result().result.names if not n.startswith(_INTERNAL)]
            self._get(name, names)

        lister.call_async(ListParameters.Request()).add_done_callback(listed)

    def _get(self, name: str, names: list[str]) -> None:
        def got(future) -> None:
            values = map(parameter_value_to_python, future.result().values)
            self._values[name] = dict(zip(names, values, strict=False))

        getter = self._clients[name][1]
        getter.call_async(GetParameters.Request(names=names)).add_done_callback(got)
