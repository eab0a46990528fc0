# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Bad input of each public function of pyfranka.sim and pyfranka.gym: a sentence, and nothing half done."""

import inspect
import math

import numpy as np
import pyfranka.gym
import pyfranka.sim
import pytest
from pyfranka.sim import FR3, KINDS, Gripper, Panda, SimulatedRobot, Simulation, SimulationBatch
from sentences import ERRORS, check_refused_while_another_thread_steps, unlike_ours

NAN, INF = math.nan, math.inf
BASE = (-0.5, 0, 0)  # beside the table of stone.xml
ROBOTS_TAKE_TURNS = True
START = (0, -0.785, 0, -2.356, 0, 1.571, 0.785)  # [rad]
FAR = 1e4  # [m], [N]: beyond what a world takes
QUATERNION_0 = (0, 0, 1, 0, 0, 0, 0)

# "Class.function" -> a part of the sentence -> the call. `x` is an object of the class.
SIMULATION = {
    "__init__": {
        "no world 'moon.xml'": lambda x: Simulation(world="moon.xml"),
        "world must be the name of a file, not 5": lambda x: Simulation(world=5),
        "robots must be a list of Panda": lambda x: Simulation(robots=Panda()),
        "robots are Panda(...), FR3(...) and their kinds, not 5": lambda x: Simulation(robots=[5]),
        "'ur5'": lambda x: Simulation(robots=["ur5"]),
        "robots must be a list": lambda x: Simulation(robots="panda"),
        "Two robots have the name 'a'": lambda x: Simulation(robots=[Panda("a"), FR3("a", base=(0, 1, 0))]),
        "seed must be a whole number, not 1.5": lambda x: Simulation(seed=1.5),
        "seed must be a whole number, not 'a'": lambda x: Simulation(seed="a"),
        "seed must be 0 to": lambda x: Simulation(seed=-1),
        "protocol of panda is for robots on the network": lambda x: Simulation(robots=[Panda(protocol=5)]),
        "vacuum gripper is served on the network": lambda x: Simulation(robots=[Panda(hand="vacuum")]),
        "world must be the name of a file, not its text": lambda x: Simulation("<mujoco/>"),
        "10 kg": lambda x: Simulation(robots=[Panda(load=(100.0, (0, 0, 0)))]),
    },
    "__getitem__": {
        "no robot 'ur5'": lambda x: x["ur5"],
        "no robot '[1]'": lambda x: x[[1]],
    },
    "serve": {
        "no robot 'ur5'": lambda x: x.serve("127.0.34.1", robot="ur5"),
        "pace is 'lockstep' or 'realtime'": lambda x: x.serve("127.0.34.1", pace="fast"),
        "patience is a number of seconds": lambda x: x.serve("127.0.34.1", patience="long"),
        "patience must be more than 0": lambda x: x.serve("127.0.34.1", patience=0),
        "patience must be a finite number": lambda x: x.serve("127.0.34.1", patience=NAN),
        "patience must be a number, not [1]": lambda x: x.serve("127.0.34.1", patience=[1]),
        "ip must be a text, not 5": lambda x: x.serve(5),
        "wait is 'auto', 'spin' or 'block', not 'sleep'": lambda x: x.serve("127.0.34.1", wait="sleep"),
        "wait must be a text, not None": lambda x: x.serve("127.0.34.1", wait=None),
        "address": lambda x: x.serve("moon"),
    },
    "step": {
        "ticks must be a whole number, not 1.5": lambda x: x.step(1.5),
        "ticks must be a whole number, not None": lambda x: x.step(None),
        "Time goes forwards": lambda x: x.step(-1),
        "ticks is too large": lambda x: x.step(2**70),
    },
    "reset": {
        "q is 7 numbers or 'random'": lambda x: x.reset(q="anywhere"),
        "q must be 7 finite numbers": lambda x: x.reset(q=[1, 2]),
        "q must be 7 finite numbers, not [nan": lambda x: x.reset(q=[NAN] * 7),
        "q must be 7 finite numbers, not ['a']": lambda x: x.reset(q=["a"]),
        "Joint 4 of": lambda x: x.reset(q=np.ones(7)),
        "no robot 'ur5'": lambda x: x.reset(q={"ur5": "random"}),
        "objects must be a dict of poses": lambda x: x.reset(objects=[1]),
        "The name of a body must be a text": lambda x: x.reset(objects={3: [0, 0, 1]}),
        "no body 'brick'": lambda x: x.reset(objects={"brick": [0, 0, 1]}),
        "pose of 'stone' must be 3 or 7 finite": lambda x: x.reset(objects={"stone": [0, 0]}),
        "pose of 'stone' must be 3 or 7 finite numbers, not [nan": lambda x: x.reset(
            objects={"stone": [NAN, 0, 0]}
        ),
        "is not free to move": lambda x: x.reset(objects={"table": [0, 0, 1]}),
        "is not a unit quaternion": lambda x: x.reset(objects={"stone": QUATERNION_0}),
        "The position for body 'stone'": lambda x: x.reset(objects={"stone": [FAR, 0, 0]}),
        "seed must be a whole number, not 2.5": lambda x: x.reset(seed=2.5),
        "seed must be 0 to": lambda x: x.reset(seed=-1, objects={"stone": [0, 0, 1]}),
    },
    "restore": {
        "snapshot must be what snapshot() has returned, not None": lambda x: x.restore(None),
        "The snapshot cannot be restored: it is of": lambda x: x.restore(Simulation().snapshot()),
    },
    "body_pose": {
        "no body 'nothing'": lambda x: x.body_pose("nothing"),
        "body must be a text, not 3": lambda x: x.body_pose(3),
    },
    "place_body": {
        "no body 'nothing'": lambda x: x.place_body("nothing", [0, 0, 1]),
        "body must be a text, not None": lambda x: x.place_body(None, [0, 0, 1]),
        "is not free to move": lambda x: x.place_body("table", [0, 0, 1]),
        "position needs 3 numbers, not 2": lambda x: x.place_body("stone", [0, 0]),
        "position must be finite": lambda x: x.place_body("stone", [0, NAN, 0]),
        "The position for body 'stone'": lambda x: x.place_body("stone", [0, 0, -FAR]),
        "orientation needs 4 numbers": lambda x: x.place_body("stone", [0, 0, 1], [1, 0]),
        "is not a unit quaternion": lambda x: x.place_body("stone", [0, 0, 1], [0, 0, 0, 0]),
    },
    "push": {
        "no body 'nothing'": lambda x: x.push("nothing", [1, 0, 0]),
        "force must be finite": lambda x: x.push("stone", [INF, 0, 0]),
        "force needs 3 numbers": lambda x: x.push("stone", 5.0),
        "torque needs 3 numbers": lambda x: x.push("stone", [0, 0, 1], "left"),
        "force must be at most 1000 N along each axis, not 10000 N": lambda x: x.push("stone", [FAR, 0, 0]),
        "force must be at most 1000 N along each axis, not -1001 N": lambda x: x.push("stone", [0, -1001, 0]),
        "torque must be at most 1000 Nm": lambda x: x.push("stone", [0, 0, 1], [0, 0, FAR]),
        "ticks of a push must be 1 or more": lambda x: x.push("stone", [0, 0, 1], ticks=0),
        "Time goes forwards": lambda x: x.push("stone", [0, 0, 1], ticks=-5),
        "ticks must be a whole number, not 0.5": lambda x: x.push("stone", [0, 0, 1], ticks=0.5),
    },
    "render": {
        "no camera 'nowhere'": lambda x: x.render("nowhere"),
        "camera must be a text, not 1": lambda x: x.render(1),
        "width must be 1 to 4096 pixels, not 0": lambda x: x.render(width=0, height=0),
        "height must be 1 to 4096 pixels, not -1": lambda x: x.render(height=-1),
        "width must be 1 to 4096 pixels, not 5000": lambda x: x.render(width=5000),
        "width must be a whole number, not 64.0": lambda x: x.render(width=64.0),
    },
}

