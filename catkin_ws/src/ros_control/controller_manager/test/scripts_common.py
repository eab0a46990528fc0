# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Helpers of the tests of services and scripts."""

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import roslib.packages
import rospy
from controller_manager_msgs.srv import (
    ListControllers,
    LoadController,
    ReloadControllerLibraries,
    SwitchController,
    SwitchControllerRequest,
    UnloadController,
)
from std_srvs.srv import SetBool

sys.path.append(str(Path(__file__).resolve().parents[5] / "tests" / "support"))
from waiting import wait_for  # noqa: E402

DEADLINE = 60.0  # [s]
STRICT = SwitchControllerRequest.STRICT


class Manager:
    """A client of the manager under test."""

    def __init__(self, namespace=""):
        def proxy(name, kind):
            full = f"{namespace}/{name}"
            rospy.wait_for_service(full, DEADLINE)
            return rospy.ServiceProxy(full, kind)

        self.list = proxy("controller_manager/list_controllers", ListControllers)
        self.load = proxy("controller_manager/load_controller", LoadController)
        self.unload = proxy("controller_manager/unload_controller", UnloadController)
        self.switch = proxy("controller_manager/switch_controller", SwitchController)
        self.reload = proxy("controller_manager/reload_controller_libraries", ReloadControllerLibraries)
        self.run_loop = proxy("run_loop", SetBool)

    def halt_loop(self):
        """Returns a condition: a switch that has come since waits for the loop."""
        before = rospy.get_param("prepared_switches", 0)
        self.run_loop(False)
        return lambda: rospy.get_param("prepared_switches", 0) > before

    def spawn(self, *names):
        assert all([self.load(name).ok for name in names])
        assert self.switch(start_controllers=names, strictness=STRICT).ok

    def states(self):
        return {controller.name: controller.state for controller in self.list().controller}


def program(name):
    paths = roslib.packages.find_node("controller_manager", name)
    assert paths, f"{name} is not installed"
    return paths[0]


class Running:
    """A script in its own process, ended with the test."""

    def __init__(self, name, *arguments):
        self.output = ""  # so far
        self.process = subprocess.Popen(
            [program(name), *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=dict(os.environ, PYTHONUNBUFFERED="1"),
        )
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            self.output += line

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.finish()
        self.process.stdout.close()

    def wait_to_print(self, text):
        wait_for(lambda: text in self.output, lambda: f"{self.output}\n'{text}'")

    def is_running(self):
        return self.process.poll() is None

    def interrupt(self):
        self.process.send_signal(signal.SIGINT)
        return self.finish()

    def finish(self):
        """Waits for the end. Returns exit status and output."""
        self.process.wait(DEADLINE)
        self._reader.join()
        return self.process.returncode, self.output
