# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The program franka_desk: options, passwords, several robots, its end."""

import contextlib
import http.client
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from desk_robot import ScriptedRobot
from desk_server import basic, unverified
from pyfranka.desk import cli
from pyfranka.franka_sim import FrankaSim, find_program
from pyfranka.sim import FR3, Panda
from waiting import wait_for

COMMAND = [sys.executable, "-m", "pyfranka.desk"]
WORD = "the password"
DEADLINE = 60.0  # [s]
READY = re.compile(r"franka_desk: robot at \S+, port \d+: https://(\S+):(\d+)")
# An address of this process alone: nothing else can have its ports.
OWN_ADDRESS, FIRST_PORT = f"127.98.{os.getpid() >> 8 & 255}.{os.getpid() % 254 + 1}", 8443


@pytest.fixture
def environment(tmp_path):
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    environment.pop("FRANKA_DESK_PASSWORD", None)
    return environment


@contextlib.contextmanager
def program(environment, *arguments, **more):
    process = subprocess.Popen(
        [*COMMAND, *arguments],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        stdin=subprocess.PIPE,
        text=True,
        **more,
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


@contextlib.contextmanager
def child_program(environment, *arguments):
    """As franka_sim starts it: with the pipe for its addresses."""
    ours, theirs = os.pipe()
    with open(ours) as addresses, contextlib.ExitStack() as stack:
        with open(theirs, "w"):
            words = [*arguments, f"--child={theirs}"]
            process = stack.enter_context(program(environment, *words, pass_fds=[theirs]))
        yield process, addresses


def places(process, count):
    """@returns lines before the first place, and the places."""
    before, found = [], []
    while len(found) < count:
        line = process.stdout.readline()
        assert line, before
        match = READY.fullmatch(line.strip())
        if match:
            found.append((match[1], int(match[2])))
        else:
            before.append(line.strip())
    return before, found


def get(place, path, headers):
    connection = http.client.HTTPSConnection(*place, timeout=DEADLINE, context=unverified())
    connection.request("GET", path, headers=headers)
    response = connection.getresponse()
    body = response.read()
    connection.close()
    return response.status, body


KINDS = ("panda", "fr3")


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """The program for two robots, and its places. The password is in the environment. The policy of the
    scheduler is one that any user may choose, which is inherited like that of real time."""

    def control_a_robot():
        os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))

    folder = str(tmp_path_factory.mktemp("cache"))
    environment = {**os.environ, "XDG_CACHE_HOME": folder, "FRANKA_DESK_PASSWORD": WORD}
    with contextlib.ExitStack() as stack:
        robots = [stack.enter_context(ScriptedRobot(type=kind, arm_id=kind)) for kind in KINDS]
        words = [f"--robot=127.0.0.1:{robot.port}" for robot in robots]
        words += [f"--listen={OWN_ADDRESS}:{FIRST_PORT}", "--user=anna", "--option", "version=5.1.0"]
        process = stack.enter_context(program(environment, *words, preexec_fn=control_a_robot))
        before, found = places(process, len(KINDS))
        assert before == []
        yield process, found


def test_a_password_of_the_environment_is_not_shown(served):
    process, (place, _) = served
    assert get(place, "/admin/api/features", basic("anna", WORD))[0] == 200
    assert get(place, "/admin/api/features", basic("anna", ""))[0] == 401
    with open(f"/proc/{process.pid}/cmdline") as file:
        assert WORD not in file.read()


def test_it_does_not_keep_the_priority_of_the_program_that_starts_it(served):
    assert os.sched_getscheduler(served[0].pid) == os.SCHED_OTHER
    assert os.getpriority(os.PRIO_PROCESS, served[0].pid) > 0


def test_each_robot_has_a_desk_of_its_own_and_its_paths_at_the_others(served):
    _, found = served
    assert found == [(OWN_ADDRESS, FIRST_PORT), (OWN_ADDRESS, FIRST_PORT + 1)]
    for number, kind in enumerate(KINDS):
        for place, prefix in ((found[number], ""), *((each, f"/robots/{number}") for each in found)):
            status, body = get(place, f"{prefix}/admin/api/robot/nameplate", basic("anna", WORD))
            assert status == 200 and json.loads(body)["armId"] == kind
    assert get(found[0], "/robots/2/admin/api/system-version", {})[0] == 404
    assert json.loads(get(found[0], "/admin/api/system-version", {})[1]).startswith("5.1.0\n")