ROBOT = {
    "__init__": {"": None},  # made by Simulation
    "command": {
        "A command is one of": lambda x: x.command(),
        "given: torque, joint_positions": lambda x: x.command(torque=[0] * 7, joint_positions=[0] * 7),
        "torque needs 7 numbers, not 2": lambda x: x.command(torque=[1, 2]),
        "torque must be finite": lambda x: x.command(torque=[NAN] * 7),
        "torque needs 7 numbers": lambda x: x.command(torque="much"),
        "joint_positions must be finite": lambda x: x.command(joint_positions=[INF] * 7),
        "joint_velocities needs 7 numbers": lambda x: x.command(joint_velocities=np.zeros((2, 7))),
        "cartesian_pose needs 16 numbers": lambda x: x.command(cartesian_pose=np.eye(3)),
        "a matrix of 4 rows": lambda x: x.command(cartesian_pose=np.eye(4).reshape(2, 8)),
        "cartesian_pose must be finite": lambda x: x.command(cartesian_pose=np.full((4, 4), NAN)),
        "cartesian_velocities needs 6": lambda x: x.command(cartesian_velocities=[0] * 7),
        "An elbow goes with": lambda x: x.command(torque=[0] * 7, elbow=[0, 1]),
        "elbow needs 2 numbers": lambda x: x.command(cartesian_velocities=[0] * 6, elbow=[0]),
        "elbow must be finite": lambda x: x.command(cartesian_velocities=[0] * 6, elbow=[NAN, 1]),
        "limit_rate and damping go": lambda x: x.command(joint_positions=[0] * 7, limit_rate=True),
        "limit_rate must be True or False": lambda x: x.command(torque=[0] * 7, limit_rate="yes"),
        "damping must not be": lambda x: x.command(torque=[0] * 7, damping=[-1.0] * 7),
        "damping needs 7": lambda x: x.command(torque=[0] * 7, damping=3.0),
        "controller is joint_impedance or": lambda x: x.command(joint_positions=[0] * 7, controller="soft"),
        "controller must be a text": lambda x: x.command(joint_positions=[0] * 7, controller=1),
    },
    "joint_impedance": {
        "target needs 7 numbers": lambda x: x.joint_impedance([1, 2]),
        "target must be finite": lambda x: x.joint_impedance([NAN] * 7),
        "Joint 2 of": lambda x: x.joint_impedance(np.degrees(START)),
        "Joint 7 of": lambda x: x.joint_impedance([*START[:6], 3.1]),
        "duration must be 0 to": lambda x: x.joint_impedance([0] * 7, duration=-1.0),
        "duration must be a finite": lambda x: x.joint_impedance([0] * 7, duration=NAN),
        "duration must be a number, not 'long'": lambda x: x.joint_impedance([0] * 7, duration="long"),
        "stiffness must lie between": lambda x: x.joint_impedance([0] * 7, stiffness=[-1.0] * 7),
        "stiffness needs 7": lambda x: x.joint_impedance([0] * 7, stiffness=100.0),
        "linear must be True or False": lambda x: x.joint_impedance([0] * 7, linear="no"),
    },
    "cartesian_impedance": {
        "target needs 16 numbers": lambda x: x.cartesian_impedance([0, 0, 1]),
        "target cannot be used": lambda x: x.cartesian_impedance(np.ones((4, 4))),
        "target lies 3 m from": lambda x: x.cartesian_impedance(np.eye(4) + np.eye(4, k=3) * 3),
        "duration must be": lambda x: x.cartesian_impedance(np.eye(4), duration=INF),
        "stiffness must not be negative": lambda x: x.cartesian_impedance(np.eye(4), stiffness=[-1] * 6),
        "stiffness must be finite": lambda x: x.cartesian_impedance(np.eye(4), stiffness=[NAN] * 6),
        "nullspace_stiffness must be a finite": lambda x: x.cartesian_impedance(
            np.eye(4), nullspace_stiffness=INF
        ),
        "nullspace_stiffness must be a number": lambda x: x.cartesian_impedance(
            np.eye(4), nullspace_stiffness=[1]
        ),
        "linear must be": lambda x: x.cartesian_impedance(np.eye(4), linear=2),
        "damping must not be": lambda x: x.cartesian_impedance(np.eye(4), damping=[-1] * 7),
    },
    "set_user_stop": {"pressed must be True or False, not 'yes'": lambda x: x.set_user_stop("yes")},
    "set_brakes": {"closed must be True or False, not None": lambda x: x.set_brakes(None)},
    "set_guiding": {"active must be True or False, not 0.5": lambda x: x.set_guiding(0.5)},
    "set_joint_impedance": {
        "K_theta needs 7 numbers": lambda x: x.set_joint_impedance([1.0]),
        "K_theta must be finite": lambda x: x.set_joint_impedance([NAN] * 7),
        "outside of what the robot accepts": lambda x: x.set_joint_impedance([1e9] * 7),
    },
    "set_cartesian_impedance": {
        "K_x needs 6 numbers": lambda x: x.set_cartesian_impedance([1.0] * 7),
        "K_x must be finite": lambda x: x.set_cartesian_impedance([NAN] * 6),
        "outside of what the robot accepts": lambda x: x.set_cartesian_impedance([-5.0] * 6),
    },
    "set_collision_behavior": {
        "lower_torque needs 7": lambda x: x.set_collision_behavior([1], [1] * 7, [1] * 6, [1] * 6),
        "upper_torque must be finite": lambda x: x.set_collision_behavior(
            [1] * 7, [INF] * 7, [1] * 6, [1] * 6
        ),
        "lower_force needs 6": lambda x: x.set_collision_behavior([1] * 7, [1] * 7, [1] * 7, [1] * 6),
        "upper_force must be finite": lambda x: x.set_collision_behavior(
            [1] * 7, [1] * 7, [1] * 6, [NAN] * 6
        ),
        "outside of what the robot accepts": lambda x: x.set_collision_behavior(
            [-1] * 7, [1] * 7, [1] * 6, [1] * 6
        ),
    },
    "set_EE": {
        "NE_T_EE needs 16 numbers": lambda x: x.set_EE([0.1]),
        "NE_T_EE cannot be used: its bottom row": lambda x: x.set_EE(2 * np.eye(4)),
        "NE_T_EE cannot be used: its entry in row 1": lambda x: x.set_EE(np.full((4, 4), NAN)),
    },
    "set_K": {
        "EE_T_K needs 16 numbers": lambda x: x.set_K(None),
        "EE_T_K cannot be used": lambda x: x.set_K(np.zeros((4, 4))),
    },
    "set_load": {
        "mass must be a number, not 'heavy'": lambda x: x.set_load("heavy", [0, 0, 0], np.zeros(9)),
        "mass must be a finite number, not nan": lambda x: x.set_load(NAN, [0, 0, 0], np.zeros(9)),
        "10 kg": lambda x: x.set_load(100.0, [0, 0, 0], np.zeros(9)),
        "F_x_Cload needs 3": lambda x: x.set_load(1.0, [0, 0], np.zeros(9)),
        "load_inertia must be finite": lambda x: x.set_load(1.0, [0, 0, 0], np.full(9, NAN)),
    },
}

