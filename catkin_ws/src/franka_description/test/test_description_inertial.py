# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Mass properties: every digit of the table, and only in the simulatable model."""

import numpy as np
import pytest
from description_robot import expand, expand_text, numbers

TABLE = """link0 | -0.041018 -0.00014 0.049974 | 0.629769 | 0.00315 0.00388 0.004285 | 8.2904E-07 0.00015 8.2299E-06
link1 | 0.003875 0.002081 -0.04762 | 4.970684 | 0.70337 0.70661 0.0091170 | -0.000139 0.0067720 0.019169
link2 | -0.003141 -0.02872 0.003495 | 0.646926 | 0.0079620 0.02811 0.025995 | -0.003925 0.010254 0.000704
link3 | 0.027518 0.039252 -0.066502 | 3.228604 | 0.037242 0.036155 0.01083 | -0.004761 -0.011396 -0.012805
link4 | -0.05317 0.104419 0.027454 | 3.587895 | 0.025853 0.019552 0.028323 | 0.007796 -0.001332 0.008641
link5 | -0.011953 0.041065 -0.038437 | 1.225946 | 0.035549 0.029474 0.008627 | -0.002117 -0.004037 0.000229
link6 | 0.060149 -0.014117 -0.010517 | 1.666555 | 0.001964 0.004354 0.005433 | 0.000109 -0.001158 0.000341
link7 | 0.010517 -0.004252 0.061597 | 0.735522 | 0.012516 0.010027 0.004815 | -0.000428 -0.001196 -0.000741
hand | -0.01 0 0.03 | 0.73 | 0.001 0.0025 0.0017 | 0 0 0
leftfinger | 0 0 0 | 0.015 | 2.375e-06 2.375e-06 7.5e-07 | 0 0 0
rightfinger | 0 0 0 | 0.015 | 2.375e-06 2.375e-06 7.5e-07 | 0 0 0"""  # noqa: E501
ROWS = {
    row.split("|")[0].strip(): [numbers(cell) for cell in row.split("|")[1:]] for row in TABLE.splitlines()
}
TERMS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


@pytest.mark.parametrize("name", ["panda", "fr3"])
def test_bit_exact(name):
    robot = expand(f"{name}/{name}", hand="true", gazebo="true", arm_id="x")
    with_inertia = {n for n, link in robot.links.items() if link.find("inertial") is not None}
    assert with_inertia == {f"x_{link}" for link in ROWS}
    for link, (com, mass, diagonal, products) in ROWS.items():
        inertial = robot.links[f"x_{link}"].find("inertial")
        assert numbers(inertial.find("origin").get("xyz")) == com
        assert numbers(inertial.find("origin").get("rpy")) == [0, 0, 0]
        assert [float(inertial.find("mass").get("value"))] == mass
        assert [float(inertial.find("inertia").get(t)) for t in TERMS] == diagonal + products


@pytest.mark.parametrize("name", ["panda", "fr3"])
def test_no_inertias_without_gazebo(name):
    assert expand(f"{name}/{name}", hand="true").xml.find(".//inertial") is None


@pytest.mark.parametrize("link", ROWS)
def test_inertias_are_physically_possible(link):
    xx, yy, zz = ROWS[link][2]
    xy, xz, yz = ROWS[link][3]
    low, middle, high = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    assert low > 0
    assert low + middle > high
    if link == "link2":  # so close to the bound that rounded values would violate it
        assert low + middle - high == pytest.approx(1.7e-6, abs=0.05e-6)


def test_unknown_link_gets_a_warning_and_no_inertia(capsys):
    robot = expand_text('<link name="l"><xacro:inertial_props name="nose"/></link>')
    assert robot.links["l"].find("inertial") is None
    assert "no inertial properties for link nose" in capsys.readouterr().err


def test_solid_cylinder():
    body = '<link name="l"><xacro:inertia-cylinder mass="2.0" radius="0.1" h="0.3"/></link>'
    inertial = expand_text(body).links["l"].find("inertial")
    inertia = {k: float(v) for k, v in inertial.find("inertia").attrib.items()}
    # 2 kg * (3 * 0.01 + 0.09) / 12 across, 2 kg * 0.01 / 2 along
    assert inertia == pytest.approx({"ixx": 0.02, "iyy": 0.02, "izz": 0.01, "ixy": 0, "ixz": 0, "iyz": 0})
    assert float(inertial.find("mass").get("value")) == 2.0
