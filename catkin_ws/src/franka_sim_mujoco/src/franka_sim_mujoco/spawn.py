# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Spawns robots (URDF) and objects (SDF, MJCF) in the running simulation, with spawn_model's arguments."""

import argparse
import math
import re
import sys
import time
from collections.abc import Iterable, Sequence
from typing import Any

import rospy
from controller_manager.command_line import Parser
from geometry_msgs.msg import Pose, Quaternion, Vector3
from std_srvs.srv import Empty

from franka_sim_mujoco.srv import (
    DeleteObject,
    DeleteRobot,
    GetBodyPose,
    GetWorld,
    SpawnObject,
    SpawnObjectRequest,
    SpawnRobot,
    SpawnRobotRequest,
)


class SpawnError(Exception):
    """An error message for the user."""


def parse(name: str, arguments: Sequence[str]) -> argparse.Namespace:
    """The options of a command line (without the program's name)."""
    parser = Parser(prog=name, description=__doc__, allow_abbrev=False)
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("-param", help="parameter that holds the description")
    source.add_argument("-file", help="file that holds the description")
    source.add_argument("-stdin", action="store_true", help="read the description from standard input")
    parser.add_argument("-model", required=True, help="name in the world")
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("-urdf", action="store_true", help="the description is a URDF")
    kind.add_argument("-sdf", action="store_true", help="the description is an SDF model")
    kind.add_argument("-mjcf", action="store_true", help="the description is MJCF, or a lone <body>")
    for axis in "xyz":
        parser.add_argument("-" + axis, type=float, default=0.0, help="position [m]")
    for letter, meaning in (("R", "roll"), ("P", "pitch"), ("Y", "yaw")):
        parser.add_argument("-" + letter, type=float, default=0.0, help=f"{meaning} [rad]")
    parser.add_argument("-reference_frame", default="", help="body that the pose is relative to")
    parser.add_argument(
        "-J",
        nargs=2,
        action="append",
        default=[],
        metavar=("JOINT", "POSITION"),
        help="initial position of a joint [rad] or [m]; may be given repeatedly",
    )
    parser.add_argument("-robot_namespace", help="of the robot's topics (default: this node's)")
    parser.add_argument("-unpause", action="store_true", help="start the simulation afterwards")
    parser.add_argument("-wait", metavar="BODY", help="spawn only when this body is there")
    parser.add_argument("-b", action="store_true", help="stay, and remove the model when ended")
    parser.add_argument(
        "-package_to_model", action="store_true", help="passed over: package:// is understood"
    )
    parser.add_argument("-gazebo_namespace", default="/gazebo", help="of the simulation's services")
    parser.add_argument(
        "-timeout", type=float, default=60.0, help="how long to wait for the simulation to come up [wall s]"
    )
    return parser.parse_args(arguments)


def read_description(options: argparse.Namespace) -> str:
    if options.stdin:
        return sys.stdin.read()
    if options.file:
        try:
            with open(options.file, encoding="utf-8") as file:
                return file.read()
        except (OSError, UnicodeDecodeError) as error:
            raise SpawnError(f"The description cannot be read: {error}") from error
    text = rospy.get_param(options.param, None)
    if not isinstance(text, str) or not text:
        raise SpawnError(f"The parameter {rospy.resolve_name(options.param)} holds no description.")
    return text


def kind_of(options: argparse.Namespace, text: str) -> str:
    """ "urdf", "sdf" or "mjcf": from the options, else from the root element."""
    for kind in ("urdf", "sdf", "mjcf"):
        if getattr(options, kind):
            return kind
    bare = re.sub(r"<!--.*?-->|<\?.*?\?>", "", text, flags=re.DOTALL)
    root = re.search(r"<\s*([\w:]+)", bare)
    kinds = {"robot": "urdf", "sdf": "sdf", "gazebo": "sdf", "model": "sdf", "mujoco": "mjcf", "body": "mjcf"}
    found_kind = kinds.get(root.group(1)) if root else None
    if found_kind is None:
        found = f"its root element is <{root.group(1)}>" if root else "it is not XML"
        raise SpawnError(f"'{options.model}' is neither URDF, SDF nor MJCF: {found}.")
    return found_kind


def read_joints(pairs: Iterable[tuple[str, str]]) -> tuple[list[str], list[float]]:
    names, positions = [], []
    for name, text in pairs:
        try:
            positions.append(float(text))
        except ValueError:
            raise SpawnError(f"The initial position '{text}' of {name} is not a number.") from None
        names.append(name)
    return names, positions


