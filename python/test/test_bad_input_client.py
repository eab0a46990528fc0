# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Bad input of the functions of pyfranka's client, FrankaSim and plots: a sentence, and nothing half done."""

import copy
import math
import os
import pickle
import subprocess
import sys
import threading
from datetime import timedelta

import numpy as np
import pyfranka
import pyfranka.plot
import pyfranka.sim
import pytest
import sentences
from pyfranka import Frame, RobotState, Torques
from pyfranka.franka_sim import FrankaSim
from pyfranka.plot import Abort, Collector, Recording, abort_figure, of_log, plot, plot_abort, read_log
from pyfranka.sim import KINDS, Panda
from sentences import ERRORS, faults_of, unlike_ours

NAN = math.nan
ROBOTS_TAKE_TURNS = True
STATE = RobotState()
SEVEN, SIX = [0.0] * 7, [0.0] * 6


def never_called(*arguments):
    raise AssertionError("The motion has begun.")


# "function" -> a part of the sentence -> the call; x is an object of the class.
ROBOT = {
    "__init__": {
        "address must be a text, not 5": lambda x: pyfranka.Robot(5),
        "realtime_config must be a RealtimeConfig, not 'ignore'": lambda x: pyfranka.Robot("a", "ignore"),
        "log_size must be a whole number, not 'big'": lambda x: pyfranka.Robot("a", log_size="big"),
        "log_size must be 0 or more, not -1": lambda x: pyfranka.Robot("a", log_size=-1),
        "missing a required argument: 'address'": lambda x: pyfranka.Robot(),
        "unexpected keyword argument 'port'": lambda x: pyfranka.Robot("a", port=5),
    },
    "read_once": {"Robot.read_once(): too many positional arguments": lambda x: x.read_once(5)},
    "read": {"callback must be a function, not 5": lambda x: x.read(5)},
    "set_filters": {
        "joint_position_filter_frequency must be a number, not 'a'": lambda x: x.set_filters("a", 1, 1, 1, 1),
        "controller_filter_frequency must be a number, not None": lambda x: x.set_filters(1, 1, 1, 1, None),
        "missing a required argument: 'controller_filter_frequency'": lambda x: x.set_filters(1, 1, 1, 1),
    },
    "get_virtual_wall": {
        "id must be a whole number, not 'a'": lambda x: x.get_virtual_wall("a"),
        "id must be a whole number, not 1.5": lambda x: x.get_virtual_wall(1.5),
    },
    "get_upper_joint_velocity_limits": {
        "q needs 7 numbers": lambda x: x.get_upper_joint_velocity_limits([1, 2])
    },
    "get_lower_joint_velocity_limits": {
        "q needs 7 numbers": lambda x: x.get_lower_joint_velocity_limits("a")
    },
    "set_collision_behavior": {
        "lower_torque needs 7": lambda x: x.set_collision_behavior([1], SEVEN, SIX, SIX),
        "upper_force needs 6": lambda x: x.set_collision_behavior(SEVEN, SEVEN, SIX, SEVEN),
        "missing a required argument: 'upper_torque'; it takes (lower_torque": lambda x: (
            x.set_collision_behavior(SEVEN)
        ),
    },
    "set_joint_impedance": {"K_theta needs 7": lambda x: x.set_joint_impedance([1.0])},
    "set_cartesian_impedance": {"K_x needs 6": lambda x: x.set_cartesian_impedance([1.0] * 7)},
    "set_guiding_mode": {
        "guiding_mode needs 6": lambda x: x.set_guiding_mode([True], False),
        "guiding_mode must be True or False, not 'x'": lambda x: x.set_guiding_mode(["x"] * 6, False),
        "elbow must be True or False, not 3": lambda x: x.set_guiding_mode([True] * 6, 3),
    },
    "set_K": {"EE_T_K needs 16": lambda x: x.set_K([1.0])},
    "set_EE": {"NE_T_EE needs 16": lambda x: x.set_EE(np.eye(3))},
    "set_load": {
        "mass must be a number, not 'heavy'": lambda x: x.set_load("heavy", [0, 0, 0], np.zeros(9)),
        "F_x_Cload needs 3": lambda x: x.set_load(1.0, [0, 0], np.zeros(9)),
    },
    "set_control_options": {
        "callback_order must be a CallbackOrder (CallbackOrder.MotionFirst or": lambda x: (
            x.set_control_options("first")
        ),
    },
    "control_torques": {
        "callback must be a function, not 5": lambda x: x.control_torques(5),
        "limit_rate must be True or False, not 'yes'": lambda x: x.control_torques(never_called, "yes"),
        "cutoff_frequency must be a number, not 'low'": lambda x: x.control_torques(
            never_called, True, "low"
        ),
        "The callback returned <class 'list'>": lambda x: x.control_torques(lambda state, period: SEVEN),
    },
    "control_joint_positions": {
        "callback must be a function, not None": lambda x: x.control_joint_positions(None),
        "torque_callback must be a function or None, not 5": lambda x: x.control_joint_positions(
            never_called, 5
        ),
        "controller_mode must be a ControllerMode (ControllerMode.JointImpedance or "
        "ControllerMode.CartesianImpedance), not 'soft'": lambda x: x.control_joint_positions(
            never_called, controller_mode="soft"
        ),
    },
    "control_torque_joint_position": {
        "motion_generator_callback must be a function": lambda x: x.control_torque_joint_position(
            never_called, 5
        )
    },
    "start_joint_position_control": {
        "controller_mode must be a ControllerMode": lambda x: x.start_joint_position_control("soft")
    },
    "start_torque_control": {"it takes no arguments": lambda x: x.start_torque_control(5)},
    "start_async_joint_position_control": {
        "maximum_velocities must be a list, each a number, not 'fast'": lambda x: (
            x.start_async_joint_position_control("fast")
        )
    },
}
# What the robot itself refuses: its own sentences.
REFUSED_BY_ROBOT = {
    "set_joint_impedance": {"": lambda x: x.set_joint_impedance([NAN] * 7)},
    "set_cartesian_impedance": {"": lambda x: x.set_cartesian_impedance([NAN] * 6)},
    "set_collision_behavior": {"": lambda x: x.set_collision_behavior([NAN] * 7, SEVEN, SIX, SIX)},
    "set_EE": {"": lambda x: x.set_EE(np.full((4, 4), NAN))},
    "set_K": {"": lambda x: x.set_K(np.full((4, 4), NAN))},
    "set_load": {"": lambda x: x.set_load(NAN, [0, 0, 0], np.zeros(9))},
}

