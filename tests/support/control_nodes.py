# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_control_node with one arm, franka_combined_control_node with several: launched, observed, used."""

import math
from collections.abc import Sequence
from pathlib import Path

import rospy
import yaml
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticArray
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState
from geometry_msgs.msg import Point, PoseStamped
from pyfranka.remote import Remote
from ros_client import Action, Controllers, follow, trigger
from ros_nodes import CONTROL_CONFIG
from std_msgs.msg import Bool, String
from waiting import wait_for

OK, WARN, ERROR = 0, 1, 2  # levels of diagnostics
ONE, COMBINED = "/franka_control", "/combined_panda"
PUSH = {"force": (0, 0, -220), "ticks": 60}  # far beyond the thresholds [N, ms]
SUCCEEDED = (GoalStatus.SUCCEEDED, "")
TRAJECTORY_ERROR = 0.01  # [rad]
MODES = {
    "idle": FrankaState.ROBOT_MODE_IDLE,
    "moving": FrankaState.ROBOT_MODE_MOVE,
    "in reflex": FrankaState.ROBOT_MODE_REFLEX,
    "user-stopped": FrankaState.ROBOT_MODE_USER_STOPPED,
}

# Arms side by side, for any number of them.
DESCRIPTION = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arms">
  <xacro:include filename="$(find franka_description)/robots/common/franka_arm.xacro" />
  <xacro:property name="limits"
    value="${{xacro.load_yaml('$(find franka_description)/robots/{robot}/joint_limits.yaml')}}" />
  <link name="base" />{arms}
