# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Eight arms in one simulation start within 20 s, and their controller managers answer within a second.

The limits hold for a machine without other work. Beside other work, the share of the processors that is left
counts: with half of them, a second is worth half a second.
"""

import os
import sys
import time
from pathlib import Path

import other_work
import pytest
from franka_sim_mujoco.session import Session
from stalls import in_time

sys.path.append(str(Path(__file__).resolve().parents[1] / "bench"))
from simulation import ALL_RUNNING, CONTROLLER, one_of_many  # noqa: E402

pytestmark = pytest.mark.alone  # judges durations

ARMS = 8
START, CALL = 20.0, 1.0  # [s]


@pytest.mark.parametrize("factor", [0, 1], ids=["flat out", "real time"])
def test_eight_arms_start_in_time_and_answer_at_once(factor, tmp_path):
    launch = tmp_path / "arms.launch"
    launch.write_text(f"<launch>{''.join(one_of_many(i, factor) for i in range(ARMS))}</launch>")
    namespaces = [f"/arm_{i}" for i in range(ARMS)]

    def start_and_call():
        """Durations of the start and of the longest call, as without other work [s]."""
        begin = time.monotonic()
        with Session(str(launch), log=tmp_path / "launch.log") as session:
            others = other_work.OtherWork(session.processes)
            session.wait_for_master()
            watch = ["/usr/bin/python3", "-c", ALL_RUNNING, str(begin), CONTROLLER, *namespaces]
            done = session.run(*watch, timeout=300, check=False)
            assert done.returncode == 0, f"{done.stderr}\n{session.tail(40)}"
            share = others.share_left()
            start, call = (share * seconds for seconds in map(float, done.stdout.split()))
            print(f"start {start:.1f} s, longest call {call:.3f} s, with {share:.2f} of the machine")
            return start, call

    start, call = in_time(start_and_call, lambda seen: seen[0] < START and seen[1] < CALL)
    assert start < START
    assert call < CALL


@pytest.mark.parametrize(
    "busy, own, left",
    [(4.0, 0.0, 0.5), (4.0, 4.0, 1.0), (8.0, 2.0, 0.25), (0.0, 1.0, 1.0)],  # in 4 s of two processors
)
def test_the_share_left_is_without_the_time_of_others(monkeypatch, busy, own, left):
    now = {"wall": 100.0, "busy": 1000.0, "own": 10.0}
    monkeypatch.setattr(other_work.time, "monotonic", lambda: now["wall"])
    monkeypatch.setattr(other_work, "busy_time", lambda: now["busy"])
    monkeypatch.setattr(other_work, "own_time", lambda: now["own"])
    monkeypatch.setattr(other_work, "time_of", lambda pid: pid * own / 4)  # a quarter, and the rest
    monkeypatch.setattr(other_work.os, "cpu_count", lambda: 2)
    work = other_work.OtherWork(lambda: [1, 2])
    now.update(wall=104.0, busy=1000.0 + busy, own=10.0 + own / 4)
    assert work.share_left() == pytest.approx(left)


def test_processor_time_of_this_process_is_measured():
    busy, own, one = other_work.busy_time(), other_work.own_time(), other_work.time_of(os.getpid())
    while other_work.time_of(os.getpid()) < one + 0.1:
        pass
    assert other_work.own_time() > own + 0.05
    assert other_work.busy_time() > busy + 0.05
    assert other_work.time_of(0) == 0.0