GRIPPER = {
    "__init__": {"": None},  # made by Robot
    "move": {
        "width must be a finite number, not nan": lambda x: x.move(NAN),
        "width must be a number, not 'wide'": lambda x: x.move("wide"),
        "speed must be a finite number, not inf": lambda x: x.move(0.05, INF),
        "refused the motion: width must be 0 to 0.08 m, not 5": lambda x: x.move(5.0),
        "refused the motion: speed must not be negative, not -1": lambda x: x.move(0.05, -1),
        "speed must be 0 to 1 m/s, not 100 m/s": lambda x: x.move(0.05, 100),
    },
    "grasp": {
        "width must be a finite": lambda x: x.grasp(NAN, 0.1, 10),
        "speed must be a finite": lambda x: x.grasp(0.03, NAN, 10),
        "force must be a finite": lambda x: x.grasp(0.03, 0.1, NAN),
        "refused the grasp: force must not be negative": lambda x: x.grasp(0.03, 0.1, -1),
        "refused the grasp: width must be 0 to 0.08": lambda x: x.grasp(-0.03, 0.1, 10),
        "force must be a number, not None": lambda x: x.grasp(0.03, 0.1, None),
        "speed must be 0 to 1 m/s, not 100 m/s": lambda x: x.grasp(0.03, 100, 10),
        "force must be 0 to 1000 N, not 10000 N": lambda x: x.grasp(0.03, 0.1, FAR),
        "epsilon_inner must be a finite": lambda x: x.grasp(0.03, 0.1, 10, epsilon_inner=NAN),
        "epsilon_outer must be a finite": lambda x: x.grasp(0.03, 0.1, 10, epsilon_outer=NAN),
    },
}

