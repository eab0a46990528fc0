# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The fixtures of pyfranka.pytest_plugin in a project of a user, and FrankaSim below them."""

import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import page_output
import pyfranka
import pytest
from pyfranka.franka_sim import FrankaSim, FrankaSimError, find_program
from pyfranka.sim import FR3, Panda
from waiting import wait_for

pytest_plugins = ["pytester"]

OWN = "catkin_ws/src/franka_sim/robots/panda.urdf"
LIMIT = 300  # [s] for a session of a user, on a busy machine


@pytest.fixture
def project(pytester):
    """A user's project; run() is a session of pytest in it."""
    pytester.makeini("[pytest]\naddopts = -p pyfranka.pytest_plugin -p no:cacheprovider\n")
    return pytester


def run(project, test, *arguments):
    project.makepyfile(test)
    return project.runpytest_inprocess("-q", *arguments)


def robots_alive(address):
    """Whether something listens where the robot was."""
    with socket.socket() as probe:
        probe.settimeout(60)
        return probe.connect_ex((address, 1337)) == 0


# ---- fixtures --------------------------------------------------------------------------------------------


def test_a_users_tests_get_robots_of_their_own(project):
    result = run(
        project,
        """
        import pyfranka
        import pytest
        from pyfranka.sim import FR3, Panda

        def test_robots(panda, fr3):
            assert panda.address != fr3.address
            assert (panda.kind, fr3.kind) == ("panda", "fr3")
            for robot, version in ((panda, 5), (fr3, 10)):
                connection = robot.connect()
                assert connection.server_version == version == robot.protocol
                assert connection.read_once().robot_mode == pyfranka.RobotMode.Idle
                assert robot.remote.state().protocol == version
                assert robot.gripper().read_once().width < 0.09
                before = robot.remote.wait() and robot.remote.time
                robot.remote.step(20)
                assert robot.remote.time == pytest.approx(before + 0.02), "lock-step"

        def test_several_in_one_world(franka_sim):
            left = FR3(name="left", base=(0, 1, 0, 1.57))
            sim = franka_sim(Panda(base=(-0.5, 0, 0)), Panda(base=(0, -1, 0)), left,
                             world="stone.xml", arguments=["--patience", "5"])
            assert [robot.name for robot in sim.robots] == ["panda", "panda_2", "left"]
            for robot in sim.robots:
                assert sim[robot.name] is robot
                assert robot.remote.body_position(robot.name + "_link0") is not None
            assert sim["left"].remote.body_position("left_link0") == pytest.approx([0, 1, 0])
            assert sim["panda"].remote.body_position("stone").shape == (3,)
            with pytest.raises(KeyError, match="There is no robot 'right'; there are: panda, panda_2, left"):
                sim["right"]

        def test_options(franka_sim):
            robot = franka_sim("fr3", name="me", realism="ideal", protocol=8, hand="none").robot
            assert robot.connect().server_version == 8
            assert robot.remote.body_position("me_link0") == pytest.approx([0, 0, 0])

        def test_robot_that_cannot_start_is_reported_with_its_message(franka_sim):
            with pytest.raises(ValueError, match="There is no robot 'ur5'; there are: panda, fr3"):
                franka_sim("ur5")
            with pytest.raises(RuntimeError, match="There is no world 'nowhere.xml'"):
                franka_sim(world="nowhere.xml")
            with pytest.raises(RuntimeError, match="--nonsense"):
                franka_sim(arguments=["--nonsense"])
        """,
    )
    result.assert_outcomes(passed=4)


def test_failed_test_shows_the_output_of_its_robot(project):
    result = run(
        project,
        """
        import pytest

        @pytest.fixture(scope="module")
        def shared(franka_sim_session):
            return franka_sim_session("fr3", name="shared").robot

        def complain(robot):
            robot.remote.place_body(f"{robot.name}_nothing", (0, 0, 0))

        def test_good(panda, shared):
            pass

        def test_bad(panda, shared):
            print("at", panda.address)
            complain(panda)

        def test_alone():
            assert False
        """,
    )
    result.assert_outcomes(passed=1, failed=2)
    text = result.stdout.str()
    address = re.search(r"^at (127\.\S+)$", text, re.MULTILINE)[1]
    bad, _, alone = text.partition("test_alone")
    assert f"franka_sim, panda at {address}" in bad
    assert f"A simulated panda waits for clients at {address}" in bad
    assert not robots_alive(address)
    # The robot of the whole module is named, but what it wrote before the test is not repeated.
    assert "franka_sim, shared at" in bad and "A simulated fr3 waits" not in bad
    assert "(it has written nothing)" in alone


