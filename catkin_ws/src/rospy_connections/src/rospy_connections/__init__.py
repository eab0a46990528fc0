# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Functions of all our Python nodes: answer_help(), init_node(), and waits in ROS time, which may jump.

init_node() is for nodes that start at the same time as their publishers, and whose clock may jump.

A subscriber learns its publishers in two ways: from the master's answer when it registers, and from the
master's later updates. On a busy machine an update can overtake the answer. rospy then keeps only the last
message, which is the outdated answer, and the subscriber waits forever for a publisher that exists (seen: an
action client whose server started in the same few milliseconds; it reports "no server"). Connecting to a
publisher that has exited does no harm, so pending publishers are never removed.

A publisher that ends and comes back in the same node counts as connected until its old connection is seen
to end, and for ever if a connection was given up because the publisher had just ended. The subscriber ignores
the master's update meanwhile, and is never connected (seen: the action error_recovery of a robot that was
lost and connected again, in one of six runs with some twenty losses each). The end of a connection therefore
asks again for the publishers that the master has named last.

A publisher that gets a subscriber first confirms the connection to it and adds it to its subscribers
afterwards. A message that is published in between is lost for this subscriber (seen on a busy machine: the
result of an action whose client had just found the server). Publishing therefore waits until the subscriber
is added.

A clock jumps back when a simulation starts again, or a bag in a loop. By default that ends a rospy.Timer,
also that of an action server's status, and raises an exception in rospy.Rate.sleep(). After init_node() both
begin a new period. Use Stopwatch, wait() and wait_for_server() instead of comparing times: a jump neither
ends a timeout early nor prolongs it.
"""

import math
import sys
import threading
from typing import Any

import rospy
from rospy.impl import tcpros_pubsub
from rospy.impl.registration import RegManager, get_topic_manager
from rospy.impl.tcpros_pubsub import TCPROSHandler

MAX_LAP = 1.0  # [s] of ROS time between two looks at the clock; more is a jump
POLL = 0.05  # [s] between two looks
MAX_WAIT = 1.0  # [s] for a publisher that is blocked by another subscriber, which must not hold up all others

_publishers: dict[
    str, tuple[Any, list[str]]
] = {}  # by topic: the manager of its updates, and the last of them


def _publisher_update(self: Any, resolved_name: str, uris: list[str]) -> None:
    """RegManager.publisher_update that keeps the publishers of an earlier, unread update."""
    with self.cond:
        waiting = [uri for name, queued in self.updates if name == resolved_name for uri in queued]
        self.updates.append((resolved_name, list(dict.fromkeys([*uris, *waiting]))))
        _publishers[resolved_name] = self, uris
        self.cond.notify_all()


_rospys_connect = tcpros_pubsub.robust_connect_subscriber


def _robust_connect_subscriber(connection: Any, *arguments: Any) -> None:
    """tcpros_pubsub.robust_connect_subscriber, which returns when a connection has ended or was given up.
    Afterwards publishers without a connection get one."""
    _rospys_connect(connection, *arguments)
    name = arguments[-1]
    topic = get_topic_manager().get_subscriber_impl(name)
    if topic and name in _publishers:
        topic.remove_connection(connection)
        manager, uris = _publishers[name]
        with manager.cond:  # without a notification it is read after half a second, however often it happens
            manager.updates.append((name, uris))


_rospys_handler = TCPROSHandler.topic_connection_handler


def _topic_connection_handler(self: Any, sock: Any, client_addr: Any, header: dict[str, str]) -> Any:
    """TCPROSHandler.topic_connection_handler, during which nothing is published on the topic."""
    topic = get_topic_manager().get_publisher_impl(header.get("topic"))
    lock = topic and topic.publock
    locked = bool(lock) and lock.acquire(timeout=MAX_WAIT)
    try:
        return _rospys_handler(self, sock, client_addr, header)
    finally:
        if locked:
            lock.release()


def answer_help(command: str, text: str) -> None:
    """Prints a program's help and exits if it was started with -h or --help. Needs no master.

    `command` is the usage line, without "usage: ".
    """
    if {"-h", "--help"} & set(rospy.myargv(sys.argv)[1:]):
        print(f"usage: {command} [NAME:=VALUE]...\n\n{text.strip()}")
        sys.exit(0)


def init_node(*arguments: Any, **options: Any) -> None:
    """rospy.init_node(), after which subscribers find their publishers in any order of start, also again, and
    miss no message after that, and rates and timers continue when the clock jumps back."""
    rospy.Rate.__init__.__defaults__ = (True,)  # reset
    rospy.Timer.__init__.__defaults__ = (False, True)  # oneshot, reset
    RegManager.publisher_update = _publisher_update
    tcpros_pubsub.robust_connect_subscriber = _robust_connect_subscriber
    TCPROSHandler.topic_connection_handler = _topic_connection_handler
    rospy.init_node(*arguments, **options)


class Stopwatch:
    """Measures ROS time in laps. A jump of the clock counts as `max_lap` [s] at most, one backwards as 0."""

    def __init__(self, max_lap: float = MAX_LAP) -> None:
        self._max_lap = max_lap
        self._last: float = rospy.get_time()

    def lap(self) -> float:
        """Time since the last call, or since the start [s]."""
        last, self._last = self._last, rospy.get_time()
        return min(max(self._last - last, 0.0), self._max_lap)


def wait(event: threading.Event, timeout: float = math.inf) -> bool:
    """Waits for an event. Returns False after `timeout` [s] of ROS time, or if the node exits."""
    watch, passed = Stopwatch(), 0.0
    while not event.wait(POLL):
        passed += watch.lap()
        if passed >= timeout or rospy.is_shutdown():
            return False
    return True


def wait_for_server(client: Any, timeout: float) -> bool:
    """Waits for the server of an action client. Returns False after `timeout` [s] of ROS time, or if the node
    exits."""
    watch, passed = Stopwatch(), 0.0
    while not client.wait_for_server(rospy.Duration.from_sec(POLL)):
        passed += watch.lap()
        if passed >= timeout or rospy.is_shutdown():
            return False
    return True
