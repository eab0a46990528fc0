# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The benchmark of pairs in lock-step, in a short form that counts cycles; the long form judges
speeds, too."""

import os
import statistics
import subprocess
import sys
from pathlib import Path

import pytest
from genuine_clients import client_python
from starvation import busy

sys.path.append(str(Path(__file__).resolve().parents[1] / "bench"))
import lock_step_pairs  # noqa: E402

pytestmark = pytest.mark.alone  # compares speeds


@pytest.mark.parametrize("library", ["pyfranka", "panda"])
def test_each_pair_has_a_speed(library):
    if library == "panda":
        client_python("panda")  # skips without it
    speeds = lock_step_pairs.factors(library, 2, 0.5)
    assert len(speeds) == 2
    assert all(speed > 0.0 for speed in speeds)


@pytest.mark.long_form("measures speeds")
def test_four_pairs_on_a_busy_machine_keep_the_speed_of_one():
    """Clients and robots that waited without sleep took the processors from each other: four pairs together
    were three times slower than one. Each pair advances."""
    ratios = []
    with busy(os.cpu_count()):
        for _ in range(3):
            (one,) = lock_step_pairs.factors("pyfranka", 1, 3.0)
            four = lock_step_pairs.factors("pyfranka", 4, 3.0)
            assert min(four) > 0.1 * max(four), four
            ratios.append(sum(four) / one)
    print(f"four pairs over one: {ratios}")
    assert statistics.median(ratios) > 0.8, ratios


def test_a_client_that_ends_is_reported(monkeypatch):
    def ending(library, address):
        return subprocess.Popen(
            [sys.executable, "-c", ""], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    monkeypatch.setattr(lock_step_pairs, "start_client", ending)
    with pytest.raises(AssertionError, match="A pyfranka client has ended"):
        lock_step_pairs.factors("pyfranka", 1, 0.1)
