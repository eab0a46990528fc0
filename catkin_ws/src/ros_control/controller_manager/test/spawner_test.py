#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The spawner, from its arguments to its exit."""

import contextlib
import io
import os
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

import rosnode
import rospy
import rostest
from controller_manager import spawner
from rosgraph_msgs.msg import Clock
from rospy.impl.registration import RegManager
from scripts_common import STRICT, Manager, Running, wait_for
from std_msgs.msg import Bool

# A controller manager that exits when it must stop a controller, as one in the same launch file does.
MORTAL_MANAGER = """
import os
import rospy
from controller_manager_msgs.msg import ControllerState
from controller_manager_msgs.srv import *

def switch(request):
    if request.stop_controllers:
        os._exit(0)
    return SwitchControllerResponse(ok=True)

rospy.init_node("mortal_manager")
running = [ControllerState(name="a", state="running")]
for name, kind, answer in (
    ("list_controllers", ListControllers, lambda _: ListControllersResponse(controller=running)),
    ("load_controller", LoadController, lambda _: LoadControllerResponse(ok=True)),
    ("unload_controller", UnloadController, lambda _: UnloadControllerResponse(ok=True)),
    ("switch_controller", SwitchController, switch),
):
    rospy.Service("/mortal/controller_manager/" + name, kind, answer)
rospy.spin()
"""


