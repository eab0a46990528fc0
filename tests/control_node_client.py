# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Uses every service and every topic of franka_control_node; prints a report as JSON.

Run by test_control_node.py with the interpreter that ROS uses, against a robot in lock-step. Arguments: the
arm, the address of the simulated robot.
"""

import csv
import json
import sys
import time
from statistics import median

import numpy as np
import rigid_arm
import rospy
import rospy_connections
import tf2_ros
from controller_manager_msgs.srv import SwitchController
from diagnosis import Diagnosis
from franka_msgs.msg import FrankaState
from geometry_msgs.msg import WrenchStamped
from pyfranka.remote import Remote
from recovery_client import PATIENCE, Robot
from sensor_msgs.msg import JointState
from setters import SETTERS
from std_msgs.msg import String
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

ARM, ADDRESS = sys.argv[1:3]
CONTROLLER = "position_joint_trajectory_controller"
PUSH = [0.0, 0.0, -8.0]  # at the seventh link [N]
BRIEFLY = 50  # [ms]
STILL = 1e-3  # [rad/s] of an arm at rest under a push
SETTLED, SLOWLY_SETTLED = 0.6, 8.0  # [s] of the robot, from the first state that shows a push
WIDE = {"torque": [60.0] * 7, "force": [60.0] * 6}  # thresholds that are never reached here [Nm], [N, Nm]
SOFT_JOINTS = [600.0] * 7  # [Nm/rad]
SOFT_HAND = [800.0, 800.0, 800.0, 60.0, 60.0, 60.0]  # [N/m], [Nm/rad]


def transform(position=(0, 0, 0), about_x=0.0, about_z=0.0):
    """A translation, then a rotation about x, then one about z; 4x4."""
    cx, sx, cz, sz = np.cos(about_x), np.sin(about_x), np.cos(about_z), np.sin(about_z)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]]) @ [[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]]
    matrix[:3, 3] = position
    return matrix


def torques_of_push(q):
    """J^T F at the origin of the seventh link [Nm]."""
    links = rigid_arm.poses(q)
    return rigid_arm.jacobian(links, links[7, :3, 3])[:3].T @ PUSH


def matrix(columns):
    return np.array(columns).reshape(4, 4).T


def columns(pose):
    return pose.T.flatten().tolist()


def matrix_of(message):
    """A geometry_msgs/Transform."""
    x, y, z, w = message.rotation.x, message.rotation.y, message.rotation.z, message.rotation.w
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    pose[:3, 3] = [message.translation.x, message.translation.y, message.translation.z]
    return pose


def apart(a, b):
    """The largest difference of two arrays."""
    return float(np.abs(np.asarray(a, float) - np.asarray(b, float)).max())


def shown_pose_is_apart(state):
    """Difference between a state's O_T_EE and the pose from its joints and frames."""
    pose = rigid_arm.poses(state.q)[rigid_arm.FLANGE] @ matrix(state.F_T_NE) @ matrix(state.NE_T_EE)
    return apart(matrix(state.O_T_EE), pose)


class Services:
    def __init__(self):
        self._setters = {n: rospy.ServiceProxy(f"/franka_control/{n}", kind) for n, kind in SETTERS.items()}
        self._switch = rospy.ServiceProxy("/controller_manager/switch_controller", SwitchController)

    def set(self, name, **values):
        """[success, error, seconds]"""
        begin = time.monotonic()
        answer = self._setters[name](**values)
        return [answer.success, answer.error, time.monotonic() - begin]

    def trigger(self, name):
        begin = time.monotonic()
        answer = rospy.ServiceProxy(f"/franka_control/{name}", Trigger)()
        return [answer.success, answer.message, time.monotonic() - begin]

    def switch(self, start=(), stop=()):
        return self._switch(
            start_controllers=list(start), stop_controllers=list(stop), strictness=2, timeout=10.0
        ).ok


def fastest(call, name, **values):
    """The answer of three refused calls that took the least time: a machine may stall in one of them."""
    return min((call(name, **values) for _ in range(3)), key=lambda answer: answer[-1])


def thresholds(**changed):
    """Arguments of set_full_collision_behavior: wide, except those named as in lower_force=5."""
    arguments = {}
    for bound in ("lower", "upper"):
        for what, wide in WIDE.items():
            values = [changed[f"{bound}_{what}"]] * len(wide) if f"{bound}_{what}" in changed else wide
            for phase in ("acceleration", "nominal"):
                arguments[f"{bound}_{what}_thresholds_{phase}"] = values
    return arguments


