# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Two Pandas in the SDF stone world; objects, states, gravity, snapshots, contacts, cameras at run time."""

import math
import subprocess
from pathlib import Path

import numpy
import pytest
import rospy
from franka_msgs.msg import FrankaState
from franka_sim_mujoco.msg import Contacts
from franka_sim_mujoco.srv import (
    DeleteObject,
    GetBodyState,
    GetJointStates,
    GetWorld,
    PushBody,
    RestoreSnapshot,
    SetBodyState,
    SetGravity,
    SetJointStates,
    SpawnObject,
    Step,
    TakeSnapshot,
)
from gazebo_msgs.msg import LinkState, LinkStates, ModelState, ModelStates, ODEJointProperties, ODEPhysics
from gazebo_msgs.srv import (
    ApplyBodyWrench,
    ApplyJointEffort,
    BodyRequest,
    DeleteLight,
    DeleteModel,
    GetJointProperties,
    GetJointPropertiesResponse,
    GetLightProperties,
    GetLinkProperties,
    GetLinkState,
    GetModelProperties,
    GetModelState,
    GetPhysicsProperties,
    GetWorldProperties,
    JointRequest,
    SetJointProperties,
    SetJointTrajectory,
    SetLightProperties,
    SetLinkProperties,
    SetLinkState,
    SetModelConfiguration,
    SetModelState,
    SetPhysicsProperties,
    SpawnModel,
)
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3, Wrench
from ros_client import Controllers, call, latest, launched
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import ColorRGBA
from std_srvs.srv import Empty, Trigger
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory
from visualization_msgs.msg import Marker, MarkerArray
from waiting import wait_for

HERE = Path(__file__).resolve().parent
BALL = "<body name='{0}'><freejoint/><geom type='sphere' size='0.05' mass='0.3'/></body>"
FEATHER = """<body name='feather'><freejoint/><inertial pos='0 0 0' mass='1e-7' diaginertia='1e-7 1e-7 1e-7'/>
  <geom type='sphere' size='0.01'/></body>"""
NONE = Vector3()
# A box of 0.1 m with a camera that looks ahead.
CRATE = """<robot name='any'><link name='body'><inertial><mass value='0.5'/><inertia ixx='0.001' iyy='0.001'
  izz='0.001' ixy='0' ixz='0' iyz='0'/></inertial>
  <collision><geometry><box size='0.1 0.1 0.1'/></geometry></collision></link>
  <gazebo reference='body'><sensor name='eye' type='camera'><update_rate>20</update_rate><camera>
  <horizontal_fov>1.0</horizontal_fov><image><width>32</width><height>24</height></image></camera></sensor>
  </gazebo></robot>"""
# A camera looks down on the floor from 2 m; a plate of 1 m in the middle of its view stands 0.5 m high.
CAMERA = """<sdf version='1.6'><model name='eye'><static>true</static><link name='link'>
  <sensor name='cam' type='depth'><update_rate>20</update_rate><camera><horizontal_fov>1.0</horizontal_fov>
  <image><width>80</width><height>60</height></image></camera></sensor>
  <collision name='c'><pose>1.5 0 0 0 0 0</pose>
  <geometry><box><size>0.02 1 1</size></box></geometry></collision>
  <visual name='v'><pose>1.5 0 0 0 0 0</pose><geometry><box><size>0.02 1 1</size></box></geometry>
  <material><diffuse>0.1 0.9 0.1 1</diffuse></material></visual>
  </link></model></sdf>"""

pytestmark = pytest.mark.own_process


@pytest.fixture(scope="module", autouse=True)
def simulation(tmp_path_factory):
    log = tmp_path_factory.mktemp("worlds") / "launch.log"
    with launched(str(HERE / "worlds.launch"), log=log):
        for arm, controller in (
            ("panda_1", "cartesian_impedance_example_controller"),
            ("panda_2", "force_example_controller"),
        ):
            Controllers(f"/{arm}").wait_for(controller, "franka_state_controller")
        yield


@pytest.fixture(autouse=True)
def world_as_at_the_start(simulation):
    """Paused, with the bodies of the world's file and the arms in their first poses."""
    gazebo("pause_physics", Empty)
    gazebo("reset", Trigger)
    models, gravity = model_names(), gazebo("get_world", GetWorld).gravity
    yield
    gazebo("pause_physics", Empty)
    gazebo("reset", Trigger)  # a world that diverged accepts nothing else
    gazebo("set_gravity", SetGravity, gravity)
    for name in model_names() - models:
        gazebo("delete_model", DeleteModel, name)


