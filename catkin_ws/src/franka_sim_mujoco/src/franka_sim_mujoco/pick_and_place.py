# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Carries the stone from the blue tray to the red one with ROS topics, services and actions only.

A user would write the same for the real arm: equilibrium poses for the Cartesian impedance controller, goals
for the gripper, set_load after the grasp. Only the stone's pose comes from the simulation, instead of from a
camera. Every step waits for measured state, with a limit in simulated and in wall time.
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import actionlib
import numpy as np
import rospy
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from dynamic_reconfigure.client import Client as ReconfigureClient
from franka_gripper.msg import (
    GraspAction,
    GraspEpsilon,
    GraspGoal,
    HomingAction,
    HomingGoal,
    MoveAction,
    MoveGoal,
    StopAction,
    StopGoal,
)
from franka_msgs.msg import FrankaState
from franka_msgs.srv import SetLoad
from gazebo_msgs.srv import GetLinkState
from geometry_msgs.msg import Point, Pose, PoseStamped
from rospy_connections import Stopwatch
from sensor_msgs.msg import Image

from franka_sim_mujoco.geometry import (
    Array,
    downwards,
    matrix_of,
    minimum_jerk,
    pose_of,
    rotation_of,
    rotation_vector,
    shortened,
    wrap,
    yaw_of,
)
from franka_sim_mujoco.srv import GetBodyPose, GetContacts, RenderPicture, SetBodyPose

# The scene of the original's stone.sdf: sizes [m], mass [kg].
STONE_SIZE = (0.025, 0.032, 0.064)
STONE_MASS = 0.1024
TRAY_SIZE = (0.235035, 0.144926, 0.023348)
PATIENCE = 10.0  # minimum wall time of any timeout [s]
MAX_COUNTED_TIME = 0.1  # simulated time between two looks that counts [s]


class TaskError(RuntimeError):
    """A step did not reach its goal; the message names it and the measured values."""


def wait_until(
    condition: Callable[[], bool], what: str, simulated: float = 15.0, wall: float = 120.0
) -> None:
    """Polls until the condition holds; raises TaskError after either time [s] has passed.

    Simulated time can advance while this process hardly runs (as fast as possible on a busy machine): of the
    time between two looks only MAX_COUNTED_TIME counts, and its timeout only after PATIENCE of wall time.
    """
    watch, counted, wall_start = Stopwatch(MAX_COUNTED_TIME), 0.0, time.monotonic()
    while not condition():
        if rospy.is_shutdown():
            raise TaskError(f"ROS went down while waiting: {what}.")
        waited = time.monotonic() - wall_start
        counted += watch.lap()
        if counted > simulated and waited > PATIENCE:
            raise TaskError(f"{what}: not within {simulated:.0f} simulated seconds.")
        if waited > wall:
            raise TaskError(f"{what}: not within {wall:.0f} s of wall time; does the simulation run?")
        time.sleep(0.002)


