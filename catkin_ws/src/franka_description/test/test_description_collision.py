# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Self-collision capsules, fine volumes, fingers, visuals, and primitives that replace meshes."""

import math
import struct

import numpy as np
import pytest
from description_robot import (
    ARM_LINKS,
    NO_MESHES,
    ROBOTS,
    expand,
    expand_text,
    numbers,
    rotation,
    shapes,
)

# link: (center, axis, radius without safety distance, length)
CAPSULES = {
    "link0": [((-0.075, 0, 0.06), 0, 0.06, 0.03)],
    "link1": [((0, 0, -0.1915), 2, 0.06, 0.283)],
    "link2": [((0, 0, 0), 2, 0.06, 0.12)],
    "link3": [((0, 0, -0.145), 2, 0.06, 0.15)],
    "link4": [((0, 0, 0), 2, 0.06, 0.12)],
    "link5": [((0, 0, -0.26), 2, 0.06, 0.10), ((0, 0.08, -0.13), 2, 0.025, 0.14)],
    "link6": [((0, 0, -0.03), 2, 0.05, 0.08)],
    "link7": [((0, 0, 0.01), 2, 0.04, 0.14), ((0.06, 0, 0.082), 0, 0.03, 0.01)],
    "hand": [((0, 0, 0.04), 1, 0.04, 0.1), ((0, 0, 0.10), 1, 0.02, 0.1)],
}
LEFT_FINGER = [
    ((0, 0.0185, 0.011), 0, (0.022, 0.015, 0.020)),
    ((0, 0.0068, 0.0022), 0, (0.022, 0.0088, 0.0038)),
    ((0, 0.0159, 0.02835), math.pi / 6, (0.0175, 0.007, 0.0235)),
    ((0, 0.00758, 0.04525), 0, (0.0175, 0.0152, 0.0185)),
]
ALL = dict(visual=[*ARM_LINKS, "hand", "finger"], collision=[*ARM_LINKS, "hand"])


def assert_capsules(link, expected, safety):
    found = shapes(link)
    assert len(found) == 3 * len(expected)
    for i, (center, axis, radius, length) in enumerate(expected):
        (tag, data, pose), *spheres = found[3 * i : 3 * i + 3]
        assert tag == "cylinder"
        assert data["radius"][0] == pytest.approx(radius + safety, abs=1e-12)
        assert data["length"] == [length]
        np.testing.assert_allclose(pose[:3, 3], center, atol=1e-15)
        direction = np.abs(pose[:3, 2])
        np.testing.assert_allclose(direction, np.eye(3)[axis], atol=1e-15)
        ends = sorted(tuple(sphere[2][:3, 3]) for sphere in spheres)
        offset = np.eye(3)[axis] * length / 2
        np.testing.assert_allclose(ends, sorted([center - offset, center + offset], key=tuple))
        for sphere in spheres:
            assert sphere[0] == "sphere"
            assert sphere[1]["radius"] == data["radius"]


@pytest.mark.parametrize("name", ["panda", "fr3"])
def test_coarse_volumes(name):
    robot = expand(f"{name}/{name}", hand="true")
    for link, expected in CAPSULES.items():
        assert_capsules(robot.links[f"{name}_{link}_sc"], expected, 0.03)
        origin = robot.joints[f"{name}_{link}_sc_joint"].find("origin")
        turn = [0, 0, math.pi / 4 if link == "link7" else 0]
        assert numbers(origin.get("xyz")) == [0, 0, 0]
        assert numbers(origin.get("rpy")) == pytest.approx(turn, abs=1e-15)


def test_safety_distance_is_added():
    robot = expand_text(
        """<xacro:franka_arm arm_id="p" safety_distance="0.1" joint_limits="${panda_limits}"/>
        <xacro:franka_hand arm_id="p" connected_to="p_link8" safety_distance="0.1"/>"""
    )
    for link, expected in CAPSULES.items():
        assert_capsules(robot.links[f"p_{link}_sc"], expected, 0.1)


