# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""`franka_sim --ip 0.0.0.0` of docs/how_to/containers.md: a robot at each address of a container."""

import subprocess
from pathlib import Path

import pytest

# Without the right to make a network, it takes the ports of all addresses of this machine.
pytestmark = pytest.mark.alone

PAGE = Path(__file__).resolve().parent.parent / "docs" / "how_to" / "containers.md"
# A network with addresses of its own and nothing else, as a container has it.
NETWORK = ["unshare", "--map-root-user", "--net"]
ADDRESSES = ["127.0.0.1", "127.0.77.2"]
CLIENTS = """
for address in {addresses}; do
  for try in $(seq 150); do franka_info $address 0.2 >out 2>err; grep -q Robot out && break; sleep 0.2; done
  grep Robot out
done
"""


def test_a_robot_serves_each_address(tmp_path):
    may_make_one = subprocess.run([*NETWORK, "true"], capture_output=True).returncode == 0
    (line,) = [
        line
        for line in PAGE.read_text().splitlines()
        if "--ip 0.0.0.0" in line and line.startswith("docker run")
    ]
    command = line[line.index("franka_sim --robot") :]
    begin = "ip link set lo up; " if may_make_one else ""
    script = f"{begin}{command} & {CLIENTS.format(addresses=' '.join(ADDRESSES))} kill %1; wait"
    done = subprocess.run(
        [*(NETWORK if may_make_one else []), "bash", "-c", script],
        cwd=tmp_path,
        text=True,
        capture_output=True,
        timeout=120,
    )
    lines = done.stdout.splitlines()
    robots = [each for each in lines if each.startswith("Robot")]
    assert len(robots) == len(ADDRESSES) and all("fr3" in each.lower() for each in robots), (
        done.stdout + done.stderr
    )