class Arm:
    """The arm under the Cartesian impedance controller, through its topics."""

    CONTROLLER = "cartesian_impedance_example_controller"
    TURN_TOLERANCE = 0.03  # [rad]
    SETTLED = 0.2  # [s] for which a pose must be kept
    MAX_TIME_STEP = 0.02  # [s] largest advance of the target per step
    MAX_CORRECTION_STEP = 0.04  # [s] above the time between two states
    CORRECTION = 4.0  # [1/s] how fast the equilibrium pose follows the error of an arm that rests
    RESTS = 0.03  # [rad/s]
    MAX_LEAD, MAX_LEAD_TURN = 0.05, 0.3  # [m], [rad]: with an obstacle the force stays small

    def __init__(self, arm_id: str, namespace: str = ""):
        """@param namespace of its launch file, with a final slash; none: that of this process."""
        self.arm_id = arm_id
        self.fingers = [f"{arm_id}_{side}finger" for side in ("left", "right")]
        self._namespace = namespace
        self._state: FrankaState | None = None
        self._target: Array | None = None
        self._arrival: float | None = None  # time since which the arm is at its target
        self._corrected = 0.0  # time of the last correction
        # Friction stops an arm before its equilibrium pose: [m] and, as a rotation vector, [rad] by which
        # that pose is led further. It stays for the next motion, so that the held object feels no jump.
        self._lead_position: Array = np.zeros(3)
        self._lead_turn: Array = np.zeros(3)
        self._publisher = rospy.Publisher(
            f"{namespace}{self.CONTROLLER}/equilibrium_pose", PoseStamped, queue_size=1
        )
        states = f"{namespace}franka_state_controller/franka_states"
        rospy.Subscriber(states, FrankaState, self._store, queue_size=1)
        self._set_load = rospy.ServiceProxy(f"{namespace}franka_control/set_load", SetLoad)

    def _store(self, state: FrankaState) -> None:
        self._state = state

    def wait_ready(self) -> None:
        """Waits until states arrive, the controller subscribes, and the robot is in Move."""
        wait_until(lambda: self._state is not None, "the first robot state", simulated=math.inf)
        wait_until(
            lambda: self._publisher.get_num_connections() > 0,
            "the impedance controller",
            simulated=math.inf,
        )
        wait_until(
            lambda: self.state.robot_mode == FrankaState.ROBOT_MODE_MOVE,
            "robot mode Move",
            simulated=math.inf,
        )
        self._target = self.pose

    @property
    def state(self) -> FrankaState:
        """The newest one. Raises TaskError before the first one has come."""
        if self._state is None:
            raise TaskError("The robot has sent no state yet; call wait_ready() first.")
        return self._state

    @property
    def pose(self) -> Array:
        """O_T_EE, 4x4."""
        return np.array(self.state.O_T_EE).reshape(4, 4, order="F")

    def configure(self, **parameters: float) -> None:
        """Sets stiffnesses by dynamic_reconfigure."""
        server = f"{self._namespace}{self.CONTROLLER}/dynamic_reconfigure_compliance_param_node"
        ReconfigureClient(rospy.resolve_name(server), timeout=30).update_configuration(parameters)

    def set_load(self, mass: float, center: tuple[float, float, float], inertia: list[float]) -> None:
        """Sets the robot's load: [kg], center in the flange frame [m], [kg m^2] column-major."""
        answer = self._set_load(mass, center, inertia)
        if not answer.success:
            raise TaskError(f"set_load was refused: {answer.error}")

    def carry(self, box: Array, size: tuple[float, float, float], mass: float) -> None:
        """Sets a held box as the robot's load: its pose in O (4x4), sides [m] and mass [kg]."""
        a, b, c = size
        principal = mass / 12.0 * np.array([b * b + c * c, a * a + c * c, a * a + b * b])
        flange = self.pose @ np.linalg.inv(np.array(self.state.F_T_EE).reshape(4, 4, order="F"))
        held = np.linalg.inv(flange) @ box
        inertia = held[:3, :3] @ np.diag(principal) @ held[:3, :3].T
        self.set_load(mass, tuple(held[:3, 3]), list(inertia.flatten(order="F")))

    def carry_nothing(self) -> None:
        self.set_load(0.0, (0.0, 0.0, 0.0), [0.0] * 9)

    def move(
        self,
        target: Array,
        speed: float = 0.15,
        turn_speed: float = 0.8,
        tolerance: float = 0.01,
        what: str = "the motion",
    ) -> None:
        """Moves the equilibrium pose to `target` (O_T_EE) and waits until the arm is there, at rest.

        @param speed [m/s], turn_speed [rad/s]: mean speeds; tolerance of the position [m].
        """
        start = self._target
        if start is None:
            raise TaskError(f"{what} begins where the arm is; call wait_ready() first.")
        turn = wrap(yaw_of(target) - yaw_of(start), 2 * math.pi)
        distance = float(np.linalg.norm(target[:3, 3] - start[:3, 3]))
        duration = max(distance / speed, abs(turn) / turn_speed, 0.3)
        # The target must not jump when this script is late, or the held object would slip.
        watch = Stopwatch(self.MAX_TIME_STEP)
        wall_end = time.monotonic() + 120.0
        fraction = 0.0
        while fraction < 1.0:
            if rospy.is_shutdown() or time.monotonic() > wall_end:
                raise TaskError(f"{what}: the simulation's clock does not advance.")
            fraction = min(fraction + watch.lap() / duration, 1.0)
            s = minimum_jerk(fraction)
            x, y, z = start[:3, 3] + s * (target[:3, 3] - start[:3, 3])
            self._lead(downwards(x, y, z, yaw_of(start) + s * turn))
            time.sleep(0.004)
        self._target = target
        self._arrival = None
        self._corrected = rospy.get_time()  # not by states from before the target's arrival
        try:
            wait_until(lambda: self._arrived(target, tolerance), what)
        except TaskError as error:
            away = (self.pose[:3, 3] - target[:3, 3]) * 1e3
            turned = rotation_vector(self.pose[:3, :3] @ target[:3, :3].T)
            raise TaskError(
                f"{error} The end effector stands {away[0]:.1f}, {away[1]:.1f}, {away[2]:.1f} mm and "
                f"{turned[0]:.3f}, {turned[1]:.3f}, {turned[2]:.3f} rad off its target, the fastest joint "
                f"moves at {max(abs(v) for v in self.state.dq):.3f} rad/s."
            ) from error

    def _lead(self, target: Array) -> None:
        led = np.eye(4)
        led[:3, 3] = target[:3, 3] + self._lead_position
        led[:3, :3] = rotation_of(self._lead_turn) @ target[:3, :3]
        message = PoseStamped(pose=pose_of(led))
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = f"{self.arm_id}_link0"
        self._publisher.publish(message)

    def _arrived(self, target: Array, tolerance: float) -> bool:
        if self.state.robot_mode != FrankaState.ROBOT_MODE_MOVE:
            raise TaskError(f"The robot left Move (mode {self.state.robot_mode}); was the user stop pressed?")
        self._lead(target)
        time.sleep(0.004)
        state = self.state
        measured = state.header.stamp.to_sec()
        pose = np.array(state.O_T_EE).reshape(4, 4, order="F")
        away = target[:3, 3] - pose[:3, 3]
        turned = rotation_vector(target[:3, :3] @ pose[:3, :3].T)
        near = np.linalg.norm(away) <= tolerance and np.linalg.norm(turned) <= self.TURN_TOLERANCE
        rests = max(abs(v) for v in state.dq) <= self.RESTS
        if rests and not near:
            self._correct(away, turned, measured)
        if not (rests and near):
            self._arrival = None
            return False
        if self._arrival is None or measured < self._arrival:  # the clock may jump back
            self._arrival = measured
        return bool(measured - self._arrival > self.SETTLED)

    def _correct(self, away: Array, turned: Array, measured: float) -> None:
        """Moves the equilibrium pose further to correct the error at rest.

        Not by a state that the arm had before the last correction: when this script is late, the same
        error would be corrected many times.
        """
        now = rospy.get_time()
        if self._corrected > now:  # the clock has jumped back
            self._corrected = now
        if measured <= self._corrected:
            return
        share = self.CORRECTION * min(measured - self._corrected, self.MAX_CORRECTION_STEP)
        self._corrected = now
        self._lead_position = shortened(self._lead_position + share * away, self.MAX_LEAD)
        self._lead_turn = shortened(self._lead_turn + share * turned, self.MAX_LEAD_TURN)


