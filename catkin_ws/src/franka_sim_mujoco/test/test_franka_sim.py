# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_sim as a person meets it: its command line, and the control interface of one line a command."""

import socket
import subprocess
import time
from contextlib import contextmanager
from pathlib import Path

import pytest
from fci_session import program, start, stop
from fci_wire import Client

ROBOTS = Path(__file__).resolve().parents[1] / "robots"

WORLD = """<mujoco><worldbody>
  <light pos="0 0 3"/>
  <body name="stone" pos="0.6 0.4 0.05"><freejoint/><geom type="box" size="0.03 0.03 0.03" mass="0.1"/></body>
  <geom type="plane" size="2 2 0.1"/>
</worldbody></mujoco>"""


def run(*arguments):
    return subprocess.run([program(), *arguments], capture_output=True, text=True, timeout=30)


@contextmanager
def simulated(address, *arguments):
    """A robot, and a function that sends it a line and returns the answer."""
    process = start("--ip", address, *arguments)
    try:
        with socket.create_connection((address, 1340), timeout=20) as connection:
            stream = connection.makefile("rw", newline="\n")

            def say(text):
                stream.write(text + "\n")
                stream.flush()
                return stream.readline().rstrip("\n")

            yield say, process
    finally:
        stop(process)
        assert process.returncode == 0


def test_help_names_every_option():
    result = run("--help")
    assert result.returncode == 0
    for option in (
        "--robot",
        "--ip",
        "--protocol",
        "--pace",
        "--world",
        "--hand",
        "--linger",
        "--patience",
        "--viewer",
        "--control-port",
    ):
        assert option in result.stdout


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        (["--robot", "ur5"], "there are panda and fr3"),
        (["--robot", "panda", "--protocol", "10"], "a panda speaks 3 to 5"),
        (["--robot", "fr3", "--protocol", "5"], "a fr3 speaks 6 to 10"),
        (["--protocol", "x"], "a number from 3 to 10"),
        (["--pace", "0"], "a factor from"),
        (["--pace", "nan"], "a factor from"),
        (["--control-port", "70000"], "0 to 65535"),
        (["--linger", "-1"], "seconds from 0 to 60"),
        (["--pace", "lockstep", "--patience", "0"], "seconds from 0.01 to 86400, or forever"),
        (["--pace", "lockstep", "--patience", "nan"], "seconds from 0.01 to 86400, or forever"),
        (["--patience", "forever"], "only a robot that waits for its client has patience"),
        (["--base", "1,2"], "three numbers"),
        (["--base", "1,2,3,4,5"], "three numbers"),
        (["--base", "1,2,x"], "three numbers"),
        (["--hand", "claw"], "there are gripper, vacuum and none"),
        (["--robot", "panda", "--robot", "fr3"], "--ip 127.0.0.1: two robots have it"),
        (["--robot", "panda", "--robot", "fr3", "--ip", "127.0.0.2"], "stand within each other"),
        (
            "--arm-id a --robot fr3 --ip 127.0.22.9 --robot fr3 --base 0,1,0 --arm-id a".split(),
            "--arm-id a: two robots have it",
        ),
        (["--nonsense"], "no option"),
        (["--ip"], "needs a value"),
    ],
)
def test_a_wrong_command_line_is_refused_with_a_sentence(arguments, sentence):
    result = run(*arguments)
    assert result.returncode == 2
    assert sentence in result.stderr


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        (["--ip", "localhost"], "is not an IPv4 address"),
        (["--ip", "192.0.2.1"], "does not have that address"),
        (["--world", "nowhere.xml"], "There is no world 'nowhere.xml'"),
        (["--urdf", "/nowhere.urdf"], "Cannot read the file '/nowhere.urdf'"),
        (["--urdf", str(ROBOTS / "panda.urdf"), "--arm-id", "nobody"], "nobody"),
    ],
)
def test_what_cannot_be_is_said(arguments, sentence):
    result = run(*arguments)
    assert result.returncode == 1
    assert sentence in result.stderr


def test_two_robots_need_two_addresses():
    with simulated("127.0.22.1"):
        result = run("--ip", "127.0.22.1")
        assert result.returncode == 1
        assert "Another simulated robot runs there" in result.stderr
        with simulated("127.0.22.2", "--robot", "fr3") as (say, _):
            assert say("state").startswith("ok Idle")


@pytest.mark.parametrize("pace", ["lockstep", "realtime"])
def test_switches_of_the_robot(pace):
    with simulated("127.0.22.3", "--pace", pace) as (say, _):
        told, joints = say("state").split(", q ")
        assert told == "ok Idle, client of protocol 0, errors none"
        ready = [0, -0.7854, 0, -2.3562, 0, 1.5708, 0.7854]
        assert [float(word) for word in joints.split()] == pytest.approx(ready, abs=1e-4)
        assert say("user_stop on") == "ok"
        assert say("state").startswith("ok User stopped")
        assert say("user_stop off") == "ok"
        assert say("state").startswith("ok Idle")
        assert say("guiding on") == "ok"
        assert say("state").startswith("ok Guiding")
        assert say("guiding off") == "ok"
        assert say("brakes close") == "ok"
        assert say("state").startswith("ok Other")
        assert say("brakes open") == "ok"
        assert say("state").startswith("ok Idle")


