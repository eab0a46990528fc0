# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated robots in this process: no sockets, no threads, no clock. A tick is a millisecond.

    import numpy as np
    import pyfranka.sim

    with pyfranka.sim.Simulation(world="stone.xml", robots=[pyfranka.sim.Panda(base=(-0.5, 0, 0))]) as sim:
        robot = sim["panda"]
        for _ in range(1000):
            robot.command(torque=robot.model.coriolis(robot.state))
            sim.step()
        print(robot.state.q)

A robot obeys the rules of a real one: its limits, reflexes and recovery. What it refuses raises
RequestRefused; a motion that it aborts is seen in `state.robot_mode` and `state.last_motion_errors`. One
thread at a time may use a simulation.
"""

from __future__ import annotations

import typing
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy
from _pyfranka import _sim
from _pyfranka._sim import ArmModel, GripperOutcome, LiveState, RequestRefused, Snapshot
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "FR3",
    "Action",
    "ArmModel",
    "Contact",
    "Gripper",
    "GripperOutcome",
    "LiveState",
    "Panda",
    "Picture",
    "RequestRefused",
    "Robot",
    "Simulation",
    "Snapshot",
]

Array = NDArray[numpy.float64]
NO_TURN = (1.0, 0.0, 0.0, 0.0)
TRIES = 1000  # random poses before giving up (chosen here)
TRIAL = 20  # ticks after which a pose has shown what it touches (chosen here)
MOVED = 1e-3  # [rad] by then, of an arm that was pushed away (chosen here)


@dataclass(frozen=True)
class _Setup:
    """A robot to add to a world.

    name: prefix of its joints and links (its kind). base: x, y, z [m] and, optionally, the turn about the
    vertical [rad]. hand: whether its hand is driven. load: mass [kg], centre of mass in the flange's frame
    [m] and, optionally, inertia 3x3 [kg m^2], as entered in Desk; it is not simulated. realism: a profile of
    docs/sim_to_real.md, such as "real,friction=off". urdf: another description of this kind of robot.
    """

    name: str = ""
    base: Sequence[float] = (0.0, 0.0, 0.0)
    hand: bool = True
    load: Sequence[ArrayLike] | None = None
    realism: str = ""
    urdf: str = ""

    kind: typing.ClassVar[str] = ""

    def _named(self, taken: set[str]) -> _Setup:
        """This, with a name of its own."""
        name, number = self.name or self.kind, 2
        while not self.name and name in taken:
            name, number = f"{self.kind}_{number}", number + 1
        if name in taken:
            raise ValueError(f"Two robots have the name '{name}'; each needs one of its own.")
        taken.add(name)
        return replace(self, name=name)

    def _seeded(self, seed: int | None) -> _Setup:
        """This, with a seed where its realism names none."""
        words = [word for word in self.realism.split(",") if word]
        if seed is None or any(word.startswith("seed=") for word in words):
            return self
        return replace(self, realism=",".join([*words, f"seed={seed}"]))

    def _native(self) -> _sim.RobotSetup:
        base = numpy.asarray(self.base, dtype=float).ravel()
        if base.size not in (3, 4):
            raise ValueError(f"base needs x, y, z and optionally the turn, not {base.size} numbers.")
        yaw = float(base[3]) if base.size == 4 else 0.0
        if not numpy.isfinite(yaw):
            raise ValueError("base must be finite numbers.")
        return _sim.RobotSetup(
            robot=self.kind,
            name=self.name,
            urdf=self.urdf,
            base=base[:3],
            yaw=yaw,
            realism=self.realism,
            hand=self.hand,
        )


@dataclass(frozen=True)
class Panda(_Setup):
    """A Panda to add to a world."""

    __doc__ += _Setup.__doc__.partition("\n")[2]
    kind: typing.ClassVar[str] = "panda"


@dataclass(frozen=True)
class FR3(_Setup):
    """An FR3 to add to a world."""

    __doc__ += _Setup.__doc__.partition("\n")[2]
    kind: typing.ClassVar[str] = "fr3"


class Action:
    """A command of the hand, which runs while the simulation steps."""

    def __init__(self, robot: _sim.Robot, ticket: int):
        self._robot, self._ticket = robot, ticket
        self._outcome = GripperOutcome.Running if ticket else GripperOutcome.Failed

    @property
    def outcome(self) -> GripperOutcome:
        """What has become of it."""
        if self._outcome == GripperOutcome.Running:
            self._outcome = self._robot.hand_outcome(self._ticket)
        return self._outcome

    @property
    def done(self) -> bool:
        """Whether it has ended."""
        return self.outcome != GripperOutcome.Running

    @property
    def succeeded(self) -> bool:
        """Whether it has ended with success."""
        return self.outcome == GripperOutcome.Succeeded


class Gripper:
    """The hand of a robot. Commands return at once with an Action; a new one interrupts the running one."""

    def __init__(self, robot: _sim.Robot):
        self._robot = robot
        robot.hand_state()  # raises without a hand

    def homing(self) -> Action:
        """Closes and opens the fingers fully."""
        return Action(self._robot, self._robot.hand_homing())

    def move(self, width: float, speed: float = 0.1) -> Action:
        """Moves the fingers to a width [m] at a speed [m/s]; refused (Failed) for values that no hand has."""
        return Action(self._robot, self._robot.hand_move(width, speed))

    def grasp(
        self, width: float, speed: float, force: float, epsilon_inner=0.005, epsilon_outer=0.005
    ) -> Action:
        """Closes [m, m/s] and holds with a force [N]. Succeeds if what is held is as wide as asked, within
        the epsilons [m]."""
        return Action(self._robot, self._robot.hand_grasp(width, speed, force, epsilon_inner, epsilon_outer))

    def stop(self) -> Action:
        """Ends the running command and the force of a grasp."""
        return Action(self._robot, self._robot.hand_stop())

    @property
    def width(self) -> float:
        """Between the fingers [m]."""
        return self._robot.hand_state()[0]

    @property
    def max_width(self) -> float:
        """[m]"""
        return self._robot.hand_state()[1]

    @property
    def is_grasped(self) -> bool:
        """Whether an object as wide as asked is held."""
        return self._robot.hand_state()[2]

    @property
    def temperature(self) -> float:
        """[deg C]"""
        return self._robot.hand_state()[3]


class Robot:
    """A robot of a simulation: `sim["panda"]`."""

    state: LiveState
    model: ArmModel

    def __init__(self, native: _sim.Robot, setup: _Setup):
        self._native, self.setup = native, setup
        self.state, self.model = native.state, native.model
        self._gripper: Gripper | None = None
        if setup.load is not None:
            mass, com, *inertia = setup.load
            native.set_load(float(mass), com, inertia[0] if inertia else numpy.zeros(9))

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
        return self._native.moving

    @property
    def brakes_closed(self) -> bool:
        """Whether the brakes are closed."""
        return self._native.brakes_closed

    @property
    def limits(self) -> tuple[Array, Array]:
        """Lowest and highest joint positions, 7 [rad] each."""
        return self._native.limits

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
    ) -> None:
        """Commands the arm: exactly one of torque 7 [Nm] (without gravity), joint_positions 7 [rad],
        joint_velocities 7 [rad/s], cartesian_pose 4x4 (O_T_EE) and cartesian_velocities 6 [m/s, rad/s].

        The first command starts a motion. Each is sent in every tick until the next one, so positions and
        poses must be commanded tick by tick, as over the FCI; a jump ends the motion. elbow: joint 3 [rad]
        and the sign of joint 4, with Cartesian commands. controller: the robot's own, "joint_impedance" or
        "cartesian_impedance"; torques go without.

        Raises RequestRefused if the robot cannot start the motion, or if one of another kind runs or one
        is ending; ValueError.
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
        if torque is not None:
            self._native.command_torques(torque)
        elif joint_positions is not None:
            self._native.command_joint_positions(joint_positions, controller)
        elif joint_velocities is not None:
            self._native.command_joint_velocities(joint_velocities, controller)
        elif cartesian_pose is not None:
            self._native.command_cartesian_pose(cartesian_pose, elbow, controller)
        else:
            self._native.command_cartesian_velocities(cartesian_velocities, elbow, controller)

    def joint_impedance(
        self, target: ArrayLike, duration: float = 0.0, stiffness: ArrayLike | None = None
    ) -> None:
        """Lets a torque controller in C++ hold the joints by springs and dampers at 1 kHz. target: 7 [rad],
        reached smoothly within the duration [s]; stiffness: 7 [Nm/rad], which stays until the motion ends.

        Raises as command().
        """
        self._native.joint_impedance(target, duration, stiffness)

    def cartesian_impedance(
        self,
        target: ArrayLike,
        duration: float = 0.0,
        stiffness: ArrayLike | None = None,
        nullspace_stiffness: float | None = None,
    ) -> None:
        """The same for the end effector. target: O_T_EE, 4x4; stiffness: 6 [N/m, Nm/rad] along and about the
        axes of K; nullspace_stiffness of the joints [Nm/rad]."""
        self._native.cartesian_impedance(target, duration, stiffness, nullspace_stiffness)

    def finish(self) -> None:
        """Ends the motion as a client does: the arm brakes, and is idle after some ticks."""
        self._native.finish()

    def recover(self) -> None:
        """Starts the recovery from errors, which takes some ticks. Raises RequestRefused."""
        self._native.recover()

    def set_user_stop(self, pressed: bool) -> None:
        """Presses or releases the user stop."""
        self._native.set_user_stop(pressed)

    def set_brakes(self, closed: bool) -> None:
        """Closes or opens the brakes."""
        self._native.set_brakes(closed)

    def set_guiding(self, active: bool) -> None:
        """Begins or ends guiding by hand. Raises RequestRefused."""
        self._native.set_guiding(active)

    def set_joint_impedance(self, K_theta: ArrayLike) -> None:
        """Stiffness of the robot's own joint controller, 7 [Nm/rad]. Raises RequestRefused, as all setters
        do."""
        self._native.set_joint_impedance(K_theta)

    def set_cartesian_impedance(self, K_x: ArrayLike) -> None:
        """Stiffness of the robot's own Cartesian controller, 6 [N/m, Nm/rad]."""
        self._native.set_cartesian_impedance(K_x)

    def set_collision_behavior(
        self,
        lower_torque: ArrayLike,
        upper_torque: ArrayLike,
        lower_force: ArrayLike,
        upper_force: ArrayLike,
    ) -> None:
        """Thresholds of contact (lower) and collision (upper): 7 [Nm] and 6 [N, Nm]."""
        self._native.set_collision_behavior(lower_torque, upper_torque, lower_force, upper_force)

    def set_EE(self, NE_T_EE: ArrayLike) -> None:
        """Pose of the end effector in NE, 4x4."""
        self._native.set_EE(NE_T_EE)

    def set_K(self, EE_T_K: ArrayLike) -> None:
        """Pose of the stiffness frame in EE, 4x4."""
        self._native.set_K(EE_T_K)

    def set_load(self, mass: float, F_x_Cload: ArrayLike, load_inertia: ArrayLike) -> None:
        """What the robot knows of its load: mass [kg], centre of mass in F, 3 [m], inertia, 3x3 [kg m^2]."""
        self._native.set_load(mass, F_x_Cload, load_inertia)

    def hash(self) -> int:
        """Hash of all states since the first command; the control interface's `hash` of a served robot."""
        return self._native.hash()