SETUP = {
    "__init__": {
        "base (x, y, z [m] and, optionally, the turn [rad]) must be 3 or 4": lambda x: x(base="a"),
        "must be 3 or 4 finite numbers, not (1, 2)": lambda x: x(base=(1, 2)),
        "must be 3 or 4 finite numbers, not (nan": lambda x: x(base=(NAN, 0, 0)),
        "must be 3 or 4 finite numbers, not (0, 0, 0, inf)": lambda x: x(base=(0, 0, 0, INF)),
        "base must be at most 100 m from the origin along each axis, not (-500.0": lambda x: x(
            base=(-500, 0, 0)
        ),
        "axis, not (0.0, 0.0, 101.0) m": lambda x: x(base=(0, 0, 101)),
        "The turn of base must be -6.283 to 6.283 rad, not 90 rad": lambda x: x(base=(0, 0, 0, 90)),
        "load must be mass, center of mass and": lambda x: x(load=5),
        "load must be mass, center of mass": lambda x: x(load=(1.0,)),
        "The mass of load [kg] must be a finite number": lambda x: x(load=("a", (0, 0, 0))),
        "The center of mass of load [m] must be 3": lambda x: x(load=(1.0, (0, 0))),
        "The inertia of load [kg m^2] must be 9": lambda x: x(load=(1.0, (0, 0, 0), [1])),
        "name must be a text, not 5": lambda x: x(name=5),
        "it cannot be 'a b'": lambda x: x(name="a b"),
        "hand must be True, False or 'vacuum', not 'yes'": lambda x: x(hand="yes"),
        "hand must be True, False or 'vacuum', not 1": lambda x: x(hand=1),
        "'reel' is not known": lambda x: x(realism="reel"),
        "there is no file '/nowhere.urdf'": lambda x: x(urdf="/nowhere.urdf"),
        "The inertia of load [kg m^2] must be 9 finite": lambda x: x(load=(1, (0, 0, 0), np.ones((9, 1)))),
        "protocol must be a whole number, not 'a'": lambda x: x(protocol="a"),
        "or 0 for all, not 2": lambda x: x(protocol=2),
        "address must be a text, not 5": lambda x: x(address=5),
        "arguments must be a list of options": lambda x: x(arguments="--patience 5"),
        "realism must be a text": lambda x: x(realism=1),
        "urdf must be the name of a file, not 5": lambda x: x(urdf=5),
        "urdf must be the name of a file, not its text (2007": lambda x: x(urdf="<robot>" + 2000 * " "),
    }
}