def nominal(**changed):
    """Those of set_force_torque_collision_behavior."""
    return {name: values for name, values in thresholds(**changed).items() if name.endswith("nominal")}


def good_values():
    """Request of each setter, and the state's field that shows it (None: only the motion shows it)."""
    hand = transform((0.01, -0.02, 0.15), 0.0, 0.5)
    stiffness = transform((0.0, 0.0, 0.05), 0.3)
    inertia = np.diag([1e-3, 2e-3, 2.5e-3]).flatten().tolist()
    return {
        "set_EE_frame": ({"NE_T_EE": columns(hand)}, {"NE_T_EE": columns(hand)}),
        "set_K_frame": ({"EE_T_K": columns(stiffness)}, {"EE_T_K": columns(stiffness)}),
        "set_load": (
            {"mass": 0.4, "F_x_center_load": [0.0, 0.01, 0.06], "load_inertia": inertia},
            {"m_load": 0.4, "F_x_Cload": [0.0, 0.01, 0.06], "I_load": inertia},
        ),
    }


def bad_values():
    """Values that every robot refuses."""
    nan = float("nan")
    mirrored = np.diag([1.0, 1.0, -1.0, 1.0])
    stretched = np.diag([1.1, 1.0, 1.0, 1.0])
    no_bottom = transform()
    no_bottom[3, 0] = 0.1
    load = {"mass": 0.4, "F_x_center_load": [0.0] * 3, "load_inertia": [0.0] * 9}
    poses = {"mirrored": mirrored, "stretched": stretched, "no bottom row": no_bottom, "NaN": np.eye(4) * nan}
    frames = {"set_EE_frame": "NE_T_EE", "set_K_frame": "EE_T_K"}
    return [
        *((s, what, {f: columns(pose)}) for s, f in frames.items() for what, pose in poses.items()),
        ("set_joint_impedance", "NaN", {"joint_stiffness": [nan] + [1000.0] * 6}),
        ("set_joint_impedance", "negative", {"joint_stiffness": [-1.0] + [1000.0] * 6}),
        ("set_joint_impedance", "too stiff", {"joint_stiffness": [1e5] * 7}),
        ("set_cartesian_impedance", "NaN", {"cartesian_stiffness": [nan] + [100.0] * 5}),
        ("set_cartesian_impedance", "too soft", {"cartesian_stiffness": [9.0] * 3 + [100.0] * 3}),
        ("set_cartesian_impedance", "too stiff", {"cartesian_stiffness": [3001.0] * 3 + [100.0] * 3}),
        ("set_force_torque_collision_behavior", "NaN", nominal(lower_force=nan)),
        ("set_force_torque_collision_behavior", "negative", nominal(upper_torque=-1.0)),
        ("set_full_collision_behavior", "NaN", thresholds(upper_force=nan)),
        ("set_full_collision_behavior", "negative", thresholds(lower_torque=-1.0)),
        ("set_load", "NaN", dict(load, mass=nan)),
        ("set_load", "negative", dict(load, mass=-0.1)),
        ("set_load", "infinitely far", dict(load, F_x_center_load=[float("inf"), 0.0, 0.0])),
        ("set_load", "no inertia", dict(load, load_inertia=[-1e-3, 0, 0, 0, 1e-3, 0, 0, 0, 1e-3])),
    ]


def periods_of(messages):
    """Times between consecutive messages, given by their stamps [s]; a busy machine drops some between."""
    headers = [messages[stamp].header for stamp in sorted(messages)]
    return [(b.stamp - a.stamp).to_sec() for a, b in zip(headers, headers[1:]) if b.seq == a.seq + 1]


