#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the benchmarks; each prints its figure as a ratio to a reference measured in the same run.

`./franka bench` runs all, `./franka bench NAME...` some of: fci, micro, tick, memory, start. Exit status 1
when a figure misses its goal. Needs the built workspace's environment, which `./franka bench` provides.
"""

import json
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from franka_sim_mujoco.session import Session

TOP = Path(__file__).resolve().parent.parent
DEVEL = TOP / "catkin_ws" / "devel"
CONTROLLER = "cartesian_impedance_example_controller"

failures: list[str] = []


def figure(text: str, value: float, unit: str, goal: float | None = None, at_least: bool = False) -> None:
    """Prints one line, with the goal and whether it is met."""
    line = f"  {text:<66} {value:10.3f} {unit}"
    if goal is not None:
        met = value >= goal if at_least else value <= goal
        line += f"   (goal: at {'least' if at_least else 'most'} {goal:g}{'' if met else ', MISSED'})"
        if not met:
            failures.append(text)
    print(line, flush=True)


# ---- google-benchmark executables ------------------------------------------------------------------------


@dataclass
class Ratio:
    """`subject` over `reference`, both names of benchmarks of one executable."""

    executable: str
    subject: str
    reference: str
    goal: float | None = None  # of the ratio
    goal_ns: float | None = None  # of the subject's time


RATIOS = [
    Ratio("libfranka_arm_model_bench", "armModel", "kdlSolvers", goal_ns=3000),
    Ratio("franka_hw_bench", "frankaHwCycle", "emptyCycle", goal_ns=5000),
    Ratio("model_kdl_bench", "ModelKDL", "bare KDL solvers", goal=1.3),
    Ratio("control_unit_bench", "torqueControlTick", "modelAlone", goal_ns=15000),
    Ratio("control_unit_bench", "idleTick", "modelAlone", goal_ns=15000),
    Ratio("control_unit_bench", "jointImpedanceTick", "modelAlone", goal_ns=15000),
    Ratio("control_unit_bench", "cartesianImpedanceTick", "modelAlone", goal_ns=15000),
    Ratio("libfranka_client_bench", "cycle/5", "copies/5", goal_ns=2000),
    Ratio("libfranka_client_bench", "cycle/9", "copies/9", goal_ns=2000),
    Ratio("libfranka_client_bench", "cycle/10", "copies/10", goal_ns=2000),
    Ratio("physics_bench", "tickOfWorld/0", "bareSteps/0"),
    Ratio("physics_bench", "tickOfWorld/1", "bareSteps/1"),
    Ratio("controller_manager_update_bench", "managerUpdate/1", "virtualCalls/1"),
    Ratio("controller_manager_update_bench", "managerUpdate/10", "virtualCalls/10"),
    Ratio("controller_manager_update_bench", "managerUpdate/50", "virtualCalls/50"),
]


@dataclass
class Counter:
    """What a benchmark counts beside its time; `subtract` names one that counts the machine's own share."""

    executable: str
    benchmark: str
    name: str
    unit: str
    goal: float | None = None
    subtract: str | None = None


COUNTERS = [
    Counter("franka_hw_bench", "frankaHwCycle", "allocations", "", 0),
    Counter("franka_hw_bench", "switchToFirstCommand", "p50_ms", "ms"),
    Counter("libfranka_client_bench", "roundTrip/5", "p50_ratio", "x", 1.5),
    Counter("libfranka_client_bench", "roundTrip/5", "p999_us", "us", 300),
    Counter("libfranka_client_bench", "roundTrip/10", "p50_ratio", "x", 1.5),
    Counter("libfranka_client_bench", "roundTrip/10", "p999_us", "us", 300),
    Counter("realtime_publisher_bench", "publishTick", "cpu_percent", "%"),
    Counter(
        "realtime_publisher_bench", "publishTick", "cpu_percent", "% beyond a bare loop", 3.0, "bareLoop"
    ),
]


def executables() -> dict[str, Path]:
    return {path.name: path for path in DEVEL.glob("lib/*/*bench") if path.is_file()}


def micro() -> None:
    print("Parts, by google-benchmark (ratio to the reference in the same run)")
    found = executables()
    # The controller manager's benchmark keeps its controllers' parameters at a master.
    with tempfile.TemporaryDirectory() as folder, Session("--core", log=Path(folder) / "core.log") as core:
        core.wait_for_master()
        for name in dict.fromkeys(ratio.executable for ratio in RATIOS):
            if name not in found:
                failures.append(f"{name} is not built")
                print(f"  {name}: not built")
                continue
            times, _ = google_benchmark(found[name], core.environment)
            for ratio in (ratio for ratio in RATIOS if ratio.executable == name):
                print_ratio(ratio, times)
        for name in dict.fromkeys(counter.executable for counter in COUNTERS):
            if name not in found:
                failures.append(f"{name} is not built")
                continue
            _, counters = google_benchmark(found[name], core.environment)
            for counter in (counter for counter in COUNTERS if counter.executable == name):
                print_counter(counter, counters)