BATCH = {
    "__init__": {
        "number must be 1 to": lambda x: SimulationBatch(0),
        "number must be a whole number, not 2.5": lambda x: SimulationBatch(2.5),
        "no world 'moon.xml'": lambda x: SimulationBatch(2, world="moon.xml"),
        "robots must be a list": lambda x: SimulationBatch(2, robots=Panda()),
        "'ur5'": lambda x: SimulationBatch(2, robots=["ur5"]),
        "seed must be a whole number": lambda x: SimulationBatch(2, seed="a"),
        "threads must be 1 to 1024": lambda x: SimulationBatch(2, threads=0),
        "threads must be a whole number": lambda x: SimulationBatch(2, threads=1.5),
        "no value 'panda.color'": lambda x: SimulationBatch(2, observe=["panda.color"]),
        "observe must be a list of names, not 'time'": lambda x: SimulationBatch(2, observe="time"),
        "observe must be a list of names, not 5": lambda x: SimulationBatch(2, observe=5),
        "A name of observe must be a text": lambda x: SimulationBatch(2, observe=[5]),
    },
    "__getitem__": {
        "no world 7; the batch has 2": lambda x: x[7],
        "The number of a world must be a whole number": lambda x: x["first"],
    },
    "index": {"": None},  # of Sequence, as count
    "count": {"": None},
    "step": {
        "Time goes forwards": lambda x: x.step(-1),
        "ticks must be a whole number, not 1.5": lambda x: x.step(1.5),
    },
    "reset": {
        "no world 5": lambda x: x.reset(worlds=[5]),
        "worlds must be a list": lambda x: x.reset(worlds=5),
        "or 'random'": lambda x: x.reset(q="anywhere"),
        "objects must be a dict": lambda x: x.reset(objects=[1]),
        "is not a unit quaternion": lambda x: x.reset(objects={"stone": QUATERNION_0}),
    },
    "replace": {
        "no world 9": lambda x: x.replace(9, Simulation()),
        "simulation must be a Simulation, not None": lambda x: x.replace(0, None),
        "already world 1": lambda x: x.replace(0, x[1]),
        "There is no value 'panda.q'": lambda x: x.replace(0, Simulation(robots=[FR3()])),
        "The number of a world must be": lambda x: x.replace("a", Simulation()),
    },
}

OPTIONS = {
    "task is one of Reach": {"task": "Cook"},
    "task is one of Reach, Push": {"task": 5},
    "robot is one of panda, fr3, not 'ur5'": {"robot": "ur5"},
    "control is one of torque": {"control": "mind"},
    "observation is one of": {"observation": "smell"},
    "reward is one of": {"reward": "huge"},
    "on_reflex is one of": {"on_reflex": "ignore"},
    "render_mode is one of": {"render_mode": "ansi"},
    "frequency is 1 to 1000 Hz": {"frequency": 30},
    "frequency must be a finite number": {"frequency": NAN},
    "frequency must be a finite number, not 'often'": {"frequency": "often"},
    "size is width and height": {"size": (0, 10)},
    "size must be a whole number": {"size": (1.5, 10)},
    "size must be a list of width and height": {"size": 5},
    "render_size is width and height": {"render_size": (0, 10)},
    "has no option 'hue', 'speed'; its options are robot, control": {"hue": 1, "speed": 2},
    "'reel' is not known": {"realism": "reel"},
    "realism must be a text": {"realism": 5},
    "no camera 'nowhere'": {"camera": "nowhere"},
    "camera must be a text": {"camera": 5},
    "randomize must be a dict": {"randomize": ["mass"]},
    "randomize: 'color' is not known": {"randomize": {"color": 1}},
    "randomize: mass is that of an object": {"task": "Reach", "randomize": {"mass": (1, 2)}},
    "randomize: load needs a lowest": {"randomize": {"load": 1}},
    "randomize: load can be from 0 to 3": {"randomize": {"load": (2, 1)}},
    "randomize: realism must be a list": {"randomize": {"realism": 5}},
}
EPISODE_OPTIONS = {
    "options must be a dict": [1],
    "Joint 1 of": {"q": [9.0] * 7},
    "The option q must be 7 finite numbers": {"q": "random"},
    "The option object must be 3 or 7 finite": {"object": [1, 2]},
    "is not a unit quaternion": {"object": QUATERNION_0},
    "The position for body 'stone'": {"object": [FAR, 0, 0]},
    "The option goal must be 3 finite": {"goal": [NAN] * 3},
    "The option goal must lie within": {"goal": [0, 0, 2.6]},
    "not 'color'": {"color": 1},
}


