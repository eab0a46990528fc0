# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Controllers and the errors of robots; prints a report as JSON.

Run by test_controllers_and_errors.py with ROS's interpreter. Arguments: what to do (throw; simulate: the same
in the simulation's process; stop: the node was told to stop controllers before a recovery), the node, and its
arms as fr3=127.0.0.1.
"""

import json
import sys
import time

import actionlib
import rospy
import rospy_connections
from controller_manager_msgs.srv import ListControllers, LoadController, SwitchController
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState
from pyfranka.remote import Remote
from recovery_client import PUSH
from std_msgs.msg import Bool

BEST_EFFORT, STRICT = 1, 2
PATIENCE = 20.0  # limit for immediate reactions [s]


def waits(condition):
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        if condition():
            return True
        time.sleep(0.005)
    return False


class Arm:
    def __init__(self, manager, node, arm, address, alone):
        self.name, self.operator = arm, Remote(address)
        self.state, self.has_error, self.states = None, None, 0
        controller = "franka_state_controller" if alone else f"{arm}_state_controller"
        rospy.Subscriber(f"{manager}{controller}/franka_states", FrankaState, self._store, queue_size=1)
        error = f"{node}/has_error" if alone else f"{node}/{arm}/has_error"
        rospy.Subscriber(error, Bool, lambda m: setattr(self, "has_error", m.data))

    def _store(self, state):
        self.state = state
        self.states += 1

    def moves(self):
        return self.state is not None and self.state.robot_mode == FrankaState.ROBOT_MODE_MOVE

    def rests(self):
        return self.state.robot_mode == FrankaState.ROBOT_MODE_IDLE


class Node:
    def __init__(self, node, arms):
        alone = len(arms) == 1
        self._manager = "/" if alone else f"{node}/"
        self.arms = [Arm(self._manager, node, arm, address, alone) for arm, address in arms.items()]
        self._joints = [f"{arm}_joint{i}" for arm in arms for i in range(1, 8)]
        self._recovery = actionlib.ActionClient(f"{node}/error_recovery", ErrorRecoveryAction)
        if not self._recovery.wait_for_server(rospy.Duration(40.0)):
            raise RuntimeError("no error_recovery")

    def _call(self, service, kind, **request):
        name = f"{self._manager}controller_manager/{service}"
        rospy.wait_for_service(name, 30.0)
        return rospy.ServiceProxy(name, kind)(**request)

    def load(self, controller):
        parameters = {"type": "test/Throwing", "joints": self._joints}
        rospy.set_param(f"{self._manager}{controller}", parameters)
        return self._call("load_controller", LoadController, name=controller).ok

    def running(self):
        answer = self._call("list_controllers", ListControllers)
        return [c.name for c in answer.controller if c.state == "running"]

    def start(self, controller, throws_in):
        rospy.set_param(f"{self._manager}{controller}/throws_in", throws_in)
        switch = {"start_controllers": [controller], "strictness": STRICT, "timeout": 5.0}
        self._call("switch_controller", SwitchController, **switch)

    def stop(self, controller):
        switch = {"stop_controllers": [controller], "strictness": BEST_EFFORT, "timeout": 5.0}
        self._call("switch_controller", SwitchController, **switch)
        return controller not in self.running()

    def recover(self):
        goal = self._recovery.send_goal(ErrorRecoveryGoal())
        waits(lambda: goal.get_comm_state() == actionlib.CommState.DONE)
        return goal.get_terminal_state()

    def all(self, condition):
        return waits(lambda: all(condition(arm) for arm in self.arms))


def states_go_on(node):
    before = [arm.states for arm in node.arms]
    return waits(lambda: all(arm.states > count + 20 for arm, count in zip(node.arms, before)))


def thrown_in_simulation(node, where):
    """The same for controllers in the simulation's process: no error, but a robot at rest."""
    node.start("thrower", where)
    outcome = {"moved": where == "starting" or node.all(Arm.moves)}
    outcome["rests"] = node.all(Arm.rests)
    outcome["states_go_on"] = states_go_on(node)
    outcome["stopped"] = node.stop("thrower")
    node.start("good", "none")
    outcome["moves"] = node.all(Arm.moves)
    node.stop("good")
    return outcome


def thrown(node, where):
    """Results of a controller that throws, and the state afterwards."""
    node.start("thrower", where)
    outcome = {"has_error": node.all(lambda arm: arm.has_error)}
    outcome["states_go_on"] = states_go_on(node)
    outcome["stopped"] = node.stop("thrower")
    outcome["recovered"] = node.recover()
    outcome["error_gone"] = node.all(lambda arm: not arm.has_error)
    node.start("good", "none")
    outcome["moves"] = node.all(Arm.moves)
    node.stop("good")
    return outcome


def stays_at_rest(node):
    """After a cleared error: whether the controller was stopped and the arm rests."""
    outcome = {"error_gone": node.all(lambda arm: not arm.has_error)}
    outcome["running"] = "good" in node.running()
    time.sleep(0.5)  # in which it would move
    outcome["rests"] = all(arm.rests() for arm in node.arms)
    node.start("good", "none")
    outcome["moves_when_told"] = node.all(Arm.moves)
    return outcome


def stopped_first(node):
    """A reflex of one arm with a recovery, then, on an arm alone, the user stop without one."""
    node.start("good", "none")
    report = {"moves": node.all(Arm.moves)}
    one = node.arms[0]
    one.operator.push(f"{one.name}_link7", *PUSH)
    report["hit"] = node.all(lambda arm: arm.has_error)
    report["recovered"] = node.recover()
    report["after_reflex"] = stays_at_rest(node)
    if len(node.arms) == 1:
        one.operator.user_stop(True)
        report["stopped"] = waits(lambda: one.has_error)
        one.operator.user_stop(False)
        report["after_user_stop"] = stays_at_rest(node)
    return report


def main():
    rospy_connections.init_node("controllers_and_errors_client", anonymous=True)
    node = Node(sys.argv[2], dict(argument.split("=") for argument in sys.argv[3:]))
    if not node.all(lambda arm: arm.state is not None):
        raise RuntimeError("no states")
    if not (node.load("thrower") and node.load("good")):
        raise RuntimeError("the controllers could not be loaded")
    if sys.argv[1] in ("throw", "simulate"):
        task = thrown if sys.argv[1] == "throw" else thrown_in_simulation
        print(json.dumps({where: task(node, where) for where in ("starting", "update")}))
    else:
        print(json.dumps(stopped_first(node)))


if __name__ == "__main__":
    main()
