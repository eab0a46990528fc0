# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Mass properties: every digit of the tables, and only in the simulatable model."""

import numpy as np
import pytest
from description_robot import expand, expand_text, numbers
from scipy.spatial.transform import Rotation

PANDA = """link0 | -0.041018 -0.00014 0.049974 | 0.629769 | 0.00315 0.00388 0.004285 | 8.2904E-07 0.00015 8.2299E-06
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
# The maker's figures.
FR3 = """link0 | -0.0172 0.0004 0.0745 | 2.3966 | 0.0090 0.0115 0.0085 | 0 0.0020 0
link1 | 4.128e-7 -0.0181251324 -0.0386035970 | 2.9274653454 | 0.023927316485107913 0.0224821613275756 0.006350098258530016 | 1.3317903455714081e-05 -0.00011404774918616684 -0.0019950320628240115
link2 | 0.0031828864 -0.0743221644 0.0088146084 | 2.9355370338 | 0.041938946257609425 0.02514514885014724 0.06170214472888839 | 0.00020257331521090626 0.004077784227179924 -0.0042252158006570156
link3 | 0.0407015686 -0.0048200565 -0.0289730823 | 2.2449013699 | 0.02410142547240885 0.01974053266708178 0.019044494482244823 | 0.002404694559042109 -0.002856269270114313 -0.002104212683891874
link4 | -0.0459100965 0.0630492960 -0.0085187868 | 2.6155955791 | 0.03452998321913202 0.028881621933049058 0.04125471171146641 | 0.01322552265982813 0.01015142998484113 -0.0009762833870704552
link5 | -0.0016039605 0.0292536262 -0.0972965990 | 2.3271207594 | 0.051610278463662895 0.04787729713371481 0.016423625579357254 | -0.005715173387783472 -0.0035673167625872135 0.010673985108535986
link6 | 0.0597131221 -0.0410294666 -0.0101692726 | 1.8170376524 | 0.005412333594383447 0.014058329545509979 0.016080817924212554 | 0.006193456360285834 0.0014219289306117652 -0.0013140753741120031
link7 | 0.0045225817 0.0086261921 -0.0161633251 | 0.6271432862 | 0.00021092389150104718 0.00017718568002411474 5.993190599659971e-05 | -2.433299114461931e-05 4.564480393778983e-05 8.744070223226438e-05"""  # noqa: E501


def rows(table):
    return {
        row.split("|")[0].strip(): [numbers(cell) for cell in row.split("|")[1:]]
        for row in table.splitlines()
    }


ROWS = {"panda": rows(PANDA), "fr3": rows(FR3)}
TERMS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def inertials(**arguments):
    """(center, mass, inertia diagonal, inertia products) of the links with a mass."""
    robot = expand(arguments.pop("name"), hand="true", gazebo="true", arm_id="x", **arguments)
    found = {}
    for name, link in robot.links.items():
        inertial = link.find("inertial")
        if inertial is not None:
            assert numbers(inertial.find("origin").get("rpy")) == [0, 0, 0]
            values = [float(inertial.find("inertia").get(term)) for term in TERMS]
            mass = float(inertial.find("mass").get("value"))
            center = numbers(inertial.find("origin").get("xyz"))
            found[name[2:]] = [center, [mass], values[:3], values[3:]]
    return found


def matrix(diagonal, products):
    (xx, yy, zz), (xy, xz, yz) = diagonal, products
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def test_the_pandas_are_those_of_the_identification():
    assert inertials(name="panda/panda") == ROWS["panda"]


def test_an_fr3_has_its_own_links():
    found = inertials(name="fr3/fr3")
    assert {link: found[link] for link in ROWS["fr3"]} == ROWS["fr3"]
    assert set(found) == set(ROWS["panda"])


def test_the_originals_fr3_has_the_pandas_links():
    assert inertials(name="fr3/fr3", inertials="panda") == ROWS["panda"]


def test_another_set_is_refused():
    with pytest.raises(Exception, match="argument 'inertials' is 'fer', but only fr3 or panda"):
        expand("fr3/fr3", inertials="fer")


def test_the_fr3s_hand_is_the_one_that_desk_configures():
    # In the flange's frame, against which the hand is turned by -45 degrees. The parallel axis theorem
    # collects the hand and the closed fingers.
    found = inertials(name="fr3/fr3")
    parts = [(found["hand"], np.zeros(3))]
    parts += [(found[f"{side}finger"], np.array([0, 0, 0.0584])) for side in ("left", "right")]
    mass = sum(part[1][0] for part, _ in parts)
    center = sum(part[1][0] * (np.array(part[0]) + at) for part, at in parts) / mass
    inertia = np.zeros((3, 3))
    for part, at in parts:
        away = np.array(part[0]) + at - center
        inertia += matrix(*part[2:]) + part[1][0] * (away @ away * np.eye(3) - np.outer(away, away))
    turn = Rotation.from_euler("z", -45, degrees=True).as_matrix()
    assert mass == pytest.approx(0.73, abs=1e-15)
    assert turn @ center == pytest.approx([-0.01, 0, 0.03], abs=1e-15)
    assert turn @ inertia @ turn.T == pytest.approx(np.diag([0.001, 0.0025, 0.0017]), abs=1e-15)


def test_no_inertias_without_gazebo():
    assert expand("panda/panda", hand="true").xml.find(".//inertial") is None


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