def environment_cases(kind, shape, **more):
    made = {
        sentence: lambda x, arguments=arguments: kind(**{"task": "PickAndPlace", **more, **arguments})
        for sentence, arguments in OPTIONS.items()
    }
    resets = {
        sentence: lambda x, options=options: x.reset(seed=3, options=options)
        for sentence, options in EPISODE_OPTIONS.items()
    }
    return {
        "__init__": made,
        "reset": {
            **resets,
            "seed must be 0 to": lambda x: x.reset(seed=-1),
            "seed must be a whole number, not 1.5": lambda x: x.reset(seed=1.5),
            "seed must be a whole number, not 'a'": lambda x: x.reset(seed="a"),
        },
        "step": {
            "has the shape": lambda x: x.step(np.zeros(3)),
            "finite numbers": lambda x: x.step(np.full(shape, NAN)),
            "array of numbers": lambda x: x.step("left"),
        },
    }


ENVIRONMENT = {
    **environment_cases(pyfranka.gym.Environment, (7,)),
    "compute_reward": {
        "A goal is an array of numbers": lambda x: x.compute_reward("near", np.zeros(4), {"reach": 0.0}),
        "A goal has 4 numbers here": lambda x: x.compute_reward(np.zeros(3), np.zeros(4), {"reach": 0.0}),
    },
}
VECTOR = environment_cases(pyfranka.gym.VectorEnvironment, (2, 7), num_envs=2)
VECTOR["__init__"].update(
    {
        "num_envs must be 1 or more": lambda x: pyfranka.gym.VectorEnvironment(0, task="Reach"),
        "num_envs must be a whole number": lambda x: pyfranka.gym.VectorEnvironment(1.5, task="Reach"),
        "max_episode_steps must be": lambda x: pyfranka.gym.VectorEnvironment(
            1, max_episode_steps=0, task="Reach"
        ),
        "threads must be 1 to 1024": lambda x: pyfranka.gym.VectorEnvironment(1, threads=0, task="Reach"),
        "The render_mode of many environments is one of rgb_array": lambda x: pyfranka.gym.VectorEnvironment(
            1, render_mode="human", task="Reach"
        ),
        "autoreset_mode is one of": lambda x: pyfranka.gym.VectorEnvironment(
            1, autoreset_mode="never", task="Reach"
        ),
    }
)
VECTOR["reset"].update(
    {
        "seed is one number, or 2 of them": lambda x: x.reset(seed=[1, 2, 3]),
        "seed must be 0 to": lambda x: x.reset(seed=[1, -1]),
        "reset_mask needs 2 bools": lambda x: x.reset(options={"reset_mask": [True]}),
    }
)
VECTOR["close_extras"] = {"": None}  # called by close(), which passes nothing on


class Thing:
    """What is called wrongly, and what of it must not change."""

    def __init__(self, thing, sims):
        self.thing, self._sims = thing, sims
        self.close = thing.close if hasattr(thing, "close") else lambda: None

    def condition(self):
        return [
            (
                sim.ticks,
                sim.state_hash(),
                [(r.state_hash(), r.moving, r.state.q.tolist()) for r in sim.values()],
            )
            for sim in self._sims
        ]


def in_simulation(get):
    def make(name):
        sim = Simulation("stone.xml", [KINDS[name](name="panda", base=BASE)])
        sim.step(10)
        made = Thing(get(sim), [sim])
        made.close = sim.close
        return made

    return make


def batch_of(name):
    batch = SimulationBatch(2, "stone.xml", [KINDS[name](name="panda", base=BASE)])
    batch.step(10)
    return Thing(batch, list(batch))


def environment_of(name):
    env = pyfranka.gym.Environment("PickAndPlace", robot=name)
    env.reset(seed=1)
    return Thing(env, [env.simulation])