def gazebo(name, kind, *arguments, fails=False):
    """The answer of a service of the simulation, which succeeds or fails."""
    answer = call("/gazebo/" + name, kind, *arguments)
    if hasattr(answer, "success"):
        assert answer.success != fails, (name, arguments, answer)
    return answer


def model_names():
    return set(gazebo("get_world_properties", GetWorldProperties).model_names)


def at(x, y, z, turn=(0, 0, 0, 1)):
    return Pose(Point(x, y, z), Quaternion(*turn))


def running(arm):
    return Controllers(f"/{arm}").running()


def near(point, x, y, z):
    for axis, value in zip("xyz", (x, y, z)):
        assert getattr(point, axis) == pytest.approx(value, abs=1e-6)


def test_both_arms_stand_in_the_world_of_the_sdf_file():
    world = gazebo("get_world", GetWorld)
    assert sorted(world.robots) == ["panda_1", "panda_2"]
    for body in (
        "stone",
        "stone::link",
        "table",
        "pick_tray",
        "place_tray",
        "panda_1_hand",
        "panda_2_link7",
    ):
        assert body in world.bodies
    assert "panda_1_joint4" in world.joints
    assert world.gravity.z == pytest.approx(-9.81, abs=0.02)
    assert world.paused
    stone = gazebo("get_body_state", GetBodyState, "stone")
    assert stone.pose.position.x == pytest.approx(0.000286, abs=2e-3)
    assert stone.pose.position.y == pytest.approx(-0.221972, abs=2e-3)
    # It rests on the tray: its center is half its height above.
    assert stone.pose.position.z == pytest.approx(0.419773 + 0.023348 + 0.032, abs=1e-3)
    base = gazebo("get_body_state", GetBodyState, "panda_2_link0").pose
    assert base.position.x == pytest.approx(0.9, abs=1e-9)
    assert abs(base.orientation.z) == pytest.approx(1, abs=1e-9)


def test_an_object_is_spawned_thrown_and_removed():
    gazebo("spawn_object", SpawnObject, "ball", BALL.format("ball"), at(2, 2, 3))
    assert gazebo("get_body_state", GetBodyState, "ball").pose.position == Point(2, 2, 3)
    thrown = Twist(Vector3(1, 0, 2), Vector3(0, 0, 3))
    gazebo("set_body_state", SetBodyState, "ball", at(2, 2, 1), thrown)
    gazebo("step", Step, 100)
    ball = gazebo("get_body_state", GetBodyState, "ball")
    assert ball.pose.position.x == pytest.approx(2.1, abs=1e-3)
    assert ball.twist.angular.z == pytest.approx(3, abs=1e-3)
    gazebo("delete_object", DeleteObject, "ball")
    assert "ball" not in gazebo("get_world", GetWorld).bodies
    assert "ball" in gazebo("delete_object", DeleteObject, "ball", fails=True).error


def test_gravity_is_what_was_set():
    gazebo("spawn_object", SpawnObject, "moon_ball", BALL.format("moon_ball"), at(2, 2, 3))
    gazebo("set_gravity", SetGravity, Vector3(0, 0, -1.62))
    gazebo("step", Step, 200)
    speed = gazebo("get_body_state", GetBodyState, "moon_ball").twist.linear.z
    assert speed == pytest.approx(-1.62 * 0.2, abs=1e-6)
    # Its control unit goes on to compensate the gravity with which it was spawned.
    gazebo("unpause_physics", Empty)
    topic = "/panda_1/franka_state_controller/franka_states"
    wait_for(lambda: abs(latest(topic, FrankaState).tau_ext_hat_filtered[1]) > 5, "Torques that lift the arm")


def test_joints_are_read_and_set():
    names = [f"panda_2_joint{i}" for i in range(1, 8)]
    before = gazebo("get_joint_states", GetJointStates, names).state
    assert list(before.name) == names
    target = [before.position[0] + 0.3, *before.position[1:]]
    gazebo("set_joint_states", SetJointStates, names, target, [])
    assert list(gazebo("get_joint_states", GetJointStates, names).state.position) == target
    gazebo("step", Step, 50)
    assert "force_example_controller" in running("panda_2")
    assert "positions" in gazebo("set_joint_states", SetJointStates, names, [0.0], [], fails=True).error
    assert len(gazebo("get_joint_states", GetJointStates, []).state.name) == 18


