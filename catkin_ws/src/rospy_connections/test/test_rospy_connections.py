# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Orders of events that lose a publisher or a message in rospy, but not after init_node()."""

import socket
import threading
from collections import defaultdict

import pytest
import rospy
import rospy_connections
from rospy.impl import registration, tcpros_pubsub
from rospy.impl.registration import RegManager
from rospy.impl.tcpros_pubsub import TCPROSHandler
from rospy.impl.transport import INBOUND, Transport
from rospy.topics import _PublisherImpl, _SubscriberImpl
from std_msgs.msg import String
from waiting import holds

TOPIC, PUBLISHER, OTHER = "/grasp/result", "http://hand:1", "http://hand:2"
LAST = "/last"  # rospy reads the oldest update last


class Handler:
    """Replaces the node: records connections by topic, and ends after `connections`."""

    def __init__(self):
        self.connected = defaultdict(list)
        self.done = False
        self.changed = threading.Condition()

    def _connect_topic(self, topic, uri):
        with self.changed:
            self.connected[topic].append(uri)
            self.changed.notify_all()
        return 1, "connected", 0


def connections(*updates: list[str], expected: int) -> set:
    """Connections of a node that gets updates about all these publishers before it reads one."""
    handler = Handler()
    manager = RegManager(handler)
    manager.publisher_update(LAST, [PUBLISHER])
    for uris in updates:
        manager.publisher_update(TOPIC, uris)
    thread = threading.Thread(target=manager.run)
    thread.start()
    with handler.changed:
        connected = handler.connected
        handler.changed.wait_for(lambda: connected[LAST] and len(connected[TOPIC]) >= expected, timeout=60.0)
    handler.done = True
    thread.join()
    return set(connected[TOPIC])


class Connection(Transport):
    """To PUBLISHER, which refuses it because it has just ended; meanwhile `comes_back` is called."""

    socket = protocol = None

    def __init__(self, comes_back):
        super().__init__(INBOUND)
        self.endpoint_id = PUBLISHER
        self.comes_back = comes_back
        self.ends = socket.socketpair()

    def fileno(self):
        return self.ends[0].fileno()

    def connect(self, *_, **__):
        self.comes_back()
        raise rospy.exceptions.TransportInitError


def connects_to_what_came_back(monkeypatch) -> bool:
    """Whether a publisher that was announced again before its old connection was given up is connected."""
    topic, handler = _SubscriberImpl(TOPIC, String), Handler()
    monkeypatch.setattr(registration.get_topic_manager(), "get_subscriber_impl", lambda _: topic)
    connect, read, connected = handler._connect_topic, threading.Event(), threading.Event()

    def connect_topic(name, uri):
        if name == TOPIC:
            (read if topic.has_connection(uri) else connected).set()
        return connect(name, uri)

    handler._connect_topic = connect_topic
    manager = RegManager(handler)
    thread = threading.Thread(target=manager.run)
    thread.start()

    def comes_back():
        manager.publisher_update(TOPIC, [PUBLISHER])
        assert read.wait(timeout=60.0)

    connection = Connection(comes_back)
    assert topic.add_connection(connection)
    tcpros_pubsub.robust_connect_subscriber(connection, "", 0, PUBLISHER, None, TOPIC)
    found = connected.wait(timeout=2.0)
    handler.done = True
    thread.join()
    return found


@pytest.fixture
def mended(monkeypatch):
    monkeypatch.setattr(tcpros_pubsub, "robust_connect_subscriber", tcpros_pubsub.robust_connect_subscriber)
    monkeypatch.setattr(RegManager, "publisher_update", RegManager.publisher_update)
    monkeypatch.setattr(TCPROSHandler, "topic_connection_handler", TCPROSHandler.topic_connection_handler)
    for function in (rospy.Rate.__init__, rospy.Timer.__init__):
        monkeypatch.setattr(function, "__defaults__", function.__defaults__)
    monkeypatch.setattr(rospy, "init_node", lambda *_: None)
    rospy_connections.init_node("any")