def test_what_it_does_not_understand_it_says():
    with simulated("127.0.22.4") as (say, _):
        assert say("dance").startswith("error: There is no command 'dance'")
        assert say("user_stop") == "error: Words are missing: user_stop on|off."
        assert say("user_stop maybe") == "error: 'maybe' is neither on nor off."
        assert say("push") == "error: Words are missing: push BODY FX FY FZ MILLISECONDS."
        assert say("push nobody 1 0 0 10").startswith("error: ")
        assert say("push panda_hand nan 0 0 10") == "error: 'nan' is not a finite number."
        assert say("loss 2") == "error: The probability of a loss is a number from 0 to 1."
        assert say("delay 3") == "error: Commands are delayed by 0, 1 or 2 ticks."
        assert say("load -1 0 0 0").startswith("error: The load was refused")
        assert "push BODY" in say("help")
        assert say("load 0.5 0 0 0.1") == "ok"


def test_a_push_moves_the_held_arm_and_lets_it_come_back(tmp_path):
    world = tmp_path / "world.xml"
    world.write_text(WORLD)

    def joints(say):
        return [float(word) for word in say("state").split(", q ")[1].split()]

    with simulated("127.0.22.5", "--pace", "lockstep", "--world", str(world)) as (say, _):

        def until(condition):
            deadline = time.monotonic() + 20
            while not condition():
                assert time.monotonic() < deadline

        def displacement():
            return max(abs(a - b) for a, b in zip(joints(say), before))

        before = joints(say)
        assert say("place stone 0.5 -0.3 0.2") == "ok"
        # So long that it is seen: time runs flat out.
        assert say("push panda_hand 0 8 0 6000") == "ok"
        until(lambda: displacement() > 1e-4)
        until(lambda: displacement() < 1e-4)
        # It was let go in the air and lies on the ground.
        until(lambda: float(say("where stone").split()[3]) == pytest.approx(0.03, abs=2e-3))


def ask(address, line):
    with socket.create_connection((address, 1340), timeout=20) as connection:
        stream = connection.makefile("rw", newline="\n")
        stream.write(line + "\n")
        stream.flush()
        return stream.readline().rstrip("\n")


@pytest.mark.parametrize("pace", ["lockstep", "realtime"])
def test_robots_of_one_world_have_addresses_and_names_of_their_own(pace):
    arms = "--robot panda"
    arms += " --robot panda --ip 127.0.22.8 --base 0.5,1,0,1.5708"
    arms += " --robot fr3 --ip 127.0.22.9 --base 0,-1,0"
    with simulated("127.0.22.7", "--pace", pace, *arms.split()) as (say, process):
        heads = {}
        for name in ("panda", "panda_2", "fr3"):
            heads[name] = [float(word) for word in say(f"where {name}_link0").split()[1:]]
        assert heads["panda_2"] == pytest.approx([0.5, 1, 0])
        assert heads["fr3"] == pytest.approx([0, -1, 0])
        # The second one looks along y.
        hand = [float(word) for word in say("where panda_2_link7").split()[1:]]
        first = [float(word) for word in say("where panda_link7").split()[1:]]
        assert hand == pytest.approx([0.5 - first[1], 1 + first[0], first[2]], abs=2e-3)
        # A switch is one robot's, the world is everyone's.
        assert ask("127.0.22.8", "user_stop on") == "ok"
        assert ask("127.0.22.8", "state").startswith("ok User stopped")
        assert say("state").startswith("ok Idle")
        assert ask("127.0.22.9", "state").startswith("ok Idle")
        assert ask("127.0.22.9", "reset") == "ok"
        assert ask("127.0.22.9", "quit") == "ok"
        assert process.wait(10) == 0


def test_a_vacuum_gripper_takes_the_gripper_s_place():
    with simulated("127.0.22.10", "--hand", "vacuum") as (say, _):
        for port, served in ((1337, True), (1338, False), (1339, True)):
            with socket.socket() as probe:
                probe.settimeout(10)
                assert (probe.connect_ex(("127.0.22.10", port)) == 0) == served
        assert say("part on") == "ok"
        assert say("part perhaps") == "error: 'perhaps' is neither on nor off."
        assert say("pump red") == "ok"
        assert say("pump blue") == "error: 'blue' is none of green, yellow, orange and red."
    with simulated("127.0.22.10") as (say, _):
        assert say("part on").startswith("error: There is no command 'part'")


def test_quit_ends_it():
    with simulated("127.0.22.6") as (say, process):
        assert say("quit") == "ok"
        assert process.wait(10) == 0


@pytest.fixture
def lingering():
    """Starts a robot with a client, tells it to end, and returns both."""
    processes = []

    def begin(seconds):
        processes.append(start("--ip", "127.0.22.10", "--linger", str(seconds)))
        client = Client("127.0.22.10", 5)
        assert client.connect() == (0, 5)
        processes[-1].terminate()
        return processes[-1], client

    yield begin
    for process in processes:
        process.kill()
        process.wait()


def test_clients_may_go_first(lingering):
    process, client = lingering(30)
    with client:
        begin = time.monotonic()
        while time.monotonic() - begin < 0.5:
            client.state()
        assert process.poll() is None
    assert process.wait(10) == 0


def test_who_does_not_go_is_left_in_the_end(lingering):
    process, client = lingering(0.3)
    with client:
        assert process.wait(10) == 0
        assert client.ended()
