# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs every example controller twice on a FrankaHWSim and records the robot's states.

Run by test_controller_formulas.py with the interpreter that ROS uses. Arguments: the arm, a file for the
recording (numpy), simulated seconds of a first and of a second run. The simulation is stepped, so the results
do not depend on the speed of this program. A JSON report is the last line of the output.
"""

import json
import sys
import threading
import time

import numpy as np
import rospy
import rospy_connections
from controller_manager_msgs.srv import ListControllers, LoadController, SwitchController
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from franka_msgs.msg import Errors, FrankaState
from franka_msgs.srv import SetJointConfiguration
from franka_sim_mujoco.srv import GetContacts, PushBody, SpawnObject, Step
from geometry_msgs.msg import Point, Pose, PoseStamped, Vector3
from rosgraph_msgs.msg import Log
from std_srvs.srv import Empty

MOTIONS = [
    "joint_position",
    "joint_velocity",
    "cartesian_pose",
    "cartesian_velocity",
    "elbow",
    "joint_impedance",
]
OTHERS = ["model", "cartesian_impedance", "force"]
START = [0, -np.pi / 4, 0, -3 * np.pi / 4, 0, np.pi / 2, np.pi / 4]
FIELDS = ["q", "q_d", "dq", "dq_d", "tau_J_d", "O_T_EE", "O_T_EE_d", "elbow_d", "time", "robot_mode"]
LOAD = ["m_total", "F_x_Ctotal", "I_total"]
IDLE, STRICT = FrankaState.ROBOT_MODE_IDLE, 2
WAIT = 60.0  # [s] of the wall
REST = 1e-5  # [rad/s]
SHIFT, PUSH = [0.05, -0.04, -0.06], [0.0, 4.0, 0.0]  # [m], [N]
PUSH_LASTS = 30.0  # [s]: the null space comes to rest slowly
# Distances from the end effector to the fingertips, and from them to the block at first [m].
TIP, GAP = 0.0584 + 0.04525 + 0.0185 / 2 - 0.1034, 1e-4
PRESSES = [  # parameters of the force controller in its first and its second run
    {"desired_mass": 1.0, "k_p": 0.0, "k_i": 0.0},
    {"desired_mass": 1.5, "k_p": 0.5, "k_i": 0.5},
]
FORCE_SETTINGS = "/dynamic_reconfigure_desired_mass_param_node/set_parameters"


def full(name):
    return name + "_example_controller"


def call(service, kind, *arguments, **fields):
    rospy.wait_for_service(service, WAIT)
    answer = rospy.ServiceProxy(service, kind)(*arguments, **fields)
    assert getattr(answer, "success", True), f"{service}: {answer}"
    return answer


def pose_of(state):
    return np.array(state.O_T_EE).reshape(4, 4).T


def at_rest(state):
    return max(map(abs, state.dq)) < REST


class Arm:
    """A simulated arm whose time advances only by steps."""

    def __init__(self, arm_id):
        self.arm_id, self.states = arm_id, []
        topic = "/franka_state_controller/franka_states"
        rospy.Subscriber(topic, FrankaState, self.states.append, queue_size=10000, buff_size=1 << 24)
        self.wait(lambda: self.states, "A first state")
        call("/gazebo/pause_physics", Empty)
        self.step(0.1)

    @staticmethod
    def wait(condition, what, limit=WAIT):
        """Waits for a condition that needs no simulated time."""
        end = time.monotonic() + limit
        while not condition():
            assert time.monotonic() < end, f"{what} did not come within {limit} s."
            time.sleep(0.001)

    def step(self, seconds):
        """Advances the time; returns the new states."""
        begin = len(self.states)
        now = call("/gazebo/step", Step, round(1000 * seconds)).time
        # A state is published every 34 ms, unless the last one is still being sent.
        recent = rospy.Duration(0.08)
        for _ in range(100):
            end = time.monotonic() + 0.5
            while time.monotonic() < end:
                if self.states[-1].header.stamp > now - recent:
                    return self.states[begin:]
                time.sleep(0.001)
            now = call("/gazebo/step", Step, 20).time
        raise AssertionError("No states come any more.")

    def until(self, condition, what, limit=60.0):
        """Advances the time until a state meets a condition, at most by a limit of simulated seconds."""
        seen = self.step(0.1)
        for _ in range(round(limit / 0.1)):
            if condition(seen[-1]):
                return seen
            seen += self.step(0.1)
        raise AssertionError(f"{what} did not come within {limit} s: {self.states[-1]}")

    def during(self, service, kind, **fields):
        """A call that is answered only if time advances."""
        answers = []
        thread = threading.Thread(target=lambda: answers.append(call(service, kind, **fields)))
        thread.start()
        while thread.is_alive():
            self.step(0.02)
        assert answers, f"{service} failed."
        return answers[0]

    def place(self):
        names = [f"{self.arm_id}_joint{i}" for i in range(1, 8)]
        service = "/set_franka_model_configuration"
        self.during(service, SetJointConfiguration, joint_names=names, joint_positions=START)
        return self.until(lambda state: state.robot_mode == IDLE and at_rest(state), "Rest at the start")[-1]

    def switch(self, start=(), stop=()):
        names = {"start_controllers": list(map(full, start)), "stop_controllers": list(map(full, stop))}
        manager = "/controller_manager/switch_controller"
        return self.during(manager, SwitchController, **names, strictness=STRICT).ok

    def run(self, name, act):
        """The states from the last one before a controller's start to its stop, and what `act` returns."""
        begin = len(self.states) - 1
        assert self.switch(start=[name]), name
        result = act()
        end = len(self.states)
        assert self.switch(stop=[name]), name
        self.until(lambda state: state.robot_mode == IDLE, f"The end of {name}")
        return self.states[begin:end], result