class SpawnerTest(unittest.TestCase):
    def setUp(self):
        self.manager = Manager()
        self.manager.run_loop(True)
        self.assertEqual({}, self.manager.states())

    def expect(self, states, manager=None):
        manager = manager or self.manager
        wait_for(lambda: manager.states() == states, lambda: f"{manager.states()}\n{states}")

    def test_starts_and_unloads_controllers(self):
        with Running("spawner", "a", "c", "a") as spawner:
            self.expect({"a": "running", "c": "running"})
            status, output = spawner.interrupt()
        self.expect({})
        self.assertEqual(0, status, output)
        for text in (
            "Loading controller: a",
            "Started controllers: a, c",
            "Stopped controllers: a, c",
        ):
            self.assertIn(text, output)
        order = [output.index(f"Unloaded controller: {name}") for name in ("c", "a")]
        self.assertEqual(sorted(order), order)

    def test_stopped_only_loads_and_the_originals_shutdown_timeout_has_no_effect(self):
        with Running("spawner", "--stopped", "--shutdown-timeout", "1", "a") as spawner:
            self.expect({"a": "initialized"})
            status, output = spawner.interrupt()
        self.assertEqual(0, status)
        self.assertNotIn("Stopped controllers", output)
        self.assertIn("--shutdown-timeout has no effect", output)
        self.expect({})

    def test_ignores_controllers_stopped_by_others(self):
        with Running("spawner", "a", "c") as spawner:
            self.expect({"a": "running", "c": "running"})
            self.assertTrue(self.manager.switch(stop_controllers=["a"], strictness=STRICT).ok)
            self.assertTrue(self.manager.unload("a").ok)
            status, output = spawner.interrupt()
        self.assertEqual(0, status)
        self.assertNotIn("Failed", output)
        self.expect({})

    def test_one_failure_does_not_stop_the_rest(self):
        with Running("spawner", "nobody", "c") as spawner:
            self.expect({"c": "running"})
            _, output = spawner.interrupt()
        self.assertIn("Failed to load nobody", output)
        self.assertIn("Started controllers: c", output)

    def test_nothing_loaded_is_an_error(self):
        with Running("spawner", "nobody") as spawner:
            status, output = spawner.finish()
        self.assertEqual(1, status)
        self.assertIn("no controller could be loaded", output)

    def test_a_conflict_is_reported_and_cleaned_up(self):
        with Running("spawner", "a", "b") as spawner:
            spawner.wait_to_print("Failed to start controllers: a, b")
            self.expect({"a": "initialized", "b": "initialized"})
            _, output = spawner.interrupt()
        self.assertIn("Failed to start controllers: a, b", output)
        self.expect({})

    def test_waits_for_a_topic(self):
        publisher = rospy.Publisher("initialized", Bool, queue_size=1, latch=True)
        publisher.publish(False)
        with Running("spawner", "--no-timeout", "--wait-for", "initialized", "a") as running:
            wait_for(lambda: publisher.get_num_connections() > 0, "A subscriber")
            self.assertEqual({}, self.manager.states())
            publisher.publish(True)
            self.expect({"a": "running"})
            running.interrupt()
        self.expect({})

    def test_finds_a_publisher_whose_announcement_was_lost(self):
        clock = mock.Mock()
        clock.monotonic.return_value = 0.0
        with mock.patch.object(spawner, "time", clock):
            with mock.patch.object(RegManager, "publisher_update") as update:
                listener = spawner.Listener("overheard")
                publisher = rospy.Publisher("overheard", Bool, queue_size=1, latch=True)
                publisher.publish(True)
                wait_for(lambda: any(call.args[1] for call in update.call_args_list), "The announcement")
                self.assertFalse(listener.has_message())
            clock.monotonic = time.monotonic
            with contextlib.closing(listener):
                wait_for(listener.has_message, "The message")

    def test_reports_the_topic_that_it_waits_for(self):
        publisher = rospy.Publisher("reported", Bool, queue_size=1, latch=True)
        reports = []
        short_ending = mock.Mock(sleep=lambda duration: time.sleep(0.01))  # the loop's period

        def take(text, *values):
            reports.append(text % values)
            # Times of the reports, and then the awaited topic.
            publisher.publish("only sent false" in reports[-1])

        often = mock.patch.multiple(spawner, FIRST_REPORT=0.0, REPORT_PERIOD=0.5)
        with often, mock.patch.object(spawner.rospy, "logwarn", take):
            spawner.wait_for_true("reported", short_ending)
        self.assertIn("/reported", reports[0])
        self.assertIn("has only sent false so far", reports[-1])

    def test_gives_up_without_a_manager(self):
        with Running("spawner", "--timeout", "0.5", "--namespace", "/nowhere", "a") as spawner:
            status, output = spawner.finish()
        self.assertEqual(1, status)
        self.assertIn(
            "Controller Spawner couldn't find the expected controller_manager ROS interface.",
            output,
        )

    def test_an_unstarted_clock_does_not_count_as_waiting_time(self):
        simulated, wall = mock.Mock(), mock.Mock()
        simulated.has_begun.return_value, wall.monotonic.return_value = False, 0.0
        with mock.patch.object(spawner, "time", wall):
            deadline = spawner.Deadline(30.0, simulated)
            wall.monotonic.return_value = 100.0
            self.assertFalse(deadline.is_over())
            simulated.has_begun.return_value = True
            wall.monotonic.return_value = 129.0
            self.assertFalse(deadline.is_over())
            wall.monotonic.return_value = 131.0
            self.assertTrue(deadline.is_over())

    def test_waits_for_an_unstarted_clock(self):
        rospy.set_param("/use_sim_time", True)
        try:
            with Running("spawner", "--timeout", "0.5", "--namespace", "/nowhere", "a") as running:
                running.wait_to_print("Waiting for /clock to be available...")
                publisher = rospy.Publisher("/clock", Clock, queue_size=1, latch=True)
                publisher.publish(Clock(rospy.Time(1)))
                status, _ = running.finish()
            self.assertEqual(1, status)
        finally:
            rospy.delete_param("/use_sim_time")

    def test_another_namespace(self):
        other = Manager("/other")
        with Running("spawner", "--namespace", "/other", "a") as spawner:
            self.expect({"a": "running"}, other)
            self.assertEqual({}, self.manager.states())
            spawner.interrupt()
        self.expect({}, other)

    def test_yaml_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "controllers.yaml")
            with open(path, "w", encoding="utf-8") as file:
                file.write("from_file: {type: dummy/Good, joints: [j1]}\n")
                file.write("second: {type: dummy/Good, joints: [j2]}\n")
            with Running("spawner", path) as running:
                self.expect({"from_file": "running", "second": "running"})
                running.interrupt()
            self.expect({})
            self.assertEqual("dummy/Good", rospy.get_param("/from_file/type"))

            cases = (
                ("- a\n", "names of controllers"),
                ("42\n", "names of controllers"),
                ("---\n", "names of controllers"),
                ("a: {type: null}\n", "names of controllers"),
                ("{a: [\n", "could not be read"),
            )
            for content, text in cases:
                with open(path, "w", encoding="utf-8") as file:
                    file.write(content)
                with self.subTest(content), self.assertRaisesRegex(spawner.SpawnerError, text):
                    spawner.controller_names([path])
        with self.assertRaisesRegex(spawner.SpawnerError, "there is no file '/no/such/file.yaml'"):
            spawner.controller_names(["/no/such/file.yaml"])

    def test_can_be_interrupted_while_the_start_waits_for_the_loop(self):
        switch_waits = self.manager.halt_loop()
        with Running("spawner", "a") as spawner:
            wait_for(switch_waits, "The switch")
            wait_for(lambda: "stands still" in spawner.output, "The reason for the wait")
            status, output = spawner.interrupt()
        self.assertEqual(0, status, output)
        self.assertIn("Failed to unload controller: a", output)
        self.manager.run_loop(True)
        self.expect({"a": "running"})
        self.assertTrue(self.manager.switch(stop_controllers=["a"], strictness=STRICT).ok)
        self.assertTrue(self.manager.unload("a").ok)

    def test_rosnode_kill_unloads_controllers_too(self):
        with Running("spawner", "a", "__name:=victim") as spawner:
            self.expect({"a": "running"})
            killed, _ = rosnode.kill_nodes(["/victim"])
            self.assertEqual(["/victim"], killed)
            status, output = spawner.finish()
        self.assertEqual(0, status, output)
        self.assertIn("Unloaded controller: a", output)
        self.expect({})

    def test_names_are_required(self):
        with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(io.StringIO()):
            spawner.parse_arguments([])
        self.assertEqual(2, end.exception.code)

    @contextlib.contextmanager
    def mortal_manager(self):
        """A manager of its own process, and a spawner that has started a controller in it."""
        manager = subprocess.Popen([sys.executable, "-c", MORTAL_MANAGER])
        try:
            with Running("spawner", "--namespace", "/mortal", "a") as spawner:
                spawner.wait_to_print("Started controllers: a")
                yield manager, spawner
        finally:
            manager.kill()
            manager.wait()

    def test_a_manager_that_exits_at_the_same_time_causes_no_error(self):
        with self.mortal_manager() as (manager, spawner):
            status, output = spawner.interrupt()
            self.assertEqual(0, status, output)
            self.assertIn("has ended meanwhile", output)
            self.assertNotIn("WARN", output)
            self.assertEqual(0, manager.wait(60))

    def test_a_manager_that_died_before_causes_no_error(self):
        with self.mortal_manager() as (manager, spawner):
            manager.kill()  # the master still lists its services
            manager.wait()
            status, output = spawner.interrupt()
            self.assertEqual(0, status, output)
            self.assertIn("has ended already", output)
            self.assertNotIn("WARN", output)

    def test_asks_again_when_a_connection_breaks(self):
        """Before the manager has the request, or with the manager's answer."""
        for broken in ("request", "answer"):
            faults = [broken, "", broken, ""]  # of the load and of the switch, and of their repetitions

            def call(service, request, _waits=None, faults=faults):
                fault = faults.pop(0)
                answer = service(request) if fault != "request" else None
                if fault:
                    raise rospy.ServiceException("transport error")
                return answer

            one = spawner.Spawner("", mock.Mock(call=call))
            one.load(["a"])
            with mock.patch.object(spawner.rospy, "loginfo") as told:
                one.start()
            self.assertIn(mock.call("Started controllers: %s", "a"), told.call_args_list)
            self.assertEqual({"a": "running"}, self.manager.states())
            one.take_away()
            self.assertEqual({}, self.manager.states())

    def test_does_not_wait_for_a_loop_that_stands_still(self):
        one = spawner.Spawner("", mock.Mock(call=lambda service, request, *_: service(request)))
        one.load(["a"])
        one.start()
        self.assertEqual({"a": "running"}, self.manager.states())
        self.manager.run_loop(False)
        short = mock.patch.object(spawner, "STOP_TIMEOUT", 0.2)
        with short, mock.patch.object(spawner.rospy, "logwarn") as warn:
            one.take_away()
        self.assertIn(mock.call("Failed to stop controllers: %s", "a"), warn.call_args_list)
        self.manager.run_loop(True)
        self.assertTrue(self.manager.switch(stop_controllers=["a"], strictness=STRICT).ok)
        self.assertTrue(self.manager.unload("a").ok)


if __name__ == "__main__":
    rospy.init_node("spawner_test")
    rostest.rosrun("controller_manager", "spawner_test", SpawnerTest, sys.argv)