</robot>"""
ONE_ARM = """
  <xacro:franka_arm arm_id="{arm}" connected_to="base" xyz="0 {place} 0" joint_limits="${{limits}}" />"""


def arms_and_launch(robot: str, count: int, first: int, folder: Path, reconnect: bool = False):
    """Arms with their addresses, and the launch of a node for them.

    @param first last number of the first address
    @param reconnect whether the node reconnects automatically; with several arms: for the second one
    """
    names = [robot] if count == 1 else [f"{robot}_{i + 1}" for i in range(count)]
    arms = {name: f"127.0.7.{first + i}" for i, name in enumerate(names)}
    if count > 1:
        more = f", {names[1]}/reconnect: true" if reconnect else ""
        return arms, _combined_launch(robot, arms, folder, more)
    launch = ["franka_control", "franka_control.launch", "load_gripper:=false", f"robot:={robot}"]
    return arms, [*launch, f"robot_ip:={arms[robot]}", f"reconnect:={str(reconnect).lower()}"]


def _combined_launch(robot: str, arms: dict[str, str], folder: Path, more: str) -> list[str]:
    """The launch of several arms with their addresses; for two Pandas only the addresses are needed.

    @param more further entries of robot_ips, each after a comma
    """
    addresses = ", ".join(f"{arm}/robot_ip: {address}" for arm, address in arms.items()) + more
    launch = ["franka_control", "franka_combined_control.launch"]
    launch += [f"robot_ips:={{{addresses}}}", f"sim_robot:={robot}"]
    if list(arms) == ["panda_1", "panda_2"]:
        return launch
    placed = "".join(ONE_ARM.format(arm=arm, place=place) for place, arm in enumerate(arms))
    description = folder / "arms.urdf.xacro"
    description.write_text(DESCRIPTION.format(robot=robot, arms=placed))
    states = ", ".join(f"{arm}_state_controller/joint_states" for arm in arms)
    return [
        *launch,
        f"robot:={description}",
        f"hw_config_file:={_for_arms('franka_combined_control_node.yaml', arms, folder)}",
        f"controllers_file:={_for_arms('default_combined_controllers.yaml', arms, folder)}",
        "controllers_to_start:=" + " ".join(f"{arm}_state_controller" for arm in arms),
        f"joint_states_source_list:=[{states}]",
    ]


def _for_arms(name: str, arms, folder: Path) -> Path:
    """A file for panda_1 and panda_2, rewritten for other arms: all get the values of panda_1."""
    text = yaml.safe_dump(_without_second_arm(yaml.safe_load((CONTROL_CONFIG / name).read_text())))
    merged = {}
    for arm in arms:
        _merge(merged, yaml.safe_load(text.replace("panda_1", arm)))
    path = folder / name
    path.write_text(yaml.safe_dump(merged))
    return path


def _without_second_arm(value):
    if isinstance(value, dict):
        return {k: _without_second_arm(v) for k, v in value.items() if not k.startswith("panda_2")}
    if isinstance(value, list):
        return [item for item in value if not str(item).startswith("panda_2")]
    return value


def _merge(into: dict, more: dict) -> None:
    """Lists that both have are joined."""
    for key, value in more.items():
        if isinstance(value, dict):
            _merge(into.setdefault(key, {}), value)
        elif isinstance(value, list):
            into[key] = into.get(key, []) + value
        else:
            into[key] = value


class Arm:
    """An arm of a node, and the operator of its simulated robot."""

    def __init__(self, name: str, address: str, node: str, alone: bool):
        self.name, self.operator = name, Remote(address)
        self.state, self.states, self.has_error, self.aborts = None, 0, None, []
        controller = "/franka_state_controller" if alone else f"{node}/{name}_state_controller"
        self._own = node if alone else f"{node}/{name}"
        rospy.Subscriber(f"{controller}/franka_states", FrankaState, self._store, queue_size=1)
        rospy.Subscriber(f"{self._own}/has_error", Bool, lambda m: setattr(self, "has_error", m.data))
        rospy.Subscriber(f"{self._own}/abort", String, lambda m: self.aborts.append(m.data))

    def _store(self, state: FrankaState) -> None:
        self.state = state
        self.states += 1

    def is_in(self, mode: str) -> bool:
        """@param mode one of MODES"""
        return self.state is not None and self.state.robot_mode == MODES[mode]

    def push(self) -> None:
        """Pushes the arm until its reflex."""
        self.operator.push(f"{self.name}_link7", **PUSH)

    def wait_for_end_of_push(self) -> None:
        """After the reflex: a recovery during the push would end in another reflex."""
        end = self.operator.time + 2e-3 * PUSH["ticks"]
        wait_for(lambda: self.operator.time > end, "The end of the push")

    def service(self, name: str) -> str:
        return f"{self._own}/{name}"

    def recover(self) -> tuple[int | None, str]:
        """Status and text of a recovery of this arm only, as far as its node has other arms."""
        return Action(self.service("error_recovery"), ErrorRecoveryAction).run(ErrorRecoveryGoal())


class ControlNode:
    """A node and its arms, given with the addresses of their simulated robots."""

    def __init__(self, arms: dict[str, str]):
        self.alone = len(arms) == 1
        self.name = ONE if self.alone else COMBINED
        self.arms = [Arm(arm, address, self.name, self.alone) for arm, address in arms.items()]
        self.controllers = Controllers("" if self.alone else self.name)
        self.recovery = Action(f"{self.name}/error_recovery", ErrorRecoveryAction)
        wait_for(lambda: all(arm.state for arm in self.arms), "A first state of each arm")

    def recover(self) -> tuple[int | None, str]:
        """Status and text, also right after a connection: a robot that is lost has no such action."""
        return Action(f"{self.name}/error_recovery", ErrorRecoveryAction).run(ErrorRecoveryGoal())

    def trigger(self, service: str) -> tuple[bool, str]:
        return trigger(f"{self.name}/{service}")

    def wait_for(self, condition, what: str) -> None:
        """Waits until a condition holds for all arms."""
        wait_for(lambda: all(condition(arm) for arm in self.arms), what)

    def wait_until_all_are(self, mode: str) -> None:
        self.wait_for(lambda arm: arm.is_in(mode), f"All arms {mode}")

    def move_joints(self, controller: str, by: float, seconds: float = 1.0, arms=None) -> None:
        """One trajectory for all joints of these arms: each moves by the same angle [rad]."""
        arms = arms or self.arms
        targets = {f"{arm.name}_joint{i + 1}": arm.state.q[i] + by for arm in arms for i in range(7)}
        follow(f"{self.controllers.namespace}/{controller}", targets, seconds)

        def arrives():
            positions = [q for arm in arms for q in arm.state.q]
            return max(abs(a - b) for a, b in zip(positions, targets.values())) < TRAJECTORY_ERROR

        wait_for(arrives, "The end of the trajectory")

    def prepare(self, controller: str) -> None:
        """All arms move without an error under one controller, whatever happened before."""
        for arm in self.arms:
            arm.operator.set_user_stop(False)
        wait_for(lambda: not any(arm.is_in("user-stopped") for arm in self.arms), "The end of the user stop")
        if controller not in self.controllers.running():
            self.controllers.start(controller)
        self.recover()
        self.wait_until_all_are("moving")
        self.wait_for(lambda arm: not arm.has_error, "The end of the errors")


class Diagnosis:
    """The latest diagnostics of a node."""

    def __init__(self, node: str):
        self.node, self.latest = node, {}
        rospy.Subscriber("/diagnostics", DiagnosticArray, self._store)

    def _store(self, message: DiagnosticArray) -> None:
        self.latest.update({status.name: status for status in message.status})

    def shows(self, what: str, text: str, **values: str):
        """One status, once it has that text and these values: level, hardware, all values."""
        return self.status_when(what, lambda now, given: now == text and given.items() >= values.items())

    def status_when(self, what: str, condition):
        """The same, once a condition on its text and its values holds."""

        def matching():
            status = self.latest.get(f"{self.node}: {what}")
            values = {each.key: each.value for each in status.values} if status else {}
            return status and condition(status.message, values) and (status.level, status.hardware_id, values)

        return wait_for(matching, lambda: f"A status of {what}, out of {self.latest},")


def go_to(arm: Arm, publisher: rospy.Publisher, position: Sequence[float]) -> None:
    """Moves the target of the Cartesian impedance controller, and waits for a third of the way up or down.

    Not if it is nearer than 2 cm: the joints' friction holds an arm at rest against 200 N/m. Measured:
    at 12 mm it does not move at all, and from 30 mm it comes as near as 16 to 19 mm.
    """
    wait_for(publisher.get_num_connections, "The controller's subscription")
    target = PoseStamped()
    target.header.frame_id = f"{arm.name}_link0"
    target.pose.position = Point(*position)
    target.pose.orientation.x = 1.0
    height = position[2]
    rest = max(abs(height - arm.state.O_T_EE[14]) * 2 / 3, 0.02)

    def gets_near():
        publisher.publish(target)  # again: a controller that restarts after a recovery forgets its target
        return abs(arm.state.O_T_EE[14] - height) <= rest

    wait_for(gets_near, "A third of the way")


def follow_pose(arm: Arm, publisher: rospy.Publisher) -> None:
    """The end effector follows the target of the Cartesian impedance controller: 3 cm up or down."""
    x, y, z = arm.state.O_T_EE[12:15]
    go_to(arm, publisher, (x, y, z + math.copysign(0.03, 0.5 - z)))
