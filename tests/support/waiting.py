# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Waits for conditions, with deadlines."""

import time

PATIENCE = 60.0  # limit for immediate reactions, on a busy machine [s]
PAUSE = 0.005  # [s] between two looks


def holds(condition, patience: float = PATIENCE, pause: float = PAUSE) -> bool:
    """Whether a condition comes true in time."""
    deadline = time.monotonic() + patience
    while not (result := condition()):
        if time.monotonic() > deadline:
            return False
        time.sleep(pause)  # between two looks
    return bool(result)


def wait_for(condition, what="It", patience: float = PATIENCE, pause: float = PAUSE):
    """The value of a condition that comes true; fails if it does not in time.

    `what` completes: "... did not come"; a function is called for it in the end.
    """
    found = None

    def look():
        nonlocal found
        found = condition()
        return found

    in_time = holds(look, patience, pause)
    assert in_time, f"{what() if callable(what) else what} did not come within {patience:g} s."
    return found