def test_a_snapshot_restores_everything():
    gazebo("spawn_object", SpawnObject, "die", BALL.format("die"), at(1.5, 1.5, 0.5))
    gazebo("step", Step, 100)
    first = gazebo("take_snapshot", TakeSnapshot, "here").state_hash
    ends = []
    for _ in range(2):
        assert gazebo("restore_snapshot", RestoreSnapshot, "here").state_hash == first
        assert gazebo("step", Step, 400).state_hash != first
        ends.append(gazebo("get_body_state", GetBodyState, "die").pose.position)
    near(ends[0], ends[1].x, ends[1].y, ends[1].z)
    assert "nowhere" in gazebo("restore_snapshot", RestoreSnapshot, "nowhere", fails=True).error


def test_the_clock_never_goes_back():
    before = gazebo("step", Step, 10)
    gazebo("reset", Trigger)
    after = gazebo("step", Step, 10)
    assert (after.time - before.time).to_nsec() == 10 * 10**6
    assert "cartesian_impedance_example_controller" in running("panda_1")


def test_contacts_are_published():
    gazebo("step", Step, 800)
    contacts = latest("/gazebo/contacts", Contacts)
    weight = 0.0
    for body1, body2, force in zip(contacts.body1s, contacts.body2s, contacts.forces):
        if {body1, body2} == {"stone", "pick_tray"}:
            weight += force.z if body2 == "stone" else -force.z
    assert weight == pytest.approx(0.1024 * 9.81, abs=0.02)
    assert contacts.header.frame_id == "world"


def test_cameras_see_colors_and_distances():
    turned = (0, math.sin(math.pi / 4), 0, math.cos(math.pi / 4))  # looking down
    gazebo("spawn_object", SpawnObject, "eye", CAMERA, at(3, 3, 2, turned))
    assert "eye::link::cam" in gazebo("get_world", GetWorld).cameras
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
        gazebo("step", Step, 60)
        return depths and images and infos and [f for f in frames if "cam" in f.child_frame_id]

    transform = wait_for(all_are_there, "a picture")[-1]
    for each in (*listeners, listener):
        each.unregister()
    depth = numpy.frombuffer(depths[-1].data, numpy.float32).reshape(60, 80)
    assert depth[30, 40] == pytest.approx(1.49, abs=0.005)  # the plate's upper face
    assert depths[-1].encoding == "32FC1"
    image = numpy.frombuffer(images[-1].data, numpy.uint8).reshape(60, 80, 3).astype(int)
    red, green, blue = image[30, 40]
    assert green > 2 * max(red, blue)
    info = infos[-1]
    assert info.K[0] == pytest.approx(40 / math.tan(0.5), abs=1e-9)
    # The plate's edge is 0.5 m from the axis.
    columns = numpy.nonzero(depth[30] < 1.6)[0]
    assert columns.size == pytest.approx(2 * info.K[0] * 0.5 / 1.49, abs=2)
    assert transform.transform.translation.z == pytest.approx(2, abs=1e-9)
    q = transform.transform.rotation
    assert 1 - 2 * (q.x**2 + q.y**2) == pytest.approx(-1, abs=1e-6)  # the optical axis points down
    gazebo("delete_object", DeleteObject, "eye")


