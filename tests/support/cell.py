# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated cell whose controllers run in the simulation's process: three arms, stepped by the test.

The arms `left` (a Panda) and `right` (an FR3) are one robot with one controller manager; `solo` (a Panda) is
a robot of its own. `served` (an FR3) waits for clients on the network. Time stands still between two steps.
"""

import os
import subprocess
import threading
from contextlib import contextmanager
from pathlib import Path

import rospy
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import FollowJointTrajectoryAction
from controller_manager_msgs.srv import ListControllers
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState
from franka_msgs.srv import SetEEFrame, SetJointConfiguration, SetLoad
from franka_sim_mujoco.srv import GetJointStates, SpawnRobot, SpawnRobotRequest, Step
from pyfranka.remote import Remote
from ros_client import Action, Controllers, launched, trajectory
from ros_nodes import executable
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool, Trigger
from waiting import wait_for

WORKSPACE = Path(__file__).resolve().parents[2] / "catkin_ws/src"
LAUNCH = """<launch>
  <param name="/use_sim_time" value="true"/>
  <node name="gazebo" pkg="franka_sim_mujoco" type="franka_sim_mujoco_node" output="screen" required="true">
    <param name="world" type="str" value="worlds/empty.world"/>
    <param name="paused" type="bool" value="true"/> <param name="gui" type="bool" value="false"/>
    <param name="real_time_factor" type="double" value="0"/>
  </node>
