# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_control_node with one arm, franka_combined_control_node with several: launched, observed, used."""

import math
from collections.abc import Sequence
from contextlib import contextmanager
from pathlib import Path

import ros_nodes
import rospy
import yaml
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticArray
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState
from geometry_msgs.msg import Point, PoseStamped
from own_process import logs
from pyfranka.franka_sim import FrankaSim, ServedRobot
from pyfranka.remote import Remote
from pyfranka.sim import FR3, KINDS, Panda
from ros_client import START, Action, Controllers, follow, join, trigger
from ros_nodes import parameters, robot_description, xacro
from std_msgs.msg import Bool, String
from waiting import wait_for

OK, WARN, ERROR = 0, 1, 2  # levels of diagnostics
ONE, COMBINED = "/franka_control", "/combined_panda"
PUSH = {"force": (0, 0, -220), "ticks": 60}  # far beyond the thresholds [N, ms]
SUCCEEDED = (GoalStatus.SUCCEEDED, "")
TRAJECTORY_ERROR = 0.01  # [rad]
PUBLISH_RATE = 100.0  # of states [Hz]: a test soon sees what has changed
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


def robots_of(kind: str, count: int, **options) -> list[Panda | FR3]:
    """Simulated arms without hands, side by side, on the addresses that franka_sim finds."""
    names = [kind] if count == 1 else [f"{kind}_{i + 1}" for i in range(count)]
    return [KINDS[kind](name=name, base=(0, i, 0), hand=False, **options) for i, name in enumerate(names)]


@contextmanager
def node_of(servers: Sequence[FrankaSim], folder: Path, publish_rate: float = PUBLISH_RATE, **own):
    """The node of all robots of these servers, whose master this process joins. Only the arms' state
    controllers run, and no launch file is used: those have test_hardware.py.

    @param publish_rate of the arms' states [Hz]
    @param own parameters of the node; those of an arm in a dictionary with its name
    """
    robots = [robot for server in servers for robot in server.robots]
    single = len(robots) == 1
    name, kind = (ONE, "franka_control_node") if single else (COMBINED, "franka_combined_control_node")
    with ros_nodes.master(folder) as master:
        watchers = _set_parameters(master, robots, folder, own)
        for watcher in watchers:
            master.set(f"{'' if single else name}/{watcher}/publish_rate", publish_rate)
        with master.node("franka_control", kind, name[1:]) as process:
            logs.append(process.log)
            join(master.uri)
            controllers = Controllers("" if single else name)
            wait_for(lambda: _is_served(controllers, process), "The controller manager", START)
            controllers.load(*watchers)
            controllers.start(*watchers)
            try:
                yield process
            finally:
                rospy.signal_shutdown("the test has ended")


def _is_served(controllers: Controllers, process: ros_nodes.Node) -> bool:
    assert process.process.poll() is None, process.output
    return (
        rospy.get_master().lookupService(f"{controllers.namespace}/controller_manager/load_controller")[0]
        == 1
    )


def _set_parameters(master: ros_nodes.Master, robots: list[ServedRobot], folder: Path, own: dict):
    """Those of the node and of its controllers, as the launch files have them.

    @returns the controllers of the arms' states
    """
    own = {"realtime_config": "ignore", "connect_timeout": 30.0, **own}
    if len(robots) == 1:
        (robot,) = robots
        master.set("/robot_description", robot_description(robot.kind, hand="false", arm_id=robot.name))
        node = parameters("franka_control_node.yaml", arm_id=robot.name)
        master.set(ONE, node | own | {"robot_ip": robot.address})
        controllers = parameters("default_controllers.yaml", arm_id=robot.name)
        namespace, watchers = "/", ["franka_state_controller"]
    else:
        arms = [robot.name for robot in robots]
        node = _for_arms(parameters("franka_combined_control_node.yaml"), arms)
        for robot in robots:
            node[robot.name] |= {"robot_ip": robot.address, **own.pop(robot.name, {})}
        master.set(COMBINED, node | own | {"robot_description": _arms_description(robots, folder)})
        controllers = _for_arms(parameters("default_combined_controllers.yaml"), arms)
        namespace, watchers = f"{COMBINED}/", [f"{arm}_state_controller" for arm in arms]
    for name, values in controllers.items():
        master.set(namespace + name, values)
    return watchers


def _arms_description(robots: list[ServedRobot], folder: Path) -> str:
    placed = "".join(ONE_ARM.format(arm=robot.name, place=place) for place, robot in enumerate(robots))
    file = folder / "arms.urdf.xacro"
    file.write_text(DESCRIPTION.format(robot=robots[0].kind, arms=placed))
    return xacro(file)


def _for_arms(value, arms: list[str]):
    """Values for panda_1 and panda_2, for other arms: all get those of panda_1."""
    if isinstance(value, list):
        lists = ([_named_after(item, arm) for arm in arms] if "panda_1" in item else [] for item in value)
        return [item for copies in lists for item in copies]
    if not isinstance(value, dict):
        return value
    found = {}
    for name, part in value.items():
        if "panda_1" in name:
            found |= {_named_after(name, arm): _named_after(part, arm) for arm in arms}
        elif "panda_2" not in name:
            found[name] = _for_arms(part, arms)
    return found


def _named_after(value, arm: str):
    return yaml.safe_load(yaml.safe_dump(value).replace("panda_1", arm))


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
    """A node and its arms."""

    def __init__(self, arms: dict[str, str]):
        """@param arms with the addresses of their simulated robots"""
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