def test_markers_show_objects_and_leave_robots_out():
    arrays = []
    listener = rospy.Subscriber("/gazebo/markers", MarkerArray, arrays.append)

    def shown(condition, what):
        """The latest markers, once they meet a condition."""
        return wait_for(lambda: arrays and condition(arrays[-1].markers) and arrays[-1].markers, what)

    markers = shown(lambda markers: any(m.ns == "stone" for m in markers), "the stone's marker")
    assert markers[0].action == Marker.DELETEALL
    assert {m.header.frame_id for m in markers} == {"world"}
    bodies = {m.ns for m in markers[1:]}
    assert {"stone", "pick_tray", "place_tray", "table"} <= bodies, bodies
    assert not [body for body in bodies if body.startswith("panda_")]
    gazebo("spawn_object", SpawnObject, "ball", BALL.format("ball"), at(2, 1, 3))
    (ball,) = (m for m in shown(lambda ms: any(m.ns == "ball" for m in ms), "the ball") if m.ns == "ball")
    assert (ball.type, ball.scale.x) == (Marker.SPHERE, 0.1)
    position = ball.pose.position
    assert (position.x, position.y, position.z) == (2, 1, 3)
    gazebo("step", Step, 200)  # it falls
    shown(lambda ms: any(m.ns == "ball" and m.pose.position.z < 2.9 for m in ms), "a fall")
    gazebo("delete_object", DeleteObject, "ball")
    shown(lambda ms: not any(m.ns == "ball" for m in ms), "no ball")
    listener.unregister()


def test_spawn_model_accepts_sdf_and_mjcf_and_refuses_others():
    def spawn(text, *options):
        command = ["rosrun", "gazebo_ros", "spawn_model", "-stdin", *options]
        return subprocess.run(command, input=text, text=True, capture_output=True, timeout=60)

    done = spawn(BALL.format("cherry"), "-mjcf", "-model", "cherry", "-reference_frame", "table", "-z", "1")
    assert done.returncode == 0, done.stdout + done.stderr
    cherry = gazebo("get_body_state", GetBodyState, "cherry").pose.position
    assert cherry.x == pytest.approx(0.016428, abs=1e-9)
    assert cherry.z == pytest.approx(1.0, abs=1e-9)
    gazebo("delete_object", DeleteObject, "cherry")
    failed = spawn("<html/>", "-model", "page")
    assert failed.returncode == 1
    assert "<html>" in failed.stdout + failed.stderr


@pytest.mark.parametrize("runs", [False, True])
def test_divergence_pauses_is_reported_and_ends_with_a_reset(runs):
    gazebo("spawn_object", SpawnObject, "feather", FEATHER, at(3, 3, 3))
    if runs:
        gazebo("unpause_physics", Empty)
    # It is so light that 10 000 N make it diverge.
    gazebo("push_body", PushBody, "feather", Vector3(1e4, 0, 0), NONE, False, Point(), 5)
    if runs:
        wait_for(lambda: gazebo("get_world", GetWorld).paused, "the pause of a world that diverged")
    error = gazebo("step", Step, 5, fails=True).error
    assert "The physics diverged: the acceleration of body 'feather" in error
    with pytest.raises(rospy.ServiceException):
        gazebo("unpause_physics", Empty)
    gazebo("reset", Trigger)
    assert gazebo("get_world", GetWorld).paused != runs


def test_an_object_inside_a_robot_is_reported():
    hand = gazebo("get_body_state", GetBodyState, "panda_1_hand").pose.position
    ball = BALL.format("inside")
    answer = gazebo("spawn_object", SpawnObject, "inside", ball, at(hand.x, hand.y, hand.z))
    assert "inside begins within panda_1_" in answer.warning
    gazebo("delete_object", DeleteObject, "inside")


def test_gazebo_services_read_models_and_links():
    names = set(gazebo("get_world_properties", GetWorldProperties).model_names)
    scenery = {"stone", "table", "pick_tray", "place_tray", "ground_plane"}
    assert names == scenery | {"panda_1", "panda_2"}
    stone = gazebo("get_body_state", GetBodyState, "stone").pose.position
    near(gazebo("get_model_state", GetModelState, "stone", "").pose.position, stone.x, stone.y, stone.z)
    seen = gazebo("get_model_state", GetModelState, "stone", "panda_2::panda_2_link0")
    near(seen.pose.position, 0.9 - stone.x, -stone.y, stone.z)  # its base is rotated by half a turn
    assert seen.header.frame_id == "panda_2::panda_2_link0"
    link = gazebo("get_link_state", GetLinkState, "stone::link", "table").link_state
    near(link.pose.position, stone.x - 0.016428, stone.y - 0.000584, stone.z)
    joint = gazebo("get_joint_properties", GetJointProperties, "panda_1_joint4")
    measured = gazebo("get_joint_states", GetJointStates, ["panda_1_joint4"]).state
    assert (joint.position[0], joint.rate[0]) == (measured.position[0], measured.velocity[0])
    assert joint.type == GetJointPropertiesResponse.REVOLUTE
    finger = gazebo("get_joint_properties", GetJointProperties, "panda_2::panda_2_finger_joint1")
    assert finger.type == GetJointPropertiesResponse.PRISMATIC
    arm = gazebo("get_model_properties", GetModelProperties, "panda_2")
    assert "panda_2_link7" in arm.body_names
    assert len(arm.joint_names) == 9
    assert not arm.is_static
    assert gazebo("get_model_properties", GetModelProperties, "table").is_static
    physics = gazebo("get_physics_properties", GetPhysicsProperties)
    assert physics.pause
    assert physics.gravity.z == pytest.approx(-9.81, abs=0.02)
    for name, kind, arguments in (
        ("get_model_state", GetModelState, ("moon", "")),
        ("get_model_state", GetModelState, ("stone", "moon")),
        ("get_link_state", GetLinkState, ("moon", "")),
        ("get_joint_properties", GetJointProperties, ("moon",)),
        ("get_model_properties", GetModelProperties, ("moon",)),
        ("delete_model", DeleteModel, ("moon",)),
    ):
        assert "'moon'" in gazebo(name, kind, *arguments, fails=True).status_message