class Recording(dict):
    """Arrays under controller/run/field."""

    def add(self, name, number, states):
        for field in [*FIELDS, *LOAD]:
            values = states[-1:] if field in LOAD else states
            self[f"{name}/{number}/{field}"] = np.array([getattr(state, field) for state in values])
        flawless = all(state.current_errors == Errors() for state in states)
        self[f"{name}/{number}/flawless"] = np.array(flawless)


def refused_beside(arm, running):
    """Results of starting each other controller beside a running one, and the state of that one."""
    started = {}
    for name in MOTIONS + OTHERS:
        if name != running:
            started[name] = arm.switch(start=[name])
            if started[name]:
                assert arm.switch(stop=[name]), name
    listed = call("/controller_manager/list_controllers", ListControllers).controller
    return {
        "started": started,
        "states": {controller.name: controller.state for controller in listed},
        "still_moving": arm.step(0.1)[-1].robot_mode == FrankaState.ROBOT_MODE_MOVE,
    }


def lead(arm):
    """Moves the hand of a running impedance controller, then pushes it.

    Returns where it comes to rest, and the states from the push's begin to after its end.
    """
    begin = arm.step(0.5)[-1]
    desired = pose_of(begin)
    desired[:3, 3] += SHIFT
    topic = f"/{full('cartesian_impedance')}/equilibrium_pose"
    hand = rospy.Publisher(topic, PoseStamped, queue_size=1)
    arm.wait(hand.get_num_connections, "The controller's interest in an equilibrium")
    x, y, z = desired[:3, 3]
    message = PoseStamped()
    message.header.frame_id = arm.arm_id + "_link0"
    message.pose.position = Point(x, y, z)
    message.pose.orientation.x = 1.0  # it points down: half a turn about x
    hand.publish(message)
    near = lambda state: np.linalg.norm(pose_of(state)[:3, 3] - [x, y, z]) < 0.01  # noqa: E731
    arm.until(near, "The motion to the equilibrium")
    reached = arm.until(at_rest, "Rest at the equilibrium")[-1]
    count = len(arm.states)
    point = Point(*pose_of(reached)[:3, 3])
    push = {"body": arm.arm_id + "_hand", "force": Vector3(*PUSH), "at_point": True, "point": point}
    call("/gazebo/push_body", PushBody, **push, ticks=round(1000 * PUSH_LASTS))
    pushed = arm.step(PUSH_LASTS - 0.1)[-1]
    arm.step(1.0)
    hand.unregister()
    poses = {"desired": desired, "reached": pose_of(reached), "pushed": pose_of(pushed)}
    found = {name: pose.tolist() for name, pose in poses.items()}
    return {**found, "q_nullspace": begin.q}, arm.states[count:]