def test_dual_panda_and_hand_alone_keep_three_centimeters():
    dual, hand = expand("dual_panda/dual_panda_example"), expand("common/hand")
    for arm in ("panda_1", "panda_2"):
        for link, expected in CAPSULES.items():
            assert_capsules(dual.links[f"{arm}_{link}_sc"], expected, 0.03)
    assert_capsules(hand.links["panda_hand_sc"], CAPSULES["hand"], 0.03)


def test_simulatable_model_has_fine_volumes_only():
    robot = expand("panda/panda", hand="true", gazebo="true")
    for link in CAPSULES:
        assert len(robot.links[f"panda_{link}_sc"]) == 0
        assert robot.links[f"panda_{link}"].find("collision") is not None


@pytest.mark.parametrize("gazebo", ["false", "true"])
@pytest.mark.parametrize("side, sign", [("left", 1), ("right", -1)])
def test_fingers(gazebo, side, sign):
    finger = expand("panda/panda", hand="true", gazebo=gazebo).links[f"panda_{side}finger"]
    found = shapes(finger)
    assert len(found) == 4
    for (tag, data, pose), (xyz, roll, size) in zip(found, LEFT_FINGER, strict=True):
        assert tag == "box"
        assert data["size"] == list(size)
        np.testing.assert_allclose(pose[:3, 3], np.multiply(xyz, (1, sign, 1)), atol=1e-15)
        np.testing.assert_allclose(pose[:3, :3], rotation([sign * roll, 0, 0]), atol=1e-15)


@pytest.mark.parametrize("direction", ["x", "y", "z"])
def test_capsule_directions(direction):
    body = f'<xacro:collision_capsule radius="0.1" length="0.4" xyz="1 2 3" direction="{direction}"/>'
    link = expand_text(f'<link name="l">{body}</link>').links["l"]
    assert_capsules(link, [((1, 2, 3), "xyz".index(direction), 0.1, 0.4)], 0)


@pytest.mark.parametrize(
    "name, folder, gazebo", [("panda", "visual", "false"), ("fr3", "visual/fr3", "true")]
)
def test_installed_meshes_are_used(mesh_index, name, folder, gazebo):
    index = mesh_index(**ALL, **{"visual/fr3": ALL["visual"]})
    robot = expand(f"{name}/{name}", mesh_index=index, hand="true", gazebo=gazebo)
    root = "package://franka_description/meshes"
    for link in [*ARM_LINKS, "hand"]:
        element = robot.links[f"{name}_{link}"]
        assert shapes(element, "visual")[0][1] == {"filename": f"{root}/{folder}/{link}.dae"}
        assert shapes(element)[0][:2] == ("mesh", {"filename": f"{root}/collision/{link}.stl"})
        assert len(element.findall("visual")) == len(element.findall("collision")) == 1
    for side, turn in (("left", 0), ("right", math.pi)):
        ((tag, data, pose),) = shapes(robot.links[f"{name}_{side}finger"], "visual")
        assert data == {"filename": f"{root}/{folder}/finger.dae"}
        np.testing.assert_allclose(pose[:3, :3], rotation([0, 0, turn]), atol=1e-15)


def test_fr3_falls_back_to_panda_meshes(mesh_index):
    robot = expand("fr3/fr3", mesh_index=mesh_index(**ALL))
    filename = "package://franka_description/meshes/visual/link3.dae"
    assert shapes(robot.links["fr3_link3"], "visual")[0][1] == {"filename": filename}


def test_only_a_missing_mesh_is_replaced_by_primitives(mesh_index):
    index = mesh_index(visual=["link0"], collision=["link1"])
    robot = expand("panda/panda", mesh_index=index)
    assert [s[0] for s in shapes(robot.links["panda_link0"], "visual")] == ["mesh"]
    assert "mesh" not in [s[0] for s in shapes(robot.links["panda_link0"])]
    assert "mesh" not in [s[0] for s in shapes(robot.links["panda_link1"], "visual")]
    assert [s[0] for s in shapes(robot.links["panda_link1"])] == ["mesh"]