def set_physics(gravity_z, time_step=0.001, **expected):
    rate = gazebo("get_physics_properties", GetPhysicsProperties).max_update_rate
    order = (time_step, rate, Vector3(0, 0, gravity_z), ODEPhysics())
    return gazebo("set_physics_properties", SetPhysicsProperties, *order, **expected)


def test_gazebo_set_physics_properties_changes_gravity_and_no_time_step():
    assert "compensating the gravity with which they were spawned" in set_physics(-1.5).status_message
    assert not set_physics(-1.5).status_message
    refused = set_physics(-9.0, time_step=0.002, fails=True)
    assert "0.002" in refused.status_message
    assert gazebo("get_physics_properties", GetPhysicsProperties).gravity.z == -1.5


def test_gazebo_wrenches_act_until_they_are_cleared():
    set_physics(0.0)
    gazebo("spawn_object", SpawnObject, "ball", BALL.format("ball"), at(2, 2, 3))
    gazebo("spawn_object", SpawnObject, "rod", BALL.format("rod"), at(2, 3, 3, (0, 0, 0.5**0.5, 0.5**0.5)))
    push, begin, unlimited = Wrench(Vector3(0.3, 0, 0), NONE), rospy.Time(0), rospy.Duration(-1)
    gazebo("apply_body_wrench", ApplyBodyWrench, "ball", "", Point(), push, begin, unlimited)
    # At a point of its own frame, which is turned: to the world's y, with a lever.
    gazebo(
        "apply_body_wrench",
        ApplyBodyWrench,
        "rod",
        "rod",
        Point(0, 0.01, 0),
        push,
        begin,
        rospy.Duration(0.05),
    )
    gazebo("step", Step, 100)
    gazebo("clear_body_wrenches", BodyRequest, "ball")
    gazebo("step", Step, 100)
    ball, rod = (gazebo("get_body_state", GetBodyState, name).twist for name in ("ball", "rod"))
    assert (ball.linear.x, ball.linear.y) == pytest.approx((0.1, 0), abs=1e-3)
    assert (rod.linear.x, rod.linear.y) == pytest.approx((0, 0.05), abs=1e-3)
    assert rod.angular.z < -0.1
    for arguments, word in (
        (("moon", "", Point(), push, begin, unlimited), "'moon'"),
        (("ball", "moon", Point(), push, begin, unlimited), "'moon'"),
        (("ball", "", Point(), push, rospy.Time(2**31), unlimited), "start_time"),
        (("ball", "", Point(math.nan, 0, 0), push, begin, unlimited), "finite"),
    ):
        assert word in gazebo("apply_body_wrench", ApplyBodyWrench, *arguments, fails=True).status_message


def test_gazebo_properties_of_links_are_read():
    gazebo("spawn_object", SpawnObject, "ball", BALL.format("ball"), at(2, 2, 3))
    ball = gazebo("get_link_properties", GetLinkProperties, "ball")
    assert ball.gravity_mode
    assert (ball.mass, ball.ixx, ball.izz) == pytest.approx((0.3, 0.4 * 0.3 * 0.05**2, 0.4 * 0.3 * 0.05**2))


