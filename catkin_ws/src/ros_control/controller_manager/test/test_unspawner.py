# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The unspawner starts its controllers again before rospy shuts down and ends all service calls."""

import importlib.machinery
import importlib.util
import signal
import threading
from pathlib import Path

import pytest
import rospy

SCRIPT = Path(__file__).parents[1] / "scripts" / "unspawner"
# Longer than a shutdown hook that does not wait takes to return, on the busiest machine.
PATIENCE = 1.0  # [s]


@pytest.fixture
def unspawner(monkeypatch):
    """The script as a module, with a fake rospy that records calls."""
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    loader = importlib.machinery.SourceFileLoader("unspawner", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("unspawner", loader))
    loader.exec_module(module)
    monkeypatch.setattr(rospy, "init_node", lambda *_, **__: None)
    monkeypatch.setattr(rospy, "signal_shutdown", lambda _: None)
    monkeypatch.setattr(rospy, "myargv", lambda *_: ["unspawner", "a"])
    yield module
    for number, handler in handlers.items():
        signal.signal(number, handler)


def test_shutdown_waits_for_the_restart(unspawner, monkeypatch):
    hooks = []
    returned = threading.Event()
    restarts = []
    monkeypatch.setattr(rospy, "on_shutdown", hooks.append)

    def shut_down():
        for hook in hooks:
            hook()
        returned.set()

    shutdown = threading.Thread(target=shut_down)

    def stop_running(names):
        shutdown.start()
        return list(names)

    def switch(start_controllers):
        restarts.append((start_controllers, returned.wait(PATIENCE)))
        return True

    monkeypatch.setattr(unspawner, "stop_running", stop_running)
    monkeypatch.setattr(unspawner, "switch", switch)
    assert unspawner.main() == 0
    shutdown.join(60)
    assert restarts == [(["a"], False)], "the shutdown had gone on before the restart was over"
    assert returned.is_set(), "the shutdown still waits after the restart"