GRIPPER = {
    "__init__": {
        "address must be a text, not None": lambda x: pyfranka.Gripper(None),
        "missing a required argument": lambda x: pyfranka.Gripper(),
    },
    "move": {
        "width must be a number, not 'wide'": lambda x: x.move("wide", 0.1),
        "Gripper.move(): missing a required argument: 'speed'": lambda x: x.move(0.05),
        "": lambda x: x.move(NAN, 0.1),
    },
    "grasp": {
        "force must be a number, not None": lambda x: x.grasp(0.03, 0.1, None),
        "epsilon_inner must be a number, not 'a'": lambda x: x.grasp(0.03, 0.1, 10, "a"),
        "": lambda x: x.grasp(0.03, NAN, 10),
    },
    "homing": {"it takes no arguments": lambda x: x.homing(5)},
}

VACUUM = {
    "__init__": {"address must be a text, not 5": lambda x: pyfranka.VacuumGripper(5)},
    "vacuum": {
        "vacuum must be a whole number, not 'a'": lambda x: x.vacuum("a", timedelta(seconds=1)),
        "timeout must be a datetime.timedelta, not 'soon'": lambda x: x.vacuum(5, "soon"),
        "profile must be a VacuumGripper.ProductionSetupProfile (VacuumGripper.ProductionSetupProfile.P0,": (
            lambda x: x.vacuum(5, timedelta(seconds=1), "P0")
        ),
        "vacuum must be within the range of its type, not 300": lambda x: x.vacuum(300, timedelta(seconds=1)),
    },
    "drop_off": {"timeout must be a datetime.timedelta, not None": lambda x: x.drop_off(None)},
}

