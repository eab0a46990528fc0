# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A control interface that answers by a script, for what no simulated robot can be made to do."""

import asyncio
import contextlib
import copy
import json
import threading

OPEN, CLOSED = [False] * 7, [True] * 7
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
REPORT = {
    "time": 1.0,
    "type": "fr3",
    "arm_id": "fr3",
    "protocol": [6, 10],
    "client": 0,
    "rules": "desk",
    "mode": "Other",
    "errors": [],
    "details": {},
    "fault": "",
    "q": [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785],
    "dq": [0.0] * 7,
    "q_d": [0.0] * 7,
    "tau_J": [0.0] * 7,
    "tau_ext": [0.0] * 7,
    "O_T_EE": IDENTITY,
    "O_F_ext": [0.0] * 6,
    "success_rate": 1.0,
    "power": True,
    "brakes": CLOSED,
    "brakes_moving": False,
    "operating_mode": "execution",
    "fci": False,
    "inputs": {"x31": False, "x32": False, "x33": False, "x4": False, "guiding": False},
    "buttons": {name: False for name in ("circle", "cross", "check", "up", "down", "left", "right")},
    "guiding": {"active": False, "mode": "free", "axes": [True] * 7},
    "navigation": "desk",
    "self_test": {"running": False, "left": 0.0, "due": 86400.0},
    "recoverable": [],
    "joint_limit_violation": [False] * 7,
    "joint_position_error": [False] * 7,
    "light": {"color": "yellow", "blinking": False},
    "hand": {
        "kind": "gripper",
        "homed": False,
        "width": 0.04,
        "max_width": 0.08,
        "grasped": False,
        "busy": False,
    },
    "end_effector": {
        "mass": 0.73,
        "center": [-0.01, 0.0, 0.03],
        "inertia": [0.001, 0, 0, 0, 0.0025, 0, 0, 0, 0.0017],
        "F_T_NE": IDENTITY,
        "power": True,
    },
    "motion": False,
}


class ScriptedRobot:
    """report: what it reports. answers: by line or its first word, an answer or a function of the words.
    lines: what was sent, without `report`. It serves in a thread of its own."""

    def __init__(self, **changes):
        self.report = {**copy.deepcopy(REPORT), **changes}
        self.answers = {}
        self.lines = []
        self.raw_report = None  # instead of the report

    def __enter__(self):
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        opening = asyncio.start_server(self._serve, "127.0.0.1", 0)
        self._server = asyncio.run_coroutine_threadsafe(opening, self._loop).result(10)
        self.port = self._server.sockets[0].getsockname()[1]
        return self

    def __exit__(self, *error):
        self._loop.call_soon_threadsafe(self._server.close)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(10)

    async def _serve(self, reader, writer):
        with contextlib.suppress(OSError):
            while line := (await reader.readline()).decode().strip():
                answer = self._answer(line)
                if asyncio.iscoroutine(answer):
                    answer = await answer
                writer.write(answer.encode() + b"\n")
                await writer.drain()
        writer.close()

    def _answer(self, line):
        if line == "report":
            return self.raw_report or "ok " + json.dumps(self.report)
        self.lines.append(line)
        word, *words = line.split()
        answer = self.answers.get(line, self.answers.get(word, "ok"))
        return answer(*words) if callable(answer) else answer