def test_a_robot_that_dies_is_reported_with_its_end(project):
    result = run(
        project,
        """
        import os, signal
        import pyfranka
        import pytest

        def test_dies(panda):
            robot = panda.connect()
            def callback(state, period):
                os.kill(panda.server.process.pid, signal.SIGSEGV)
                return pyfranka.Torques([0.0] * 7)
            robot.control_torques(callback)

        def test_unnoticed(fr3):
            os.kill(fr3.server.process.pid, signal.SIGKILL)
            fr3.server.process.wait()

        def test_on_purpose(panda):
            panda.server.kill()

        def test_quits(panda):
            panda.remote.quit()
        """,
    )
    result.assert_outcomes(passed=3, failed=1, errors=2)
    text = result.stdout.str()
    assert "NetworkException" in text and "franka_sim has ended by signal SIGSEGV." in text
    assert "franka_sim has ended by signal SIGKILL. It ended by itself; its last lines:" in text


def test_options_of_a_session(project):
    test = """
        def test_pace(panda):
            print(panda.server.process.args)
            panda.remote.time
        """
    for pace, *arguments in (
        ("lockstep",),
        ("realtime", "--franka-sim-pace=realtime"),
        ("patient", "-o", "franka_sim_pace=patient"),
    ):
        result = run(project, test, "-s", *arguments)
        result.assert_outcomes(passed=1)
        assert f"--pace={pace}" in result.stdout.str()
    result = run(project, test, "--franka-sim-program=/nowhere/franka_sim")
    result.assert_outcomes(errors=1)
    assert "There is no program '/nowhere/franka_sim'." in result.stdout.str()


def test_short_names_of_fixtures_can_be_left_to_the_project(project):
    test = """
        import pytest

        def test_name(franka_panda, franka_fr3{more}):
            assert (franka_panda.kind, franka_fr3.kind, franka_panda.name) == ("panda", "fr3", "panda")
        """
    run(project, test.format(more=", panda")).assert_outcomes(passed=1)
    run(project, test.format(more=""), "-o", "franka_short_fixtures=false").assert_outcomes(passed=1)
    result = run(project, test.format(more=", panda"), "-o", "franka_short_fixtures=false")
    result.assert_outcomes(errors=1)
    assert "fixture 'panda' not found" in result.stdout.str()


def test_a_session_without_our_fixtures_loads_nothing_but_the_plugin(project):
    project.makepyfile(
        """
        import sys

        def test_nothing():
            ours = {name for name in sys.modules if "pyfranka" in name}
            assert ours == {"pyfranka", "pyfranka.pytest_plugin"} and "numpy" not in sys.modules

        def test_fails():
            assert False
        """
    )
    result = project.runpytest_subprocess("-q")
    result.assert_outcomes(passed=1, failed=1)


def test_paths_may_be_like_paths(tmp_path):
    class Place:
        def __init__(self, place):
            self.place = place

        def __fspath__(self):
            return str(self.place)

    program = find_program()
    for given in (program, Path(program), Place(program)):
        assert find_program(given) == program and type(find_program(given)) is str
    own = tmp_path / "own.urdf"
    own.write_text((Path(__file__).resolve().parents[2] / OWN).read_text())
    inertia = np.diag([1e-3, 2e-3, 3e-3])
    robot = Panda(base=(-0.5, 0, 0), urdf=Place(own), load=(0.3, (0, 0, 0.05), inertia))
    with FrankaSim(robot, world=Place("stone.xml"), program=Place(program)) as sim:
        assert sim.robot.remote.body_position("stone").shape == (3,)
        state = sim.robot.connect().read_once()
        assert state.m_load == pytest.approx(0.3) and state.I_load == pytest.approx(inertia)
    with FrankaSim(Panda(hand=False)) as sim, pytest.raises(pyfranka.NetworkException):
        sim.robot.gripper()


def test_the_fixture_takes_the_arguments_of_franka_sim_and_of_a_robot(franka_sim):
    sim = franka_sim("fr3", name="left", patience="forever", start="locked", desk=True)
    assert sim.robot.name == "left" and sim.robot.desk.startswith("https://")
    assert not sim.robot.remote.report().brakes_open
    with pytest.raises(TypeError, match="'hue'"):
        franka_sim("fr3", hue=5)


def test_the_examples_of_the_documentation_work(project, capsys):
    tests, alone = page_output.examples("python.md", "## Tests of your own project")
    result = run(project, tests.code)
    result.assert_outcomes(passed=2)
    capsys.readouterr()
    alone.run()
    alone.check(capsys.readouterr().out)


# ---- several sessions, and ends of sessions --------------------------------------------------------------