class Gripper:
    """The hand's actions."""

    ACTIONS = {"homing": HomingAction, "move": MoveAction, "grasp": GraspAction, "stop": StopAction}

    def __init__(self, namespace: str = ""):
        """@param namespace as of Arm."""
        # Goal handles are polled: the simple client loses goals that end before its send_goal() returns,
        # as they do when the simulation runs as fast as possible.
        self._clients = {
            name: actionlib.ActionClient(f"{namespace}franka_gripper/{name}", kind)
            for name, kind in self.ACTIONS.items()
        }

    def wait_ready(self) -> None:
        for name, client in self._clients.items():
            wait_until(
                partial(client.wait_for_server, rospy.Duration(0.05)),
                f"the gripper's {name} action",
                simulated=math.inf,
            )

    def _run(self, name: str, goal: Any, simulated: float = 20.0) -> None:
        handle = self._clients[name].send_goal(goal)
        wait_until(
            lambda: handle.get_comm_state() == CommState.DONE,
            f"the gripper's {name}",
            simulated=simulated,
        )
        result = handle.get_result()
        if handle.get_terminal_state() != GoalStatus.SUCCEEDED or not result.success:
            text = (result.error if result else "") or handle.get_goal_status_text()
            raise TaskError(f"The gripper's {name} failed: {text or 'no reason given'}")

    def homing(self) -> None:
        self._run("homing", HomingGoal(), simulated=40.0)

    def move(self, width: float, speed: float = 0.1) -> None:
        self._run("move", MoveGoal(width=width, speed=speed))

    def grasp(self, width: float, force: float, speed: float = 0.05, epsilon: float = 0.005) -> None:
        self._run(
            "grasp",
            GraspGoal(
                width=width,
                epsilon=GraspEpsilon(inner=epsilon, outer=epsilon),
                speed=speed,
                force=force,
            ),
        )

    def stop(self) -> None:
        self._run("stop", StopGoal())


