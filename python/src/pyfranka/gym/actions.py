# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What a policy's action does to an arm and a hand. All values of an action lie in [-1, 1].

The robot's own control runs at 1 kHz below the policy; an action moves the target of its springs, or sets
torques. A target never leads the arm by more than a limit, so that an arm at an obstacle presses gently.
"""

from __future__ import annotations

import math

import numpy
from scipy.spatial.transform import Rotation

from pyfranka import Frame, RobotMode
from pyfranka.sim import Robot

__all__ = ["CONTROLS", "ArmControl", "HandControl"]

# Chosen here. Speeds: the joints stay below their limits. Stiffnesses: an arm at an obstacle presses with
# 40 N (cartesian_delta) or 60 Nm (joint_delta) at most, which is stiffness times lead.
TORQUE = numpy.array([15.0, 15.0, 15.0, 15.0, 4.5, 4.5, 4.5])  # of action 1 [Nm]
DAMPING = TORQUE / 1.5  # at 1.5 rad/s nothing is left of action 1 [Nm s/rad]
TORQUE_MARGIN, FADING = 0.2, 2.0 * TORQUE  # from the limits [rad]; towards them [Nm/rad]
JOINT_SPEED = 1.0  # of action 1 [rad/s]
JOINT_STIFFNESS = [400.0, 400.0, 400.0, 400.0, 200.0, 100.0, 50.0]  # [Nm/rad]
JOINT_LEAD = 0.15  # [rad]
JOINT_MARGIN = 0.1  # from the limits, which targets keep [rad]
SPEED, TURN_SPEED = 0.25, 0.8  # of an action of length 1 [m/s], [rad/s]
STIFFNESS = [2000.0, 2000.0, 2000.0, 100.0, 100.0, 100.0]  # [N/m, Nm/rad]
SWING_DAMPING = [5.0, 5.0, 5.0, 5.0, 1.0, 1.0, 1.0]  # of joints [Nm s/rad]: without, an arm swings at 1 Hz
LEAD, TURN_LEAD = 0.02, 0.1  # [m], [rad]
LARGEST_JOINT_SPEED = 1.0  # of the way that a target takes [rad/s]
SINGULAR = 1e-4 * numpy.eye(6)  # damps the joint speeds that are computed near singular poses
LARGEST_TURN = 1.4  # from the orientation at the start [rad]
GRIP_FORCE, GRIP_SPEED = 20.0, 0.1  # [N], [m/s]
MODES_THAT_TAKE_COMMANDS = (RobotMode.Idle, RobotMode.Move)


def shortened(vector: numpy.ndarray, longest: float) -> numpy.ndarray:
    """The vector, or one of the same direction with the largest length allowed."""
    length = math.sqrt(vector @ vector)
    return vector if length <= longest else vector * (longest / length)


class ArmControl:
    """Applies the actions of one arm. While the robot cannot be commanded, as during its recovery, actions
    have no effect."""

    size: int  # how many numbers of the action it takes
    unit: str  # what they mean, for error messages and documentation

    def __init__(self, robot: Robot, base: numpy.ndarray, workspace: numpy.ndarray):
        """base: pose of the robot in the world, 4x4. workspace: lowest and highest x, y, z of targets in the
        world, 2x3 [m]."""
        self._robot, self._state = robot, robot.state
        self._base, self._to_base, self._workspace = base, numpy.linalg.inv(base), workspace
        self.restart()

    def restart(self) -> None:
        """Call after a reset."""
        self._running = False

    def apply(self, action: numpy.ndarray, seconds: float) -> None:
        """An action in [-1, 1], for so long."""
        if self._state.robot_mode not in MODES_THAT_TAKE_COMMANDS:
            self._running = False
            return
        if not self._running:
            self._begin()
            self._running = True
        self._command(action, seconds)

    def _begin(self) -> None:
        """The arm rests, and an action is about to come."""

    def _command(self, action: numpy.ndarray, seconds: float) -> None:
        raise NotImplementedError


class TorqueControl(ArmControl):
    """Torques beside those that carry the arm's weight, damped in every tick. Towards a limit of a joint they
    fade, and turn back where it is near."""

    size = 7
    unit = "torques of the joints"

    def __init__(self, *arguments):
        super().__init__(*arguments)
        lowest, highest = self._robot.limits
        self._lowest, self._highest = lowest + TORQUE_MARGIN, highest - TORQUE_MARGIN

    def _command(self, action, seconds):
        lowest, highest = FADING * (self._lowest - self._state.q), FADING * (self._highest - self._state.q)
        torque = numpy.minimum(numpy.maximum(action * TORQUE, lowest), highest)
        torque = numpy.minimum(numpy.maximum(torque, -2.0 * TORQUE), 2.0 * TORQUE)
        self._robot.command(torque=torque, limit_rate=True, damping=DAMPING)


class JointControl(ArmControl):
    """Steps of the joints' targets."""

    size = 7
    unit = "position steps of the joints"

    def __init__(self, *arguments):
        super().__init__(*arguments)
        lowest, highest = self._robot.limits
        self._lowest, self._highest = lowest + JOINT_MARGIN, highest - JOINT_MARGIN

    def _begin(self):
        self._target = self._state.q.copy()
        self._robot.joint_impedance(self._target, stiffness=JOINT_STIFFNESS)

    def _command(self, action, seconds):
        q = self._state.q
        target = self._target + (JOINT_SPEED * seconds) * action
        target = numpy.minimum(numpy.maximum(target, self._lowest), self._highest)
        self._target = numpy.minimum(numpy.maximum(target, q - JOINT_LEAD), q + JOINT_LEAD)
        self._robot.joint_impedance(self._target, seconds, linear=True)


