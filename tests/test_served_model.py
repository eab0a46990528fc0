# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The model that a served robot gives its clients, against the closed form of the published figures."""

import numpy as np
import pytest
import rigid_arm
from fci_session import simulated

STATES = 200
GRAVITY = [0.0, 0.0, -9.81]  # [m/s^2]
SERVED = [("panda", 5), ("fr3", 6), ("fr3", 9), ("fr3", 10)]


@pytest.fixture(scope="module", params=SERVED, ids=lambda p: f"{p[0]} {p[1]}")
def served(request):
    robot, version = request.param
    with simulated(robot, "patient", protocol=version) as sim:
        client = sim.connect()
        assert client.server_version == version
        yield robot, client.load_model(), client.read_once()


@pytest.fixture(scope="module")
def states():
    random = np.random.default_rng(53)
    return random.uniform(-2.8, 2.8, (STATES, 7)), random.uniform(-2.0, 2.0, (STATES, 7))


def test_the_end_effector_is_the_hand(served):
    robot, _, state = served
    if robot == "fr3":  # as Desk configures it; protocol 10 sends floats
        assert state.m_ee == pytest.approx(0.73, abs=1e-7)
        assert state.F_x_Cee == pytest.approx([-0.01, 0, 0.03], abs=1e-7)
    else:  # the description's hand and fingers
        assert state.m_ee == pytest.approx(0.76, abs=1e-7)


def test_gravity_and_mass_are_those_of_the_published_links(served, states):
    robot, model, state = served
    payload = (state.m_ee, state.F_x_Cee, state.I_ee)
    parts = rigid_arm.bodies(rigid_arm.Body(rigid_arm.FLANGE, *payload), robot)
    worst = np.zeros(2)
    for q in states[0]:
        gravity = model.gravity(q, payload[0], payload[1], GRAVITY) - rigid_arm.gravity(q, parts)
        mass = model.mass(q, payload[2], payload[0], payload[1]) - rigid_arm.mass(q, parts)
        worst = np.maximum(worst, [abs(gravity).max(), abs(mass).max()])
    print(f"{robot}: gravity {worst[0]:.1e} Nm, mass {worst[1]:.1e} kg m^2")
    assert worst[0] <= 1e-9
    assert worst[1] <= 1e-9


def test_coriolis_torques_are_those_of_the_published_links(served, states):
    robot, model, state = served
    payload = (state.m_ee, state.F_x_Cee, state.I_ee)
    parts = rigid_arm.bodies(rigid_arm.Body(rigid_arm.FLANGE, *payload), robot)
    for q, dq in list(zip(*states))[:20]:  # the reference takes central differences
        torques = model.coriolis(q, dq, payload[2], payload[0], payload[1])
        np.testing.assert_allclose(torques, rigid_arm.coriolis(q, dq, parts), atol=1e-6)


def test_an_arm_at_rest_shows_the_gravity_of_its_own_links(served):
    # What the estimate of the external torque takes away from tau_J is the robot's own model.
    robot, _, state = served
    load = rigid_arm.Body(rigid_arm.FLANGE, state.m_ee, state.F_x_Cee, state.I_ee)
    own = rigid_arm.gravity(state.q, rigid_arm.bodies(load, robot))
    other = rigid_arm.gravity(state.q, rigid_arm.bodies(load, "panda" if robot == "fr3" else "fr3"))
    shown = np.array(state.tau_J) - np.array(state.tau_ext_hat_filtered)
    assert abs(shown - own).max() < 0.003
    assert abs(shown - other).max() > 0.3