</launch>"""
START = (0.0, -0.785398163, 0.0, -2.35619449, 0.0, 1.57079632679, 0.785398163397)
ARMS = {"left": "/duo", "right": "/duo", "solo": "/solo"}  # with their namespaces
ROBOTS = {"duo": ("left", "right"), "solo": ("solo",), "served": ("served",)}
GUEST = "guest"  # a robot that comes and goes
ADDRESS = "127.0.7.91"  # of the served robot
EXAMPLES = "franka_example_controllers/"
# Controllers of each arm by their kind. Those of MOTIONS claim the arm, and exclude each other.
MOTIONS = {
    "velocity": EXAMPLES + "JointVelocityExampleController",
    "position": EXAMPLES + "JointPositionExampleController",
    "twist": EXAMPLES + "CartesianVelocityExampleController",
    "pose": EXAMPLES + "CartesianPoseExampleController",
    "torque": EXAMPLES + "CartesianImpedanceExampleController",
    "trajectory": "position_controllers/JointTrajectoryController",
}
STATE, GRIPPER = "franka_state_controller", "franka_gripper"
PUBLISH_RATE = 1000.0  # [Hz]
MAX_TICKS = 4000  # of a request that waits for ticks
MOVE, REFLEX, USER_STOPPED = FrankaState.ROBOT_MODE_MOVE, FrankaState.ROBOT_MODE_REFLEX, 5


def load_of(mass: float) -> dict:
    """The fields of a request of set_load. @param mass [kg]"""
    return {
        "mass": mass,
        "F_x_center_load": [0, 0, 0.05],
        "load_inertia": [1e-3, 0, 0, 0, 1e-3, 0, 0, 0, 1e-3],
    }


def controller(arm: str, kind: str) -> str:
    return f"{arm}/{kind}"


def parameters(arm: str) -> dict:
    """Those of the controllers of an arm."""
    joints = [f"{arm}_joint{i}" for i in range(1, 8)]
    common = {"arm_id": arm, "joint_names": joints, "joints": joints}
    fingers = {f"finger{i}": {"gains": {"p": 100, "d": 1}} for i in (1, 2)}
    return {
        STATE: {"type": "franka_control/FrankaStateController", "publish_rate": PUBLISH_RATE, **common},
        GRIPPER: {"type": "franka_gazebo/FrankaGripperSim", **common, **fingers},
        **{kind: {"type": name, **common} for kind, name in MOTIONS.items()},
    }


def description(robot: str) -> str:
    """The URDF of a robot of the cell."""
    files = {
        "duo": [WORKSPACE / "franka_sim_mujoco/test/two_arms.urdf.xacro"],
        "solo": [
            WORKSPACE / "franka_description/robots/panda/panda.urdf.xacro",
            *("gazebo:=true", "hand:=true", "arm_id:=solo", "xyz:=-4 0 0"),
        ],
        "served": [
            WORKSPACE / "franka_description/robots/fr3/fr3.urdf.xacro",
            *("gazebo:=true", "hand:=false", "arm_id:=served", "xyz:=4 0 0"),
        ],
    }
    files[GUEST] = [files["served"][0], "gazebo:=true", "hand:=true", "arm_id:=guest", "xyz:=0 4 0"]
    command = [executable("xacro", "xacro"), *map(str, files[robot])]
    return subprocess.run(command, text=True, capture_output=True, check=True).stdout


class CellArm:
    """An arm of the cell: its services, and its last state."""

    def __init__(self, name: str):
        self.name, self.namespace = name, ARMS[name]
        prefix = self.namespace if name == "solo" else f"{self.namespace}/{name}"
        self.joints = [f"{name}_joint{i}" for i in range(1, 8)]
        self.joints += [f"{name}_finger_joint{i}" for i in (1, 2)]
        self.control = f"{prefix}/franka_control"
        self.place = rospy.ServiceProxy(f"{prefix}/set_franka_model_configuration", SetJointConfiguration)
        self.set_user_stop = self._service("set_user_stop", SetBool)
        self.connect = self._service("connect", Trigger)
        self.disconnect = self._service("disconnect", Trigger)
        self.set_load = self._service("set_load", SetLoad)
        self.set_EE_frame = self._service("set_EE_frame", SetEEFrame)
        self.state: FrankaState | None = None
        topic = f"{self.namespace}/{controller(name, STATE)}/franka_states"
        rospy.Subscriber(topic, FrankaState, lambda state: setattr(self, "state", state), tcp_nodelay=True)

    def _service(self, name: str, kind):
        return rospy.ServiceProxy(f"{self.control}/{name}", kind)


class Cell:
    """The cell, and what steps it."""

    def __init__(self, process: int):
        self.process = process
        self._step = rospy.ServiceProxy("/gazebo/step", Step, persistent=True)
        self._joints = rospy.ServiceProxy("/gazebo/get_joint_states", GetJointStates, persistent=True)
        self._reset = rospy.ServiceProxy("/gazebo/reset", Trigger)
        rospy.wait_for_service("/gazebo/step", 60)
        self.begin = self.tick = self._step(0).tick
        self.now = rospy.Time()
        for robot in ROBOTS:
            self.spawn(robot)
        self.operator = Remote(ADDRESS)
        self.stop_served = rospy.ServiceProxy("/served/franka_sim/set_user_stop", SetBool)
        self.step(5)  # the hardware reads the positions, at which some controllers must load
        self.arms = {name: CellArm(name) for name in ARMS}
        self.managers = {ns: Controllers(ns) for ns in dict.fromkeys(ARMS.values())}
        lists = {ns: f"{ns}/controller_manager/list_controllers" for ns in self.managers}
        self._lists = [rospy.ServiceProxy(name, ListControllers, persistent=True) for name in lists.values()]
        for arm, namespace in ARMS.items():
            self.managers[namespace].load(*(controller(arm, kind) for kind in parameters(arm)))
            assert self.switch(arm, start=[STATE, GRIPPER])
        actions = {}
        for name, arm in self.arms.items():
            action = self.during_steps(
                lambda arm=arm: Action(f"{arm.control}/error_recovery", ErrorRecoveryAction)
            )
            actions[name] = action
        self._recoveries = actions
        self._goals = {
            arm: Action(
                f"{namespace}/{controller(arm, 'trajectory')}/follow_joint_trajectory",
                FollowJointTrajectoryAction,
            )
            for arm, namespace in ARMS.items()
        }
        self._clock = rospy.Publisher("/clock", Clock, queue_size=1)

    @staticmethod
    def spawn(robot: str) -> None:
        order = SpawnRobotRequest(name=robot, urdf=description(robot), robot_namespace=f"/{robot}")
        rospy.set_param(f"/{robot}/reflexes", True)
        rospy.set_param(f"/{robot}/robot_description", order.urdf)
        if robot != "duo":
            rospy.set_param(f"/{robot}/arm_id", robot)
        if robot == "served":
            rospy.set_param("/served/fci_ip", ADDRESS)
        for arm in ROBOTS.get(robot, (robot,)):
            rospy.set_param(f"/{robot}/{arm}", parameters(arm))
            order.joint_names += [f"{arm}_joint{i}" for i in range(1, 8)]
            order.joint_positions += START
        order.pose.orientation.w = 1
        answer = rospy.ServiceProxy("/gazebo/spawn_robot", SpawnRobot)(order)
        assert answer.success, answer.error

    @property
    def age(self) -> int:
        """Ticks since the last reset."""
        return self.tick - self.begin

    @property
    def threads(self) -> int:
        """Of the simulation's process."""
        return len(list(Path(f"/proc/{self.process}/task").iterdir()))

    @property
    def memory(self) -> int:
        """Resident bytes of the simulation's process."""
        pages = int(Path(f"/proc/{self.process}/statm").read_text(encoding="ascii").split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE")

    def step(self, ticks: int) -> None:
        answer = self._step(ticks)
        assert answer.success, answer.error
        self.tick, self.now = answer.tick, answer.time

    def reset(self) -> None:
        answer = self._reset()
        assert answer.success, answer.message
        self.begin = self.tick

    def positions(self) -> dict[str, tuple[float, ...]]:
        """Positions and velocities of all joints, by arm."""
        names = [joint for arm in self.arms.values() for joint in arm.joints]
        state = self._joints(names).state
        values = dict(zip(state.name, zip(state.position, state.velocity)))
        return {
            name: tuple(value for joint in arm.joints for value in values[joint])
            for name, arm in self.arms.items()
        }

    def during_steps(self, request):
        """The result of a request that waits for ticks, which are made one at a time."""
        result, ended = [], threading.Event()

        def run():
            try:
                result.append(request())
            except Exception as error:  # is raised by the caller
                result.append(error)
            ended.set()

        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        for _ in range(MAX_TICKS):
            if ended.wait(0.002):
                break
            self.step(1)
        wait_for(ended.is_set, "The end of a request")
        thread.join()
        if isinstance(result[0], Exception):
            raise result[0]
        return result[0]

    def switch(self, arm: str, start=(), stop=()) -> bool:
        """Whether the controller manager of an arm starts and stops these kinds of its controllers."""
        names = [[controller(arm, kind) for kind in kinds] for kinds in (start, stop)]
        return self.during_steps(lambda: self.managers[ARMS[arm]].switches(*names))

    def recover(self, arm: str) -> bool:
        status, _ = self.during_steps(lambda: self._recoveries[arm].run(ErrorRecoveryGoal()))
        return status == GoalStatus.SUCCEEDED

    def accepts_goal(self, arm: str, right: bool) -> bool:
        """Whether the trajectory controller of an arm takes a goal. @param right with its own joints"""
        names = self.arms[arm].joints[:7] if right else ["nobody"]
        handle = self._goals[arm].send(trajectory(dict(zip(names, START)), 0.2))
        waits = (CommState.WAITING_FOR_GOAL_ACK, CommState.PENDING)
        wait_for(lambda: handle.get_comm_state() not in waits, "An answer to a goal")
        return handle.get_goal_status() != GoalStatus.REJECTED

    def jump_clock(self, by: float) -> None:
        """Publishes a time that is not the simulation's. @param by seconds from its own"""
        self._clock.publish(Clock(rospy.Time(max(self.now.to_sec() + by, 0.0))))

    def running(self) -> dict[str, set[str]]:
        """The kinds of the controllers that run, by arm."""
        found = {arm: set() for arm in ARMS}
        for controllers in self._lists:
            for one in controllers().controller:
                arm, _, kind = one.name.partition("/")
                if one.state == "running":
                    found[arm].add(kind)
        return found

    def fresh_states(self) -> None:
        """Waits until each arm has published a state of new ticks, at most those of half a second."""
        since, steps = self.now, 0

        def late():
            return [n for n, a in self.arms.items() if not a.state or a.state.header.stamp <= since]

        def arrive():
            nonlocal steps
            if steps < 50 and late():
                self.step(10)
                steps += 1
            return not late()

        wait_for(arrive, lambda: f"A state of {', '.join(late())}")


@contextmanager
def started_cell(folder: Path):
    file = folder / "cell.launch"
    file.write_text(LAUNCH)
    with launched(str(file), log=folder / "launch.log", disable_rostime=True) as session:
        names = {pid: Path(f"/proc/{pid}/comm") for pid in session.processes()}
        found = [pid for pid, name in names.items() if name.exists() and "franka_sim_muj" in name.read_text()]
        assert len(found) == 1, (names, os.getpid())
        yield Cell(found[0])
