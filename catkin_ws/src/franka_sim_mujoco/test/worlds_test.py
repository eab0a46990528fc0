#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Two Pandas in the SDF stone world; objects, states, gravity, snapshots, contacts, cameras at run time."""

import math
import subprocess
import sys
import time
import unittest

import numpy
import rospy
import rospy_connections
import rostest
from controller_manager_msgs.srv import ListControllers
from franka_msgs.msg import FrankaState
from franka_sim_mujoco.msg import Contacts
from franka_sim_mujoco.srv import (
    DeleteObject,
    GetBodyState,
    GetJointStates,
    GetWorld,
    PushBody,
    RestoreSnapshot,
    SetBodyPose,
    SetBodyState,
    SetGravity,
    SetJointStates,
    SpawnObject,
    Step,
    TakeSnapshot,
)
from gazebo_msgs.msg import LinkState, LinkStates, ModelState, ModelStates
from gazebo_msgs.srv import (
    DeleteModel,
    GetJointProperties,
    GetJointPropertiesResponse,
    GetLinkState,
    GetModelProperties,
    GetModelState,
    GetPhysicsProperties,
    GetWorldProperties,
    SetLinkState,
    SetModelConfiguration,
    SetModelState,
    SpawnModel,
)
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from sensor_msgs.msg import CameraInfo, Image
from std_srvs.srv import Empty, Trigger
from tf2_msgs.msg import TFMessage

WAIT = 30  # wall seconds
BALL = "<body name='{0}'><freejoint/><geom type='sphere' size='0.05' mass='0.3'/></body>"
FEATHER = """<body name='feather'><freejoint/><inertial pos='0 0 0' mass='1e-7' diaginertia='1e-7 1e-7 1e-7'/>
  <geom type='sphere' size='0.01'/></body>"""
NONE = Vector3()
# A camera looks down on the floor from 2 m; a plate of 1 m in the middle of its view stands 0.5 m high.
CAMERA = """<sdf version='1.6'><model name='eye'><static>true</static><link name='link'>
  <sensor name='cam' type='depth'><update_rate>20</update_rate><camera><horizontal_fov>1.0</horizontal_fov>
  <image><width>80</width><height>60</height></image></camera></sensor>
  <collision name='c'><pose>1.5 0 0 0 0 0</pose>
  <geometry><box><size>0.02 1 1</size></box></geometry></collision>
  <visual name='v'><pose>1.5 0 0 0 0 0</pose><geometry><box><size>0.02 1 1</size></box></geometry>
  <material><diffuse>0.1 0.9 0.1 1</diffuse></material></visual>
  </link></model></sdf>"""


def call(name, kind, *arguments, fails=False):
    rospy.wait_for_service("/gazebo/" + name, WAIT)
    answer = rospy.ServiceProxy("/gazebo/" + name, kind)(*arguments)
    if hasattr(answer, "success"):
        assert answer.success != fails, (name, arguments, answer)
    return answer


def at(x, y, z, turn=(0, 0, 0, 1)):
    return Pose(Point(x, y, z), Quaternion(*turn))


def until(condition, what):
    end = time.monotonic() + WAIT
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.05)
    raise AssertionError(f"{what} did not come about within {WAIT} s")


def running(arm):
    controllers = rospy.ServiceProxy(f"/{arm}/controller_manager/list_controllers", ListControllers)
    try:
        return {c.name for c in controllers().controller if c.state == "running"}
    except rospy.ServiceException:
        return set()  # called during its start


class WorldsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy_connections.init_node("worlds_test")
        for arm, controller in (
            ("panda_1", "cartesian_impedance_example_controller"),
            ("panda_2", "force_example_controller"),
        ):
            rospy.wait_for_service(f"/{arm}/controller_manager/list_controllers", WAIT)
            until(lambda a=arm, c=controller: {c, "franka_state_controller"} <= running(a), controller)

    def setUp(self):
        call("pause_physics", Empty)

    def external_torque_after(self, ticks):
        """External torque of joint 2 of panda_1 after a time of the simulation [Nm]."""
        messages = []
        topic = "/panda_1/franka_state_controller/franka_states"
        subscriber = rospy.Subscriber(topic, FrankaState, messages.append)
        until(subscriber.get_num_connections, topic)

        def end_is_received():
            # States come at 30 Hz; the last one may still be in transit.
            end = call("step", Step, ticks).time
            patience = time.monotonic() + 0.5
            while time.monotonic() < patience:
                if messages and (end - messages[-1].header.stamp).to_sec() < 0.08:
                    return True
                time.sleep(0.01)
            return False

        until(end_is_received, topic)
        subscriber.unregister()
        return messages[-1].tau_ext_hat_filtered[1]

    def test_1_both_arms_stand_in_the_world_of_the_sdf_file(self):
        world = call("get_world", GetWorld)
        self.assertEqual(sorted(world.robots), ["panda_1", "panda_2"])
        for body in (
            "stone",
            "stone::link",
            "table",
            "pick_tray",
            "place_tray",
            "panda_1_hand",
            "panda_2_link7",
        ):
            self.assertIn(body, world.bodies)
        self.assertIn("panda_1_joint4", world.joints)
        self.assertAlmostEqual(world.gravity.z, -9.81, delta=0.02)
        self.assertTrue(world.paused)
        stone = call("get_body_state", GetBodyState, "stone")
        self.assertAlmostEqual(stone.pose.position.x, 0.000286, delta=2e-3)
        self.assertAlmostEqual(stone.pose.position.y, -0.221972, delta=2e-3)
        # It rests on the tray: its centre is half its height above.
        self.assertAlmostEqual(stone.pose.position.z, 0.419773 + 0.023348 + 0.032, delta=1e-3)
        base = call("get_body_state", GetBodyState, "panda_2_link0").pose
        self.assertAlmostEqual(base.position.x, 0.9, delta=1e-9)
        self.assertAlmostEqual(abs(base.orientation.z), 1, delta=1e-9)

    def test_2_objects_are_spawned_fall_and_are_removed(self):
        call("spawn_object", SpawnObject, "ball", BALL.format("ball"), at(2, 2, 3))
        before = call("get_body_state", GetBodyState, "ball").pose.position.z
        self.assertAlmostEqual(before, 3)
        call("step", Step, 300)
        ball = call("get_body_state", GetBodyState, "ball")
        self.assertAlmostEqual(ball.pose.position.z, 3 - 0.5 * 9.81 * 0.09, delta=2e-3)
        self.assertAlmostEqual(ball.twist.linear.z, -9.81 * 0.3, delta=1e-3)
        thrown = Twist(Vector3(1, 0, 2), Vector3(0, 0, 3))
        call("set_body_state", SetBodyState, "ball", at(2, 2, 1), thrown)
        call("step", Step, 100)
        ball = call("get_body_state", GetBodyState, "ball")
        self.assertAlmostEqual(ball.pose.position.x, 2.1, delta=1e-3)
        self.assertAlmostEqual(ball.twist.angular.z, 3, delta=1e-3)
        again = call("spawn_object", SpawnObject, "ball", BALL.format("other"), at(0, 0, 9), fails=True)
        self.assertIn("ball", again.error)
        call("delete_object", DeleteObject, "ball")
        self.assertNotIn("ball", call("get_world", GetWorld).bodies)
        self.assertIn("ball", call("delete_object", DeleteObject, "ball", fails=True).error)
        # The robots raised no error.
        self.assertIn("cartesian_impedance_example_controller", running("panda_1"))

    def test_3_gravity_is_what_was_set(self):
        call("spawn_object", SpawnObject, "moon_ball", BALL.format("moon_ball"), at(2, 2, 3))
        call("set_gravity", SetGravity, Vector3(0, 0, -1.62))
        call("step", Step, 200)
        speed = call("get_body_state", GetBodyState, "moon_ball").twist.linear.z
        self.assertAlmostEqual(speed, -1.62 * 0.2, delta=1e-6)
        # The compensated but absent gravity pushes the arm up: with more than four fifths of its weight.
        self.assertGreater(abs(self.external_torque_after(200)), 5)
        call("set_gravity", SetGravity, Vector3(0, 0, -9.81))
        self.assertLess(abs(self.external_torque_after(500)), 1)
        self.assertIn("numbers", call("set_gravity", SetGravity, Vector3(0, math.nan, 0), fails=True).error)
        call("delete_object", DeleteObject, "moon_ball")

    def test_4_joints_are_read_and_set(self):
        names = [f"panda_2_joint{i}" for i in range(1, 8)]
        before = call("get_joint_states", GetJointStates, names).state
        self.assertEqual(list(before.name), names)
        target = list(before.position)
        target[0] += 0.3
        call("set_joint_states", SetJointStates, names, target, [])
        after = call("get_joint_states", GetJointStates, names).state
        self.assertEqual(list(after.position), target)
        call("step", Step, 50)
        self.assertIn("force_example_controller", running("panda_2"))
        call("set_joint_states", SetJointStates, names, list(before.position), [])
        wrong = call("set_joint_states", SetJointStates, names[:2], [0.0, 9.0], [], fails=True)
        self.assertIn("panda_2_joint2", wrong.error)
        # All or none.
        self.assertEqual(
            call("get_joint_states", GetJointStates, names).state.position, tuple(before.position)
        )
        self.assertIn(
            "positions", call("set_joint_states", SetJointStates, names, [0.0], [], fails=True).error
        )
        every = call("get_joint_states", GetJointStates, []).state
        self.assertEqual(len(every.name), 18)

    def test_5_a_snapshot_restores_everything(self):
        call("spawn_object", SpawnObject, "die", BALL.format("die"), at(1.5, 1.5, 0.5))
        call("step", Step, 100)
        first = call("take_snapshot", TakeSnapshot, "here").state_hash
        ends = []
        for _ in range(2):
            self.assertEqual(call("restore_snapshot", RestoreSnapshot, "here").state_hash, first)
            self.assertNotEqual(call("step", Step, 400).state_hash, first)
            ends.append(call("get_body_state", GetBodyState, "die").pose.position)
        for axis in "xyz":
            self.assertAlmostEqual(getattr(ends[0], axis), getattr(ends[1], axis), delta=1e-6)
        self.assertIn("nowhere", call("restore_snapshot", RestoreSnapshot, "nowhere", fails=True).error)
        call("delete_object", DeleteObject, "die")
        self.assertIn("came or went", call("restore_snapshot", RestoreSnapshot, "here", fails=True).error)

    def test_6_the_clock_never_goes_back(self):
        before = call("step", Step, 10)
        call("reset", Trigger)
        after = call("step", Step, 10)
        self.assertEqual((after.time - before.time).to_nsec(), 10 * 10**6)
        self.assertIn("cartesian_impedance_example_controller", running("panda_1"))

    def test_7_contact_forces_equal_the_weight_of_a_resting_object(self):
        call("reset", Trigger)
        call("step", Step, 800)

        contacts = rospy.wait_for_message("/gazebo/contacts", Contacts, WAIT)
        weight = 0.0
        for body1, body2, force in zip(contacts.body1s, contacts.body2s, contacts.forces):
            if {body1, body2} == {"stone", "pick_tray"}:
                weight += force.z if body2 == "stone" else -force.z
        self.assertAlmostEqual(weight, 0.1024 * 9.81, delta=0.02)
        self.assertEqual(contacts.header.frame_id, "world")

    def test_8_cameras_see_colours_and_distances(self):
        turned = (0, math.sin(math.pi / 4), 0, math.cos(math.pi / 4))  # looking down
        call("spawn_object", SpawnObject, "eye", CAMERA, at(3, 3, 2, turned))
        self.assertIn("eye::link::cam", call("get_world", GetWorld).cameras)
        topic = "/gazebo/eye/link/cam/"
        frames = []
        listener = rospy.Subscriber("/tf", TFMessage, lambda m: frames.extend(m.transforms))
        # Paused: one picture per subscriber; depth subscribes first, so that all are rendered.
        depths, images, infos = [], [], []
        listeners = [
            rospy.Subscriber(topic + "depth/image_raw", Image, depths.append),
            rospy.Subscriber(topic + "image_raw", Image, images.append),
            rospy.Subscriber(topic + "camera_info", CameraInfo, infos.append),
        ]

        def all_are_there():
            call("step", Step, 60)
            return depths and images and infos and [f for f in frames if "cam" in f.child_frame_id]

        transform = until(all_are_there, "a picture")[-1]
        for each in (*listeners, listener):
            each.unregister()
        depth = numpy.frombuffer(depths[-1].data, numpy.float32).reshape(60, 80)
        self.assertAlmostEqual(depth[30, 40], 1.49, delta=0.005)  # the plate's upper face
        self.assertEqual(depths[-1].encoding, "32FC1")
        image = numpy.frombuffer(images[-1].data, numpy.uint8).reshape(60, 80, 3).astype(int)
        red, green, blue = image[30, 40]
        self.assertGreater(green, 2 * max(red, blue))
        info = infos[-1]
        self.assertAlmostEqual(info.K[0], 40 / math.tan(0.5), delta=1e-9)
        # The plate's edge is 0.5 m from the axis.
        columns = numpy.nonzero(depth[30] < 1.6)[0]
        self.assertAlmostEqual(columns.size, 2 * info.K[0] * 0.5 / 1.49, delta=2)
        self.assertAlmostEqual(transform.transform.translation.z, 2, delta=1e-9)
        q = transform.transform.rotation
        self.assertAlmostEqual(1 - 2 * (q.x**2 + q.y**2), -1, delta=1e-6)  # the optical axis points down
        call("delete_object", DeleteObject, "eye")

    def test_9_spawn_model_accepts_sdf_and_mjcf_and_refuses_others(self):
        def spawn(text, *options):
            command = ["rosrun", "gazebo_ros", "spawn_model", "-stdin", *options]
            return subprocess.run(command, input=text, text=True, capture_output=True, timeout=60)

        done = spawn(
            BALL.format("cherry"), "-mjcf", "-model", "cherry", "-reference_frame", "table", "-z", "1"
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        cherry = call("get_body_state", GetBodyState, "cherry").pose.position
        self.assertAlmostEqual(cherry.x, 0.016428, delta=1e-9)
        self.assertAlmostEqual(cherry.z, 1.0, delta=1e-9)
        call("delete_object", DeleteObject, "cherry")
        failed = spawn("<html/>", "-model", "page")
        self.assertEqual(failed.returncode, 1)
        self.assertIn("<html>", failed.stdout + failed.stderr)

    def test_divergence_pauses_is_reported_and_ends_with_a_reset(self):
        call("spawn_object", SpawnObject, "feather", FEATHER, at(3, 3, 3))
        for size, push in ((1e12, (1e12, 0, 0)), (-10001, (0, 0, -10001))):
            order = ("feather", Vector3(*push), NONE, False, Point(), 5)
            refused = call("push_body", PushBody, *order, fails=True)
            self.assertIn(f"is {size:g} N; at most 10000 N", refused.error)
        twist = Twist(Vector3(1001, 0, 0), NONE)
        refused = call("set_body_state", SetBodyState, "feather", at(0, 0, 9), twist, fails=True)
        self.assertIn("is 1001 m/s; at most 1000 m/s", refused.error)
        refused = call("set_body_pose", SetBodyPose, "feather", at(1e11, 0, 0), fails=True)
        self.assertIn("is 1e+11 m; at most 1000 m", refused.error)
        refused = call("set_gravity", SetGravity, Vector3(0, 0, -981), fails=True)
        self.assertIn("is -981 m/s^2; at most 100 m/s^2", refused.error)
        refused = call("spawn_object", SpawnObject, "ball", BALL.format("ball"), at(0, 1e9, 0), fails=True)
        self.assertIn("is 1e+09 m; at most 1000 m", refused.error)
        place = call("get_body_state", GetBodyState, "feather").pose.position
        self.assertEqual((place.x, place.y, place.z), (3, 3, 3), "nothing was half done")
        # It is so light that 10 000 N make it diverge.
        for runs in (False, True):
            if runs:
                call("unpause_physics", Empty)
            call("push_body", PushBody, "feather", Vector3(1e4, 0, 0), NONE, False, Point(), 5)
            if runs:
                until(lambda: call("get_world", GetWorld).paused, "the pause of a world that diverged")
            error = call("step", Step, 5, fails=True).error
            self.assertIn("The physics diverged: the acceleration of body 'feather", error)
            with self.assertRaises(rospy.ServiceException):
                call("unpause_physics", Empty)
            error = call("set_body_pose", SetBodyPose, "feather", at(0, 0, 1), fails=True).error
            self.assertIn("until it is reset", error)
            call("reset", Trigger)
            self.assertEqual(call("get_world", GetWorld).paused, not runs)
        call("delete_object", DeleteObject, "feather")

    def test_an_object_inside_a_robot_is_reported(self):
        hand = call("get_body_state", GetBodyState, "panda_1_hand").pose.position
        ball = BALL.format("inside")
        answer = call("spawn_object", SpawnObject, "inside", ball, at(hand.x, hand.y, hand.z))
        self.assertIn("inside begins within panda_1_", answer.warning)
        call("delete_object", DeleteObject, "inside")

    def near(self, point, x, y, z):
        for axis, value in zip("xyz", (x, y, z)):
            self.assertAlmostEqual(getattr(point, axis), value, delta=1e-6)

    def test_gazebo_services_read_models_and_links(self):
        names = set(call("get_world_properties", GetWorldProperties).model_names)
        scenery = {"stone", "table", "pick_tray", "place_tray", "ground_plane"}
        self.assertEqual(names, scenery | {"panda_1", "panda_2"})
        stone = call("get_body_state", GetBodyState, "stone").pose.position
        self.near(
            call("get_model_state", GetModelState, "stone", "").pose.position, stone.x, stone.y, stone.z
        )
        seen = call("get_model_state", GetModelState, "stone", "panda_2::panda_2_link0")
        self.near(seen.pose.position, 0.9 - stone.x, -stone.y, stone.z)  # its base is rotated by half a turn
        self.assertEqual(seen.header.frame_id, "panda_2::panda_2_link0")
        link = call("get_link_state", GetLinkState, "stone::link", "table").link_state
        self.near(link.pose.position, stone.x - 0.016428, stone.y - 0.000584, stone.z)
        joint = call("get_joint_properties", GetJointProperties, "panda_1_joint4")
        measured = call("get_joint_states", GetJointStates, ["panda_1_joint4"]).state
        self.assertEqual((joint.position[0], joint.rate[0]), (measured.position[0], measured.velocity[0]))
        self.assertEqual(joint.type, GetJointPropertiesResponse.REVOLUTE)
        finger = call("get_joint_properties", GetJointProperties, "panda_2::panda_2_finger_joint1")
        self.assertEqual(finger.type, GetJointPropertiesResponse.PRISMATIC)
        arm = call("get_model_properties", GetModelProperties, "panda_2")
        self.assertIn("panda_2_link7", arm.body_names)
        self.assertEqual(len(arm.joint_names), 9)
        self.assertFalse(arm.is_static)
        self.assertTrue(call("get_model_properties", GetModelProperties, "table").is_static)
        physics = call("get_physics_properties", GetPhysicsProperties)
        self.assertTrue(physics.pause)
        self.assertAlmostEqual(physics.gravity.z, -9.81, delta=0.02)
        for name, kind, arguments in (
            ("get_model_state", GetModelState, ("moon", "")),
            ("get_model_state", GetModelState, ("stone", "moon")),
            ("get_link_state", GetLinkState, ("moon", "")),
            ("get_joint_properties", GetJointProperties, ("moon",)),
            ("get_model_properties", GetModelProperties, ("moon",)),
            ("delete_model", DeleteModel, ("moon",)),
        ):
            self.assertIn("'moon'", call(name, kind, *arguments, fails=True).status_message)

    def test_gazebo_services_and_topics_set_states(self):
        spun = Twist(Vector3(0, 0, 1), Vector3(0, 0, 2))
        unset = at(2, 2, 1, (0, 0, 0, 0))  # defaults of a message
        call("set_model_state", SetModelState, ModelState("stone", unset, spun, ""))
        state = call("get_model_state", GetModelState, "stone", "world")
        self.near(state.pose.position, 2, 2, 1)
        self.near(state.twist.linear, 0, 0, 1)
        self.near(state.twist.angular, 0, 0, 2)
        frame = "panda_2_link0"
        call("set_link_state", SetLinkState, LinkState("stone::link", at(1, 0, 1), Twist(), frame))
        self.near(call("get_model_state", GetModelState, "stone", "").pose.position, -0.1, 0, 1)
        self.near(call("get_model_state", GetModelState, "stone", frame).pose.position, 1, 0, 1)
        for state, word in (
            (ModelState("panda_1", at(0, 0, 1), Twist(), ""), "not free to move"),
            (ModelState("table", at(0, 0, 1), Twist(), ""), "not free to move"),
            (ModelState("stone", at(0, 0, math.nan), Twist(), ""), "finite"),
            (ModelState("stone", at(0, 0, 1), Twist(), "moon"), "'moon'"),
        ):
            answer = call("set_model_state", SetModelState, state, fails=True)
            self.assertIn(word, answer.status_message)
        with_topic = rospy.Publisher("/gazebo/set_model_state", ModelState, queue_size=1, latch=True)
        with_topic.publish(ModelState("stone", at(-2, 1, 1), Twist(), ""))

        def stone():
            states = rospy.wait_for_message("/gazebo/model_states", ModelStates, WAIT)
            return states.pose[states.name.index("stone")].position

        until(lambda: stone() == Point(-2, 1, 1), "the stone where the topic put it")
        with_topic.unregister()
        links = rospy.wait_for_message("/gazebo/link_states", LinkStates, WAIT)
        self.near(links.pose[links.name.index("stone::link")].position, -2, 1, 1)
        hand = call("get_body_state", GetBodyState, "panda_1_hand").pose.position
        self.near(links.pose[links.name.index("panda_1::panda_1_hand")].position, hand.x, hand.y, hand.z)
        self.assertEqual(len(links.name), len(links.twist))

    def test_gazebo_models_are_spawned_configured_and_deleted(self):
        ball = BALL.format("marble")
        spawned = call(
            "spawn_sdf_model", SpawnModel, "marble", ball, "", at(0, 0, 1, (0, 0, 0, 0)), "panda_2_link0"
        )
        self.assertTrue(spawned.success)
        self.near(call("get_model_state", GetModelState, "marble", "").pose.position, 0.9, 0, 1)
        call("delete_model", DeleteModel, "marble")
        self.assertNotIn("marble", call("get_world_properties", GetWorldProperties).model_names)
        answer = call("delete_model", DeleteModel, "table", fails=True)
        self.assertIn("belongs to the world file", answer.status_message)
        configure = ("panda_2", "robot_description", ["panda_2_joint1"])
        before = call("get_joint_properties", GetJointProperties, "panda_2_joint1").position[0]
        call("set_model_configuration", SetModelConfiguration, *configure, [before + 0.2])
        self.assertEqual(
            call("get_joint_properties", GetJointProperties, "panda_2_joint1").position[0], before + 0.2
        )
        call("set_model_configuration", SetModelConfiguration, *configure, [before])
        answer = call("set_model_configuration", SetModelConfiguration, *configure, [9.0], fails=True)
        self.assertIn("panda_2_joint1", answer.status_message)

    def test_states_come_from_both_robots(self):
        call("unpause_physics", Empty)
        for arm in ("panda_1", "panda_2"):
            state = rospy.wait_for_message(f"/{arm}/franka_state_controller/franka_states", FrankaState, WAIT)
            self.assertEqual(state.robot_mode, FrankaState.ROBOT_MODE_MOVE)
            self.assertEqual(state.header.frame_id, "")


if __name__ == "__main__":
    rostest.rosrun("franka_sim_mujoco", "worlds", WorldsTest, sys.argv)