def orientation_of(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Quaternion of rotations about the fixed axes x, y, z, in this order, as in a URDF."""
    (cr, sr), (cp, sp), (cy, sy) = [(math.cos(a / 2), math.sin(a / 2)) for a in (roll, pitch, yaw)]
    return Quaternion(
        x=sr * cp * cy - cr * sp * sy,
        y=cr * sp * cy + sr * cp * sy,
        z=cr * cp * sy - sr * sp * cy,
        w=cr * cp * cy + sr * sp * sy,
    )


def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """The rotation b, then the rotation a."""
    return Quaternion(
        w=a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
        x=a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        y=a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        z=a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
    )


def compose(base: Pose, pose: Pose) -> Pose:
    """Transforms a pose from the frame `base` into the frame of base's own pose."""
    q, p = base.orientation, pose.position
    turned = multiply(multiply(q, Quaternion(x=p.x, y=p.y, z=p.z, w=0)), Quaternion(-q.x, -q.y, -q.z, q.w))
    result = Pose(orientation=multiply(q, pose.orientation))
    result.position.x = base.position.x + turned.x
    result.position.y = base.position.y + turned.y
    result.position.z = base.position.z + turned.z
    return result


def call(options: argparse.Namespace, name: str, kind: Any, *arguments: Any) -> Any:
    name = options.gazebo_namespace + "/" + name
    try:
        # Wall time: the simulation may be paused.
        rospy.wait_for_service(name, timeout=options.timeout)
        return rospy.ServiceProxy(name, kind)(*arguments)
    except rospy.ROSException as error:
        raise SpawnError(
            f"The simulation does not offer {name} within {options.timeout:g} s. Is it running?"
        ) from error
    except rospy.ServiceException as error:
        raise SpawnError(f"{name} failed: {error}") from error


def pose_of(options: argparse.Namespace) -> Pose:
    pose = Pose(orientation=orientation_of(options.R, options.P, options.Y))
    pose.position = Vector3(options.x, options.y, options.z)
    if options.reference_frame in ("", "world"):
        return pose
    base = call(options, "get_body_pose", GetBodyPose, options.reference_frame)
    if not base.success:
        raise SpawnError(f"The reference frame of '{options.model}' is unknown: {base.error}")
    return compose(base.pose, pose)


def wait_for_body(options: argparse.Namespace) -> None:
    end = time.monotonic() + options.timeout
    while options.wait not in call(options, "get_world", GetWorld).bodies:
        if time.monotonic() > end:
            raise SpawnError(f"The body '{options.wait}' did not appear within {options.timeout:g} s.")
        time.sleep(0.2)


def spawn_robot(options: argparse.Namespace, text: str) -> Any:
    order = SpawnRobotRequest(name=options.model, urdf=text, pose=pose_of(options))
    order.robot_namespace = options.robot_namespace or rospy.get_namespace()
    order.joint_names, order.joint_positions = read_joints(options.J)
    return call(options, "spawn_robot", SpawnRobot, order)


def spawn_object(options: argparse.Namespace, text: str) -> Any:
    if options.J:
        raise SpawnError("Initial joint positions (-J) are for robots (URDF) only.")
    order = SpawnObjectRequest(name=options.model, xml=text, pose=pose_of(options))
    return call(options, "spawn_object", SpawnObject, order)


def spawn(options: argparse.Namespace) -> None:
    text = read_description(options)
    is_robot = kind_of(options, text) == "urdf"
    if options.wait:
        wait_for_body(options)
    answer = spawn_robot(options, text) if is_robot else spawn_object(options, text)
    if not answer.success:
        raise SpawnError(f"'{options.model}' was not spawned: {answer.error}")
    if answer.warning:
        rospy.logwarn("%s", answer.warning)
    rospy.loginfo("Spawned '%s'.", options.model)
    if options.unpause:
        call(options, "unpause_physics", Empty)
    if options.b:
        stay(options, is_robot)


def stay(options: argparse.Namespace, is_robot: bool) -> None:
    """Waits until the node exits; then deletes the model."""

    def remove() -> None:
        name, kind = ("delete_robot", DeleteRobot) if is_robot else ("delete_object", DeleteObject)
        try:
            rospy.ServiceProxy(options.gazebo_namespace + "/" + name, kind)(options.model)
        except (rospy.ServiceException, rospy.ROSException):
            pass  # the simulation exited first

    rospy.on_shutdown(remove)
    rospy.spin()


def run(name: str, arguments: Sequence[str]) -> int:
    """A program's main: @returns its exit status."""
    options = parse(name, rospy.myargv(arguments)[1:])
    # Without ROS time: waits use wall time, because the simulation may be paused.
    rospy.init_node(name, anonymous=True, disable_rostime=True)
    try:
        spawn(options)
    except SpawnError as error:
        rospy.logfatal("%s", error)
        return 1
    except rospy.ROSInterruptException:
        return 1
    return 0