MODEL = {
    "mass": {
        "state must be a RobotState, not 5. Model.mass() takes (state) or (q, I_total,": lambda x: x.mass(5),
        "m_total must be a number, not 'a'": lambda x: x.mass(SEVEN, np.eye(3), "a", [0, 0, 0]),
        "q needs 7": lambda x: x.mass([1, 2], np.eye(3), 1.0, [0, 0, 0]),
        "it takes (state) or (q,": lambda x: x.mass(),
    },
    "coriolis": {"state must be a RobotState, not None": lambda x: x.coriolis(None)},
    "gravity": {"gravity_earth needs 3": lambda x: x.gravity(STATE, [1.0])},
    "pose": {
        "frame must be a Frame (Frame.Joint1, ": lambda x: x.pose("flange", STATE),
        "state must be a RobotState, not [0.0,": lambda x: x.pose(Frame.Flange, SEVEN),
        "F_T_EE needs 16": lambda x: x.pose(Frame.Flange, SEVEN, [1], np.eye(4)),
    },
    "zero_jacobian": {"frame must be a Frame": lambda x: x.zero_jacobian(3, STATE)},
    "body_jacobian": {"frame must be a Frame": lambda x: x.body_jacobian(None, STATE)},
}

# Values, and functions of the module.
VALUES = {
    "Torques": {
        "Torques needs 7": lambda x: Torques([1.0]),
        "values": lambda x: Torques(),
        "motion_finished must be True or False, not 'yes'": lambda x: setattr(
            Torques(SEVEN), "motion_finished", "yes"
        ),
    },
    "CartesianPose": {
        "elbow needs 2": lambda x: pyfranka.CartesianPose(np.eye(4), [1]),
        "CartesianPose needs 16": lambda x: pyfranka.CartesianPose(np.eye(3)),
    },
    "RobotState": {
        "q needs 7": lambda x: setattr(RobotState(), "q", [1]),
        "m_ee must be a number, not 'heavy'": lambda x: setattr(RobotState(), "m_ee", "heavy"),
        "robot_mode must be a RobotMode (RobotMode.Other, ": lambda x: setattr(RobotState(), "robot_mode", 1),
        "state must be a RobotState, not 5": lambda x: RobotState(5),
    },
    "RobotMode": {"value must be a whole number, not 'Idle'": lambda x: pyfranka.RobotMode("Idle")},
    "ArmLimits": {"version must be 3 to": lambda x: pyfranka.ArmLimits(2)},
    "Duration": {"A Duration is made of whole milliseconds": lambda x: pyfranka.Duration("long")},
    "limit_rate": {
        "commanded_values needs 7": lambda x: pyfranka.limit_rate(SEVEN, [1], SEVEN),
        "": lambda x: pyfranka.limit_rate(SEVEN, [NAN] * 7, SEVEN),
    },
    "motion_finished": {"command must be a command such as Torques": lambda x: pyfranka.motion_finished(5)},
    "is_valid_elbow": {"elbow needs 2": lambda x: pyfranka.is_valid_elbow("a")},
    "log_to_csv": {"log must be a list, each a Record, not 5": lambda x: pyfranka.log_to_csv(5)},
    "configure": {
        "robot must be a Robot, not 5": lambda x: pyfranka.AsyncPositionControlHandler.configure(5, 6)
    },
    "method": {"self must be a Robot, not 5": lambda x: pyfranka.Robot.stop(5)},
}

FRANKA_SIM = {
    "__init__": {
        "There is no robot 'ur5'; there are: panda, fr3": lambda x: FrankaSim("ur5"),
        "robots are Panda(...), FR3(...) and their kinds, not 5": lambda x: FrankaSim(5),
        "world must be the name of a file, not 5": lambda x: FrankaSim("panda", world=5),
        "There is no program '/nowhere'": lambda x: FrankaSim("panda", program="/nowhere"),
        "not fast": lambda x: FrankaSim("panda", pace="fast"),
        "'moon.xml'": lambda x: FrankaSim("panda", world="moon.xml"),
        "not long": lambda x: FrankaSim("panda", patience="long"),
    },
    "__getitem__": {"There is no robot 'ur5'": lambda x: x["ur5"]},
    "log": {
        "since must be a whole number, not 'start'": lambda x: x.log("start"),
        "since must be 0 to": lambda x: x.log(-1),
    },
}


def recording():
    collector = Collector("robot", 5)
    collector.add(RobotState())
    return collector.recording()