def print_counter(counter: Counter, counters: dict[str, dict[str, float]]) -> None:
    value = counters.get(counter.benchmark, {}).get(counter.name)
    if value is None:
        failures.append(f"{counter.executable}: no {counter.name} of {counter.benchmark}")
        return
    if counter.subtract:
        value -= counters[counter.subtract][counter.name]
    figure(f"{counter.executable}: {counter.benchmark} {counter.name}", value, counter.unit, counter.goal)


def print_ratio(ratio: Ratio, times: dict[str, float]) -> None:
    if ratio.subject not in times or ratio.reference not in times:
        failures.append(f"{ratio.executable}: no benchmark {ratio.subject} or {ratio.reference}")
        print(f"  {ratio.executable} has {', '.join(times)}")
        return
    subject, reference = times[ratio.subject], times[ratio.reference]
    figure(f"{ratio.executable}: {ratio.subject}", subject, "ns", ratio.goal_ns)
    figure(f"{ratio.executable}: {ratio.subject} / {ratio.reference}", subject / reference, "x", ratio.goal)


def google_benchmark(
    executable: Path, environment: dict[str, str]
) -> tuple[dict[str, float], dict[str, dict[str, float]]]:
    """Median CPU time of each benchmark [ns], and its counters."""
    unit = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        command = [str(executable), f"--benchmark_out={out.name}", "--benchmark_out_format=json"]
        command.append("--benchmark_repetitions=3")
        subprocess.run(command, capture_output=True, text=True, check=True, timeout=300, env=environment)
        entries = json.loads(Path(out.name).read_text())["benchmarks"]
    medians = [entry for entry in entries if entry.get("aggregate_name") == "median"]
    times, counters = {}, {}
    for entry in medians:
        name = entry["run_name"].split("/min_time")[0].split("/repeats")[0].split("/iterations")[0]
        times[name] = entry["cpu_time"] * unit[entry["time_unit"]]
        counters[name] = {key: value for key, value in entry.items() if isinstance(value, float)}
    return times, counters


# ---- the whole simulation --------------------------------------------------------------------------------


def simulation(folder: Path, world: str, *arguments: str) -> Session:
    return Session(
        "franka_sim_mujoco",
        "panda.launch",
        f"world:={world}",
        f"controller:={CONTROLLER}",
        "interactive_marker:=false",
        *arguments,
        log=folder / "launch.log",
    )


def wait_running(session: Session, timeout: float = 60.0) -> None:
    """Until the controller runs, as `controller_manager/list_controllers` says."""
    deadline = time.monotonic() + timeout
    while time.monotonic() < deadline:
        session.check()
        answer = session.run("rosservice", "call", "/controller_manager/list_controllers", check=False).stdout
        for block in answer.split("name: "):
            if block.strip('" \n').startswith(CONTROLLER) and "running" in block:
                return
    raise RuntimeError(f"{CONTROLLER} did not run within {timeout} s:\n{session.tail()}")


def call(session: Session, service: str, request: str) -> dict[str, float]:
    """Calls a service and reads the numbers of its answer."""
    text = session.run("rosservice", "call", service, request, timeout=300).stdout
    values = {}
    for line in text.splitlines():
        key, _, value = line.partition(":")
        try:
            values[key.strip()] = float(value)
        except ValueError:
            continue
    return values


def node_memory(session: Session) -> float:
    """Resident memory of the simulation's process [MB]."""
    port = f"ROS_MASTER_URI=http://localhost:{session.port}".encode()
    for status in Path("/proc").glob("[0-9]*/status"):
        try:
            command = (status.parent / "cmdline").read_bytes()
            if b"franka_sim_mujoco_node" in command and port in (status.parent / "environ").read_bytes():
                line = next(line for line in status.read_text().splitlines() if line.startswith("VmRSS"))
                return float(line.split()[1]) / 1024
        except (OSError, StopIteration):
            continue
    raise RuntimeError("the simulation's process was not found")


