"""Record angles in real time until killed, saying the stamp of each once it is written. For the tests."""

import sys
import time

from hasel_recording import McapRecorder
from hasel_recording.topics import MEASURED

path, rate_hz = sys.argv[1], float(sys.argv[2])
recorder = McapRecorder(path)
while True:
    now_ns = time.time_ns()
    angle = {"sin_theta": 0.1, "theta": 0.1, "valid": True}
    markers = {name: [0.0, 1.0, 2.0] for name in ("marker_x", "marker_y", "marker_quality")}
    recorder.write(MEASURED, angle | markers, now_ns)
    print(now_ns, flush=True)
    time.sleep(1 / rate_hz)