PLOT = {
    "plot": {
        "recording must be what of_log() or read_log() has returned, not 5": lambda x: plot(5),
        'There is no signal "color"': lambda x: plot(x, ["color"]),
        "signals must be a list of names": lambda x: plot(x, "q"),
        "A signal is a name such as q or q+q_d, not 5": lambda x: plot(x, [5]),
        "limits is one of auto, all, none, not 'some'": lambda x: plot(x, limits="some"),
        "joints must be a list of numbers, not 3": lambda x: plot(x, joints=3),
        "The number of a joint must be 1 to 7, not 0": lambda x: plot(x, joints=[0]),
        "The number of a joint must be 1 to 7, not 8": lambda x: plot(x, joints=[8]),
        "There is no signal to plot": lambda x: plot(x, []),
    },
    "plot_abort": {
        "recording must be": lambda x: plot_abort(None),
        "There is no signal to plot": lambda x: plot_abort(Recording("empty", np.zeros(1), {})),
        "abort must be an Abort, as Abort.of_text() makes it, not 'reason'": lambda x: plot_abort(
            x, "reason"
        ),
    },
    "abort_figure": {
        "error must be the ControlException of a motion": lambda x: abort_figure(ValueError("It moved.")),
    },
    "of_log": {
        "The exception has no log": lambda x: of_log([]),
        "log must be a list of records, that of a ControlException, not 5": lambda x: of_log(5),
        "log must be a list of records, that of a ControlException, not of 5": lambda x: of_log([5]),
    },
    "Abort": {"text must be a text, not None": lambda x: Abort.of_text(None)},
    "Collector": {
        "state must be a RobotState, not 5": lambda x: Collector("a").add(5),
        "a has no state": lambda x: Collector("a").recording(),
    },
    "read_log": {
        "file must be the name of a file, not 5": lambda x: read_log(5),
        "/nowhere.csv": lambda x: read_log("/nowhere.csv"),
    },
}


def condition(robot):
    """What setters and motions would change."""
    state = robot.read_once()
    return (
        state.robot_mode,
        state.q_d.tolist(),
        state.NE_T_EE.tolist(),
        state.EE_T_K.tolist(),
        state.m_load,
        state.F_x_Cload.tolist(),
    )


@pytest.mark.parametrize("cases", [ROBOT, REFUSED_BY_ROBOT], ids=["types", "values"])
def test_bad_input_of_a_robot_is_refused_with_a_sentence_and_changes_nothing(cases, robot):
    before = condition(robot)
    wrong = faults_of(cases, robot, "Robot")
    assert not wrong, "\n".join(wrong)
    assert condition(robot) == before


def test_bad_input_of_a_hand_is_refused_with_a_sentence_and_moves_nothing(served, name):
    hand = served[name].gripper()
    before = hand.read_once().width
    wrong = faults_of(GRIPPER, hand, "Gripper")
    assert not wrong, "\n".join(wrong)
    assert hand.read_once().width == before


def test_bad_input_of_a_vacuum_gripper_is_refused_with_a_sentence():
    with FrankaSim(Panda(hand="vacuum")) as server:
        gripper = pyfranka.VacuumGripper(server.robot.address)
        wrong = faults_of(VACUUM, gripper, "VacuumGripper")
        assert not wrong, "\n".join(wrong)
        wrong = faults_of(FRANKA_SIM, server, "FrankaSim")
        assert not wrong, "\n".join(wrong)


def test_bad_input_of_a_model_is_refused_with_a_sentence(robot):
    wrong = faults_of(MODEL, robot.load_model(), "Model")
    assert not wrong, "\n".join(wrong)


def test_bad_input_of_an_active_control_is_refused_with_a_sentence(robot):
    with robot.start_torque_control() as motion:
        motion.read_once()
        wrong = faults_of(
            {
                "write_once": {
                    "command must be a Torques or a JointPositions or a JointVelocities or": lambda x: (
                        x.write_once(SEVEN)
                    ),
                    "torques must be a Torques or None, not 5": lambda x: x.write_once(
                        pyfranka.JointPositions(SEVEN), 5
                    ),
                }
            },
            motion,
            "ActiveControl",
        )
        motion.write_once(Torques(SEVEN))
    assert not wrong, "\n".join(wrong)
    closed = {
        "read_once": {"This motion has been closed": lambda x: x.read_once()},
        "write_once": {"This motion has been closed": lambda x: x.write_once(Torques(SEVEN))},
    }
    wrong = faults_of(closed, motion, "ActiveControl")
    assert not wrong, "\n".join(wrong)


def test_bad_input_of_values_and_functions_is_refused_with_a_sentence():
    wrong = faults_of(VALUES, None, "pyfranka")
    assert not wrong, "\n".join(wrong)


