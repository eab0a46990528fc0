# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_plot with a ROS master and with a window; python/test/test_plot.py tests everything else."""

import os
import signal
import subprocess
from contextlib import contextmanager

import pytest
from franka_msgs.msg import FrankaState
from ros_client import latest, launched
from screen import colors, virtual_screen, window_of
from std_msgs.msg import String
from waiting import wait_for

PATIENCE = 180.0  # [s] for what it shows or prints, on a busy machine
LAUNCH = """<launch>
  <param name="left/arm_id" value="left_fr3"/>
  <node name="states" pkg="rostopic" type="rostopic" output="screen"
    args="pub -r 50 /left/franka_states franka_msgs/FrankaState
      '{q: [0.1, 0.2, 0.3, -2, 0.5, 1.5, 0.7], robot_mode: 2}'"/>
  <node name="other" pkg="rostopic" type="rostopic" args="pub -r 1 /chatter std_msgs/String hello"/>
</launch>"""

pytestmark = pytest.mark.own_process


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plot")
    (folder / "states.launch").write_text(LAUNCH)
    with launched(str(folder / "states.launch"), log=folder / "launch.log") as running:
        latest("/left/franka_states", FrankaState, PATIENCE)
        latest("/chatter", String, PATIENCE)
        yield running


def run(session, *words):
    return session.run(*words, timeout=PATIENCE, check=False)


def test_a_topic_is_plotted(session, tmp_path):
    file = tmp_path / "a.svg"
    words = "/left/franka_states", "--seconds", "0.5", "-s", "q", "-o", str(file)
    assert run(session, "franka_plot", "topic", *words).returncode == 0
    text = file.read_text()
    assert "limits of an FR3" in text and "move" in text and "joint 7" in text


@pytest.mark.parametrize(
    "topic, sentence",
    [
        ("/right/franka_states", "No node publishes /right/franka_states. There are: /left/franka_states."),
        ("/chatter", "/chatter has messages of std_msgs/String, not franka_msgs/FrankaState."),
    ],
)
def test_a_wrong_topic_is_refused(session, tmp_path, topic, sentence):
    result = run(session, "franka_plot", "topic", topic, "-o", str(tmp_path / "a.png"))
    assert (result.returncode, result.stderr) == (1, f"franka_plot: {sentence}\n")


def test_without_a_master_it_prints_a_message(session, tmp_path):
    master = "ROS_MASTER_URI=http://127.0.0.1:9"
    result = run(session, "env", master, "franka_plot", "topic", "-o", str(tmp_path / "a.png"))
    assert result.returncode == 1 and "There is no ROS master" in result.stderr


@contextmanager
def window(picture, *words, environment=None):
    """A window of franka_plot, once it shows something; it ends by Ctrl-C and prints nothing."""
    with virtual_screen():
        variables = {**(environment or os.environ), "DISPLAY": os.environ["DISPLAY"]}
        command = ["franka_plot", *words]
        program = subprocess.Popen(command, env=variables, stderr=subprocess.PIPE, text=True)
        try:

            def is_drawn():
                assert program.poll() is None
                return window_of("franka_plot") and colors(picture) >= 50

            wait_for(is_drawn, "The window", PATIENCE, 0.1)
            yield program
            program.send_signal(signal.SIGINT)
            printed = program.communicate(timeout=PATIENCE)[1]
        finally:
            program.kill()
    assert (program.returncode, printed) == (0, "")


def test_a_window_follows_the_topic(session, tmp_path):
    words = ["topic", "/left/franka_states", "-s", "q,dq"]
    with window(tmp_path / "a.png", *words, environment=session.environment):
        pass
