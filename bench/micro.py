# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The google-benchmark executables: each subject relative to a reference of the same run."""

import json
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from franka_sim_mujoco.session import Session
from report import executables, failures, figure


@dataclass
class Ratio:
    """`subject` over `reference`, both names of benchmarks of one executable."""

    executable: str
    subject: str
    reference: str
    goal: float | None = None  # of the ratio
    goal_ns: float | None = None  # of the subject's time


def python_controller(script: str, reference: str, simulated_goal_ns: float) -> list[Ratio]:
    """A cycle on hardware, where the loop sleeps until the script answers, and in simulated time."""
    return [
        Ratio(
            "python_controller_bench",
            f"{script}/simulated:{simulated}/real_time",
            f"{reference}/real_time",
            goal_ns=simulated_goal_ns if simulated else None,
        )
        for simulated in (0, 1)
    ]


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
    Ratio("physics_bench", "tickOfRobot/real", "tickOfRobot/ideal", goal=1.05),
    Ratio("physics_bench", "tickOfRobot/recorded", "tickOfRobot/ideal", goal=1.15),
    Ratio("controller_manager_update_bench", "managerUpdate/1", "virtualCalls/1"),
    Ratio("controller_manager_update_bench", "managerUpdate/10", "virtualCalls/10"),
    Ratio("controller_manager_update_bench", "managerUpdate/50", "virtualCalls/50"),
    *python_controller("jointImpedance", "callOfPython", simulated_goal_ns=20000),
    *python_controller("constantCommand", "controllerInCpp", simulated_goal_ns=6000),
]


@dataclass
class Counter:
    """A counter of a benchmark; `subtract` names one with the machine's own share."""

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
    Counter("libfranka_client_bench", "barePingPong/5", "p999_us", "us"),
    Counter("libfranka_client_bench", "roundTrip/10", "p50_ratio", "x", 1.5),
    Counter("libfranka_client_bench", "roundTrip/10", "p999_us", "us", 300),
    Counter("realtime_publisher_bench", "publishTick", "cpu_percent", "%"),
    Counter(
        "realtime_publisher_bench", "publishTick", "cpu_percent", "% beyond a bare loop", 1.5, "bareLoop"
    ),
    Counter("realtime_publisher_bench", "publishToSubscribers", "cpu_percent", "%"),
    Counter("realtime_publisher_bench", "publishToSubscribers", "accepted_percent", "%"),
]


def micro() -> None:
    print("Parts, by google-benchmark (ratio to the reference in the same run)")
    found = executables()
    # The benchmarks of controllers need a master for their parameters.
    with tempfile.TemporaryDirectory() as folder, Session("--core", log=Path(folder) / "core.log") as core:
        core.wait_for_master()
        # Once each: a benchmark's parameters stay in the master, where the next run would add its robot.
        of_ratios = [ratio.executable for ratio in RATIOS]
        for name in dict.fromkeys([*of_ratios, *(counter.executable for counter in COUNTERS)]):
            if name not in found:
                failures.append(f"{name} is not built")
                print(f"  {name}: not built")
                continue
            times, counters = google_benchmark(found[name], core.environment)
            for ratio in (ratio for ratio in RATIOS if ratio.executable == name):
                print_ratio(ratio, times)
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
    """Median time of each benchmark [ns], processor time by default, and its counters."""
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
        clock = "real_time" if name.endswith("/real_time") else "cpu_time"
        times[name] = entry[clock] * unit[entry["time_unit"]]
        counters[name] = {key: value for key, value in entry.items() if isinstance(value, float)}
    return times, counters