def test_two_sessions_beside_each_other(project):
    project.makepyfile(
        """
        import pyfranka
        import pytest

        @pytest.mark.parametrize("run", range(3))
        def test_moves(panda, fr3, run):
            for robot in (panda, fr3):
                print("at", robot.address)
                count = [0]
                def callback(state, period):
                    count[0] += 1
                    torques = pyfranka.Torques([0.0] * 7)
                    return pyfranka.motion_finished(torques) if count[0] == 200 else torques
                robot.connect().control_torques(callback)
        """
    )
    command = [sys.executable, "-m", "pytest", "-q", "-s", "-p", "pyfranka.pytest_plugin"]
    sessions = [
        subprocess.Popen(command, cwd=project.path, stdout=subprocess.PIPE, text=True) for _ in range(2)
    ]
    seen = []
    for session in sessions:
        text, _ = session.communicate(timeout=LIMIT)
        assert session.returncode == 0, text
        seen += re.findall(r"at (127\.\S+)", text)
    assert len(set(seen)) == len(seen) == 12


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_robot_outlives_its_session(project, end):
    project.makepyfile(
        """
        import signal

        def test_waits(panda):
            print("at", panda.address, flush=True)
            signal.pause()
        """
    )
    command = [sys.executable, "-m", "pytest", "-q", "-s", "-p", "pyfranka.pytest_plugin"]
    with subprocess.Popen(command, cwd=project.path, stdout=subprocess.PIPE, text=True) as session:
        try:
            lines = iter(session.stdout.readline, "")
            address = next(line.split()[-1] for line in lines if "at 127." in line)
            assert robots_alive(address)
            session.send_signal(end)
            session.wait(60)
        finally:
            session.kill()
    wait_for(lambda: not robots_alive(address), f"The end of the robot at {address}")


# ---- FrankaSim -------------------------------------------------------------------------------------------


def test_addresses_are_reserved_while_their_robots_run():
    """Not even a process that does not look takes an address in the meantime."""
    with FrankaSim("panda") as sim:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other, pytest.raises(OSError):
            other.bind((sim.robot.address, 1340))
        with pytest.raises(FrankaSimError, match="Another simulated robot runs there"):
            FrankaSim(Panda(address=sim.robot.address))
        address = sim.robot.address
    with FrankaSim(FR3(address=address)) as sim:
        assert sim.robot.address == address


def test_an_address_that_another_program_uses_is_left_to_it(monkeypatch):
    """A robot that was not started here has no reservation: the next address is tried."""
    with FrankaSim(Panda(address="127.64.0.9")) as first:
        numbers = iter([8, 8, 9])
        monkeypatch.setattr("pyfranka.franka_sim.secrets.randbelow", lambda most: next(numbers))
        with FrankaSim("panda") as second:
            assert (first.robot.address, second.robot.address) == ("127.64.0.9", "127.64.0.10")


def test_a_context_ends_its_robot_and_keeps_its_log():
    with FrankaSim("panda", pace="realtime") as sim:
        assert sim.robot.connect().read_once().robot_mode == pyfranka.RobotMode.Idle
        assert sim.status() == ""
    assert sim.process.returncode == 0 and sim.stopped
    assert "waits for clients" in sim.log()
    sim.stop()
    sim.kill()


def test_a_robot_that_does_not_end_is_killed_and_reported(monkeypatch):
    monkeypatch.setattr("pyfranka.franka_sim.TO_END", 0.3)
    sim = FrankaSim("panda")
    sim.process.send_signal(signal.SIGSTOP)
    with pytest.raises(FrankaSimError, match="by signal SIGKILL. It ended on request"):
        sim.stop()
    assert sim.process.poll() is not None


def test_program_that_never_reports_ready_is_ended(tmp_path, monkeypatch):
    program, begun = tmp_path / "franka_sim", tmp_path / "begun"
    program.write_text(f"#!/bin/sh\necho $$ >{tmp_path}/pid\necho thinking\ntouch {begun}\nexec sleep 3000\n")
    program.chmod(0o755)
    # The limit passes once the program has begun.
    clock = SimpleNamespace(sleep=time.sleep, monotonic=lambda: time.monotonic() + 100 * begun.exists())
    monkeypatch.setattr("pyfranka.franka_sim.time", clock)
    with pytest.raises(FrankaSimError, match="thinking\nfranka_sim was not ready within 60 s"):
        FrankaSim("panda", program=str(program))
    with pytest.raises(ProcessLookupError):
        os.kill(int((tmp_path / "pid").read_text()), 0)


def test_a_robot_that_a_thread_starts_outlives_the_thread():
    started = []
    thread = threading.Thread(target=lambda: started.append(FrankaSim("panda")))
    thread.start()
    thread.join(LIMIT)
    with started[0] as sim:
        assert sim.robot.remote.state().mode == "Idle"


FORK = """
import os, sys
from pyfranka.franka_sim import FrankaSim
sim = FrankaSim("panda")
if os.fork() == 0:
    sys.exit()
os.wait()
print(sim.robot.remote.state().mode, sim.robot.address)
"""


def test_a_robot_outlives_a_fork_but_not_its_program():
    done = subprocess.run([sys.executable, "-c", FORK], capture_output=True, text=True, timeout=LIMIT)
    assert done.stdout.startswith("Idle "), done.stderr
    assert not robots_alive(done.stdout.split()[1])


def test_the_program_is_found_in_the_workspace_then_on_path(tmp_path, monkeypatch):
    program = tmp_path / "bin" / "franka_sim"
    program.parent.mkdir()
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(program.parent))
    assert find_program() != str(program), "The workspace's comes first."
    monkeypatch.setenv("CMAKE_PREFIX_PATH", "")
    assert find_program() == str(program)
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(FrankaSimError, match="There is no franka_sim in this workspace"):
        find_program()
    with pytest.raises(FrankaSimError, match="There is no program '/nowhere/x'"):
        find_program("/nowhere/x")