@pytest.mark.parametrize(
    ("name", "kind", "arguments", "reason"),
    [
        (
            "set_link_properties",
            SetLinkProperties,
            ("stone", Pose(), True, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0),
            "spawn",
        ),
        ("set_joint_properties", SetJointProperties, ("panda_1_joint4", ODEJointProperties()), "spawn"),
        (
            "apply_joint_effort",
            ApplyJointEffort,
            ("panda_1_joint4", 1.0, rospy.Time(0), rospy.Duration(-1)),
            "controller",
        ),
        (
            "set_joint_trajectory",
            SetJointTrajectory,
            ("panda_1", JointTrajectory(), Pose(), False, False),
            "set_model_configuration",
        ),
    ],
)
def test_gazebo_changes_of_properties_and_arms_are_refused_with_a_reason(name, kind, arguments, reason):
    assert reason in gazebo(name, kind, *arguments, fails=True).status_message


RAIL = """<sdf version='1.6'><model name='any'><static>false</static><link name='base'/>
  <link name='cart'><inertial><mass>2</mass></inertial></link>
  <joint name='world_joint' type='fixed'><parent>world</parent><child>base</child></joint>
  <joint name='slide' type='prismatic'><parent>base</parent><child>cart</child><axis><xyz>1 0 0</xyz>
  </axis></joint></model></sdf>"""


def test_gazebo_efforts_act_on_joints_of_objects_until_they_are_cleared():
    gazebo("spawn_object", SpawnObject, "rail", RAIL, at(2, 2, 3))
    gazebo("apply_joint_effort", ApplyJointEffort, "rail::slide", 2.0, rospy.Time(0), rospy.Duration(-1))
    gazebo("step", Step, 100)
    gazebo("clear_joint_forces", JointRequest, "rail::slide")
    gazebo("step", Step, 100)
    joint = gazebo("get_joint_properties", GetJointProperties, "rail::slide")
    assert joint.rate[0] == pytest.approx(0.1)


LAMP = """<sdf version='1.6'><model name='any'><static>true</static><link name='link'>
  <light name='bulb' type='point'><diffuse>1 1 0.5 1</diffuse></light></link></model></sdf>"""


def test_gazebo_lights_are_read_set_and_deleted():
    gazebo("spawn_sdf_model", SpawnModel, "lamp", LAMP, "", at(0, 0, 3), "")
    for name in ("sun", "lamp::link::bulb"):
        color, attenuation = ColorRGBA(0.25, 0.5, 1, 1), (0.5, 0.25, 0.125)
        order = (name, False, color, ColorRGBA(), *attenuation, Vector3(0, 0, -1), Pose())
        gazebo("set_light_properties", SetLightProperties, *order)
        found = gazebo("get_light_properties", GetLightProperties, name)
        assert found.diffuse == color
        constants = (found.attenuation_constant, found.attenuation_linear, found.attenuation_quadratic)
        assert constants == attenuation
    wrong = (*order[:4], -1.0, *order[5:])
    answer = gazebo("set_light_properties", SetLightProperties, *wrong, fails=True)
    assert "attenuation" in answer.status_message
    gazebo("delete_light", DeleteLight, name)
    for service, kind, arguments in (
        ("get_light_properties", GetLightProperties, ()),
        ("set_light_properties", SetLightProperties, order[1:]),
        ("delete_light", DeleteLight, ()),
    ):
        assert f"'{name}'" in gazebo(service, kind, name, *arguments, fails=True).status_message


