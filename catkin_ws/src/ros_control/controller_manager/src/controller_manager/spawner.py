# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Loads controllers, starts them, and unloads them when the spawner exits."""

from __future__ import annotations

import argparse
import contextlib
import os
import socket
import time
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any

import rosgraph
import rosparam
import rospy
import yaml
from controller_manager_msgs.srv import (
    ListControllers,
    LoadController,
    LoadControllerRequest,
    SwitchController,
    SwitchControllerRequest,
    UnloadController,
)
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Bool

from controller_manager.command_line import Parser
from controller_manager.ending import POLL_PERIOD, Ended, Ending

DEFAULT_TIMEOUT = 30.0  # [s]
# How long the loop may take to stop controllers at the end. roslaunch waits 15 s before it kills.
STOP_TIMEOUT = 5.0  # [s]
# The manager's message about a failed load must be above ours in the log.
PAUSE_AFTER_FAILED_LOAD = 1.0  # [s]
# Time until a wait for a topic is first reported, and then the period.
FIRST_REPORT = 10.0  # [s]
REPORT_PERIOD = 60.0  # [s]
LONG_SWITCH = 3.0  # [s] after which a switch without an answer is reported; it takes two cycles of the loop
RESUBSCRIBE_TIME = 3.0  # [s] after which a subscriber without a publisher is replaced
# roslaunch ends all its nodes at once: time until a manager that broke a call off has exited.
END_OF_MANAGER = 2.0  # [s]


class SpawnerError(Exception):
    """An error that ends the spawner; the message is for the user."""


def parse_arguments(arguments: Sequence[str]) -> argparse.Namespace:
    parser = Parser(
        prog="spawner",
        description="Loads and starts controllers, and stops and unloads them when it is ended.",
    )
    parser.add_argument(
        "controllers",
        nargs="+",
        metavar="controller",
        help="name of a controller whose parameters are on the parameter server, or a YAML file "
        "with the parameters of one or more controllers",
    )
    parser.add_argument("--stopped", action="store_true", help="load the controllers only")
    parser.add_argument(
        "--wait-for",
        metavar="TOPIC",
        help="wait until this topic (std_msgs/Bool) says true before anything is loaded; without "
        "limit, as a paused simulation may stay so for long",
    )
    parser.add_argument("--namespace", metavar="NS", default="", help="namespace of the controller manager")
    timeouts = parser.add_mutually_exclusive_group()
    timeouts.add_argument(
        "--timeout",
        type=float,
        default=DEFAULT_TIMEOUT,
        help="[s] how long to wait for the controller manager; zero or less waits for ever "
        "(default: %(default)s)",
    )
    timeouts.add_argument(
        "--no-timeout",
        dest="timeout",
        action="store_const",
        const=0.0,
        help="wait for ever, as --timeout 0",
    )
    parser.add_argument(
        "--shutdown-timeout", type=float, metavar="X", help="without effect, for older launch files"
    )
    return parser.parse_args(arguments)


class SimulatedClock:
    """Whether the simulated clock has started, if there is one.

    Unsubscribes from /clock then. The clock's thousand messages per second would wake the node each time,
    and every robot has its spawners, which run as long as the robot.
    """

    def __init__(self) -> None:
        self._listener: Listener | None = None
        self._begun = not rospy.get_param("/use_sim_time", False)

    def has_begun(self) -> bool:
        if not self._begun:
            if self._listener is None:
                self._listener = Listener("/clock", Clock, lambda message: not message.clock.is_zero())
            self._begun = self._listener.has_message()
            if self._begun:
                self.close()
        return self._begun

    def close(self) -> None:
        if self._listener is not None:
            self._listener.close()
            self._listener = None


class Deadline:
    """Wall time left for waiting. It stands still before a simulated clock starts."""

    def __init__(self, timeout: float, clock: SimulatedClock):
        self._clock = clock
        self._timeout = timeout
        self._end = time.monotonic() + timeout
        self._said = False

    def is_over(self) -> bool:
        if self._timeout <= 0:
            return False
        if not self._clock.has_begun():
            if not self._said:
                rospy.loginfo("Waiting for /clock to be available...")
                self._said = True
            self._end = time.monotonic() + self._timeout
            return False
        return time.monotonic() > self._end


def wait_until(condition: Callable[[], bool], deadline: Deadline, ending: Ending) -> bool:
    """True if the condition holds, False after the time."""
    while not condition():
        if deadline.is_over():
            return False
        ending.sleep(POLL_PERIOD)
    return True


def is_offered(service: str) -> bool:
    """Whether a process accepts connections at the service's address; sends nothing.

    rospy.wait_for_service() would warn about a service whose node has died or is just exiting.
    """
    try:
        uri = rosgraph.Master(rospy.get_name()).lookupService(rospy.resolve_name(service))
        socket.create_connection(rospy.core.parse_rosrpc_uri(uri), POLL_PERIOD).close()
        return True
    except (rosgraph.MasterException, rospy.ROSException, OSError):
        return False


