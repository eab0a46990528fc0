# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Times of what a simulated Panda publishes: after steps, and as fast as possible."""

import random
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import rospy
from franka_msgs.msg import FrankaState
from franka_sim_mujoco.srv import RenderPicture, SetRealTimeFactor, Step
from geometry_msgs.msg import Point
from ros_client import Controllers, call, launched
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage
from waiting import wait_for

HERE = Path(__file__).resolve().parent
TICK = 0.001

pytestmark = pytest.mark.own_process("rate")
step = partial(call, "/gazebo/step", Step)


def header(message):
    return message.header.stamp


def link_1(message):
    """The controller publishes other frames."""
    return next((t.header.stamp for t in message.transforms if t.child_frame_id == "panda_link1"), None)


class Times:
    """The times of all messages of a topic [ticks]."""

    def __init__(self, topic, kind, stamp=header):
        self.topic, self.ticks = topic, []
        self.subscriber = rospy.Subscriber(topic, kind, lambda message: self._add(stamp(message)))
        wait_for(lambda: self.subscriber.get_num_connections() > 0, f"a publisher of {topic}")

    def _add(self, stamp):
        if stamp is not None:
            self.ticks.append(round(stamp.to_sec() / TICK))

    def wait_for(self, tick, what):
        wait_for(lambda: self.ticks and self.ticks[-1] >= tick, f"{what} of tick {tick}")


def wait_for_first_messages(topics):
    """Steps until each has one: roscpp answers a subscriber before it adds the connection, and a message in
    between is not sent to it."""
    wait_for(lambda: step(1).success and all(times.ticks for times in topics), "a message of each topic")


@pytest.fixture(scope="module", params=[30, 1000])
def rate(request, tmp_path_factory):
    """The rate of joint states of a paused simulation."""
    log = tmp_path_factory.mktemp("published_times") / "launch.log"
    with launched(str(HERE / "published_times.launch"), f"joint_state_rate:={request.param}", log=log):
        Controllers().wait_for("franka_state_controller")
        call("/gazebo/pause_physics", Empty)
        yield request.param


def test_a_step_ends_with_its_state_published(rate):
    seen = {
        "joint states": Times("/joint_states", JointState),
        "transforms": Times("/tf", TFMessage, link_1),
        "clock": Times("/clock", Clock, lambda message: message.clock),
    }
    wait_for_first_messages(seen.values())
    randoms = random.Random(1)
    for ticks in [1, 10, 33, 100] + [randoms.randint(1, 120) for _ in range(12)]:
        answer = step(ticks)
        assert answer.success, answer.error
        now = round(answer.time.to_sec() / TICK)
        for what, times in seen.items():
            times.wait_for(now, what)
            assert times.ticks[-1] == now, what
        view = {"position": Point(1, 1, 1), "target": Point(0, 0, 0.4), "width": 64, "height": 48}
        picture = call("/gazebo/render_picture", RenderPicture, **view)
        assert picture.image.header.stamp == answer.time
    for what in ("joint states", "transforms"):
        assert (np.diff(seen[what].ticks) > 0).all(), f"{what}: no time twice"


def test_each_message_that_is_due_is_published(rate):
    times = [
        (Times("/joint_states", JointState), rate),
        (Times("/tf", TFMessage, link_1), rate),
        (Times("/franka_state_controller/franka_states", FrankaState), 30),
    ]
    wait_for_first_messages([topic for topic, _ in times])
    # Faster than rospy takes them, subscribers lose messages: as fast as possible goes in pieces, after each
    # of which all have arrived, because a subscriber that gets no processor for a second misses 86,000 ticks.
    for factor in (0, 20) if rate < 1000 else (2,):
        assert call("/gazebo/set_real_time_factor", SetRealTimeFactor, factor).success
        begin = end = round(step(1).time.to_sec() / TICK)
        while end < begin + 5000:
            if factor == 0:
                step(1000)
            else:
                call("/gazebo/unpause_physics", Empty)
                times[0][0].wait_for(begin + 5000, "joint states")
                call("/gazebo/pause_physics", Empty)
            end = round(step(1).time.to_sec() / TICK)
            for each, frequency in times:
                each.wait_for(end - 1000 / frequency - 1, "messages")
        for each, frequency in times:
            ticks = np.array(sorted({tick for tick in each.ticks if begin <= tick <= end}))
            assert np.diff(ticks).max() <= np.ceil(1000 / frequency), (each.topic, factor)