def press(arm, settings):
    """Sets the desired mass of a running force controller; returns forces on the block [N]."""
    doubles = [DoubleParameter(name, value) for name, value in settings.items()]
    call(FORCE_SETTINGS, Reconfigure, Config(doubles=doubles))
    arm.step(10.0)  # its targets approach with a time constant of 1 s
    return [force_on_block(arm) for _ in range(20)]


def force_on_block(arm):
    arm.step(0.1)
    contacts = call("/gazebo/get_contacts", GetContacts, body1="block", body2="")
    down = [
        force.z if first == "block" else -force.z for first, force in zip(contacts.body1s, contacts.forces)
    ]
    return sum(down)


def put_block(arm):
    """Puts it under the fingers: they must touch something when the force controller starts."""
    side = 0.1
    x, y, z = pose_of(arm.states[-1])[:3, 3]
    xml = (
        f'<body name="block"><geom type="box" size="{side} {side} {side}" friction="1 0.005 0.0001"/></body>'
    )
    pose = Pose(position=Point(x, y, z - TIP - GAP - side))
    pose.orientation.w = 1.0
    call("/gazebo/spawn_object", SpawnObject, "block", xml, pose)


def read_model(arm, lines):
    """The next output of the model example, and the state it belongs to."""
    begin = len(lines)
    state = arm.step(1.5)[-1]
    arm.wait(lambda: any("joint_zero_jacobian" in line for line in lines[begin:]), "The model's print")
    printed = {}
    for line in lines[begin:]:
        name, _, numbers = line.partition(":")
        if numbers.strip().startswith("["):
            printed[name.strip()] = json.loads(numbers)
    return {"printed": printed, "q": state.q, "O_T_EE": state.O_T_EE, "tau_J": state.tau_J}


def main():
    arm_id, output, *lengths = sys.argv[1:]
    rospy_connections.init_node("controller_formulas_client", anonymous=True, disable_rostime=True)
    lines = []
    rospy.Subscriber("/rosout", Log, lambda log: lines.append(log.msg), queue_size=1000)
    arm, recording, report = Arm(arm_id), Recording(), {}

    arm.place()
    for name in MOTIONS + OTHERS:
        assert call("/controller_manager/load_controller", LoadController, full(name)).ok, name
    for name in MOTIONS:
        for number, seconds in enumerate(lengths):
            arm.place()
            states, _ = arm.run(name, lambda seconds=seconds: arm.step(float(seconds)))
            recording.add(name, number, states)
    arm.place()
    _, report["refused"] = arm.run("joint_velocity", lambda: refused_beside(arm, "joint_velocity"))
    arm.place()
    report["model"] = [arm.run("model", lambda: read_model(arm, lines))[1] for _ in range(2)]
    arm.place()
    _, (report["led"], pushed) = arm.run("cartesian_impedance", lambda: lead(arm))
    recording.add("cartesian_impedance", 0, pushed)
    recording.add(
        "cartesian_impedance", 1, arm.run("cartesian_impedance", lambda: arm.step(float(lengths[1])))[0]
    )
    arm.place()
    put_block(arm)
    report["pressed"] = []
    for number, settings in enumerate(PRESSES):
        arm.place()
        states, forces = arm.run("force", lambda settings=settings: press(arm, settings))
        recording.add("force", number, states)
        report["pressed"].append({"forces": forces, **settings})
    np.savez(output, **recording)
    print(json.dumps(report))


if __name__ == "__main__":
    main()
