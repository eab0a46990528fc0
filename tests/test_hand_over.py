# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Two arms in one simulation hand a bar over: one takes it from a stand, the other puts it on another."""

import json
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session
from PIL import Image

HERE = Path(__file__).resolve().parent
LIFT = 0.08  # [m]
MOVE = 2
SEEDS, SEEDS_IN_SHORT = range(1, 11), range(1, 2)


@pytest.fixture(scope="module", params=["panda", "fr3"])
def report(request, tmp_path_factory, long_run):
    robot, folder = request.param, tmp_path_factory.mktemp("hand_over")
    if robot == "fr3" and not long_run:
        pytest.skip("the long form has FR3s too")
    launch = [str(HERE / "data" / "hand_over.launch"), f"robot:={robot}"]
    with Session(*launch, log=folder / "launch.log") as session:
        session.wait_for_master()
        seeds = [str(seed) for seed in (SEEDS if long_run else SEEDS_IN_SHORT)]
        client = ["/usr/bin/python3", str(HERE / "hand_over_client.py"), robot, str(folder), *seeds]
        result = session.run(*client, check=False, timeout=800)
        print(result.stdout, result.stderr, session.tail(60), sep="\n")
        assert result.returncode == 0, f"{result.stderr}\n{session.tail(60)}"
        session.check()
    with Image.open(folder / "hand_over.png") as picture:
        colours = len(picture.convert("RGB").getcolors(maxcolors=1 << 20))
    return {"colours": colours, **json.loads(result.stdout.strip().splitlines()[-1])}


def test_the_bar_is_handed_over(report):
    for go in report["goes"]:
        forces = go["forces"]
        assert forces["one"] > 30.0 and forces["two"] > 30.0, go  # both hold it at the same time
        assert forces["one after"] == 0.0, go


def test_the_bar_never_falls(report):
    assert all(go["lowest"] > LIFT - 0.02 for go in report["goes"]), report["goes"]


def test_the_bar_stands_on_the_second_stand(report):
    for go in report["goes"]:
        assert go["away"] < 0.015 and go["turned"] < 0.05, go
        assert abs(go["height"]) < 1e-3, go


def test_no_reflex_and_no_error(report):
    assert report["modes"] == [MOVE] and report["errors"] == []


def test_the_picture_is_not_empty(report):
    assert report["colours"] > 200