def test_other_description_packages_use_their_own_meshes():
    body = """<xacro:franka_arm arm_id="p" description_pkg="my_description"
        joint_limits="${panda_limits}"/>"""
    link = expand_text(body).links["p_link4"]
    filename = "package://my_description/meshes/visual/link4.dae"
    assert shapes(link, "visual")[0][1] == {"filename": filename}
    assert "my_description" not in str(shapes(link))


def test_without_meshes_all_links_are_primitives():
    robot = expand("fr3/fr3", mesh_index=NO_MESHES, hand="true", gazebo="true")
    assert "<mesh" not in robot.text
    for link in [*ARM_LINKS, "hand", "leftfinger", "rightfinger"]:
        for kind in ("visual", "collision"):
            found = shapes(robot.links[f"fr3_{link}"], kind)
            assert found, f"{link} has no {kind}"
            for tag, data, _ in found:
                assert tag in ("box", "cylinder", "sphere")
                assert all(v > 0 for values in data.values() for v in values)
        for visual in robot.links[f"fr3_{link}"].findall("visual"):
            color = numbers(visual.find("material/color").get("rgba"))
            assert len(color) == 4 and color[3] == 1


def distance(shape, points):
    """Signed distance [m] of points from a primitive, negative inside."""
    tag, data, pose = shape
    local = (points - pose[:3, 3]) @ pose[:3, :3]
    if tag == "sphere":
        return np.linalg.norm(local, axis=1) - data["radius"][0]
    if tag == "cylinder":
        radial = np.hypot(local[:, 0], local[:, 1]) - data["radius"][0]
        excess = np.stack([radial, np.abs(local[:, 2]) - data["length"][0] / 2], axis=1)
    else:
        excess = np.abs(local) - np.array(data["size"]) / 2
    return np.minimum(excess.max(axis=1), 0) + np.linalg.norm(np.maximum(excess, 0), axis=1)


def surface(shape, rng, count=3000):
    """Random points on a primitive's surface: outward rays, pulled back to distance zero."""
    directions = rng.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    near, far = np.zeros(count), np.ones(count)
    for _ in range(40):
        middle = (near + far) / 2
        inside = distance(shape, shape[2][:3, 3] + middle[:, None] * directions) < 0
        near, far = np.where(inside, middle, near), np.where(inside, far, middle)
    return shape[2][:3, 3] + near[:, None] * directions


def triangles(stl):
    data = stl.read_bytes()
    (count,) = struct.unpack_from("<I", data, 80)
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    return np.frombuffer(data, kind, count, 84)["corners"].astype(float)


def visual_points(folder):
    lines = [line for part in folder.glob("*.obj") for line in part.read_text().splitlines()]
    return np.array([numbers(line[2:]) for line in lines if line.startswith("v ")])


@pytest.mark.parametrize("link", [*ARM_LINKS, "hand"])
def test_primitives_fit_the_meshes(link):
    """The bounds that primitives.yaml states, where the meshes are installed."""
    meshes = ROBOTS.parent / "meshes"
    if not (meshes / "mujoco" / "visual" / link / "index.yaml").is_file():
        pytest.skip("the robots' meshes are not installed: run ./franka install")
    found = shapes(expand("panda/panda", hand="true").links[f"panda_{link}"])
    points = visual_points(meshes / "mujoco" / "visual" / link)
    assert np.min([distance(shape, points) for shape in found], axis=0).max() < 0.020

    corners = triangles(meshes / "collision" / f"{link}.stl")
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normals, axis=1)
    normals, corners = normals[size > 1e-12] / size[size > 1e-12, None], corners[size > 1e-12]
    offsets = np.einsum("ij,ij->i", normals, corners[:, 0])
    rng = np.random.default_rng(1)
    for shape in found:
        assert (surface(shape, rng) @ normals.T - offsets).max(axis=1).max() < 0.025