def test_gazebo_services_and_topics_set_states():
    spun = Twist(Vector3(0, 0, 1), Vector3(0, 0, 2))
    unset = at(2, 2, 1, (0, 0, 0, 0))  # defaults of a message
    gazebo("set_model_state", SetModelState, ModelState("stone", unset, spun, ""))
    state = gazebo("get_model_state", GetModelState, "stone", "world")
    near(state.pose.position, 2, 2, 1)
    near(state.twist.linear, 0, 0, 1)
    near(state.twist.angular, 0, 0, 2)
    frame = "panda_2_link0"
    gazebo("set_link_state", SetLinkState, LinkState("stone::link", at(1, 0, 1), Twist(), frame))
    near(gazebo("get_model_state", GetModelState, "stone", "").pose.position, -0.1, 0, 1)
    near(gazebo("get_model_state", GetModelState, "stone", frame).pose.position, 1, 0, 1)
    for state, word in (
        (ModelState("panda_1", at(0, 0, 1), Twist(), ""), "not free to move"),
        (ModelState("table", at(0, 0, 1), Twist(), ""), "not free to move"),
        (ModelState("stone", at(0, 0, math.nan), Twist(), ""), "finite"),
        (ModelState("stone", at(0, 0, 1), Twist(), "moon"), "'moon'"),
        (ModelState("stone", at(0, 0, 9), Twist(Vector3(1e6, 0, 0), NONE), ""), "at most 1000 m/s"),
    ):
        answer = gazebo("set_model_state", SetModelState, state, fails=True)
        assert word in answer.status_message
    assert gazebo("get_model_state", GetModelState, "stone", "").pose.position.z < 2, "nothing was half done"
    with_topic = rospy.Publisher("/gazebo/set_model_state", ModelState, queue_size=1, latch=True)
    with_topic.publish(ModelState("stone", at(-2, 1, 1), Twist(), ""))

    def stone():
        states = latest("/gazebo/model_states", ModelStates)
        return states.pose[states.name.index("stone")].position

    wait_for(lambda: stone() == Point(-2, 1, 1), "the stone where the topic put it")
    with_topic.unregister()
    links = latest("/gazebo/link_states", LinkStates)
    near(links.pose[links.name.index("stone::link")].position, -2, 1, 1)
    hand = gazebo("get_body_state", GetBodyState, "panda_1_hand").pose.position
    near(links.pose[links.name.index("panda_1::panda_1_hand")].position, hand.x, hand.y, hand.z)
    assert len(links.name) == len(links.twist)


def test_gazebo_models_are_spawned_configured_and_deleted():
    ball = BALL.format("marble")
    spawned = gazebo(
        "spawn_sdf_model", SpawnModel, "marble", ball, "", at(0, 0, 1, (0, 0, 0, 0)), "panda_2_link0"
    )
    assert spawned.success
    near(gazebo("get_model_state", GetModelState, "marble", "").pose.position, 0.9, 0, 1)
    gazebo("delete_model", DeleteModel, "marble")
    assert "marble" not in gazebo("get_world_properties", GetWorldProperties).model_names
    answer = gazebo("delete_model", DeleteModel, "table", fails=True)
    assert "belongs to the world file" in answer.status_message
    configure = ("panda_2", "robot_description", ["panda_2_joint1"])
    before = gazebo("get_joint_properties", GetJointProperties, "panda_2_joint1").position[0]
    gazebo("set_model_configuration", SetModelConfiguration, *configure, [before + 0.2])
    assert gazebo("get_joint_properties", GetJointProperties, "panda_2_joint1").position[0] == before + 0.2
    gazebo("set_model_configuration", SetModelConfiguration, *configure, [before])
    answer = gazebo("set_model_configuration", SetModelConfiguration, *configure, [9.0], fails=True)
    assert "panda_2_joint1" in answer.status_message


def test_gazebo_spawns_a_urdf_object_that_falls_and_sees():
    gazebo("spawn_urdf_model", SpawnModel, "crate", CRATE, "", at(2, 2, 0.3), "")
    near(gazebo("get_model_state", GetModelState, "crate", "").pose.position, 2, 2, 0.3)
    gazebo("step", Step, 1000)
    state = gazebo("get_model_state", GetModelState, "crate", "")
    assert state.pose.position.z == pytest.approx(0.05, abs=1e-3)
    assert state.twist.linear.z == pytest.approx(0, abs=1e-3)
    image = latest("/gazebo/crate/body/eye/image_raw", Image)
    assert (image.width, image.height, len(image.data)) == (32, 24, 3 * 32 * 24)
    assert len(set(image.data)) > 1
    gazebo("delete_model", DeleteModel, "crate")
    assert "crate" not in model_names()


def test_gazebo_reports_what_a_spawned_model_has_and_is_not_simulated():
    bumper = "<sensor name='bumper' type='contact'/></link>"
    answer = gazebo(
        "spawn_sdf_model", SpawnModel, "lamp", LAMP.replace("</link>", bumper), "", at(0, 0, 3), ""
    )
    assert "bumper" in answer.status_message
