"""Keys: the policy names what the node really has, and a driver that cannot be protected does not run unprotected."""

import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as Tree
from pathlib import Path

import pytest
from hasel_driver.driver_services import SERVICES
from hasel_driver.mode import Mode

POLICY = Path(__file__).parents[1] / "security" / "policy.xml"
NAMESPACE = "/hasel/"


def names(enclave: str, kind: str, permission: str) -> set[str]:
    """What an enclave's profiles allow."""
    found = Tree.parse(POLICY).findall(
        f".//enclave[@path='{enclave}']//{kind}s[@{permission}='ALLOW']/{kind}"
    )
    return {element.text for element in found}


def test_only_the_commander_may_arm_and_command():
    """Who listens may stop, and nothing else; who drives serves, and commands nobody."""
    services = {f"{NAMESPACE}{name}" for name in SERVICES}
    assert services <= names("/hasel/driver", "service", "reply")
    assert services <= names("/hasel/commander", "service", "request")
    assert names("/hasel/observer", "service", "request") == {"/hasel/emergency_stop"}
    assert "/hasel/command" in names("/hasel/commander", "topic", "publish")
    assert "/hasel/command" not in names("/hasel/observer", "topic", "publish") | names(
        "/hasel/driver", "topic", "publish"
    )


def test_every_topic_and_service_of_the_node_is_in_the_policy(start_driver, virtual_rig, ros):
    """What is not in the policy would not work with keys."""
    start_driver(virtual_rig.port)
    ros.await_mode(Mode.STANDBY)
    for node in ("hasel_driver", "hasel_driver_inputs"):
        published = {name for name, _ in ros.node.get_publisher_names_and_types_by_node(node, "/hasel")}
        heard = {name for name, _ in ros.node.get_subscriber_names_and_types_by_node(node, "/hasel")}
        served = {name for name, _ in ros.node.get_service_names_and_types_by_node(node, "/hasel")}
        assert {n for n in published if "_action" not in n} <= names("/hasel/driver", "topic", "publish")
        assert {n for n in heard if "_action" not in n} <= names("/hasel/driver", "topic", "subscribe")
        assert {n for n in served if "_action" not in n} <= names("/hasel/driver", "service", "reply")


def test_without_usable_keys_the_driver_ends(tmp_path, virtual_rig):
    """Asked to enforce security and unable to, it says so in a sentence instead of running open to everybody."""
    protected = {
        "ROS_SECURITY_ENABLE": "true",
        "ROS_SECURITY_STRATEGY": "Enforce",
        "ROS_SECURITY_KEYSTORE": str(tmp_path),
    }
    done = subprocess.run(
        [sys.executable, "-m", "hasel_driver.driver_node", "--ros-args", "-p", f"port:={virtual_rig.port}"]
        + ["-p", "state_folder:=" + str(tmp_path), "-p", f"history_file:={tmp_path}/history.jsonl"],
        env=os.environ | protected,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, "Traceback" in done.stderr) == (1, False), done.stderr
    assert "hasel_driver:" in done.stderr


@pytest.mark.skipif(shutil.which("ros2") is None, reason="needs ROS 2 from apt with its package sros2")
def test_keys_are_made_of_the_policy(tmp_path):
    """`ros2 security` accepts the policy."""
    for words in (
        ["create_keystore", str(tmp_path / "keys")],
        ["generate_artifacts", "-k", str(tmp_path / "keys"), "-p", str(POLICY)],
    ):
        done = subprocess.run(
            ["ros2", "security", *words], capture_output=True, text=True, timeout=120, check=False
        )
        if "invalid choice" in done.stderr:
            pytest.skip("ROS 2 is there without its package sros2")
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "keys" / "enclaves" / "hasel" / "driver" / "permissions.p7s").is_file()