class Listener:
    """Waits for a message that counts, and subscribes again while there is no publisher.

    rospy permanently misses a publisher that registers at the same moment as the subscriber, if the
    master's update overtakes the master's answer.
    """

    def __init__(
        self, topic: str, kind: Any = Bool, counts: Callable[[Any], bool] = lambda message: message.data
    ):
        self._topic = topic
        self._kind = kind
        self._counts = counts
        self._has_message = False
        self._has_news = False
        self._subscribe()

    def _subscribe(self) -> None:
        self._subscriber = rospy.Subscriber(self._topic, self._kind, self._take)
        self._doubt = time.monotonic() + RESUBSCRIBE_TIME

    def _take(self, message: Any) -> None:
        self._has_news = True
        self._has_message = self._has_message or self._counts(message)

    def has_message(self) -> bool:
        """Whether such a message has arrived."""
        if self._subscriber.get_num_connections() == 0 and time.monotonic() > self._doubt:
            self.close()
            self._subscribe()
        return self._has_message

    def account(self) -> str:
        """Describes what has arrived instead of such a message, as the end of a sentence."""
        if self._has_news:
            return "has only sent false so far (a simulation sends true once it is no longer paused)"
        if self._subscriber.get_num_connections() > 0:
            return "has a publisher, which has sent nothing so far"
        return "has no publisher"

    def close(self) -> None:
        self._subscriber.unregister()


def wait_for_true(topic: str, ending: Ending) -> None:
    """Waits without limit. Raises Ended on a request to exit."""
    name = rospy.resolve_name(topic)
    rospy.loginfo("Controller Spawner: Waiting for %s to be true", name)
    begin = time.monotonic()
    report = begin + FIRST_REPORT
    with contextlib.closing(Listener(topic)) as listener:
        while not listener.has_message():
            if time.monotonic() > report:
                rospy.logwarn(
                    "Controller Spawner: after %.0f s, %s %s. Waiting on.",
                    time.monotonic() - begin,
                    name,
                    listener.account(),
                )
                report += REPORT_PERIOD
            ending.sleep(POLL_PERIOD)


def upload(path: str) -> list[str]:
    """Loads a YAML file on the parameter server. Returns the controllers it describes."""
    not_controllers = f"'{path}' does not hold names of controllers with their parameters"
    names = []
    try:
        for parameters, namespace in rosparam.load_file(path):
            if not isinstance(parameters, dict):
                raise SpawnerError(not_controllers)
            rosparam.upload_params(namespace, parameters)
            names += list(parameters)
    except (rosparam.RosParamException, yaml.YAMLError, OSError, UnicodeDecodeError) as error:
        raise SpawnerError(f"'{path}' could not be read: {error}") from error
    except (TypeError, AttributeError) as error:
        # rosparam expects documents that map names to values of XML-RPC types.
        raise SpawnerError(f"{not_controllers}: {error}") from error
    if not names:
        raise SpawnerError(f"'{path}' describes no controller")
    return names


def controller_names(arguments: Iterable[str]) -> list[str]:
    """Names as given, files replaced by their controllers, without duplicates."""
    names = []
    for argument in arguments:
        if os.path.isfile(argument):
            names += upload(argument)
        elif argument.endswith((".yaml", ".yml")):
            raise SpawnerError(f"there is no file '{argument}'")
        else:
            names.append(argument)
    return list(dict.fromkeys(names))


class SwitchReport:
    """Says once that a switch is waited for: the control loop makes it."""

    def __init__(self, service: str):
        self._service = service
        self._due: float | None = time.monotonic() + LONG_SWITCH

    def __call__(self) -> None:
        if self._due is None or time.monotonic() < self._due:
            return
        self._due = None
        hint = ""
        if rospy.get_param("/use_sim_time", False):
            hint = " A paused simulation starts no controllers: rosservice call /gazebo/unpause_physics"
        rospy.logwarn(
            "Controller Spawner: %s has not answered for %.0f s: its control loop stands still.%s",
            rospy.resolve_name(self._service),
            LONG_SWITCH,
            hint,
        )


