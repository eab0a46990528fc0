# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The demo as a user starts it. In the long form every listed seed places the stone, and a carried stone does
not slip."""

import json
import subprocess
import sys

import pytest

SEEDS = range(1, 21)


def pick_and_place(output, *arguments: str, timeout: float = 800.0) -> tuple[int, list[dict], str]:
    command = [
        "rosrun",
        "franka_sim_mujoco",
        "pick_and_place",
        "--start",
        "--output",
        str(output),
        *arguments,
    ]
    result = subprocess.run(
        command, text=True, capture_output=True, timeout=timeout, stdin=subprocess.DEVNULL
    )
    print(result.stdout)
    print(result.stderr, file=sys.stderr)
    report = output / "report.json"
    results = json.loads(report.read_text()) if report.exists() else []
    return result.returncode, results, result.stdout


@pytest.mark.long_form("all robots, realisms and seeds")
@pytest.mark.parametrize("realism", ["ideal", "real", "recorded"])
@pytest.mark.parametrize("robot", ["panda", "fr3"])
def test_every_seed_places_the_stone(robot, realism, tmp_path):
    options = [text for seed in SEEDS for text in ("--seed", str(seed))]
    options += ["--realism", realism]
    carried = ["--hold", "60"] if realism == "ideal" else []  # friction keeps the arm off its way
    code, results, _ = pick_and_place(
        tmp_path, f"robot:={robot}", "--speed", "0", "--no-pictures", *options, *carried
    )
    assert code == 0
    assert [result["seed"] for result in results] == list(SEEDS)
    assert all(result["in_tray"] for result in results)
    assert not carried or all(result["slip"] < 1e-3 for result in results)


def test_demo_shows_progress_and_pictures(tmp_path):
    from PIL import Image

    code, results, output = pick_and_place(tmp_path, "robot:=fr3", "--speed", "5", "--realism", "real")
    assert code == 0
    assert "rests in the red tray" in output and "from the tray's center" in output
    assert "simulated" in output and "wall" in output
    for name in ("1-before", "2-grasped", "3-placed"):
        with Image.open(tmp_path / f"{name}.png") as picture:
            colors = picture.convert("RGB").getcolors(maxcolors=1 << 20)
            assert picture.width >= 640
            assert len(colors) > 200, "the picture is empty"
    assert results[0]["distance"] < 0.03


def test_unknown_robot_is_refused():
    result = subprocess.run(
        ["rosrun", "franka_sim_mujoco", "pick_and_place", "robot:=ur5"],
        text=True,
        capture_output=True,
        timeout=60,
    )
    assert result.returncode == 2
    assert "panda" in result.stderr and "fr3" in result.stderr