def test_bad_input_of_plots_is_refused_with_a_sentence():
    wrong = faults_of(PLOT, recording(), "pyfranka.plot")
    assert not wrong, "\n".join(wrong)


# ---- in use by another thread, closed, after a fork --------------------------------------------------------

IN_USE = {
    "read_once": lambda robot: robot.read_once(),
    "read": lambda robot: robot.read(lambda state: False),
    "control_torques": lambda robot: robot.control_torques(never_called),
    "start_torque_control": lambda robot: robot.start_torque_control(),
}


def test_while_another_thread_moves_the_robot_other_operations_are_refused(robot):
    moving, ended, wrong = threading.Event(), threading.Event(), []

    def hold(state, period):
        moving.set()
        command = Torques(SEVEN)
        return pyfranka.motion_finished(command) if ended.is_set() else command

    worker = threading.Thread(target=robot.control_torques, args=(hold,))
    worker.start()
    try:
        assert moving.wait(60)
        for name, call in IN_USE.items():
            try:
                call(robot)
                wrong.append(f"{name}: not refused")
            except ERRORS as error:
                if unlike_ours(str(error)):
                    wrong.append(f"{name}: {type(error)} {error}")
    finally:
        ended.set()
        worker.join()
    assert not wrong, "\n".join(wrong)


AFTER_FORK = {
    "Robot": {
        "before the process was forked": lambda x: x["robot"].read_once(),
        "forked and belongs to the other process": lambda x: x["robot"].control_torques(never_called),
        "Connect again": lambda x: x["robot"].set_K(np.eye(4)),
    },
    "Gripper": {
        "before the process was forked": lambda x: x["hand"].read_once(),
        "Connect again": lambda x: x["hand"].move(0.02, 0.1),
    },
    "ActiveControl": {"before the process was forked": lambda x: x["motion"].write_once(Torques(SEVEN))},
    "VacuumGripper": {
        "before the process was forked": lambda x: x["vacuum"].read_once(),
        "Connect again": lambda x: x["vacuum"].vacuum(5, timedelta(seconds=1)),
        "belongs to the other process": lambda x: x["vacuum"].drop_off(timedelta(seconds=1)),
        "Connect again in this one": lambda x: x["vacuum"].stop(),
    },
}
IN_FORKED_PROCESS = """
import os, sys
sys.path[:0] = {path!r}
import pyfranka
from test_bad_input_client import AFTER_FORK, SEVEN, Torques, faults_of

robot = pyfranka.Robot({address!r}, pyfranka.RealtimeConfig.Ignore)
hand, vacuum = pyfranka.Gripper({address!r}), pyfranka.VacuumGripper({vacuum!r})
motion = robot.start_torque_control()
motion.read_once()
child = os.fork()
if child == 0:
    wrong = faults_of(AFTER_FORK, dict(robot=robot, hand=hand, motion=motion, vacuum=vacuum))
    print("\\n".join(wrong), flush=True)
    motion.close()
    del robot, hand, motion, vacuum  # as at the end of the interpreter
    os._exit(bool(wrong))
ended = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
motion.write_once(Torques(SEVEN))
motion.read_once()
motion.close()
assert hand.read_once().width >= 0.0
assert not vacuum.read_once().part_present
vacuum.stop()
robot.read_once()
sys.exit(ended)
"""


def test_a_forked_process_can_neither_use_nor_end_the_connections_of_the_other(name):
    path = [os.path.dirname(__file__), os.path.dirname(sentences.__file__)]
    with FrankaSim(KINDS[name](), Panda(name="vacuum", hand="vacuum", base=(0, 2, 0))) as server:
        addresses = {"address": server[name].address, "vacuum": server["vacuum"].address}
        code = IN_FORKED_PROCESS.format(path=path, **addresses)
        done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_snapshot_cannot_be_pickled_and_says_what_to_do():
    with pyfranka.sim.Simulation() as sim, pytest.raises(TypeError, match="restore it in the process"):
        pickle.dumps(sim.snapshot())


@pytest.mark.parametrize("copies", [pickle.dumps, copy.copy, copy.deepcopy])
def test_a_simulation_cannot_be_pickled_or_copied_and_says_what_to_do(copies):
    with pyfranka.sim.Simulation() as sim, pytest.raises(TypeError, match="make one with the same world"):
        copies(sim)