class Spawner:
    """The controllers this program has loaded into one controller manager."""

    def __init__(self, namespace: str, ending: Ending):
        self._prefix = f"{namespace.rstrip('/')}/" if namespace else ""
        self._prefix += "controller_manager/"
        self._ending = ending
        self.loaded: list[str] = []

    def _service(self, name: str, kind: Any) -> Any:
        return rospy.ServiceProxy(self._prefix + name, kind)

    def wait_for_manager(self, timeout: float, clock: SimulatedClock) -> bool:
        for name in ("load_controller", "switch_controller", "unload_controller"):
            service = self._prefix + name
            rospy.loginfo("Controller Spawner: Waiting for service %s", service)
            offered = wait_until(partial(is_offered, service), Deadline(timeout, clock), self._ending)
            if not offered:
                return False
        return True

    def _controllers(self) -> dict[str, str]:
        """States of the manager's controllers, by their names."""
        listing = self._service("list_controllers", ListControllers)().controller
        return {controller.name: controller.state for controller in listing}

    def _is_loaded(self, name: str) -> bool:
        return name in self._controllers()

    def _ask(
        self,
        name: str,
        kind: Any,
        request: Any,
        is_done: Callable[[], bool],
        waits: Callable[[], None] = lambda: None,
    ) -> bool:
        """Calls a service of the manager, and once more if the connection breaks while the manager goes on.
        Returns whether it was done, by either request."""
        service = self._service(name, kind)
        try:
            return bool(self._ending.call(service, request, waits).ok)
        except rospy.ServiceException as error:
            if not is_offered(self._prefix + name):
                raise
            rospy.logwarn("Controller Spawner: %s is asked again: %s", self._prefix + name, error)
        return bool(self._ending.call(service, request, waits).ok) or is_done()

    def load(self, names: Iterable[str]) -> None:
        for name in names:
            rospy.loginfo("Loading controller: %s", name)
            # Added before the answer, so that it is unloaded even after an exit in between.
            self.loaded.append(name)
            request = LoadControllerRequest(name)
            if not self._ask("load_controller", LoadController, request, partial(self._is_loaded, name)):
                self.loaded.remove(name)
                self._ending.sleep(PAUSE_AFTER_FAILED_LOAD)
                rospy.logerr("Failed to load %s", name)

    def start(self) -> None:
        request = SwitchControllerRequest(
            start_controllers=self.loaded, strictness=SwitchControllerRequest.STRICT
        )

        def all_run() -> bool:
            states = self._controllers()
            return all(states.get(name) == "running" for name in self.loaded)

        report = SwitchReport(self._prefix + "switch_controller")
        started = self._ask("switch_controller", SwitchController, request, all_run, report)
        names = ", ".join(self.loaded)
        if started:
            rospy.loginfo("Started controllers: %s", names)
        else:
            rospy.logerr("Failed to start controllers: %s", names)

    def take_away(self) -> None:
        """Stops and unloads the rest of the controllers; others may have done so already."""
        if not self.loaded:
            return
        rospy.loginfo("Shutting down spawner. Stopping and unloading controllers...")
        try:
            if not is_offered(self._prefix + "list_controllers"):
                rospy.loginfo("The controller manager has ended already: nothing to stop")
                return
            states = self._controllers()
            self._stop([name for name in self.loaded if states.get(name) == "running"])
            self._unload([name for name in reversed(self.loaded) if name in states])
        except (rospy.ServiceException, rospy.ROSException) as error:
            if self._manager_ends():
                rospy.loginfo("The controller manager has ended meanwhile, its controllers with it")
            else:
                rospy.logwarn("Controllers could not be taken away: %s", error)

    def _manager_ends(self) -> bool:
        end = time.monotonic() + END_OF_MANAGER
        while is_offered(self._prefix + "list_controllers"):
            if time.monotonic() > end:
                return False
            time.sleep(POLL_PERIOD)
        return True

    def _stop(self, names: list[str]) -> None:
        if not names:
            return
        response = self._service("switch_controller", SwitchController)(
            SwitchControllerRequest(
                stop_controllers=names,
                strictness=SwitchControllerRequest.STRICT,
                timeout=STOP_TIMEOUT,
            )
        )
        if response.ok:
            rospy.loginfo("Stopped controllers: %s", ", ".join(names))
        else:
            rospy.logwarn("Failed to stop controllers: %s", ", ".join(names))

    def _unload(self, names: Iterable[str]) -> None:
        unload_controller = self._service("unload_controller", UnloadController)
        for name in names:
            if unload_controller(name).ok:
                rospy.loginfo("Unloaded controller: %s", name)
            else:
                rospy.logwarn("Failed to unload controller: %s", name)


def spawn(options: argparse.Namespace, spawner: Spawner, ending: Ending) -> None:
    """Loads and starts. Raises Ended or SpawnerError."""
    with contextlib.closing(SimulatedClock()) as clock:
        if not spawner.wait_for_manager(options.timeout, clock):
            raise SpawnerError(
                "Controller Spawner couldn't find the expected controller_manager ROS interface."
            )
    if options.wait_for:
        wait_for_true(options.wait_for, ending)
    spawner.load(controller_names(options.controllers))
    if not spawner.loaded:
        raise SpawnerError("no controller could be loaded; the controller manager's log has the reason")
    if options.stopped:
        rospy.loginfo("Loaded controllers: %s", ", ".join(spawner.loaded))
    else:
        spawner.start()
    while True:
        ending.sleep(POLL_PERIOD)


def main() -> int:
    """Runs until a request to exit. Returns the exit status."""
    options = parse_arguments(rospy.myargv()[1:])
    # Without ROS time: nothing here uses it. See SimulatedClock.
    rospy.init_node("spawner", anonymous=True, disable_signals=True, disable_rostime=True)
    if options.shutdown_timeout is not None:
        rospy.logwarn("--shutdown-timeout has no effect any more")
    ending = Ending()
    spawner = Spawner(options.namespace, ending)
    status = 0
    try:
        spawn(options, spawner, ending)
    except Ended:
        spawner.take_away()
    except SpawnerError as error:
        rospy.logerr("%s", error)
        status = 1
    except (rospy.ServiceException, rospy.ROSException) as error:
        rospy.logerr("Controller Spawner lost the controller manager: %s", error)
        status = 1
    ending.finish()
    return status