def wait_for_control(place, password):
    """@returns a connection that waits for an answer."""
    connection = http.client.HTTPSConnection(*place, timeout=DEADLINE, context=unverified())
    request = "POST", "/api/system/control-token:take", b'{"owner": "me"}', basic("franka", password)
    connection.request(*request)
    assert connection.getresponse().read()
    connection.request(*request)
    return connection


def test_it_ends_on_request_and_each_time_has_a_new_password(environment):
    passwords = set()
    with ScriptedRobot(protocol=[6, 7]) as robot:
        words = [f"--robot=127.0.0.1:{robot.port}", "--listen=127.0.0.1:0", "--profile=fr3-v1"]
        for how in (signal.SIGTERM, signal.SIGINT, "end of input"):
            with child_program(environment, *words) as (process, addresses):
                (line,), (place,) = places(process, 1)
                assert addresses.read() == f"https://{place[0]}:{place[1]}\n"
                password = re.fullmatch(r"franka_desk: user franka, password (\S{12,})", line)[1]
                passwords.add(password)
                waiting = wait_for_control(place, password)
                if how == "end of input":
                    process.stdin.close()
                    process.stdin = None
                else:
                    process.send_signal(how)
                assert process.wait(DEADLINE) == 0, how
                waiting.close()
    assert len(passwords) == 3


@pytest.mark.parametrize(
    "argument",
    ["--option=boot-time=-1", "--listen=127.0.0.1:nowhere", "--robot=127.0.0.1:99999", "--user=a:b"],
)
def test_a_wrong_command_line_is_refused_with_a_sentence(argument, capfd):
    assert cli.main([argument]) == 2
    text = capfd.readouterr().err.strip()
    assert text.startswith("franka_desk: ") and text.endswith(".") and len(text.splitlines()) == 1


def test_a_port_in_use_is_an_error_with_a_sentence(environment):
    with ScriptedRobot() as robot:
        place = f"127.0.0.1:{robot.port}"
        command = [*COMMAND, f"--robot={place}", f"--listen={place}"]
        result = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=DEADLINE)
    assert result.returncode == 1
    assert str(robot.port) in result.stderr and "--listen" in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1


def test_desk_serves_before_its_robot_is_there(environment):
    with ScriptedRobot() as robot:
        port = robot.port
    with program(environment, f"--robot=127.0.0.1:{port}", "--listen=127.0.0.1:0") as process:
        _, (place,) = places(process, 1)
        status, body = get(place, "/api/system", {})
        assert status == 503 and str(port) in json.loads(body)["message"]


def test_franka_sim_starts_desk_with_its_password_and_ends_it(environment, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", environment["XDG_CACHE_HOME"])
    monkeypatch.setenv("FRANKA_DESK_PASSWORD", "not this one")
    robots = [FR3(base=[0, 0, 0]), Panda(base=[1, 1, 0])]
    with FrankaSim(*robots, desk=True, desk_user="anna", desk_password=WORD) as sim:
        found = READY.findall(sim.log())  # it is ready when Desk is
        assert WORD not in sim.log()
        assert [robot.desk for robot in sim.robots] == [f"https://{host}:{port}" for host, port in found]
        assert [address for address, _ in found] == [robot.address for robot in sim.robots]
        for (address, port), robot in zip(found, sim.robots, strict=True):
            body = get((address, int(port)), "/admin/api/robot/nameplate", basic("anna", WORD))[1]
            assert json.loads(body)["armId"] == robot.kind
            assert all(robot.remote.report().brakes)
    with pytest.raises(OSError):
        get((address, int(port)), "/admin/api/startup-phase", {})


def test_franka_sim_ends_if_desk_cannot_start():
    """Its robots would stay locked."""
    words = [find_program(), "--ip=127.0.62.1", "--desk=192.0.2.1:9443"]
    result = subprocess.run(words, capture_output=True, text=True, timeout=DEADLINE)
    assert result.returncode == 1
    assert "Desk cannot listen at 192.0.2.1, port 9443" in result.stderr
    assert "Desk has ended before it was ready (status 1)" in result.stderr.splitlines()[-1]


def test_franka_sim_goes_on_if_desk_fails_later(environment, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", environment["XDG_CACHE_HOME"])
    with FrankaSim("panda", desk=True, start="ready") as sim:
        (desk,) = Path(f"/proc/{sim.process.pid}/task/{sim.process.pid}/children").read_text().split()
        os.kill(int(desk), signal.SIGKILL)
        wait_for(lambda: "Desk has ended by itself (status 137)" in sim.log(), sim.log)
        assert sim.robot.remote.state().mode == "Idle"