def tick() -> None:
    print("One tick of 1 ms: physics, control unit, hardware, controller manager, impedance controller")
    for title, world, goal in (
        ("arm, hand and controller", "empty.xml", 25),
        ("pick-and-place scene", "stone.xml", 12),
    ):
        with (
            tempfile.TemporaryDirectory() as folder,
            simulation(Path(folder), world, "x:=-0.5", "real_time_factor:=0") as session,
        ):
            wait_running(session)
            best = min(
                (call(session, "/gazebo/benchmark", "ticks: 20000") for _ in range(3)),
                key=lambda answer: answer["tick_us"] / answer["bare_us"],
            )
            for part in ("physics_us", "read_us", "update_us", "write_us"):
                figure(f"{title}: {part}", best[part], "us")
            figure(f"{title}: tick", best["tick_us"], "us")
            figure(f"{title}: tick / bare mj_step", best["tick_us"] / best["bare_us"], "x", 2.0)
            figure(
                f"{title}: times real time, flat out",
                1000 / best["tick_us"],
                "x",
                goal,
                at_least=True,
            )


def memory() -> None:
    print("Memory of the simulation's process")
    with (
        tempfile.TemporaryDirectory() as folder,
        simulation(Path(folder), "stone.xml", "x:=-0.5", "real_time_factor:=0") as session,
    ):
        wait_running(session)
        before = node_memory(session)
        figure("resident before the first picture", before, "MB", 150)
        begin = simulated_seconds(session)
        wait_simulated(session, begin + 30)  # threads, publishers and buffers have come up
        settled = node_memory(session)
        wait_simulated(session, begin + 630)
        figure("growth over 10 simulated minutes", node_memory(session) - settled, "MB", 1)


def simulated_seconds(session: Session) -> float:
    text = session.run("rostopic", "echo", "-n1", "-p", "/clock/clock", timeout=30).stdout
    return float(text.split()[-1].split(",")[-1]) / 1e9


def wait_simulated(session: Session, until: float, timeout: float = 200.0) -> None:
    """Lets the simulation run flat out until its clock has passed a time [s]."""
    deadline = time.monotonic() + timeout
    while simulated_seconds(session) < until:
        if time.monotonic() > deadline:
            raise RuntimeError(f"the simulation did not reach {until:.0f} s within {timeout:.0f} s")
        time.sleep(0.5)


def start() -> None:
    print("Start")
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        with simulation(Path(folder), "empty.xml") as session:
            wait_running(session)
            figure("roslaunch to the first controller running", time.monotonic() - begin, "s", 5)


# ---- the robot on the network ------------------------------------------------------------------------------

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
    """This project's C++ client, for so many seconds of the robot's time."""
    program = executables()["client_of_franka_sim_bench"]
    result = subprocess.run(
        [str(program), address, str(seconds)], capture_output=True, text=True, timeout=600, check=True
    )
    return json.loads(result.stdout)


def genuine_client(library: str, address: str) -> float | None:
    """Times real time of a genuine Python client; nothing where it is not installed."""
    python = TOP / "out" / "genuine" / library / "bin" / "python"
    if not python.exists():
        return None
    command = [str(python), "-c", ZERO_TORQUES, library, address]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    return float(result.stdout.split()[-1])


def fci() -> None:
    sys.path.insert(0, str(TOP / "tests" / "support"))
    from fci_session import simulated

    print("The simulated robot on the network (franka_sim)")
    for robot, library in (("panda", "panda"), ("fr3", "pylibfranka")):
        with simulated(robot, "127.0.27.1", "lockstep") as sim:
            runs = [bench_client(sim.address, 20) for _ in range(3)]
            best = max(runs, key=lambda run: run["times_real_time"])
            title = f"{robot} in lock-step"
            figure(
                f"{title}: times real time, own C++ client", best["times_real_time"], "x", 20, at_least=True
            )
            figure(f"{title}: answer to next state, p50", best["p50_us"], "us")
            figure(f"{title}: answer to next state, p99.9", best["p999_us"], "us", 100)
            speeds = [genuine_client(library, sim.address) for _ in range(3)]
            if None in speeds:
                print(f"  {library} is not installed; ./franka test tests installs it")
            else:
                figure(f"{title}: times real time, {library}", max(speeds), "x", 10, at_least=True)
            figure(f"{robot}: resident memory", sim.memory(), "MB", 80)
    with simulated("panda", "127.0.27.2", "realtime") as sim:
        figure("commands lost in 60 s at 1 kHz", bench_client(sim.address, 60)["lost"], "", 0)


BENCHMARKS = {"fci": fci, "micro": micro, "tick": tick, "memory": memory, "start": start}


def main() -> int:
    names = sys.argv[1:] or list(BENCHMARKS)
    unknown = [name for name in names if name not in BENCHMARKS]
    if unknown:
        print(
            f"There is no benchmark {', '.join(unknown)}. There are: {', '.join(BENCHMARKS)}.",
            file=sys.stderr,
        )
        return 2
    for name in names:
        BENCHMARKS[name]()
    for text in failures:
        print(f"MISSED: {text}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
