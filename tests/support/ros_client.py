# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""This process as a node: joins a launch's master, waits, calls services, sends goals.

A process can join one master only: mark its tests with `own_process`.
"""

import os
from contextlib import contextmanager, suppress
from pathlib import Path

import actionlib
import rospy
import rospy_connections
import yaml
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import FollowJointTrajectoryAction, FollowJointTrajectoryGoal
from controller_manager_msgs.srv import ListControllers, LoadController, SwitchController, UnloadController
from franka_sim_mujoco.session import Session
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectoryPoint
from waiting import PATIENCE, holds, wait_for

START = 180.0  # limit for a launch, on a busy machine [s]
STRICT = 2
EXAMPLES = (
    Path(__file__).resolve().parents[2] / "catkin_ws/src/franka_example_controllers/config"
    "/franka_example_controllers.yaml"
)


def join(uri: str, **options) -> None:
    """Makes this process a node of a master. @param options of rospy.init_node"""
    if rospy.core.is_initialized():
        raise RuntimeError(
            "This process has joined another ROS master before, and rospy can join one only. "
            "Mark the test with own_process, and name the parameters that need another launch."
        )
    os.environ.update(ROS_MASTER_URI=uri, ROS_HOSTNAME=os.environ.get("ROS_HOSTNAME", "localhost"))
    rospy_connections.init_node("test", anonymous=True, disable_signals=True, **options)


@contextmanager
def in_session(session: Session, **options):
    """Starts a session, and joins its master. @param options of rospy.init_node"""
    from own_process import logs  # of pytest, which programs of rostest do not have

    with session:
        logs.append(session.log)
        session.wait_for_node(START)
        join(session.environment["ROS_MASTER_URI"], **options)
        try:
            yield session
            session.check()
        finally:
            rospy.signal_shutdown("the test has ended")


def launched(*launch: str, log: Path, **options):
    """A launch whose master this process joins. @param options of rospy.init_node"""
    return in_session(Session(*launch, log=log), **options)


def call(service: str, kind, *arguments, **fields):
    """The answer of a service, which may not exist yet."""
    rospy.wait_for_service(service, START)
    return rospy.ServiceProxy(service, kind)(*arguments, **fields)


def trigger(service: str) -> tuple[bool, str]:
    """Success and message of a std_srvs/Trigger."""
    answer = call(service, Trigger)
    return answer.success, answer.message


def latest(topic: str, kind, timeout: float = PATIENCE):
    """The next message of a topic, or its latched one."""
    return rospy.wait_for_message(topic, kind, timeout)


class Action:
    """The client of an action."""

    def __init__(self, name: str, kind, patience: float = START):
        self._client = actionlib.ActionClient(name, kind)
        assert rospy_connections.wait_for_server(self._client, patience), f"There is no action {name}."

    def send(self, goal, **callbacks):
        """The handle of a goal. @param callbacks of actionlib's send_goal"""
        return self._client.send_goal(goal, **callbacks)

    def run(self, goal, patience: float = PATIENCE) -> tuple[int | None, str]:
        """Status and text of a goal."""
        return outcome(self.send(goal), patience)


def outcome(handle, patience: float = PATIENCE) -> tuple[int | None, str]:
    """Status and text of a goal that was sent."""
    if not holds(lambda: handle.get_comm_state() == actionlib.CommState.DONE, patience):
        return None, "no result"
    return handle.get_goal_status(), handle.get_goal_status_text()


class Controllers:
    """A controller manager."""

    def __init__(self, namespace: str = ""):
        self.namespace = namespace

    def _call(self, service, kind, *arguments, **fields):
        return call(f"{self.namespace}/controller_manager/{service}", kind, *arguments, **fields)

    def load(self, *names: str) -> None:
        for name in names:
            assert self._call("load_controller", LoadController, name).ok, f"{name} was not loaded."

    def unload(self, name: str) -> None:
        assert self._call("unload_controller", UnloadController, name).ok, f"{name} was not unloaded."

    def switches(self, start=(), stop=(), strictness: int = STRICT) -> bool:
        """Whether the manager starts and stops these controllers."""
        answer = self._call(
            "switch_controller",
            SwitchController,
            start_controllers=list(start),
            stop_controllers=list(stop),
            strictness=strictness,
            timeout=PATIENCE,
        )
        return answer.ok

    def start(self, *names: str) -> None:
        assert self.switches(start=names), f"{', '.join(names)} did not start."

    def stop(self, *names: str) -> None:
        assert self.switches(stop=names), f"{', '.join(names)} did not stop."

    def states(self) -> dict[str, str]:
        return {c.name: c.state for c in self._call("list_controllers", ListControllers).controller}

    def running(self) -> list[str]:
        return [name for name, state in self.states().items() if state == "running"]

    def wait_for(self, *names: str, patience: float = START) -> None:
        """Waits until these controllers run, also while the manager still starts."""

        def all_run():
            with suppress(rospy.ServiceException):  # called during its start
                return set(names) <= set(self.running())

        wait_for(all_run, f"The controllers {', '.join(names)} of {self.namespace or '/'}", patience)


def set_example_parameters(arm: str) -> None:
    """Sets the parameters of the example controllers for an arm."""
    for name, value in yaml.safe_load(EXAMPLES.read_text().replace("$(arg arm_id)", arm)).items():
        rospy.set_param(f"/{name}", value)


def trajectory(targets: dict[str, float], seconds: float) -> FollowJointTrajectoryGoal:
    """A goal with one point, at which the joints rest."""
    goal = FollowJointTrajectoryGoal()
    goal.trajectory.joint_names = list(targets)
    goal.trajectory.points = [
        JointTrajectoryPoint(
            positions=list(targets.values()),
            velocities=[0.0] * len(targets),
            time_from_start=rospy.Duration(seconds),
        )
    ]
    return goal


def follow(controller: str, targets: dict[str, float], seconds: float) -> None:
    """Moves joints by a trajectory controller, to its success."""
    action = Action(f"{controller}/follow_joint_trajectory", FollowJointTrajectoryAction)
    result = action.run(trajectory(targets, seconds))
    assert result[0] == GoalStatus.SUCCEEDED, result
