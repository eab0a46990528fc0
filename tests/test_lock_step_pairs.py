# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The benchmark of pairs in lock-step, in a short form: it counts cycles, and judges no speed."""

import subprocess
import sys
from pathlib import Path

import pytest
from genuine_clients import client_python

sys.path.append(str(Path(__file__).resolve().parents[1] / "bench"))
import lock_step_pairs  # noqa: E402


@pytest.mark.parametrize("library", ["pyfranka", "panda"])
def test_each_pair_has_a_speed(library):
    if library == "panda":
        client_python("panda")  # skips without it
    speeds = lock_step_pairs.factors(library, 2, 0.5)
    assert len(speeds) == 2
    assert all(speed > 0.0 for speed in speeds)


def test_a_client_that_ends_is_reported(monkeypatch):
    def ending(library, address):
        return subprocess.Popen(
            [sys.executable, "-c", ""], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    monkeypatch.setattr(lock_step_pairs, "start_client", ending)
    with pytest.raises(AssertionError, match="A pyfranka client has ended"):
        lock_step_pairs.factors("pyfranka", 1, 0.1)