class Topics:
    """All messages of the state controller, by their number."""

    NAMES = {
        "franka_states": FrankaState,
        "F_ext": WrenchStamped,
        "joint_states": JointState,
        "joint_states_desired": JointState,
    }

    def __init__(self):
        self.kept = {}
        for name, kind in self.NAMES.items():
            rospy.Subscriber(f"/franka_state_controller/{name}", kind, self._keep, callback_args=name)
        rospy.Subscriber("/tf", TFMessage, self._keep_frames)
        self.forget()

    def forget(self):
        self.kept = {name: {} for name in [*self.NAMES, "tf"]}

    def _keep(self, message, name):
        self.kept[name][message.header.stamp.to_nsec()] = message

    def _keep_frames(self, message):
        if message.transforms[0].child_frame_id == f"{ARM}_NE":
            self.kept["tf"][message.transforms[0].header.stamp.to_nsec()] = message

    def compare(self, count):
        """Largest differences between topics of one cycle, over a number of cycles."""
        self.forget()
        complete, periods = [], []
        deadline = time.monotonic() + 8 * PATIENCE
        while (len(complete) < count or not periods) and time.monotonic() < deadline:
            time.sleep(0.02)
            kept = {name: dict(messages) for name, messages in self.kept.items()}
            complete = sorted(set.intersection(*(set(messages) for messages in kept.values())))
            periods = periods_of(kept["franka_states"])
        differences = dict.fromkeys(kept, 0.0)
        for stamp in complete:
            cycle = {name: messages[stamp] for name, messages in kept.items()}
            for name, difference in self._differences(cycle).items():
                differences[name] = max(differences[name], difference)
        wrench, joints, frames = (kept[name][complete[0]] for name in ("F_ext", "joint_states", "tf"))
        return {
            "cycles": len(complete),
            "differences": differences,
            "rate": 1.0 / median(periods),  # the machine delays some messages
            "wrench_frame": wrench.header.frame_id,
            "names": joints.name,
            "frames": [[t.header.frame_id, t.child_frame_id] for t in frames.transforms],
        }

    @staticmethod
    def _differences(cycle):
        state, wrench = cycle["franka_states"], cycle["F_ext"].wrench
        measured, desired = cycle["joint_states"], cycle["joint_states_desired"]
        force = [*(getattr(wrench.force, c) for c in "xyz"), *(getattr(wrench.torque, c) for c in "xyz")]
        frames = [matrix_of(t.transform) for t in cycle["tf"].transforms]
        return {
            "F_ext": apart(force, state.K_F_ext_hat_K),
            "joint_states": apart(
                measured.position + measured.velocity + measured.effort, state.q + state.dq + state.tau_J
            ),
            "joint_states_desired": apart(
                desired.position + desired.velocity + desired.effort, state.q_d + state.dq_d + state.tau_J_d
            ),
            "tf": apart(frames, [matrix(m) for m in (state.F_T_NE, state.NE_T_EE, state.EE_T_K)]),
            "franka_states": shown_pose_is_apart(state),
        }


def idle(robot, operator, services, topics, diagnosis):
    report = {"diagnosis": diagnosis.shows("Robot", "Ready")}
    report["loop"] = diagnosis.shows("Control loop", "The controllers keep time")
    before = robot.state
    report["bad"] = [
        [name, what, *fastest(services.set, name, **values)] for name, what, values in bad_values()
    ]
    report["still"] = apart(robot.state.q, before.q)
    report["good"] = {}
    for name, (values, effect) in good_values().items():
        answer = services.set(name, **values)

        def seen(effect=effect):
            return all(apart(getattr(robot.state, f), v) < 1e-6 for f, v in effect.items())

        report["good"][name] = [*answer[:2], robot.waits(seen) is not None]
    report["m_total"] = apart(robot.state.m_total, robot.state.m_ee + 0.4)
    operator.push(f"{ARM}_link7", (0, 0, 0), 10)  # the world runs: states show the settings
    robot.waits(lambda: shown_pose_is_apart(robot.state) < 1e-5)
    report["topics"] = topics.compare(20)
    report["second_source"] = apart(operator.state().q, robot.state.q)
    report["tree"] = tree(robot)
    # Resets the load to zero.
    services.set("set_load", mass=0.0, F_x_center_load=[0.0] * 3, load_inertia=[0.0] * 9)
    services.set("set_EE_frame", NE_T_EE=list(before.NE_T_EE))
    services.set("set_K_frame", EE_T_K=list(before.EE_T_K))
    robot.waits(lambda: robot.state.m_load == 0.0 and apart(robot.state.EE_T_K, before.EE_T_K) < 1e-6)
    return report


def tree(robot):
    """Difference between the chain of /tf from base to end effector and the robot's O_T_EE."""
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)
    difference = 1.0
    deadline = time.monotonic() + PATIENCE
    while difference > 1e-6 and time.monotonic() < deadline:
        time.sleep(0.05)
        if buffer.can_transform(f"{ARM}_link0", f"{ARM}_EE", rospy.Time()):
            found = buffer.lookup_transform(f"{ARM}_link0", f"{ARM}_EE", rospy.Time())
            difference = apart(matrix_of(found.transform), matrix(robot.state.O_T_EE))
    listener.unregister()
    return difference