@pytest.fixture
def set_time(monkeypatch):
    """Sets the time [s] of a simulated clock."""
    monkeypatch.setattr(rospy.rostime, "_rostime_current", None)
    monkeypatch.setattr(rospy.rostime, "_rostime_initialized", True)
    return lambda seconds: rospy.rostime._set_rostime(rospy.Time.from_sec(seconds))


@pytest.mark.parametrize(
    "updates, expected",
    [
        ([[PUBLISHER], []], {PUBLISHER}),
        ([[], [PUBLISHER]], {PUBLISHER}),
        ([[PUBLISHER], [PUBLISHER]], {PUBLISHER}),
        ([[PUBLISHER, OTHER], [OTHER]], {PUBLISHER, OTHER}),
        ([[PUBLISHER], [], [OTHER], []], {PUBLISHER, OTHER}),
        ([[], []], set()),
    ],
)
def test_no_publisher_is_lost(mended, updates, expected):
    assert connections(*updates, expected=len(expected)) == expected


def test_a_publisher_that_comes_back_is_connected_again(mended, monkeypatch):
    assert connects_to_what_came_back(monkeypatch)


def can_publish_before_the_subscriber_is_added(monkeypatch) -> bool:
    """Whether another thread can publish after the subscriber got its confirmation, before it is added."""
    topic = _PublisherImpl(TOPIC, String)
    published = []

    def publish():
        if topic.publock.acquire(blocking=False):
            topic.publock.release()
            published.append(True)

    def add_connection(self, connection):
        thread = threading.Thread(target=publish)
        thread.start()
        thread.join()
        return real_add(self, connection)

    real_add = _PublisherImpl.add_connection
    monkeypatch.setattr(_PublisherImpl, "add_connection", add_connection)
    monkeypatch.setattr(registration.get_topic_manager(), "get_publisher_impl", lambda _: topic)
    server, client = socket.socketpair()
    header = {"topic": TOPIC, "md5sum": String._md5sum, "type": String._type, "callerid": "/any"}
    with server, client:
        assert TCPROSHandler().topic_connection_handler(server, ("127.0.0.1", 1), header) is None
        assert len(topic.connections) == 1
        assert topic.publock.acquire(blocking=False)  # free again
    return bool(published)


def test_publishing_waits_until_the_subscriber_is_added(mended, monkeypatch):
    assert not can_publish_before_the_subscriber_is_added(monkeypatch)


def test_timers_and_the_rates_in_them_continue_after_jumps(mended, set_time):
    set_time(1000.0)
    ticks = []
    timer = rospy.Timer(rospy.Duration(0.01), ticks.append)
    for start in (1000.0, 10.0, 5000.0, 0.5):
        ticks.clear()
        # Ends long before the time of the jump back.
        for step in range(10000):
            set_time(start + 0.01 * step)
            if holds(lambda: len(ticks) >= 5, patience=0.005):
                break
        assert len(ticks) >= 5, f"after a jump to {start} s"
    timer.shutdown()


def test_a_stopwatch_counts_no_jump(set_time):
    set_time(5.0)
    watch, laps = rospy_connections.Stopwatch(max_lap=1.0), []
    for seconds in (5.25, 6.0, 1000.0, 1000.5, 2.0, 2.5):
        set_time(seconds)
        laps.append(watch.lap())
    assert laps == [0.25, 0.75, 1.0, 0.5, 0.0, 0.5]


def test_init_node_passes_its_arguments_on(monkeypatch):
    monkeypatch.setattr(RegManager, "publisher_update", RegManager.publisher_update)
    monkeypatch.setattr(TCPROSHandler, "topic_connection_handler", TCPROSHandler.topic_connection_handler)
    monkeypatch.setattr(tcpros_pubsub, "robust_connect_subscriber", tcpros_pubsub.robust_connect_subscriber)
    calls = []
    monkeypatch.setattr(rospy, "init_node", lambda *arguments, **options: calls.append((arguments, options)))
    rospy_connections.init_node("name", anonymous=True)
    assert calls == [(("name",), {"anonymous": True})]
