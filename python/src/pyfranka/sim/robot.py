# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A robot of a simulation, and its hand."""

from __future__ import annotations

import numpy
from _pyfranka import GripperState, RobotState
from _pyfranka._sim import ArmModel, GripperOutcome, LiveState
from numpy.typing import ArrayLike, NDArray

from pyfranka import _copies
from pyfranka._native import _sim

from .setups import _Setup

Array = NDArray[numpy.float64]


class Action:
    """A command of the hand, which runs while the simulation steps.

    >>> action = arm.gripper.move(0.04)
    >>> sim.step(2000)
    >>> action.succeeded
    True
    """

    def __init__(self, robot: _sim.SimulatedRobot, ticket: int, what: str):
        self._robot, self._ticket, self._what = robot, ticket, what
        self._outcome = GripperOutcome.Running

    __reduce__ = _copies.refused(
        "An Action can be neither pickled nor copied: it runs in a simulation of this process. Use its "
        "outcome."
    )

    def __repr__(self) -> str:
        try:
            return f"<Action {self._what}: {self.outcome.name}>"
        except RuntimeError as error:
            return f"<Action {self._what}: {error}>"

    @property
    def outcome(self) -> GripperOutcome:
        """Its outcome."""
        if self._outcome == GripperOutcome.Running:
            self._outcome = self._robot.hand_outcome(self._ticket)
        return self._outcome

    def __bool__(self) -> bool:
        """Whether it has succeeded, which a hand on the network returns. RuntimeError: it runs."""
        if not self.done:
            raise RuntimeError(
                f"The {self._what} still runs: step the simulation until it is done, then ask for success."
            )
        return self.succeeded

    @property
    def done(self) -> bool:
        """Whether it has ended."""
        return bool(self.outcome != GripperOutcome.Running)

    @property
    def succeeded(self) -> bool:
        """Whether it has ended with success."""
        return bool(self.outcome == GripperOutcome.Succeeded)


class Gripper:
    """The hand of a robot. Commands return at once with an Action; a new one interrupts the running one.

    What the hand refuses raises RequestRefused, as the arm's requests do: a width beyond max_width, a speed
    or a force below zero. ValueError or TypeError: what is not a finite number, a speed above 1 m/s and a
    force above 1000 N. Nothing has changed then.

    >>> arm.gripper.grasp(0.03, 0.1, 20.0)
    <Action grasp: Running>
    """

    def __init__(self, robot: _sim.SimulatedRobot):
        self._robot = robot
        robot.hand_state()  # raises without a hand

    __reduce__ = _copies.refused(
        "A Gripper can be neither pickled nor copied: it is part of a simulation of this process. Make a "
        "Simulation where it is used, or keep its width and max_width."
    )

    def __repr__(self) -> str:
        try:
            state = self._robot.hand_state()
        except RuntimeError as error:
            return f"<Gripper: {error}>"
        held = "" if state.is_grasped else "not "
        return f"<Gripper: width {state.width:.4g} of {state.max_width:.4g} m, {held}grasped>"

    def homing(self) -> Action:
        """Closes and opens the fingers fully.

        >>> arm.gripper.homing().outcome == pyfranka.sim.GripperOutcome.Running
        True
        """
        return Action(self._robot, self._robot.hand_homing(), "homing")

    def move(self, width: float, speed: float = 0.1) -> Action:
        """Moves the fingers to a width [m] at a speed [m/s]. Raises RequestRefused.

        >>> arm.gripper.move(0.04)
        <Action move: Running>
        """
        return Action(self._robot, self._robot.hand_move(width, speed), "move")

    def grasp(
        self,
        width: float,
        speed: float,
        force: float,
        epsilon_inner: float = 0.005,
        epsilon_outer: float = 0.005,
    ) -> Action:
        """Closes [m, m/s] and holds with a force [N]. Succeeds if the held object has the requested width,
        within the epsilons [m]. Raises RequestRefused.

        >>> action = arm.gripper.grasp(0.03, speed=0.1, force=20.0)
        >>> sim.step(3000)
        >>> action.done, action.succeeded  # there is nothing to hold
        (True, False)
        """
        ticket = self._robot.hand_grasp(width, speed, force, epsilon_inner, epsilon_outer)
        return Action(self._robot, ticket, "grasp")

    def stop(self) -> Action:
        """Ends the running command and the force of a grasp.

        >>> arm.gripper.stop().succeeded
        True
        """
        return Action(self._robot, self._robot.hand_stop(), "stop")

    def read_once(self) -> GripperState:
        """The state of the present tick.

        >>> arm.gripper.read_once().is_grasped
        False
        """
        state: GripperState = self._robot.hand_state()
        return state

    @property
    def width(self) -> float:
        """Between the fingers [m]."""
        return float(self.read_once().width)

    @property
    def max_width(self) -> float:
        """[m]"""
        return float(self.read_once().max_width)

    @property
    def is_grasped(self) -> bool:
        """Whether an object of the requested width is held."""
        return bool(self.read_once().is_grasped)

    @property
    def temperature(self) -> int:
        """[deg C]"""
        return int(self.read_once().temperature)


