"""`ros2 service list|call`."""

import argparse

from messages import as_yaml, filled, interface
from rclpy.node import Node
from session import discover, spin_until


def add_parsers(commands) -> None:
    """Add what `ros2 service` knows."""
    listing = commands.add_parser("list", help="services that are there")
    listing.add_argument("-t", "--show-types", action="store_true")
    listing.set_defaults(run=list_services)
    call = commands.add_parser("call", help="call a service and print its answer")
    call.add_argument("service")
    call.add_argument("type", help="such as std_srvs/srv/Trigger")
    call.add_argument("values", nargs="?", default="{}", help="YAML, such as '{effect: quadratic_drag}'")
    call.set_defaults(run=call_service)


def list_services(node: Node, options: argparse.Namespace) -> None:
    """Print the names, with types if asked to."""
    discover(node)
    for name, types in sorted(node.get_service_names_and_types()):
        print(f"{name} [{', '.join(types)}]" if options.show_types else name)


def call_service(node: Node, options: argparse.Namespace) -> None:
    """Wait for the service, call it, print request and response."""
    kind = interface(options.type, "srv")
    request = filled(kind.Request(), options.values)
    client = node.create_client(kind, options.service)
    if not spin_until(node, client.service_is_ready, 2.0):
        print("waiting for service to become available...", flush=True)
        spin_until(node, client.service_is_ready)
    print(f"requester: making request:\n{as_yaml(request)}", flush=True)
    answer = client.call_async(request)
    spin_until(node, answer.done)
    print(f"response:\n{as_yaml(answer.result())}", flush=True)
