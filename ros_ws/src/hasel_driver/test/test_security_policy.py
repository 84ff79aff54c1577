# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Keys: the policy names what the node really has, and a driver that cannot be protected does not run unprotected."""

import os
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as Tree
from pathlib import Path

import pytest
from hasel_driver.nodes.driver_services import SERVICES
from hasel_driver.protocol.status import Mode

POLICY = Path(__file__).parents[1] / "security" / "policy.xml"
NAMESPACE = "/hasel/"
DISCOVERY_S = 5.0
NODE = [sys.executable, "-m", "hasel_driver.nodes.driver_node", "--ros-args", "--enclave"]
START = "from hasel_driver.start import console; raise SystemExit(console())"
CONSOLE = [sys.executable, "-c", START, "--ros-args", "--enclave"]


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
    nodes = ("hasel_driver", "hasel_driver_inputs")
    expected = {(node, "/hasel") for node in nodes}
    ros.wait(lambda: expected <= set(ros.node.get_node_names_and_namespaces()), DISCOVERY_S)
    for node in nodes:
        published = {name for name, _ in ros.node.get_publisher_names_and_types_by_node(node, "/hasel")}
        heard = {name for name, _ in ros.node.get_subscriber_names_and_types_by_node(node, "/hasel")}
        served = {name for name, _ in ros.node.get_service_names_and_types_by_node(node, "/hasel")}
        assert {n for n in published if "_action" not in n} <= names("/hasel/driver", "topic", "publish")
        assert {n for n in heard if "_action" not in n} <= names("/hasel/driver", "topic", "subscribe")
        assert {n for n in served if "_action" not in n} <= names("/hasel/driver", "service", "reply")


def protected(keys: Path) -> dict[str, str]:
    """The environment in which nothing runs without its key."""
    own = {
        "ROS_SECURITY_ENABLE": "true",
        "ROS_SECURITY_STRATEGY": "Enforce",
        "ROS_SECURITY_KEYSTORE": str(keys),
    }
    return os.environ | own


def run(words: list[str], environment: dict[str, str], typed: str = "") -> subprocess.CompletedProcess:
    """A command to its end."""
    return subprocess.run(
        words, env=environment, input=typed, capture_output=True, text=True, timeout=120, check=False
    )


def worthless_keys(folder: Path) -> Path:
    """A key store of the right form with a key of its own for the driver, which signs nothing that is a permission."""
    enclave = folder / "enclaves" / "hasel" / "driver"
    enclave.mkdir(parents=True)
    certificate, key = enclave / "cert.pem", enclave / "key.pem"
    making = [
        "openssl",
        "req",
        "-x509",
        "-newkey",
        "ec",
        "-pkeyopt",
        "ec_paramgen_curve:prime256v1",
        "-nodes",
    ]
    subprocess.run(
        [*making, "-subj", "/CN=driver", "-keyout", key, "-out", certificate], check=True, capture_output=True
    )
    for name in ("identity_ca.cert.pem", "permissions_ca.cert.pem"):
        shutil.copy(certificate, enclave / name)
    for name in ("governance", "permissions"):
        (enclave / f"{name}.xml").write_text("<dds/>")
        signing = [
            "openssl",
            "smime",
            "-sign",
            "-text",
            "-in",
            enclave / f"{name}.xml",
            "-signer",
            certificate,
        ]
        subprocess.run([*signing, "-inkey", key, "-out", enclave / f"{name}.p7s"], check=True)
    return folder


@pytest.mark.parametrize("keys", ["none", "worthless"])
def test_without_usable_keys_the_driver_ends(tmp_path, virtual_rig, keys):
    """Asked to enforce security and unable to, it says so in a sentence instead of running open to everybody."""
    if keys == "worthless" and shutil.which("openssl") is None:
        pytest.skip("needs openssl")
    folder = worthless_keys(tmp_path / "keys") if keys == "worthless" else tmp_path
    command = [*NODE, "/hasel/driver"]
    command += ["-p", f"port:={virtual_rig.port}", "-p", f"state_folder:={tmp_path}"]
    done = run([*command, "-p", f"history_file:={tmp_path}/history.jsonl"], protected(folder))
    assert (done.returncode, "Traceback" in done.stderr) == (1, False), done.stderr
    assert "hasel_driver:" in done.stderr
    assert virtual_rig.changes == []


def test_without_usable_keys_the_console_ends(tmp_path):
    """With a sentence, and with the words that `ros2 run` hands on to ROS."""
    words = [*CONSOLE, "/hasel/commander"]
    done = run(words, protected(tmp_path))
    assert (done.returncode, "Traceback" in done.stderr) == (1, False), done.stderr
    assert done.stderr.startswith("console: ")


@pytest.fixture(scope="module")
def keys(tmp_path_factory) -> Path:
    """Made of the policy by ROS 2's own tool."""
    if shutil.which("ros2") is None:
        pytest.skip("needs ROS 2 from apt with its package sros2")
    folder = tmp_path_factory.mktemp("keys")
    for words in (["create_keystore", folder], ["generate_artifacts", "-k", folder, "-p", POLICY]):
        done = run(["ros2", "security", *map(str, words)], dict(os.environ))
        if "invalid choice" in done.stderr:
            pytest.skip("ROS 2 is there without its package sros2")
        assert done.returncode == 0, done.stderr
    return folder


def test_keys_are_made_of_the_policy(keys):
    """`ros2 security` accepts the policy."""
    assert (keys / "enclaves" / "hasel" / "driver" / "permissions.p7s").is_file()


def test_only_the_commanders_key_arms(keys, tmp_path, virtual_rig):
    """The driver under its key: who has the observer's, or none, does not arm it."""
    driver = [*NODE, "/hasel/driver"]
    for word in (
        f"port:={virtual_rig.port}",
        f"state_folder:={tmp_path}",
        f"history_file:={tmp_path}/h.jsonl",
    ):
        driver += ["-p", word]
    with subprocess.Popen(driver, env=protected(keys)) as process:
        try:
            time.sleep(DISCOVERY_S)
            assert process.poll() is None
            unprotected = run([*CONSOLE, "/"], dict(os.environ), "arm\nquit\n")
            observer = run([*CONSOLE, "/hasel/observer"], protected(keys), "arm\nquit\n")
            assert "Armed" not in unprotected.stdout + observer.stdout
            assert not virtual_rig.live
            commander = run([*CONSOLE, "/hasel/commander"], protected(keys), "arm\nquit\n")
            assert "Armed" in commander.stdout, commander.stderr
        finally:
            process.terminate()
