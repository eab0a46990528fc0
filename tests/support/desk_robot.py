# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A control interface that answers by a script, for what no simulated robot can be made to do.

By itself it obeys the lines that Desk sends, in no time and without the rules of a robot.
"""

import asyncio
import contextlib
import copy
import json
import threading

from operator_table import operator_table

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
    "user_stop": [],
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
    """report: what it reports. answers: by line or its first word, an answer or a function of the words, in
    place of its own. lines: what was sent, without `report`, of which reports is the number. It
    serves in a thread of its own."""

    def __init__(self, **changes):
        self._first = {**REPORT, **changes}
        self.reset()
        self.reports = 0  # answered
        self.port = 0
        self._writers = set()

    def reset(self):
        """Is again as it was first."""
        self.report = copy.deepcopy(self._first)
        self.raw_report = None  # instead of the report
        self.answers = {}
        self.lines = []

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *error):
        self.stop()

    def start(self):
        """Serves, at the same port as before."""
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        opening = asyncio.start_server(self._serve, "127.0.0.1", self.port)
        self._server = asyncio.run_coroutine_threadsafe(opening, self._loop).result(10)
        self.port = self._server.sockets[0].getsockname()[1]

    def stop(self):
        """Goes away."""
        if not self._thread.is_alive():
            return
        asyncio.run_coroutine_threadsafe(self._end(), self._loop).result(10)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(10)

    def call(self, work, *arguments):
        """Calls a function in the thread of the robot."""
        self._loop.call_soon_threadsafe(work, *arguments)

    async def _end(self):
        self._server.close()
        for writer in list(self._writers):
            writer.transport.abort()
        tasks = asyncio.all_tasks() - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _serve(self, reader, writer):
        self._writers.add(writer)
        with contextlib.suppress(OSError):
            while line := (await reader.readline()).decode().strip():
                answer = self._answer(line)
                if asyncio.iscoroutine(answer):
                    answer = await answer
                writer.write(answer.encode() + b"\n")
                await writer.drain()
        self._writers.discard(writer)
        writer.close()

    def _answer(self, line):
        if line == "report":
            self.reports += 1
            return "ok " + json.dumps(self.report) if self.raw_report is None else self.raw_report
        if line == "help json":
            return "ok " + operator_table()
        self.lines.append(line)
        word, *words = line.split()
        answer = self.answers.get(line, self.answers.get(word))
        if answer is None:
            return self._obey(word, words)
        return answer(*words) if callable(answer) else answer

    def _obey(self, word, words):
        report, on = self.report, words[-1:] == ["on"]
        if word == "joints":
            report["brakes"] = OPEN if words == ["unlock"] else CLOSED
        elif word in ("fci", "power"):
            report[word] = on
        elif word in ("operating_mode", "navigation"):
            report[word] = words[0]
        elif word == "guiding_mode":
            report["guiding"]["mode"] = words[0]
        elif word == "end_effector_power":
            report["end_effector"]["power"] = on
        elif word == "end_effector":
            self._set_end_effector([float(each) for each in words])
        elif (word, words) == ("hand", ["homing"]):
            report["hand"]["homed"] = True
        elif word == "acknowledge":
            if words[0] not in report["recoverable"]:
                return "error: NoAckRequired: Nothing has to be acknowledged."
            report["recoverable"].remove(words[0])
        return "ok"

    def _set_end_effector(self, numbers):
        self.report["end_effector"].update(
            mass=numbers[0], center=numbers[1:4], inertia=numbers[4:13], F_T_NE=numbers[13:]
        )
