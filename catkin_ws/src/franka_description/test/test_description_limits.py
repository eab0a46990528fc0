# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Joint limits of the URDF and physics parameters against the published tables."""

import pytest
import yaml
from description_robot import ROBOTS, expand, numbers

PANDA = """-2.8973 2.8973 2.1750 87
-1.7628 1.7628 2.1750 87
-2.8973 2.8973 2.1750 87
-3.0718 -0.0698 2.1750 87
-2.8973 2.8973 2.6100 12
-0.0175 3.7525 2.6100 12
-2.8973 2.8973 2.6100 12"""
FR3 = """-2.3093 2.3093 2.0 87
-1.5133 1.5133 1.0 87
-2.4937 2.4937 1.50 87
-2.7478 -0.4461 1.25 87
-2.4800 2.4800 3.00 12
0.8521 4.2094 1.50 12
-2.6895 2.6895 3.00 12"""
TABLES = {
    name: [numbers(row) for row in table.splitlines()] for name, table in (("panda", PANDA), ("fr3", FR3))
}

# The limits the FCI documents, joints 1 to 7: Panda; FR3 before system 5.9; FR3 from 5.9 on.
FCI = {
    "panda": [
        (
            "-2.8973 -1.7628 -2.8973 -3.0718 -2.8973 -0.0175 -2.8973",
            "2.8973 1.7628 2.8973 -0.0698 2.8973 3.7525 2.8973",
        )
    ],
    "fr3": [
        (
            "-2.7437 -1.7837 -2.9007 -3.0421 -2.8065 0.5445 -3.0159",
            "2.7437 1.7837 2.9007 -0.1518 2.8065 4.5169 3.0159",
        ),
        (
            "-2.9007 -1.8361 -2.9007 -3.0770 -2.8763 0.4398 -3.0508",
            "2.9007 1.8361 2.9007 -0.1169 2.8763 4.6216 3.0508",
        ),
    ],
}


@pytest.fixture
def physics():
    return yaml.safe_load((ROBOTS.parent / "config" / "physics.yaml").read_text())


@pytest.mark.parametrize("name", TABLES)
def test_limits(name):
    robot = expand(f"{name}/{name}", arm_id="a")
    for i, row in enumerate(TABLES[name], start=1):
        limit = robot.joints[f"a_joint{i}"].find("limit")
        assert [float(limit.get(k)) for k in ("lower", "upper", "velocity", "effort")] == row
        safety = robot.joints[f"a_joint{i}"].find("safety_controller")
        assert {k: float(v) for k, v in safety.attrib.items()} == {
            "k_position": 100.0,
            "k_velocity": 40.0,
            "soft_lower_limit": row[0],
            "soft_upper_limit": row[1],
        }


def test_two_arms_have_the_limits_of_their_type():
    robot = expand("dual_panda/dual_panda_example", arm_id_1="l", arm_id_2="r", robot="fr3")
    for arm in "lr":
        for i, row in enumerate(TABLES["fr3"], start=1):
            limit = robot.joints[f"{arm}_joint{i}"].find("limit")
            assert [float(limit.get(k)) for k in ("lower", "upper", "velocity", "effort")] == row


def test_finger_limits():
    for number in (1, 2):
        joint = expand("panda/panda", hand="true").joints[f"panda_finger_joint{number}"]
        limit = {k: float(v) for k, v in joint.find("limit").attrib.items()}
        assert limit == {"effort": 100, "lower": 0, "upper": 0.04, "velocity": 0.2}
        assert joint.find("safety_controller") is None


@pytest.mark.parametrize("name", TABLES)
def test_mechanical_stops_are_outside_every_fci_limit(physics, name):
    stops = physics[name]["joint_stops"]
    tables = [(numbers(lower), numbers(upper)) for lower, upper in FCI[name]]
    for joint in range(7):
        lower = min(table[0][joint] for table in tables)
        upper = max(table[1][joint] for table in tables)
        assert stops["lower"][joint] == pytest.approx(lower - 0.02, abs=1e-12)
        assert stops["upper"][joint] == pytest.approx(upper + 0.02, abs=1e-12)
        assert stops["lower"][joint] < TABLES[name][joint][0]
        assert stops["upper"][joint] > TABLES[name][joint][1]


@pytest.mark.parametrize("name", TABLES)
def test_inertia_of_the_motors(physics, name):
    assert set(physics) == {"panda", "fr3"}
    assert physics[name]["rotor_inertia"] == [0.1] * 7
    assert physics[name]["motors"]["inertia"] == [0.195] * 4 + [0.074] * 3


def test_friction_is_that_of_the_publications(physics):
    panda, fr3 = (physics[name]["friction"] for name in ("panda", "fr3"))
    assert panda["amplitude"] == [0.546, 0.872, 0.641, 1.279, 0.839, 0.303, 0.565]
    assert panda["offset"] == [0.0395, 0.0259, -0.0461, 0.0362, 0.0262, -0.0210, 0.0036]
    assert panda["slope"] == [5.12, 9.07, 10.14, 5.59, 8.35, 17.13, 10.34]
    identified = [1.137] * 4 + [0.763, 0.44, 0.248]
    for amplitude, coulomb, total in zip(fr3["amplitude"], fr3["coulomb"], identified):
        assert amplitude / 2 + coulomb == pytest.approx(total, abs=1e-12)
    assert fr3["amplitude"] == [2 * hysteresis for hysteresis in (0.50, 0.35, 0.27, 0.22, 0.28, 0.30, 0.14)]
    assert fr3["damping"] == [0.21] * 7 and "viscous" not in fr3
    assert panda["coulomb"] == fr3["coulomb"]
