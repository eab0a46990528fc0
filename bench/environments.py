# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Steps a second of pyfranka.gym and of other packages' environments, in turns in one run.

The others come from PyPI into environments of their own in a folder that is deleted afterwards. Where one
cannot be installed, the benchmark says so and goes on.
"""

import os
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

from report import figure

LOCKS = Path(__file__).parents[1] / "locks"
OTHERS = ("robosuite", "panda-gym")
TITLES = {
    "pyfranka": "pyfranka PickAndPlace, control at 1 kHz",
    "robosuite": "robosuite Panda Lift, control at 500 Hz",
    "panda-gym": "panda-gym PandaPickAndPlace-v3, targets at 20 Hz",
}
SECONDS = float(os.environ.get("FRANKA_BENCH_SECONDS", "5"))  # of a measurement
ROUNDS = 3
INSTALLING = 900  # [s] at most, for each package
PROGRAM = Path(__file__).with_name("environment_steps.py")


def install(name: str, folder: Path) -> str | None:
    """The interpreter of a new environment with a package; None, after a message, if that fails."""
    venv.create(folder, with_pip=True)
    python = str(folder / "bin" / "python3")
    command = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--prefer-binary"]
    command += ["--no-deps", "--require-hashes", f"--requirement={LOCKS / name}.txt"]
    try:
        result = subprocess.run(command, capture_output=True, text=True, timeout=INSTALLING)
    except subprocess.TimeoutExpired:
        print(f"  {name} cannot be compared: its installation took longer than {INSTALLING} s")
        return None
    if result.returncode != 0:
        lines = result.stderr.strip().splitlines() or ["no reason given"]
        print(f"  {name} cannot be compared, its installation failed: {lines[-1]}")
        return None
    return python


def steps(name: str, python: str, processes: int) -> float:
    """Steps a second of so many processes together. Raises RuntimeError with the output of a process."""
    own = dict(os.environ)
    if name != "pyfranka":
        own.pop("PYTHONPATH", None)
    own["OMP_NUM_THREADS"] = "1"
    command = [python, str(PROGRAM), name, str(SECONDS)]
    running = [
        subprocess.Popen(command, env=own, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for _ in range(processes)
    ]
    total = 0.0
    for process in running:
        out, error = process.communicate(timeout=600)
        found = [line for line in out.splitlines() if line.startswith("steps a second:")]
        if not found:
            raise RuntimeError((error.strip().splitlines() or ["it printed nothing"])[-1])
        total += float(found[0].split(":")[1])
    return total


def compare(pythons: dict[str, str], processes: int) -> None:
    """Prints the best of several rounds, and what is ours over the faster of the others."""
    best = dict.fromkeys(pythons, 0.0)
    for _ in range(ROUNDS):
        for name in list(best):
            try:
                best[name] = max(best[name], steps(name, pythons[name], processes))
            except RuntimeError as error:
                if name == "pyfranka":
                    raise
                print(f"  {name} cannot be compared, it does not run here: {error}")
                del best[name]
    count = "1 process" if processes == 1 else f"{processes} processes"
    for name, value in best.items():
        figure(f"{TITLES[name]}, {count}: steps a second", value, "")
    others = [value for name, value in best.items() if name != "pyfranka"]
    if others:
        ratio = best["pyfranka"] / max(others)
        figure(f"pyfranka over the faster one, {count}", ratio, "", 2.0, at_least=True)


def environments() -> None:
    print("Environments of Gymnasium at 20 Hz with random actions (pyfranka.gym)")
    with tempfile.TemporaryDirectory() as folder:
        pythons: dict[str, str | None] = {"pyfranka": sys.executable}
        for name in OTHERS:
            pythons[name] = install(name, Path(folder) / name)
        present = {name: python for name, python in pythons.items() if python}
        for processes in (1, 2):
            compare(present, processes)
