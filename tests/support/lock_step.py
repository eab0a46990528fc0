# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Motions of a lock-step robot whose client, or the robot itself, stops in the middle."""

import os
import signal
import time
from contextlib import contextmanager, suppress


@contextmanager
def stopped(process):
    """Stops a process, as a debugger does, until the end of the block."""
    os.kill(process.pid, signal.SIGSTOP)
    try:
        yield
    finally:
        with suppress(ProcessLookupError):
            os.kill(process.pid, signal.SIGCONT)


def begin_motion(client, **task):
    """Gives the client a motion, and waits until it moves. With `held` its callback waits for `go_on`."""
    client.give("move", announce=True, **task)
    begun = client.line()
    assert begun == "moving", begun


def moved(sim, client, torque=False, process=None, seconds=0.0, pause=0.0, motion=8.0):
    """One motion of `motion` seconds from a reset world. `process` is stopped for `seconds` in its middle; or
    the callback sleeps once for `pause`. @returns the robot's hash."""
    sim.remote.reset()
    held = process is not None
    begin_motion(
        client, seconds=motion, amplitude=0.0 if torque else 0.1, torque=torque, pause=pause, held=held
    )
    if held:
        with stopped(process):
            client.go_on()
            time.sleep(seconds)  # the fault itself
    result = client.result(timeout=120.0)
    assert result["outcome"] == "ok", result
    assert client.run_task("set_load")["outcome"] == "ok"  # answered when the world is at rest
    return sim.remote.state_hash()