def vector_of(name):
    env = pyfranka.gym.VectorEnvironment(2, task="PickAndPlace", robot=name)
    env.reset(seed=1)
    return Thing(env, [episode.sim for episode in env.episodes])


# The class, how one is made, and its cases.
CLASSES = {
    Simulation: (in_simulation(lambda sim: sim), SIMULATION),
    SimulatedRobot: (in_simulation(lambda sim: sim["panda"]), ROBOT),
    Gripper: (in_simulation(lambda sim: sim["panda"].gripper), GRIPPER),
    Panda: (lambda name: Thing(Panda, []), SETUP),
    FR3: (lambda name: Thing(FR3, []), SETUP),
    SimulationBatch: (batch_of, BATCH),
    pyfranka.gym.Environment: (environment_of, ENVIRONMENT),
    pyfranka.gym.VectorEnvironment: (vector_of, VECTOR),
}


def with_arguments(kind):
    """The public functions of a class that take arguments."""
    names = set()
    for name, function in inspect.getmembers(kind, inspect.isfunction):
        public = not name.startswith("_") or name in ("__init__", "__getitem__")
        module = getattr(function, "__module__", "")
        ours = module.startswith(("pyfranka", "collections")) or name == "__init__"
        parameters = list(inspect.signature(function).parameters.values())[1:]
        if public and ours and parameters:
            names.add(name)
    return names


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_each_public_function_has_a_case(kind):
    assert set(CLASSES[kind][1]) >= with_arguments(kind)


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_bad_input_is_refused_with_a_sentence_and_changes_nothing(kind, name):
    make, cases = CLASSES[kind]
    used, wrong = make(name), []
    before = used.condition()
    for function, sentences in cases.items():
        for part, call in sentences.items():
            if call is None:
                continue
            where = f"{kind.__name__}.{function}, {part!r}"
            try:
                call(used.thing)
                wrong.append(f"{where}: not refused")
            except ERRORS as error:
                # KeyError shows the repr of its argument.
                text = str(error.args[0]) if error.args else ""
                if part not in text or unlike_ours(text):
                    wrong.append(f"{where}: {unlike_ours(text) or 'another sentence'}: {type(error)} {text}")
            if used.condition() != before:
                wrong.append(f"{where}: something has changed")
                before = used.condition()
    used.close()
    assert not wrong, "\n".join(wrong)


# Right in themselves, and refused while the arm moves.
REFUSED_IN_MOTION = [
    lambda x: x.set_joint_impedance([1000.0] * 7),
    lambda x: x.set_cartesian_impedance([500.0] * 3 + [50.0] * 3),
    lambda x: x.set_collision_behavior([50.0] * 7, [60.0] * 7, [50.0] * 6, [60.0] * 6),
    lambda x: x.set_EE(np.eye(4)),
    lambda x: x.set_K(np.eye(4)),
    lambda x: x.set_load(0.5, [0, 0, 0.05], 1e-3 * np.eye(3).ravel()),
    lambda x: x.recover(),
    lambda x: x.command(torque=[0.0] * 7),
    lambda x: x.command(cartesian_velocities=[0.0] * 6),
    lambda x: x.joint_impedance([0.0, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8]),
    lambda x: x.cartesian_impedance(x.state.O_T_EE),
]


def test_refused_calls_do_not_disturb_a_motion(name):
    def calls_of(table):
        return [call for cases in table.values() for call in cases.values() if call]

    def things(sim):
        arm = sim["panda"]
        return (
            (arm, calls_of(ROBOT) + REFUSED_IN_MOTION),
            (arm.gripper, calls_of(GRIPPER)),
            (sim, calls_of(SIMULATION)),
        )

    hashes = []
    for disturbed in (False, True):
        with Simulation("stone.xml", [KINDS[name](name="panda", base=BASE)]) as sim:
            arm = sim["panda"]
            arm.command(joint_velocities=[0.0] * 7)
            for tick in range(1, 21):
                arm.command(joint_velocities=[1e-3 * tick] + [0.0] * 6)
                sim.step()
            arm.gripper.move(0.02)
            sim.step(5)
            for thing, calls in things(sim) if disturbed else []:
                for call in calls:
                    with pytest.raises(ERRORS):
                        call(thing)
            sim.step(300)
            assert arm.moving
            hashes.append(sim.state_hash())
    assert hashes[0] == hashes[1]


def test_bad_input_of_an_episode_keeps_its_random_numbers(name):
    """What a wrong reset would have drawn is drawn by the next one."""
    wrong, right = pyfranka.gym.Environment("Push", robot=name), pyfranka.gym.Environment("Push", robot=name)
    for env in (wrong, right):
        env.reset(seed=5)
    for options in ({"object": [FAR, 0, 0]}, {"q": [9.0] * 7}, {"color": 1}):
        with pytest.raises((ValueError, RuntimeError)):
            wrong.reset(seed=9, options=options)
    first, second = wrong.reset()[0], right.reset()[0]
    assert all((first[part] == second[part]).all() for part in first)
    for env in (wrong, right):
        env.close()