class Scene:
    """Poses and pictures from the simulation, instead of a camera."""

    def __init__(self, node: str = "/gazebo"):
        self._node = node
        self._pose = self._service("get_body_pose", GetBodyPose)
        self._set_pose = self._service("set_body_pose", SetBodyPose)
        self._link_state = self._service("get_link_state", GetLinkState)
        self._contacts = self._service("get_contacts", GetContacts)
        self._render = self._service("render_picture", RenderPicture)

    def _service(self, name: str, kind: Any) -> rospy.ServiceProxy:
        full = f"{self._node}/{name}"
        try:
            rospy.wait_for_service(full, timeout=60)
        except rospy.ROSException as error:
            raise TaskError(f"The simulation does not offer {full}; is it running?") from error
        return rospy.ServiceProxy(full, kind)

    @staticmethod
    def _checked(answer: Any, what: str) -> Any:
        if not answer.success:
            raise TaskError(f"{what}: {answer.error}")
        return answer

    def pose(self, body: str) -> Array:
        """World pose of a body, 4x4."""
        return matrix_of(self._checked(self._pose(body), f"pose of {body}").pose)

    def pose_in(self, frame: str, body: str) -> Array:
        """Pose of a body in the frame of another one, 4x4; both are read in the same tick."""
        answer = self._link_state(body, frame)
        if not answer.success:
            raise TaskError(f"pose of {body} in {frame}: {answer.status_message}")
        return matrix_of(answer.link_state.pose)

    def place(self, body: str, pose: Pose) -> None:
        self._checked(self._set_pose(body, pose), f"placing {body}")

    def grip_force(self, body: str, finger_links: list[str]) -> float:
        """Sum of the contact forces between the fingers and a body [N]."""
        total = 0.0
        for link in finger_links:
            answer = self._checked(self._contacts(body, link), "contacts")
            total += sum(math.hypot(f.x, f.y, f.z) for f in answer.forces)
        return total

    def picture(
        self,
        eye: tuple[float, float, float] = (1.15, -0.95, 1.05),
        target: tuple[float, float, float] = (-0.1, 0.0, 0.42),
        width: int = 960,
        height: int = 720,
    ) -> Image:
        """Picture from a point of the world towards another [m]."""
        answer = self._render(Point(*eye), Point(*target), 45.0, width, height)
        return self._checked(answer, "picture").image


@dataclass
class Placement:
    """Final position of the stone."""

    position: tuple[float, float, float]  # in the world [m]
    distance: float  # from the tray's center, in the plane [m]
    in_tray: bool  # stands or lies in the red tray, at rest