class Contact(typing.NamedTuple):
    """Where two bodies touch: names, position in the world [m], force on the second one, world axes [N]."""

    body1: str
    body2: str
    position: Array
    force: Array


class Picture(typing.NamedTuple):
    """rgb: height x width x 3. depth along the viewing axis [m], height x width; None for the free camera."""

    rgb: NDArray[numpy.uint8]
    depth: NDArray[numpy.float32] | None


class Simulation(Mapping):
    """A world with robots, stepped by the program. `sim["panda"]` is a Robot.

    world: an MJCF or SDF file, or the name of one that comes along (stone.xml); empty: an empty world.
    robots: Panda and FR3. seed: of all randomness; the same seed and the same calls give the same bits.

    Raises RuntimeError or ValueError with a sentence for a world or a robot that cannot be used.
    """

    def __init__(self, world: str = "", robots: Sequence[_Setup] | None = None, seed: int = 1):
        robots, taken = [Panda()] if robots is None else robots, set()
        for robot in robots:
            if not isinstance(robot, (Panda, FR3)):
                raise TypeError(f"robots are Panda(...) and FR3(...), not {type(robot).__name__}.")
        named = [robot._named(taken) for robot in robots]
        setups = [robot._seeded(seed + i) for i, robot in enumerate(named)]
        self._random = numpy.random.default_rng(seed)
        self._native = _sim.Simulation(world, [setup._native() for setup in setups])
        self._robots = {setup.name: Robot(self._native.robot(setup.name), setup) for setup in setups}
        for name in self:
            if overlaps := self._native.overlaps(name):
                warnings.warn(f"{overlaps} Give it another base.", stacklevel=2)

    def __getitem__(self, name: str) -> Robot:
        if name not in self._robots:
            raise KeyError(f"There is no robot '{name}'; there are: {', '.join(self._robots)}.")
        return self._robots[name]

    def __iter__(self):
        return iter(self._robots)

    def __len__(self) -> int:
        return len(self._robots)

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *error) -> None:
        self.close()

    def close(self) -> None:
        """Ends the simulation: all further calls raise RuntimeError."""
        self._native.close()

    @property
    def ticks(self) -> int:
        """Milliseconds since the start or the last reset."""
        return self._native.ticks()

    @property
    def time(self) -> float:
        """The same [s]."""
        return 1e-3 * self.ticks

    def step(self, ticks: int = 1) -> None:
        """Advances by so many milliseconds; other Python threads run meanwhile. Raises RuntimeError once the
        physics has diverged; reset() ends that."""
        self._native.step(ticks)

    def reset(
        self,
        q: ArrayLike | str | Mapping[str, ArrayLike | str] | None = None,
        objects: Mapping[str, ArrayLike] | None = None,
        seed: int | None = None,
    ) -> None:
        """Resets the world to its beginning; the robots are idle, at rest and without errors.

        q: joint positions, 7 [rad], or "random" (within the limits, free of contacts), of all robots or by
        name. objects: body name -> x, y, z [m] and, optionally, the quaternion w, x, y, z. seed: of the
        random numbers from now on; without one, their sequence goes on.

        Raises ValueError, KeyError, and nothing has changed; RuntimeError where an object cannot be moved or
        no random pose is free.
        """
        places = {body: self._checked_place(body, pose) for body, pose in (objects or {}).items()}
        given = q if isinstance(q, Mapping) else {name: q for name in self if q is not None}
        poses = {name: self._checked_pose(self[name], pose) for name, pose in given.items()}
        self._native.reset()
        if seed is not None:
            self._random = numpy.random.default_rng(seed)
        for body, (position, orientation) in places.items():
            self.place_body(body, position, orientation)
        for name, pose in poses.items():
            if pose is None:
                self._place_randomly(self[name])
            else:
                self[name]._native.place(pose)

    def _checked_place(self, body: str, pose: ArrayLike) -> tuple[Array, Array]:
        values = numpy.asarray(pose, dtype=float).ravel()
        if body not in self.bodies():
            raise ValueError(f"There is no body '{body}' in the world.")
        if values.size not in (3, 7) or not numpy.isfinite(values).all():
            raise ValueError(f"The pose of '{body}' is 3 or 7 finite numbers: x, y, z, and w, x, y, z.")
        return values[:3], values[3:] if values.size == 7 else numpy.array(NO_TURN)

    def _checked_pose(self, robot: Robot, q: ArrayLike | str) -> Array | None:
        """None for a random pose."""
        if isinstance(q, str):
            if q != "random":
                raise ValueError(f"q is 7 numbers or 'random', not '{q}'.")
            return None
        values = numpy.asarray(q, dtype=float).ravel()
        robot._native.check_positions(values)
        return values

    def _place_randomly(self, robot: Robot) -> None:
        before = self.snapshot()
        for _ in range(TRIES):
            q = self._random.uniform(*robot.limits)
            robot._native.place(q)
            self.step(TRIAL)
            free = not robot.state.current_errors and numpy.abs(robot.state.q - q).max() < MOVED
            free = free and not self._touches(robot)
            self.restore(before)
            if free:
                robot._native.place(q)
                return
        raise RuntimeError(f"No random pose of '{robot.name}' is free of contacts ({TRIES} tries).")

    def _touches(self, robot: Robot) -> bool:
        own = f"{robot.name}_"
        touched = any(c.body1.startswith(own) or c.body2.startswith(own) for c in self.contacts())
        return touched or bool(self._native.overlaps(robot.name))

    def snapshot(self) -> Snapshot:
        """The present state of the world, for restore()."""
        return self._native.snapshot()

    def restore(self, snapshot: Snapshot) -> None:
        """Returns to a snapshot. The robots hold their poses in it, idle; commands in transit are lost."""
        self._native.restore(snapshot)

    def hash(self) -> int:
        """Hash of the world's state: bodies, joints and what acts on them."""
        return self._native.hash()

    def bodies(self) -> list[str]:
        """Names of all bodies, links included."""
        return self._native.bodies()

    def body_pose(self, body: str) -> tuple[Array, Array]:
        """Position [m] and quaternion w, x, y, z of a body in the world."""
        return self._native.body_pose(body)

    def place_body(self, body: str, position: ArrayLike, orientation: ArrayLike = NO_TURN) -> None:
        """Puts a free body to a position [m] and a quaternion w, x, y, z, at rest."""
        self._native.place_body(body, position, orientation)

    def push(self, body: str, force: ArrayLike, torque: ArrayLike = (0.0, 0.0, 0.0), ticks: int = 1) -> None:
        """A force [N] and a torque [Nm] at a body's origin, world axes, for so many milliseconds from now."""
        self._native.push(body, force, torque, ticks)

    def contacts(self) -> list[Contact]:
        """Where bodies touch now."""
        return [Contact(*contact) for contact in self._native.contacts()]

    def cameras(self) -> list[str]:
        """Names of the world's cameras."""
        return self._native.cameras()

    def render(self, camera: str = "", width: int = 640, height: int = 480) -> Picture:
        """A picture of a camera; without a name, of a view of the whole world. Needs no display."""
        return Picture(*self._native.render(camera, width, height))
