#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The six services, with the loop running and with the loop halted."""

import os
import sys
import threading
import time
import unittest

import rospy
import rostest
from controller_manager_msgs.srv import ListControllerTypes
from scripts_common import DEADLINE, STRICT, Manager, wait_for


class ServicesTest(unittest.TestCase):
    def setUp(self):
        self.manager = Manager()
        self.manager.run_loop(True)

    def tearDown(self):
        self.manager.run_loop(True)
        self.assertTrue(self.manager.reload(True).ok)
        self.assertEqual({}, self.manager.states())

    def test_types_name_their_base_class(self):
        list_types = rospy.ServiceProxy("controller_manager/list_controller_types", ListControllerTypes)
        answer = list_types()
        self.assertEqual(len(answer.types), len(answer.base_classes))
        bases = dict(zip(answer.types, answer.base_classes))
        self.assertEqual("dummies::DummyController", bases["dummy/Good"])

    def test_controller_is_loaded_started_stopped_and_unloaded(self):
        self.assertTrue(self.manager.load("a").ok)
        self.assertFalse(self.manager.load("a").ok)
        (controller,) = self.manager.list().controller
        self.assertEqual(
            ("a", "dummy/Good", "initialized"), (controller.name, controller.type, controller.state)
        )
        (claimed,) = controller.claimed_resources
        self.assertEqual("hardware_interface::EffortJointInterface", claimed.hardware_interface)
        self.assertEqual(["j0", "j3"], claimed.resources)
        self.assertTrue(self.manager.switch(start_controllers=["a"], strictness=STRICT).ok)
        self.assertEqual({"a": "running"}, self.manager.states())
        self.assertFalse(self.manager.unload("a").ok)
        self.assertTrue(
            self.manager.switch(start_controllers=["a"], stop_controllers=["a"], strictness=STRICT).ok
        )
        self.assertTrue(self.manager.switch(stop_controllers=["a"], strictness=STRICT).ok)
        self.assertEqual({"a": "stopped"}, self.manager.states())
        self.assertTrue(self.manager.unload("a").ok)
        self.assertEqual({}, self.manager.states())

    @unittest.skipUnless(os.environ.get("FRANKA_TEST_REALTIME"), "real time: ./franka test --realtime")
    def test_a_switch_is_answered_in_a_few_milliseconds(self):
        self.assertTrue(self.manager.load("a").ok)
        times = []
        for _ in range(10):
            begin = time.monotonic()
            self.assertTrue(self.manager.switch(start_controllers=["a"], strictness=STRICT).ok)
            times.append(time.monotonic() - begin)
            self.assertTrue(self.manager.switch(stop_controllers=["a"], strictness=STRICT).ok)
        self.assertLess(sorted(times)[5], 0.1)

    def test_controllers_are_listed_while_one_is_being_loaded(self):
        self.assertTrue(self.manager.load("a").ok)
        answers = []
        load = threading.Thread(target=lambda: answers.append(self.manager.load("slow")))
        load.start()
        wait_for(lambda: rospy.get_param("slow/loading", False), "The loading of slow")
        self.assertEqual({"a": "initialized"}, self.manager.states())
        self.assertEqual([], answers)
        rospy.set_param("slow/loading", False)
        load.join(DEADLINE)
        self.assertTrue(answers[0].ok)
        self.assertEqual({"a": "initialized", "slow": "initialized"}, self.manager.states())


if __name__ == "__main__":
    rospy.init_node("services_test")
    rostest.rosrun("controller_manager", "services_test", ServicesTest, sys.argv)