MISSING_FILES = {
    "world": lambda file: Simulation(world=file),
    "world of a batch": lambda file: SimulationBatch(2, world=file),
    "urdf of a Panda": lambda file: Panda(urdf=file),
    "urdf of an FR3": lambda file: FR3(urdf=file),
}


@pytest.mark.parametrize("suffix", ["xml", "world", "urdf"])
@pytest.mark.parametrize("call", MISSING_FILES.values(), ids=MISSING_FILES)
def test_a_missing_file_is_named(call, suffix):
    with pytest.raises(FileNotFoundError, match=f"'/nowhere.{suffix}'.*[.]$"):
        call(f"/nowhere.{suffix}")


# ---- closed, and in use by another thread ------------------------------------------------------------------

# What works in any case: names and views.
ALWAYS = {
    Simulation: {"close", "keys", "items", "values", "hash"},
    SimulatedRobot: {"name", "hash", "set_brakes"},  # the last two are old names
    Gripper: set(),
}
ARGUMENTS = {
    ("Simulation", "serve"): ("127.0.34.2",),
    ("Simulation", "body_pose"): ("stone",),
    ("Simulation", "place_body"): ("stone", (0, 0, 1)),
    ("Simulation", "push"): ("stone", (0, 0, 1)),
    ("SimulatedRobot", "command"): (),
    ("SimulatedRobot", "joint_impedance"): ([0, 0, 0, -1.5, 0, 1.5, 0],),
    ("SimulatedRobot", "cartesian_impedance"): (np.eye(4),),
    ("SimulatedRobot", "set_user_stop"): (True,),
    ("SimulatedRobot", "set_guiding"): (True,),
    ("SimulatedRobot", "set_joint_impedance"): ([1000.0] * 7,),
    ("SimulatedRobot", "set_cartesian_impedance"): ([1000.0] * 6,),
    ("SimulatedRobot", "set_collision_behavior"): ([10.0] * 7, [10.0] * 7, [10.0] * 6, [10.0] * 6),
    ("SimulatedRobot", "set_EE"): (np.eye(4),),
    ("SimulatedRobot", "set_K"): (np.eye(4),),
    ("SimulatedRobot", "set_load"): (0.1, [0, 0, 0], np.zeros(9)),
    ("Gripper", "move"): (0.05,),
    ("Gripper", "grasp"): (0.05, 0.1, 10.0),
}


def calls_of(thing, snapshot):
    """Every public function and attribute of an object, as calls by name."""
    kind = type(thing)
    for name, member in inspect.getmembers(kind):
        if name.startswith("_") or name in ALWAYS[kind]:
            continue
        if isinstance(member, property):
            yield f"{kind.__name__}.{name}", lambda name=name: getattr(thing, name)
        elif inspect.isfunction(member):
            arguments = ARGUMENTS.get((kind.__name__, name), ())
            arguments = (snapshot,) if name == "restore" else arguments
            keywords = {"torque": [0.0] * 7} if name == "command" else {}
            yield (
                f"{kind.__name__}.{name}",
                lambda name=name, a=arguments, k=keywords: getattr(thing, name)(*a, **k),
            )


@pytest.fixture
def sim(name):
    with Simulation("stone.xml", [KINDS[name](base=BASE)]) as simulation:
        yield simulation


def all_calls(sim, name):
    gripper, snapshot = sim[name].gripper, sim.snapshot()
    return [call for thing in (sim, sim[name], gripper) for call in calls_of(thing, snapshot)]


# Made once, then only shown.
CACHED = {"SimulatedRobot.gripper"}
# Views, which another thread's step changes.
VIEWS = {"SimulatedRobot.live_state", "SimulatedRobot.model"}


def test_a_closed_simulation_raises_at_each_call(sim, name):
    calls = all_calls(sim, name)
    called = {called for called, _ in calls}
    assert {f"SimulatedRobot.{each}" for each in ("state_hash", "state", "model", "moving")} <= called
    sim.close()
    for called, call in calls:
        if called not in CACHED:
            with pytest.raises(RuntimeError, match="The simulation is closed"):
                call()
                pytest.fail(called)


def test_while_another_thread_steps_each_call_is_refused(sim, name):
    calls = [(called, call) for called, call in all_calls(sim, name) if called not in CACHED | VIEWS]
    check_refused_while_another_thread_steps(sim, calls)
