# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 service list|call`."""

import argparse

from listing import add_listing
from messages import as_yaml, filled, interface
from rclpy.node import Node
from session import spin_until


def add_parsers(commands) -> None:
    """Add what `ros2 service` knows."""
    add_listing(commands, "services", Node.get_service_names_and_types)
    call = commands.add_parser("call", help="call a service and print its answer")
    call.add_argument("service")
    call.add_argument("type", help="such as std_srvs/srv/Trigger")
    call.add_argument("values", nargs="?", default="{}", help="YAML, such as '{effect: quadratic_drag}'")
    call.set_defaults(run=call_service)


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
