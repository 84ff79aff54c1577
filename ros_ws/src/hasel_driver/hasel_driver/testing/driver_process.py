"""The driver's node in a process of its own."""

import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

from hasel_driver.mode import Mode
from hasel_driver.testing.ros_client import RosClient


class DriverProcess:
    """Starts the node on a port; `log` collects what it prints."""

    def __init__(self, client: RosClient, port: str, **parameters: object) -> None:
        self._client = client
        client.states.clear()
        self._folder = tempfile.TemporaryDirectory(prefix="hasel_driver_")
        self.folder = Path(self._folder.name)
        self.history = self.folder / "history.jsonl"
        folders = dict.fromkeys(("recording_directory", "waveform_directory", "state_folder"), self.folder)
        own = {"history_file": self.history, **folders}
        chosen = {"port": port, "discovery_time": 0.2} | own | parameters
        arguments = [word for key, value in chosen.items() for word in ("-p", f"{key}:={value}")]
        self.process = subprocess.Popen(
            [sys.executable, "-m", "hasel_driver.driver_node", "--ros-args", *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.log: list[str] = []
        self._reader = threading.Thread(target=lambda: self.log.extend(self.process.stdout), daemon=True)
        self._reader.start()

    def arm(self) -> None:
        """From STANDBY; waits for the discovery time, and for publishers that are about to leave."""
        self._client.await_mode(Mode.STANDBY)
        for _ in range(20):
            answer = self._client.trigger("arm")
            if answer.success:
                self._client.command((0.0, 0.0))  # with which every controller begins
                return
            time.sleep(0.2)
        raise AssertionError(answer.message)

    def to_standby(self) -> None:
        """From whatever state, of the lifecycle too."""
        client = self._client
        client.activate()
        client.wait(lambda: bool(client.states), 10.0)
        client.trigger("disarm")
        client.states.clear()
        client.wait(lambda: bool(client.states))
        if client.state.mode == Mode.FAULT:
            client.trigger("clear_fault")
        self._client.await_mode(Mode.STANDBY)

    def close(self) -> None:
        """End the process, politely first, so that the graph forgets it."""
        self.process.terminate()
        try:
            self.process.wait(5.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self._reader.join(timeout=5.0)
        self._folder.cleanup()