def stopped(robot, services):
    """Stops the controller. The states that show it have arrived, so that the next Move is another one."""
    answer = services.switch(stop=[CONTROLLER])
    robot.waits(lambda: robot.state.robot_mode != FrankaState.ROBOT_MODE_MOVE)
    robot.waits(lambda: abs(robot.state.O_F_ext_hat_K[2]) < 0.1 * abs(PUSH[2]))  # no push is left
    return answer


def pushed(robot, operator, topics, settling=SETTLED):
    """Pushes the arm until it rests under the push; returns its state before, and one at rest.

    Topics drop messages on a busy machine: if too many are missing, the arm is pushed again, for twice as
    long each time.
    """
    robot.waits(lambda: robot.state.robot_mode == FrankaState.ROBOT_MODE_MOVE)
    before = robot.state
    for seconds in (10, 20, 40, 80, 160):
        topics.forget()
        operator.push(f"{ARM}_link7", PUSH, 1000 * seconds)
        felt = states_of_push(topics, seconds)
        # A state of an earlier moment may arrive late, so the last one must show an arm at rest.
        if felt and felt[-1].time - felt[0].time > settling and max(map(abs, felt[-1].dq)) < STILL:
            return before, felt[-1]
    raise RuntimeError(f"{len(felt)} states were published under a push of {seconds} s.")


def states_of_push(topics, seconds):
    """States during a push of that duration, collected until published states are past its end."""
    deadline = time.monotonic() + 8 * PATIENCE  # the robot waits for each answer
    states, felt = [], []
    while not states or states[-1].time < (felt[-1].time + 0.3 if felt else states[0].time + 2 * seconds):
        if time.monotonic() > deadline:
            raise RuntimeError("The robot's time hardly passes: the push is not over.")
        time.sleep(0.01)
        states = [s for _, s in sorted(topics.kept["franka_states"].copy().items())]
        felt = [s for s in states if abs(s.O_F_ext_hat_K[2]) > 0.8 * abs(PUSH[2])]
    return felt


def soft_joints(robot, operator, services, topics, diagnosis):
    """Joint impedance, contacts by force; and answers of a moving robot."""
    report = {
        "set": [
            services.set("set_joint_impedance", joint_stiffness=SOFT_JOINTS)[0],
            services.set("set_force_torque_collision_behavior", **nominal(lower_force=5.0))[0],
        ]
    }
    report["started"] = services.switch([CONTROLLER])
    # For the next switch: the node processes this in the background.
    rospy.set_param("/franka_control/internal_controller", "cartesian_impedance")
    before, last = pushed(robot, operator, topics)
    expected = torques_of_push(np.array(last.q))
    spring = np.array(SOFT_JOINTS) * (np.array(last.q) - np.array(last.q_d))
    report["spring"] = apart(spring, expected) / np.abs(expected).max()
    report["external"] = apart(last.tau_ext_hat_filtered, -expected) / np.abs(expected).max()
    report["contacts"] = [any(last.cartesian_contact), any(last.joint_contact), last.robot_mode]
    report["contact_before"] = any(before.cartesian_contact)
    report["diagnosis"] = diagnosis.shows("Robot", "Ready", Mode="Move")
    report["response"] = diagnosis.status_when(
        "Robot", lambda _, v: int(v["Commands since the last report"]) > 0
    )
    report["topics"] = topics.compare(20)
    refused = {"set_joint_impedance": {"joint_stiffness": [3000.0] * 7}}
    refused["set_cartesian_impedance"] = {"cartesian_stiffness": SOFT_HAND}
    refused["set_force_torque_collision_behavior"] = nominal()
    refused["set_full_collision_behavior"] = thresholds()
    refused.update({name: values for name, (values, _) in good_values().items()})
    report["refused"] = {name: fastest(services.set, name, **values) for name, values in refused.items()}
    report["refused"].update({name: fastest(services.trigger, name) for name in ("connect", "disconnect")})
    report["goes_on"] = robot.state.robot_mode
    report["stopped"] = stopped(robot, services)
    return report


