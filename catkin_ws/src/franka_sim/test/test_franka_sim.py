# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_sim as a user calls it: its command line, and the control interface."""

import json
import os
import socket
import struct
import subprocess
from contextlib import contextmanager
from pathlib import Path

import pytest
from fci_wire import IDLE, JOINT_IMPEDANCE, JOINT_POSITION, LAYOUTS, REFLEX, Client
from pyfranka.franka_sim import FrankaSim, find_program
from pyfranka.sim import FR3, KINDS, Panda
from waiting import wait_for

ROBOTS = Path(__file__).resolve().parents[1] / "robots"


def run(*arguments):
    return subprocess.run([find_program(), *arguments], capture_output=True, text=True, timeout=60)


@contextmanager
def served(*robots, pace="realtime", world="", arguments=()):
    """Robots, and a function that sends the first one a line as it stands and returns the answer."""
    with FrankaSim(*robots, pace=pace, world=world, arguments=arguments) as server:
        with socket.create_connection((server.robot.address, 1340), timeout=60) as connection:
            stream = connection.makefile("rw", newline="\n")

            def send(text):
                stream.write(text + "\n")
                stream.flush()
                return stream.readline().rstrip("\n")

            yield send, server


def simulated(address, *arguments, kind="panda", **options):
    """The same for one robot with these words of the command line."""
    return served(KINDS[kind](address=address), arguments=arguments, **options)


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        (["--robot", "ur5"], "--robot: ur5 not in {panda,fr3}"),
        (["--robot", "panda", "--protocol", "10"], "a panda speaks 3 to 5"),
        (["--robot", "fr3", "--protocol", "5"], "a fr3 speaks 6 to 10"),
        (["--protocol", "x"], "a number from 3 to 10"),
        (["--pace", "0"], "a factor from"),
        (["--pace", "nan"], "a factor from"),
        (["--control-port", "70000"], "0 to 65535"),
        (["--linger", "-1"], "seconds from 0 to 60"),
        (["--pace", "lockstep", "--patience", "0"], "seconds from 0.01 to 86400, or forever"),
        (["--pace", "lockstep", "--patience", "for ever"], "or forever, not for ever."),
        (["--patience", "forever"], "needs --pace patient or --pace lockstep"),
        (["--pace", "patient", "--wait", "sleep"], "--wait: give auto, spin or block, not sleep."),
        (["--wait", "auto"], "needs --pace patient or --pace lockstep"),
        (["--base", "1,2"], "three numbers"),
        (["--base", "1,2,x"], "three numbers"),
        (["--hand", "claw"], "--hand: claw not in {gripper,vacuum,none}"),
        (["--robot", "panda", "--robot", "fr3"], "--ip 127.0.0.1: two robots have it"),
        (
            ["--robot", "panda", "--robot", "fr3", "--ip", "127.0.0.2"],
            "overlap; give them different positions",
        ),
        (
            "--arm-id a --robot fr3 --ip 127.0.22.9 --robot fr3 --base 0,1,0 --arm-id a".split(),
            "--arm-id a: two robots have it",
        ),
        (["--nonsense"], "not expected: --nonsense"),
        (["--friction", "on"], "--realism ideal,friction=on"),
        (["--realism", "x"], "--realism: realism 'x': 'x' is not known there."),
        (["--control-port", "1337"], "1337 to 1339 are those of robot, gripper and vacuum gripper"),
        (["--ip=robot.local"], "--ip: robot.local is not an IPv4 address"),
        (["--viewer=yes"], "--viewer: it takes no value"),
        (["--base", "1e11,0,0"], "give meters, 1000 at most"),
        (["--ip"], "--ip: 1 required"),
        (["--ready-fd", "2"], "--ready-fd: give a number from 3, not 2."),
        (["--ready-fd", "3.5"], "--ready-fd: 3.5 is not a whole number."),
        (["--ready-fd", "99"], "--ready-fd: descriptor 99 is not open for writing"),
        (["--urdf", str(ROBOTS / "panda.urdf"), "--arm-id", "nobody"], "nobody"),
    ],
)
def test_a_wrong_command_line_is_refused(arguments, sentence):
    result = run(*arguments)
    assert result.returncode == 2
    assert sentence in result.stderr


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        (["--viewer", "--ip", "127.0.22.11"], "There is no display"),
        (["--ip", "192.0.2.1"], "does not have that address"),
        (["--world", "nowhere.xml"], "There is no world 'nowhere.xml'"),
        (["--urdf", "/nowhere.urdf"], "Cannot read the file '/nowhere.urdf'"),
    ],
)
def test_impossible_configurations_are_reported(arguments, sentence, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    result = run(*arguments)
    assert result.returncode == 1
    assert sentence in result.stderr


@contextmanager
def started_with_pipe(*arguments):
    """franka_sim, and the end of the pipe for its line about itself."""
    ours, theirs = os.pipe()
    with open(ours, encoding="utf-8") as lines:
        with open(theirs, "wb"):
            words = [find_program(), f"--ready-fd={theirs}", *arguments]
            process = subprocess.Popen(words, pass_fds=[theirs], stderr=subprocess.PIPE, text=True)
        try:
            yield process, lines
        finally:
            process.terminate()
            process.communicate(timeout=60)


def test_robots_are_reported_to_the_program_that_starts_them():
    words = "--robot panda --ip 127.0.22.31".split()
    second = "--robot panda --ip 127.0.22.32 --base 0,1,0 --hand vacuum --control-port 1341".split()
    third = "--robot fr3 --ip 127.0.22.33 --base 0,2,0 --no-hand --control-port 0 --arm-id left".split()
    first = {
        "robot": "panda",
        "arm_id": "panda",
        "address": "127.0.22.31",
        "protocols": [3, 5],
        "ports": {"robot": 1337, "gripper": 1338, "control": 1340},
    }
    others = [
        {
            "robot": "panda",
            "arm_id": "panda_2",
            "address": "127.0.22.32",
            "protocols": [3, 5],
            "ports": {"robot": 1337, "vacuum_gripper": 1339, "control": 1341},
        },
        {
            "robot": "fr3",
            "arm_id": "left",
            "address": "127.0.22.33",
            "protocols": [6, 10],
            "ports": {"robot": 1337},
        },
    ]
    for arguments, robots in ((words, [first]), ([*words, *second, *third], [first, *others])):
        with started_with_pipe(*arguments) as (process, lines):
            assert [json.loads(line) for line in lines] == [{"robots": robots}]
            for robot in robots:
                for port in robot["ports"].values():
                    socket.create_connection((robot["address"], port), timeout=60).close()
        assert process.returncode == 0


def test_errors_are_reported_to_the_program_that_starts_it():
    with started_with_pipe("--ip", "127.0.22.34") as (_, first):
        assert first.readline()
        for arguments, sentence, status, in_use in (
            (["--ip", "127.0.22.34"], "Another simulated robot runs there", 1, True),
            (["--ip", "192.0.2.1"], "does not have that address", 1, False),
            (["--robot", "ur5"], "--robot: ur5 not in {panda,fr3}", 2, False),
        ):
            with started_with_pipe(*arguments) as (process, lines):
                (report,) = [json.loads(line) for line in lines]
                assert process.wait(60) == report["status"] == status
                assert sentence in report.pop("error") and report["address_in_use"] == in_use


def test_robots_are_served_if_nobody_reads_the_report():
    ours, theirs = os.pipe()
    os.close(ours)
    words = [find_program(), f"--ready-fd={theirs}", "--ip=127.0.22.35", "--pace=lockstep"]
    with subprocess.Popen(words, pass_fds=[theirs], stderr=subprocess.PIPE, text=True) as process:
        os.close(theirs)
        assert "nothing can be written to descriptor" in process.stderr.readline()
        with socket.create_connection(("127.0.22.35", 1340), timeout=60) as connection:
            connection.sendall(b"quit\n")
        assert process.wait(60) == 0


def test_robots_of_one_world_have_their_own_addresses_and_names():
    turned = Panda(base=(0.5, 1, 0, 1.5708))
    with served("panda", turned, FR3(base=(0, -1, 0)), pace="lockstep") as (send, server):
        heads = {}
        for name in ("panda", "panda_2", "fr3"):
            heads[name] = [float(word) for word in send(f"where {name}_link0").split()[1:]]
        assert heads["panda_2"] == pytest.approx([0.5, 1, 0])
        assert heads["fr3"] == pytest.approx([0, -1, 0])
        # The second one faces along y.
        hand = [float(word) for word in send("where panda_2_link7").split()[1:]]
        first = [float(word) for word in send("where panda_link7").split()[1:]]
        assert hand == pytest.approx([0.5 - first[1], 1 + first[0], first[2]], abs=2e-3)
        # A switch concerns one robot, the world all.
        second, third = server["panda_2"].remote, server["fr3"].remote
        second.set_user_stop(True)
        assert second.state().mode == "User stopped"
        assert send("state").startswith("ok Idle")
        assert third.state().mode == "Idle"
        third.reset()
        third.quit()
        assert server.process.wait(60) == 0


def test_a_vacuum_gripper_replaces_the_gripper():
    with simulated("127.0.22.10", "--hand", "vacuum") as (send, _):
        for port, served in ((1337, True), (1338, False), (1339, True)):
            with socket.socket() as probe:
                probe.settimeout(60)
                assert (probe.connect_ex(("127.0.22.10", port)) == 0) == served
        assert send("part on") == "ok"


FEATHER = """<mujoco><worldbody><body name="feather" pos="5 5 5"><freejoint/>
  <inertial pos="0 0 0" mass="1e-7" diaginertia="1e-7 1e-7 1e-7"/><geom type="sphere" size="0.01"/></body>
</worldbody></mujoco>"""


def test_models_are_found_in_folders_that_ros_packages_export(tmp_path, monkeypatch):
    package = tmp_path / "my packages" / "pebbles"
    model = package / "my models" / "pebble"
    model.mkdir(parents=True)
    (package / "package.xml").write_text(
        "<package format='2'><name>pebbles</name><version>1.0.0</version><description>d</description>"
        "<maintainer email='a@b.org'>a</maintainer><license>none</license>"
        "<exec_depend>gazebo_ros</exec_depend>"
        "<export><gazebo_ros gazebo_model_path='${prefix}/my models'/></export></package>"
    )
    (package / "pebble.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    )
    (model / "model.config").write_text(
        "<model><name>pebble</name><version>1.0</version><sdf version='1.6'>model.sdf</sdf></model>"
    )
    (model / "model.sdf").write_text(
        "<sdf version='1.6'><model name='pebble'><static>true</static><link name='link'><visual name='v'>"
        "<geometry><mesh><uri>package://pebbles/pebble.obj</uri></mesh></geometry></visual></link>"
        "</model></sdf>"
    )
    world = tmp_path / "beach.sdf"
    world.write_text(
        "<sdf version='1.6'><world name='beach'>"
        "<include><uri>model://pebble</uri><pose>3 0 1 0 0 0</pose></include></world></sdf>"
    )
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"{package.parent}:{os.environ['ROS_PACKAGE_PATH']}")
    with simulated("127.0.22.23", "--pace=lockstep", "--world", str(world)) as (send, _):
        assert send("where pebble").startswith("ok 3 0 1")


def test_a_diverging_world_stops_is_reported_and_can_be_reset(tmp_path):
    world = tmp_path / "feather.xml"
    world.write_text(FEATHER)
    with simulated("127.0.22.14", "--world", str(world)) as (send, server):
        with Client("127.0.22.14", 5) as client:
            client.connect()
            assert send("push feather 1e4 0 0 10") == "ok"
            wait_for(lambda: "The physics diverged" in send("state"), "An error")
            assert send("state").startswith("ok Other"), "brakes are closed: nothing can be commanded"
            assert send("place feather 0 0 1").startswith("error: The physics diverged")
            client.state()
            assert send("reset") == "ok"
            assert send("state").startswith("ok Idle, client of protocol 5, errors none")
            client.state()
    assert "franka_sim: The physics diverged: the acceleration of body 'feather'" in server.log()


def test_a_robot_that_starts_inside_a_body_is_reported():
    page = (ROBOTS.parents[3] / "docs" / "franka_sim.md").read_text()
    example = next(line.split() for line in page.splitlines() if line.startswith("franka_sim --robot"))
    assert "stone.xml" in example
    for base, within in (([], False), (["--base=0,0,0"], True)):
        with simulated("127.0.22.15", *example[3:], *base, kind=example[2]) as (_, server):
            pass
        assert ("begins within other bodies" in server.log()) == within


@pytest.mark.parametrize("kind, protocol", [("panda", 5), ("fr3", 10)])
def test_the_first_state_after_a_recovery_is_idle(kind, protocol):
    layout = LAYOUTS[protocol]
    with simulated("127.0.22.20", kind=kind), Client("127.0.22.20", protocol) as client:
        assert client.connect() == (0, protocol)
        for _ in range(2):
            client.start(JOINT_IMPEDANCE, JOINT_POSITION)  # and no command follows
            client.state_until(lambda state: state.mode == REFLEX)
            assert client.reply()[1][0] == layout.reflex, "the motion was aborted"
            client.request(layout.recovery)
            assert client.reply()[1][0] == 0
            # Whatever waits in the socket now was sent before the answer came.
            assert client.newest_state().mode == IDLE


@pytest.mark.parametrize(("kind", "pace"), [("panda", "realtime"), ("fr3", "lockstep"), ("fr3", "0.5")])
def test_the_initial_width_of_a_hand_is_the_same_at_any_pace(kind, pace):
    with simulated("127.0.22.21", "--pace", pace, kind=kind):
        # Gripper protocol: Connect [u16 version, u16 port]; states are 23 bytes, the width behind the id.
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as states:
            states.bind(("", 0))
            states.settimeout(60)
            with socket.create_connection(("127.0.22.21", 1338), timeout=60) as hand:
                hand.sendall(struct.pack("<HIIHH", 0, 1, 14, 3, states.getsockname()[1]))
                for _ in range(3):
                    data = states.recv(100)
                    assert struct.unpack_from("<d", data, 4)[0] == pytest.approx(0.002, abs=1e-5)


@pytest.mark.parametrize("pace", ["lockstep", "0.5"])
def test_franka_info_ignores_lateness_of_a_robot_with_another_pace(pace):
    info = Path(find_program()).with_name("franka_info")
    with simulated("127.0.22.22", "--pace", pace):
        result = subprocess.run([str(info), "127.0.22.22", "0.5"], capture_output=True, text=True, timeout=60)
    assert "of the clock's: a simulated robot" in result.stdout
    assert "states come late" not in result.stdout
    lost = "states are lost" in result.stdout  # as happens to a client on a busy machine
    assert ("Verdict         ready to be controlled" in result.stdout) == (not lost)
    assert result.returncode == lost


# Answers of the system, whatever the user may do.
SCHEDULER = """#include <errno.h>
#include <stdlib.h>
int sched_setscheduler(int pid, int policy, const void* parameters) {
  errno = EPERM;
  return getenv("DENY_PRIORITY") ? -1 : 0;
}
int mlockall(int flags) { errno = ENOMEM; return -1; }
"""


@pytest.mark.parametrize(
    ("denied", "words"), [("priority", ("SCHED_FIFO", "rtprio")), ("memory", ("mlockall", "memlock"))]
)
def test_denied_real_time_resources_are_reported(denied, words, tmp_path, monkeypatch):
    source, library = tmp_path / "scheduler.c", tmp_path / "scheduler.so"
    source.write_text(SCHEDULER)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source], check=True)
    monkeypatch.setenv("LD_PRELOAD", f"{os.environ.get('LD_PRELOAD', '')}:{library}")
    if denied == "priority":
        monkeypatch.setenv("DENY_PRIORITY", "1")
    with FrankaSim("panda", pace="realtime") as server:
        wait_for(lambda: words[0] in server.log(), "The sentence")
        sentences = [line for line in server.log().splitlines() if "limits.conf" in line]
        assert len(sentences) == 1 and all(word in sentences[0] for word in words), server.log()


@pytest.fixture
def lingering():
    """Starts a robot with a client, signals it to exit, and returns both."""
    servers = []

    def begin(seconds):
        servers.append(FrankaSim("panda", pace="realtime", linger=seconds))
        client = Client(servers[-1].robot.address, 5)
        assert client.connect() == (0, 5)
        servers[-1].process.terminate()
        return servers[-1].process, client

    yield begin
    for server in servers:
        server.kill()


def test_exit_waits_for_clients(lingering):
    process, client = lingering(30)
    with client:
        for _ in range(500):
            client.state()
        assert process.poll() is None
    assert process.wait(60) == 0


def test_exit_drops_clients_after_the_linger_time(lingering):
    process, client = lingering(0.3)
    with client:
        assert process.wait(60) == 0
        assert client.ended()
