# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Executes Python that a test sends, with the packages of a client's own environment.

One JSON line in, one out: {"run": statements} or {"value": expression}. The answer has the value, or the
error's type and text. What a client prints goes to standard error.
`wait_for` is there for all of them.
"""

import json
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))
from waiting import wait_for  # noqa: E402

sys.path.pop()  # the client's packages only


def execute(task: dict, names: dict) -> object:
    if "run" in task:
        exec(task["run"], names)  # noqa: S102 - the test's own statements
        return None
    return eval(task["value"], names)  # noqa: S307 - the test's own expression


def answer(task: dict, names: dict) -> dict:
    try:
        return {"value": execute(task, names)}
    except Exception as error:  # noqa: BLE001 - its type and text are tested
        return {"error": type(error).__name__, "text": str(error)}


def main() -> None:
    out, sys.stdout = sys.stdout, sys.stderr
    names: dict = {"__name__": "client", "wait_for": wait_for}
    for line in sys.stdin:
        print(json.dumps(answer(json.loads(line), names), default=str), file=out, flush=True)


main()
