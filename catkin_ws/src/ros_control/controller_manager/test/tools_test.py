#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The scripts controller_manager, unspawner and controller_group, and the Python helpers."""

import contextlib
import io
import runpy
import sys
import threading
import unittest
from unittest import mock

import rosnode
import rospy
import rostest
from controller_manager_msgs import utils
from scripts_common import STRICT, Manager, Running, program, wait_for

EFFORT = "hardware_interface::EffortJointInterface"


def run(name, *arguments):
    """Runs a script with the node of this test, which is faster. Returns exit status and output."""
    output = io.StringIO()
    with (
        mock.patch.object(sys, "argv", [name, *arguments]),
        mock.patch.object(rospy, "init_node"),
        mock.patch.object(rospy, "logerr", lambda text, *values: print(text % values)),
        contextlib.redirect_stdout(output),
    ):
        try:
            runpy.run_path(program(name), run_name="__main__")
        except SystemExit as end:
            return end.code, output.getvalue()
    raise AssertionError(f"{name} has no exit status")


class ToolsTest(unittest.TestCase):
    def setUp(self):
        self.manager = Manager()
        self.manager.run_loop(True)

    def tearDown(self):
        self.assertTrue(self.manager.reload(True).ok)
        self.assertEqual({}, self.manager.states())

    def check(self, expected_status, expected_texts, *arguments, name="controller_manager"):
        status, output = run(name, *arguments)
        for text in expected_texts:
            self.assertIn(text, output)
        self.assertEqual(expected_status, status, output)

    def test_scripts_are_nodes_of_their_own(self):
        for name, command, argument in (
            ("controller_manager", "spawn", "a"),
            ("controller_group", "switch", "right"),
        ):
            with Running(name, command, argument) as process:
                status, output = process.finish()
            self.assertEqual(0, status, output)
        self.assertEqual({"a": "stopped", "b": "running", "c": "running"}, self.manager.states())

    def test_controller_manager(self):
        self.check(0, ["No controllers are loaded in mechanism control"], "list")
        self.check(0, ["dummy/Good"], "lt")
        self.check(0, ["Loaded 'a'"], "load", "a")
        self.check(1, ["Error when loading 'a'"], "load", "a")
        self.check(0, ["Started ['a'] successfully"], "start", "a")
        self.check(1, ["Error when starting ['a'] and stopping []"], "start", "a")
        self.check(0, [f"'a' - '{EFFORT}' ( running )"], "lc")
        self.check(1, ["Error when unloading 'a'"], "unload", "a")
        self.check(0, ["Stopped ['a'] successfully"], "stop", "a")
        self.check(0, ["Unloaded 'a' successfully"], "unload", "a")
        self.check(0, ["Loaded 'a'", "Loaded 'c'", "Started ['a', 'c']"], "spawn", "a", "c")
        self.check(0, ["Stopped ['a']", "Unloaded 'a' successfully"], "kl", "a")
        restored = ["Successfully reloaded libraries", "Controllers restored to original state"]
        self.check(0, restored, "reload-libraries", "--restore")
        self.assertEqual({"c": "running"}, self.manager.states())

    def test_usage(self):
        self.check(0, ["usage: controller_manager"])
        self.check(1, ["usage: controller_manager"], "dance")
        self.check(1, ["usage: controller_manager"], "load")
        self.check(1, ["usage: unspawner"], name="unspawner")
        self.check(0, ["usage: unspawner"], "-h", name="unspawner")
        self.check(0, ["usage: controller_group"], name="controller_group")
        self.check(1, ["usage: controller_group"], "spawn", name="controller_group")

    def test_unspawner(self):
        self.manager.spawn("a", "c")
        with Running("unspawner", "a") as unspawner:
            wait_for(lambda: self.manager.states()["a"] == "stopped", "The stop of a")
            self.assertEqual("running", self.manager.states()["c"])
            self.assertTrue(self.manager.switch(start_controllers=["a"], strictness=STRICT).ok)
            wait_for(lambda: self.manager.states()["a"] == "stopped", "The stop of a")
            status, _ = unspawner.interrupt()
        self.assertEqual(0, status)
        self.assertEqual({"a": "running", "c": "running"}, self.manager.states())

    def test_unspawner_ended_by_the_master(self):
        self.manager.spawn("a")
        with Running("unspawner", "a") as unspawner:
            wait_for(lambda: self.manager.states()["a"] == "stopped", "The stop of a")
            nodes = [name for name in rosnode.get_node_names() if name.startswith("/unspawner_")]
            kill = threading.Thread(target=rosnode.kill_nodes, args=(nodes,))
            switch_waits = self.manager.halt_loop()
            kill.start()
            wait_for(switch_waits, "The restart")
            self.assertTrue(unspawner.is_running())
            self.manager.run_loop(True)
            status, output = unspawner.finish()
            kill.join()
        self.assertEqual(0, status, output)
        self.assertEqual({"a": "running"}, self.manager.states(), output)

    def test_controller_group(self):
        name = "controller_group"
        groups = "Number of groups: 2\n  left\n      a\n  right\n      b\n      c\n"
        self.check(0, [groups], "list", name=name)
        self.check(0, ["Loaded 'a'", "Started ['a'] successfully"], "spawn", "left", name=name)
        self.check(0, ["Started ['b', 'c']", "Stopped ['a']"], "switch", "right", name=name)
        self.assertEqual({"a": "stopped", "b": "running", "c": "running"}, self.manager.states())
        self.check(0, ["There is no controller defined in group up"], "switch", "up", name=name)
        # b cannot run together with a, which another client has started.
        self.manager.switch(start_controllers=["a"], stop_controllers=["b"], strictness=STRICT)
        self.check(0, ["Error when starting ['b']"], "spawn", "right", name=name)

    def test_finding_managers(self):
        self.assertEqual(
            ["/controller_manager", "/other/controller_manager"], utils.get_controller_managers()
        )
        self.assertEqual(["/other/controller_manager"], utils.get_controller_managers("/other"))
        self.assertTrue(utils.is_controller_manager("/controller_manager"))
        self.assertFalse(utils.is_controller_manager("/"))
        with mock.patch.object(utils, "is_controller_manager", wraps=utils.is_controller_manager) as ask:
            found = utils.get_controller_managers("/", ["/other/controller_manager", "/gone"])
        self.assertEqual(["/controller_manager", "/other/controller_manager"], found)
        ask.assert_called_once_with("/controller_manager")
        lister = utils.ControllerManagerLister("/other")
        self.assertEqual(["/other/controller_manager"], lister())
        self.assertEqual(["a", "b", "c"], utils.get_rosparam_controller_names())
        self.assertEqual(["a"], utils.get_rosparam_controller_names("/other"))

    def test_filtering_controllers(self):
        self.manager.spawn("a", "c")
        controllers = utils.ControllerLister()()

        def names(chosen):
            return [one.name for one in chosen]

        self.assertEqual(["a", "c"], names(controllers))
        self.assertEqual(["a"], names(utils.filter_by_name(controllers, "a")))
        self.assertEqual([], names(utils.filter_by_type(controllers, "Good")))
        self.assertEqual(["a", "c"], names(utils.filter_by_type(controllers, "Good", True)))
        self.assertEqual(["a", "c"], names(utils.filter_by_state(controllers, "running")))
        self.assertEqual(["a", "c"], names(utils.filter_by_hardware_interface(controllers, EFFORT)))
        self.assertEqual(["a"], names(utils.filter_by_resources(controllers, ["j0", "j3"])))
        self.assertEqual([], names(utils.filter_by_resources(controllers, ["j0", "j1"])))
        self.assertEqual(
            ["a", "c"], names(utils.filter_by_resources(controllers, ["j0", "j1"], EFFORT, True))
        )
        self.assertEqual([], names(utils.filter_by_resources(controllers, ["j0"], "other")))
        self.assertEqual([], utils.ControllerLister("/nowhere")())


if __name__ == "__main__":
    rospy.init_node("tools_test")
    rostest.rosrun("controller_manager", "tools_test", ToolsTest, sys.argv)