class PickAndPlace:
    """The task, one function per step; `report` gets a message for each."""

    APPROACH = 0.12  # above the stone [m]
    FORCE = 5.0  # [N]

    def __init__(
        self,
        arm: Arm,
        gripper: Gripper,
        scene: Scene,
        report: Callable[[str], None],
        stone: str = "stone",
        tray: str = "place_tray",
    ):
        self.arm, self.gripper, self.scene, self.report = arm, gripper, scene, report
        self.stone, self.tray = stone, tray
        arm.wait_ready()
        gripper.wait_ready()
        self._base_inverse = np.linalg.inv(scene.pose(f"{arm.arm_id}_link0"))

    def prepare(self) -> None:
        self.arm.configure(nullspace_stiffness=10.0, translational_stiffness=400.0, rotational_stiffness=30.0)
        self.report("homing the gripper")
        self.gripper.homing()
        self.gripper.move(0.08)
        self.report("the gripper is open")

    def pick(self) -> None:
        stone = self._in_base(self.scene.pose(self.stone))
        yaw, width = self._grasp_of(stone)
        x, y, z = stone[:3, 3]
        self.report(f"the stone stands at x {x:.3f}, y {y:.3f}, z {z:.3f} m before the robot")
        self.arm.move(downwards(x, y, z + self.APPROACH, yaw), what="the way above the stone")
        self._descend(x, y, z, yaw)
        self.report(f"grasping with {self.FORCE:.0f} N")
        self.gripper.grasp(width, self.FORCE)
        self.arm.carry(self._in_base(self.scene.pose(self.stone)), STONE_SIZE, STONE_MASS)
        self.report(
            f"the stone is held, contact forces {self.scene.grip_force(self.stone, self.arm.fingers):.1f} N"
        )
        self._held = (z, yaw, stone)
        self.arm.move(downwards(x, y, z + self.APPROACH, yaw), speed=0.1, what="the lift")
        lifted = self._in_base(self.scene.pose(self.stone))[2, 3] - z
        if lifted < 0.5 * self.APPROACH:
            raise TaskError(f"The stone was not lifted: it rose by {lifted * 1e3:.0f} mm only.")

    def carry(self) -> None:
        z, yaw, _ = self._held
        tray = self._in_base(self.scene.pose(self.tray))
        self.arm.move(
            downwards(tray[0, 3], tray[1, 3], z + self.APPROACH, yaw),
            what="the way to the red tray",
        )
        self.report("the stone is above the red tray")

    def place(self) -> None:
        z, yaw, _ = self._held
        tray = self._in_base(self.scene.pose(self.tray))
        x, y = tray[:2, 3]
        self._descend(x, y, z + 0.002, yaw)
        self.gripper.stop()
        self.gripper.move(0.08, speed=0.05)
        self.arm.carry_nothing()
        self.report("the stone is let go")
        self.arm.move(downwards(x, y, z + self.APPROACH, yaw), what="the retreat")

    def placement(self) -> Placement:
        """Position of the stone, once it is at rest."""
        watch, passed, stone = Stopwatch(MAX_COUNTED_TIME), 0.0, self.scene.pose(self.stone)

        def at_rest() -> bool:
            nonlocal passed, stone
            passed += watch.lap()
            if passed < 0.5:
                return False
            last, stone, passed = stone, self.scene.pose(self.stone), 0.0
            return float(np.linalg.norm(stone[:3, 3] - last[:3, 3])) < 1e-4

        wait_until(at_rest, "the stone coming to rest")
        tray = self.scene.pose(self.tray)
        offset = np.linalg.inv(tray) @ stone
        lowest = STONE_SIZE[0] / 2 - 1e-3
        highest = math.hypot(*STONE_SIZE) / 2
        # The tray's frame is at its bottom; the stone rests on its upper face.
        height = offset[2, 3] - TRAY_SIZE[2]
        inside = bool(
            abs(offset[0, 3]) < TRAY_SIZE[0] / 2
            and abs(offset[1, 3]) < TRAY_SIZE[1] / 2
            and lowest < height < highest
        )
        x, y, z = map(float, stone[:3, 3])
        return Placement((x, y, z), math.hypot(offset[0, 3], offset[1, 3]), inside)

    def _in_base(self, world: Array) -> Array:
        return self._base_inverse @ world

    @staticmethod
    def _grasp_of(stone: Array) -> tuple[float, float]:
        """Gripper yaw and width for the pair of the stone's sides that needs the smaller rotation."""
        yaw = yaw_of(stone)
        along_y = wrap(yaw, math.pi)  # the fingers close along the stone's y
        along_x = wrap(yaw + math.pi / 2, math.pi)  # ... and along its x
        if abs(along_y) <= abs(along_x):
            return along_y, STONE_SIZE[1]
        return along_x, STONE_SIZE[0]

    def _descend(self, x: float, y: float, z: float, yaw: float) -> None:
        self.arm.move(downwards(x, y, z, yaw), speed=0.06, tolerance=0.008, what="the descent")
