# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Record angles in real time until killed, saying the stamp of each once it is written. For the tests."""

import sys
import time

from hasel_common.topics import MEASURED
from hasel_recording import McapRecorder
from hasel_recording.ros_messages import bending_angle_message

path, rate_hz = sys.argv[1], float(sys.argv[2])
recorder = McapRecorder(path)
while True:
    now_ns = time.time_ns()
    pixels = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]
    angle = bending_angle_message(0.1, marker_names=("head", "middle", "tail"), pixels=pixels)
    recorder.write(MEASURED, angle, now_ns)
    print(now_ns, flush=True)
    time.sleep(1 / rate_hz)
