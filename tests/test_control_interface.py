# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""An operator's line of the control interface during a client's motion, in lock-step."""

from fci_motion import begin, drive, hold
from fci_session import simulated
from fci_wire import IDLE, LAYOUTS, connected

GUIDING = 3


def test_guiding_ends_a_motion_and_leaves_the_arm_free():
    with simulated("panda", "lockstep") as sim, connected(sim) as client:
        state, first = begin(client)
        state = drive(client, state, hold(first), 50)[-1]
        sim.remote.set_guiding(True)
        state = drive(client, state, hold(first), 10)[-1]
        assert state.mode == GUIDING
        assert client.reply()[1][0] not in (0, LAYOUTS[client.version].reflex)
        before = client.state_until(lambda s: s.mode == GUIDING).joints("q")
        sim.remote.push(f"{sim.name}_hand", (0, 5, 0), ticks=500)
        moved = client.state_until(lambda s: max(abs(a - b) for a, b in zip(s.joints("q"), before)) > 0.02)
        assert moved.mode == GUIDING
        sim.remote.set_guiding(False)
        client.state_until(lambda s: s.mode == IDLE)