class CartesianControl(ArmControl):
    """Steps of the end effector's target, in the world's axes: x, y, z and a rotation vector. Each of the
    two is shortened to the length 1."""

    size = 6
    unit = "steps of the end effector's position and orientation"

    def restart(self):
        super().restart()
        self._start = self._world_pose()[:3, :3]

    def _world_pose(self):
        return self._base @ self._state.O_T_EE

    def _begin(self):
        self._target = self._world_pose()
        self._robot.cartesian_impedance(self._state.O_T_EE, stiffness=STIFFNESS, damping=SWING_DAMPING)

    def _command(self, action, seconds):
        now, target = self._world_pose(), self._target
        step, turn = SPEED * shortened(action[:3], 1.0), TURN_SPEED * shortened(action[3:], 1.0)
        share = seconds * self._share_of_speed(step, turn)
        position = target[:3, 3] + share * step
        position = numpy.minimum(numpy.maximum(position, self._workspace[0]), self._workspace[1])
        target[:3, 3] = now[:3, 3] + shortened(position - now[:3, 3], LEAD)
        turned = Rotation.from_rotvec(share * turn).as_matrix() @ target[:3, :3]
        turned = within(turned, self._start, LARGEST_TURN)
        target[:3, :3] = within(turned, now[:3, :3], TURN_LEAD)
        self._robot.cartesian_impedance(self._to_base @ target, seconds, linear=True)

    def _share_of_speed(self, velocity: numpy.ndarray, turning: numpy.ndarray) -> float:
        """How much of a velocity of the end effector, in the world, the joints can take: 0 to 1."""
        J = self._robot.model.zero_jacobian(Frame.EndEffector, self._state)
        turn = self._to_base[:3, :3]
        twist = numpy.concatenate([turn @ velocity, turn @ turning])
        dq = J.T @ numpy.linalg.solve(J @ J.T + SINGULAR, twist)
        return min(1.0, LARGEST_JOINT_SPEED / max(float(numpy.abs(dq).max()), 1e-9))


def within(rotation: numpy.ndarray, centre: numpy.ndarray, largest: float) -> numpy.ndarray:
    """The rotation, 3x3, or the nearest one that is turned from the centre by the largest angle [rad]."""
    # The trace of a rotation is 1 + 2 cos(angle).
    if numpy.vdot(rotation, centre) >= 1.0 + 2.0 * math.cos(largest):
        return rotation
    vector = Rotation.from_matrix(rotation @ centre.T).as_rotvec()
    return Rotation.from_rotvec(shortened(vector, largest)).as_matrix() @ centre


class HandControl:
    """Applies an action's last number: below 0 the hand closes and holds what is between the fingers with
    20 N, else it opens fully. A command is given only when this changes."""

    def __init__(self, robot: Robot):
        self._gripper = robot.gripper
        self._widest = robot.gripper.max_width
        self.restart()

    def restart(self) -> None:
        """Call after a reset: the hand is open."""
        self._closed = False

    def apply(self, action: float) -> None:
        """In [-1, 1]."""
        closed = bool(action < 0.0)
        if closed and not self._closed:
            self._gripper.grasp(0.0, GRIP_SPEED, GRIP_FORCE, epsilon_outer=self._widest)
        elif self._closed and not closed:
            self._gripper.move(self._widest, GRIP_SPEED)
        self._closed = closed


CONTROLS: dict[str, type[ArmControl]] = {
    "torque": TorqueControl,
    "joint_delta": JointControl,
    "cartesian_delta": CartesianControl,
}
