# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated robot on the network, with our client and with genuine ones."""

import json
import os
import subprocess
import time
from pathlib import Path

from fci_session import memory_of, simulated
from genuine_clients import folder_of
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import Panda
from report import executables, failures, figure, print_stalls
from stalls import Stalls

ZERO_TORQUES = """
import sys, time
if sys.argv[1] == "panda":
    from panda_py import libfranka
    robot, count, begin = libfranka.Robot(sys.argv[2]), 0, 0.0
    def callback(state, period):
        global count, begin
        count += 1
        begin = begin or time.monotonic()
        torques = libfranka.Torques([0.0] * 7)
        torques.motion_finished = count >= 10000
        return torques
    robot.control(callback, False)
else:
    import pylibfranka
    robot = pylibfranka.Robot(sys.argv[2], pylibfranka.RealtimeConfig.kIgnore)
    control, torques, begin = robot.start_torque_control(), pylibfranka.Torques([0.0] * 7), time.monotonic()
    for i in range(10000):
        control.readOnce()
        torques.motion_finished = i == 9999
        control.writeOnce(torques)
print(10.0 / (time.monotonic() - begin))
"""


def bench_client(address: str, seconds: float) -> dict[str, float]:
    """This project's C++ client, for a number of seconds of the robot's time."""
    program = executables()["client_of_franka_sim_bench"]
    result = subprocess.run(
        [str(program), address, str(seconds)], capture_output=True, text=True, timeout=600, check=True
    )
    figures: dict[str, float] = json.loads(result.stdout)
    return figures


def genuine_client(library: str, address: str) -> float | None:
    """Speed of a genuine Python client, in times real time; None if it is not installed."""
    python = folder_of(library) / "bin" / "python"
    if not python.exists():
        return None
    command = [str(python), "-c", ZERO_TORQUES, library, address]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    return float(result.stdout.split()[-1])


def fci() -> None:
    print("The simulated robot on the network (franka_sim)")
    for robot, library in (("panda", "panda"), ("fr3", "pylibfranka")):
        with simulated(robot, "lockstep") as sim:
            runs = [bench_client(sim.address, 20) for _ in range(3)]
            best = max(runs, key=lambda run: run["times_real_time"])
            title = f"{robot} in lock-step"
            figure(
                f"{title}: times real time, own C++ client", best["times_real_time"], "x", 60, at_least=True
            )
            figure(f"{title}: answer to next state, p50", best["p50_us"], "us")
            figure("two threads that only exchange such datagrams, p50", best["bare_p50_us"], "us")
            figure("the same, p99.9", best["bare_p999_us"], "us")
            goal = max(60, 1.2 * best["bare_p999_us"])
            figure(f"{title}: answer to next state, p99.9", best["p999_us"], "us", goal)
            speeds = [genuine_client(library, sim.address) for _ in range(3)]
            measured = [speed for speed in speeds if speed is not None]
            if measured:
                figure(f"{title}: times real time, {library}", max(measured), "x", 30, at_least=True)
            else:
                print(f"  {library} is not installed; ./franka test tests installs it")
            figure(f"{title}: resident memory", memory_of(sim.server.process.pid), "MB", 20)
    with simulated("panda", "realtime") as sim:
        figure("panda in real time: resident memory", memory_of(sim.server.process.pid), "MB", 40)
        title = "commands lost in 60 s at 1 kHz"
        with Stalls() as stalls:
            try:
                figure(title, bench_client(sim.address, 60)["lost"], "", 0)
            except subprocess.CalledProcessError as error:  # twenty lost in a row
                print(f"  {title}: {error.stderr.strip()}")
                failures.append(title)
        print_stalls(stalls)
    idle()


def idle() -> None:
    """Twenty robots in one process, in real time and without clients."""
    robots = [Panda(arguments=["--base", f"{2 * i},0,0"]) for i in range(20)]
    with FrankaSim(*robots, pace="realtime") as sim:
        time.sleep(2.0)  # MuJoCo and caches have settled
        before, begin = processor_seconds(sim.process.pid), time.monotonic()
        time.sleep(10.0)
        spent = (processor_seconds(sim.process.pid) - before) / (time.monotonic() - begin)
        figure("twenty idle robots in one process: share of a processor", 100 * spent, "%", 20)


def processor_seconds(pid: int) -> float:
    """The processor time that a process has taken [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