class SimulatedRobot:
    """A robot of a simulation: `sim["panda"]`.

    What it refuses raises RequestRefused with its mode and what to do; ValueError or TypeError: arguments
    that cannot be used; RuntimeError: the simulation is closed or in use by another thread. Nothing has
    changed then.

    >>> arm = sim["panda"]
    >>> arm.command(torque=[0.0] * 7)
    >>> sim.step(10)
    >>> arm
    <Panda 'panda': moving>
    """

    def __init__(self, native: _sim.SimulatedRobot, setup: _Setup):
        self._native, self.setup = native, setup
        self._live_state, self._model = native.live_state, native.model
        self._gripper: Gripper | None = None
        if setup.load is not None:
            native.set_load(*setup.load)

    __reduce__ = _copies.refused(
        "A SimulatedRobot can be neither pickled nor copied: it is part of a simulation of this process. "
        "Make a Simulation with the same world, robots and seed where it is used; its state can be pickled."
    )

    def __repr__(self) -> str:
        try:
            mode = "moving" if self.moving else self.state.robot_mode.name
        except RuntimeError as error:
            mode = str(error)
        return f"<{type(self.setup).__name__} '{self.name}': {mode}>"

    @property
    def state(self) -> RobotState:
        """The state of the present tick, which stays as it is, as read_once() of a robot on the network."""
        state: RobotState = self._native.state
        return state

    def read_once(self) -> RobotState:
        """The same, as programs for robots on the network write it.

        >>> arm.read_once() == arm.state
        True
        """
        return self.state

    @property
    def live_state(self) -> LiveState:
        """The same without a copy, for programs that read it in each tick: its values and arrays change with
        each step. live_state.copy() stays."""
        self._native.require_open()
        return self._live_state

    @property
    def model(self) -> ArmModel:
        """The model of its own control."""
        self._native.require_open()
        return self._model

    @property
    def name(self) -> str:
        """Prefix of its joints and links."""
        return self.setup.name

    @property
    def gripper(self) -> Gripper:
        """Its hand. Raises RuntimeError if it has none."""
        if self._gripper is None:
            self._gripper = Gripper(self._native)
        return self._gripper

    @property
    def moving(self) -> bool:
        """Whether a motion runs."""
        return bool(self._native.moving)

    @property
    def brakes_closed(self) -> bool:
        """Whether the brakes are closed."""
        return bool(self._native.brakes_closed)

    @property
    def limits(self) -> tuple[Array, Array]:
        """Lowest and highest joint positions, 7 [rad] each."""
        limits: tuple[Array, Array] = self._native.limits
        return limits

    def command(
        self,
        *,
        torque: ArrayLike | None = None,
        joint_positions: ArrayLike | None = None,
        joint_velocities: ArrayLike | None = None,
        cartesian_pose: ArrayLike | None = None,
        cartesian_velocities: ArrayLike | None = None,
        elbow: ArrayLike | None = None,
        controller: str = "joint_impedance",
        limit_rate: bool = False,
        damping: ArrayLike | None = None,
    ) -> None:
        """Commands the arm: exactly one of torque 7 [Nm] (without gravity), joint_positions 7 [rad],
        joint_velocities 7 [rad/s], cartesian_pose 4x4 (O_T_EE) and cartesian_velocities 6 [m/s, rad/s].

        The first command starts a motion. Each is sent in every tick until the next one, so positions and
        poses must be commanded tick by tick, as over the FCI; a jump ends the motion. elbow: joint 3 [rad]
        and the sign of joint 4, with Cartesian commands. controller: the robot's own, "joint_impedance" or
        "cartesian_impedance"; torques go without. limit_rate: with torques that change in steps; what is
        sent then follows as fast as the robot allows (1 Nm per tick) instead of ending the motion. damping:
        with torques, 7 [Nm s/rad] times the joint velocities are subtracted in every tick.

        Raises RequestRefused if the robot cannot start the motion, or if one of another kind runs or one
        is ending; ValueError or TypeError with a sentence, and nothing has changed.

        >>> arm.command(joint_velocities=[0.0] * 7)
        >>> sim.step()
        >>> arm.moving
        True
        """
        values = {
            "torque": torque,
            "joint_positions": joint_positions,
            "joint_velocities": joint_velocities,
            "cartesian_pose": cartesian_pose,
            "cartesian_velocities": cartesian_velocities,
        }
        given = [name for name, value in values.items() if value is not None]
        if len(given) != 1:
            raise ValueError(f"A command is one of {', '.join(values)}; given: {', '.join(given) or 'none'}.")
        if elbow is not None and not given[0].startswith("cartesian"):
            raise ValueError("An elbow goes with cartesian_pose and cartesian_velocities only.")
        if torque is None and (limit_rate is not False or damping is not None):
            raise ValueError("limit_rate and damping go with torques only.")
        if torque is not None:
            self._native.command_torques(torque, limit_rate, damping)
        elif joint_positions is not None:
            self._native.command_joint_positions(joint_positions, controller)
        elif joint_velocities is not None:
            self._native.command_joint_velocities(joint_velocities, controller)
        elif cartesian_pose is not None:
            self._native.command_cartesian_pose(cartesian_pose, elbow, controller)
        else:
            self._native.command_cartesian_velocities(cartesian_velocities, elbow, controller)

    def joint_impedance(
        self,
        target: ArrayLike,
        duration: float = 0.0,
        stiffness: ArrayLike | None = None,
        linear: bool = False,
    ) -> None:
        """Lets a torque controller in C++ hold the joints by springs and dampers at 1 kHz. target: 7 [rad],
        reached within the duration [s], smoothly from rest to rest or, for targets that follow each other
        (linear), at constant speed; stiffness: 7 [Nm/rad], which stays until the motion ends.

        Raises as command(), and ValueError for a target beyond the range of its joint.

        >>> arm.joint_impedance(arm.state.q + 0.1, duration=1.0)
        >>> sim.step(1500)
        >>> arm.moving
        True
        """
        self._native.joint_impedance(target, duration, stiffness, linear)

    def cartesian_impedance(
        self,
        target: ArrayLike,
        duration: float = 0.0,
        stiffness: ArrayLike | None = None,
        nullspace_stiffness: float | None = None,
        linear: bool = False,
        damping: ArrayLike | None = None,
    ) -> None:
        """The same for the end effector. target: O_T_EE, 4x4, at most 2 m from the base; stiffness:
        6 [N/m, Nm/rad] along and about the axes of K; nullspace_stiffness of the joints [Nm/rad]; damping of
        the joints in addition to that of the springs, 7 [Nm s/rad], for an arm that swings.

        >>> target = arm.state.O_T_EE.copy()
        >>> target[2, 3] += 0.05
        >>> arm.cartesian_impedance(target, duration=1.0)
        """
        self._native.cartesian_impedance(target, duration, stiffness, nullspace_stiffness, linear, damping)

    def finish(self) -> None:
        """Ends the motion as a client does: the arm brakes, and is idle after some ticks.

        >>> arm.command(torque=[0.0] * 7)
        >>> arm.finish()
        """
        self._native.finish()

    def recover(self) -> None:
        """Starts the recovery from errors, which takes some ticks. Raises RequestRefused.

        >>> if arm.state.robot_mode == pyfranka.RobotMode.Reflex:
        ...     arm.recover()
        """
        self._native.recover()

    def set_user_stop(self, pressed: bool) -> None:
        """Presses or releases the user stop.

        >>> arm.set_user_stop(True)
        >>> sim.step()
        >>> arm.state.robot_mode == pyfranka.RobotMode.UserStopped
        True
        """
        self._native.set_user_stop(pressed)

    def close_brakes(self) -> None:
        """Closes the brakes, which ends a motion.

        >>> arm.close_brakes()
        >>> sim.step(1000)
        >>> arm.brakes_closed
        True
        """
        self._native.set_brakes(True)

    def open_brakes(self) -> None:
        """Opens the brakes, which takes some ticks.

        >>> arm.close_brakes()
        >>> sim.step(1000)
        >>> arm.open_brakes()
        """
        self._native.set_brakes(False)

    def set_guiding(self, active: bool) -> None:
        """Begins or ends guiding by hand. Raises RequestRefused with closed brakes, while the user stop is
        pressed and in a recovery.

        >>> arm.set_guiding(True)
        >>> sim.step()
        >>> arm.state.robot_mode == pyfranka.RobotMode.Guiding
        True
        """
        self._native.set_guiding(active)

    def set_joint_impedance(self, K_theta: ArrayLike) -> None:
        """Stiffness of the robot's own joint controller, 7 [Nm/rad]. Raises RequestRefused, as all setters
        do.

        >>> arm.set_joint_impedance([3000.0] * 4 + [2500.0, 2000.0, 2000.0])
        """
        self._native.set_joint_impedance(K_theta)

    def set_cartesian_impedance(self, K_x: ArrayLike) -> None:
        """Stiffness of the robot's own Cartesian controller, 6 [N/m, Nm/rad].

        >>> arm.set_cartesian_impedance([3000.0] * 3 + [300.0] * 3)
        """
        self._native.set_cartesian_impedance(K_x)

    def set_collision_behavior(
        self,
        lower_torque: ArrayLike,
        upper_torque: ArrayLike,
        lower_force: ArrayLike,
        upper_force: ArrayLike,
    ) -> None:
        """Thresholds of contact (lower) and collision (upper): 7 [Nm] and 6 [N, Nm].

        >>> arm.set_collision_behavior([20.0] * 7, [40.0] * 7, [20.0] * 6, [40.0] * 6)
        """
        self._native.set_collision_behavior(lower_torque, upper_torque, lower_force, upper_force)

    def set_EE(self, NE_T_EE: ArrayLike) -> None:
        """Pose of the end effector in NE, 4x4.

        >>> arm.set_EE(numpy.eye(4))
        """
        self._native.set_EE(NE_T_EE)

    def set_K(self, EE_T_K: ArrayLike) -> None:
        """Pose of the stiffness frame in EE, 4x4.

        >>> arm.set_K(numpy.eye(4))
        """
        self._native.set_K(EE_T_K)

    def set_load(
        self, mass: float, F_x_Cload: ArrayLike = (0.0, 0.0, 0.0), load_inertia: ArrayLike = (0.0,) * 9
    ) -> None:
        """The load that the robot assumes: mass [kg], center of mass in F, 3 [m], inertia, 3x3
        [kg m^2].

        >>> arm.set_load(0.5, [0.0, 0.0, 0.05], 0.001 * numpy.eye(3))
        """
        self._native.set_load(mass, F_x_Cload, load_inertia)

    def state_hash(self) -> int:
        """Hash of all states since the first command; the control interface's `hash` of a served robot.

        >>> arm.command(torque=[0.0] * 7)
        >>> sim.step()
        >>> arm.state_hash() != 0
        True
        """
        return int(self._native.hash())