def soft_hand(robot, operator, services, topics):
    """Cartesian impedance, chosen by a parameter that is read at the switch; contacts by torque."""
    report = {
        "set": [
            services.set("set_cartesian_impedance", cartesian_stiffness=SOFT_HAND)[0],
            services.set("set_full_collision_behavior", **thresholds(lower_torque=2.0))[0],
        ]
    }
    report["started"] = services.switch([CONTROLLER])
    before, last = pushed(robot, operator, topics, SLOWLY_SETTLED)  # the null space comes to rest slowly
    moved = np.array(last.O_T_EE[12:15]) - np.array(before.O_T_EE_d[12:15])
    report["gives"] = (moved / (PUSH[2] / SOFT_HAND[2])).tolist()
    report["contacts"] = [any(last.cartesian_contact), any(last.joint_contact)]
    report["stopped"] = stopped(robot, services)
    return report


def reflex(robot, operator, services, diagnosis):
    """A push above a threshold, and the node's reports about it."""
    services.set("set_full_collision_behavior", **thresholds(upper_force=4.0))
    report = {"started": services.switch([CONTROLLER])}
    robot.waits(lambda: robot.state.robot_mode == FrankaState.ROBOT_MODE_MOVE)
    operator.push(f"{ARM}_link7", PUSH, BRIEFLY)
    report["reflex"] = robot.shows(FrankaState.ROBOT_MODE_REFLEX)
    report["flagged"] = robot.waits(lambda: robot.state.current_errors.cartesian_reflex) is not None
    report["has_error"] = robot.waits(lambda: robot.has_error) is not None
    # A diagnostics message at the time of the reflex may still hold the last state of the motion.
    report["diagnosis"] = diagnosis.shows("Robot", "In error; call the action error_recovery", Mode="Reflex")
    # Latched: late subscribers get it too.
    report["abort"] = rospy.wait_for_message("/franka_control/abort", String, PATIENCE).data
    report["log"] = log_of(report["abort"], robot.state)
    report["recovered"] = robot.recover()
    report["error_gone"] = robot.waits(lambda: not robot.has_error) is not None
    stopped(robot, services)
    services.set("set_full_collision_behavior", **thresholds())
    return report


def log_of(text, state):
    """Content of the file that the text names."""
    words, path = text.splitlines()[-1].split(": ", 1)
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    times = [int(row["time"]) for row in rows]
    last = [float(rows[-1][f"state.q[{i}]"]) for i in range(7)]
    # The last rows may show the braking, the first ones no command yet.
    echo = min(
        apart(*([float(row[f"{source}.q_d[{i}]"]) for i in range(7)] for source in ("cmd", "state")))
        for row in rows[-5:]
    )
    return {
        "announced": int(words.split()[2]),
        "rows": len(rows),
        "rising": all(b > a for a, b in zip(times, times[1:])),
        "before_the_state": 0 <= 1000 * state.time - times[-1],
        "apart": apart(last, state.q),
        "echo": echo,
        "columns": len(rows[0]),
    }


def offered():
    """Names of the node's own services and of its action's goal topic."""
    _, _, (publishers, subscribers, services) = rospy.get_master().getSystemState()
    names = [name for name, _ in services + subscribers if name.startswith("/franka_control/")]
    return {*SETTERS, "error_recovery/goal"} & {name.split("/", 2)[2] for name in names}


def connection(robot, services, diagnosis):
    report = {"offered": len(offered())}
    report["disconnect"] = services.trigger("disconnect")
    report["withdrawn"] = sorted(offered())
    report["diagnosis"] = diagnosis.shows("Robot", "Not connected to the robot")
    report["disconnect_again"] = services.trigger("disconnect")
    report["connect"] = services.trigger("connect")
    report["offered_again"] = len(offered())
    report["diagnosis_again"] = diagnosis.shows("Robot", "Ready")
    report["set"] = services.set("set_joint_impedance", joint_stiffness=[3000.0] * 7)[0]
    return report


def main():
    rospy_connections.init_node("control_node_client", anonymous=True)
    topics, diagnosis, services = Topics(), Diagnosis("franka_control"), Services()
    robot, operator = Robot(), Remote(ADDRESS)
    robot.waits(lambda: True)
    report = {"idle": idle(robot, operator, services, topics, diagnosis)}
    report["soft_joints"] = soft_joints(robot, operator, services, topics, diagnosis)
    report["soft_hand"] = soft_hand(robot, operator, services, topics)
    report["reflex"] = reflex(robot, operator, services, diagnosis)
    report["connection"] = connection(robot, services, diagnosis)
    print(json.dumps(report))


if __name__ == "__main__":
    main()
