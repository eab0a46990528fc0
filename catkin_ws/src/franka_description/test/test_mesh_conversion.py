# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Conversion of a small COLLADA file of which every coordinate is known."""

import shutil

import mesh_conversion
import pytest
from description_robot import numbers

needs_assimp = pytest.mark.skipif(shutil.which("assimp") is None, reason="assimp is not installed")

# Two triangles in red and one in blue on a 10 mm grid, lifted by 0.5 m.
RED = [(0, 0, 0), (2, 0, 0), (0, 3, 0), (2, 3, 1)]
BLUE = [(0, 0, 1), (4, 0, 1), (0, 0, 7)]


def material(name, rgba):
    return f"""<effect id="{name}-e"><profile_COMMON><technique sid="common"><lambert>
      <diffuse><color>{rgba}</color></diffuse></lambert></technique></profile_COMMON></effect>"""


def geometry(name, points, triangles):
    values = " ".join(str(v / 100) for point in points for v in point)
    count = len(points)
    return f"""<geometry id="{name}"><mesh>
      <source id="{name}-p"><float_array id="{name}-a" count="{3 * count}">{values}</float_array>
        <technique_common><accessor source="#{name}-a" count="{count}" stride="3">
          <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
        </accessor></technique_common></source>
      <vertices id="{name}-v"><input semantic="POSITION" source="#{name}-p"/></vertices>
      <triangles material="m" count="{len(triangles) // 3}">
        <input semantic="VERTEX" source="#{name}-v" offset="0"/>
        <p>{" ".join(map(str, triangles))}</p></triangles></mesh></geometry>"""


def node(name):
    return f"""<node id="{name}-n"><matrix>1 0 0 0 0 1 0 0 0 0 1 0.5 0 0 0 1</matrix>
      <instance_geometry url="#{name}"><bind_material><technique_common>
        <instance_material symbol="m" target="#{name}-m"/>
      </technique_common></bind_material></instance_geometry></node>"""


def collada(red_triangles=(0, 1, 2, 1, 3, 2)):
    colors = {"red": "1 0 0 1", "blue": "0 0 1 1"}
    effect = '<instance_effect url="#{0}-e"/>'
    materials = [f'<material id="{n}-m">{effect.format(n)}</material>' for n in colors]
    return f"""<?xml version="1.0"?>
    <COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
      <asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
      <library_effects>{"".join(material(n, c) for n, c in colors.items())}</library_effects>
      <library_materials>
        {"".join(materials)}
      </library_materials>
      <library_geometries>{geometry("red", RED, red_triangles)}{geometry("blue", BLUE, [0, 1, 2])}
      </library_geometries>
      <library_visual_scenes><visual_scene id="s">{node("red")}{node("blue")}</visual_scene>
      </library_visual_scenes>
      <scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


def read(obj):
    """Each face of an OBJ as its corners' coordinates."""
    lines = obj.read_text().splitlines()
    vertices = [tuple(numbers(line[2:])) for line in lines if line.startswith("v ")]
    normals = [line for line in lines if line.startswith("vn ")]
    faces = []
    for line in lines:
        if line.startswith("f "):
            pairs = [tuple(map(int, corner.split("//"))) for corner in line.split()[1:]]
            assert all(1 <= n <= len(normals) for _, n in pairs)
            faces.append([vertices[v - 1] for v, _ in pairs])
    return faces


def lifted(points):
    return {(x / 100, y / 100, z / 100 + 0.5) for x, y, z in points}


def rounded(faces):
    return {tuple(round(v, 6) for v in corner) for face in faces for corner in face}


@needs_assimp
def test_coordinates_are_kept_and_colors_are_split(tmp_path):
    (tmp_path / "part.dae").write_text(collada())
    mesh_conversion.convert(tmp_path / "part.dae", tmp_path / "out" / "part")
    index = (tmp_path / "out" / "part" / "index.yaml").read_text().splitlines()
    assert sorted(line.partition("rgba: ")[2] for line in index) == [
        "[0.0, 0.0, 1.0, 1.0]}",
        "[1.0, 0.0, 0.0, 1.0]}",
    ]
    for line in index:
        faces = read(tmp_path / "out" / "part" / line.split("file: ")[1].split(",")[0])
        red = "[1.0, 0.0" in line
        assert len(faces) == (2 if red else 1)
        assert rounded(faces) == {tuple(round(v, 6) for v in p) for p in lifted(RED if red else BLUE)}


@needs_assimp
def test_orientation_of_faces_is_kept(tmp_path):
    (tmp_path / "part.dae").write_text(collada())
    mesh_conversion.convert(tmp_path / "part.dae", tmp_path / "part")
    faces = [f for n in (0, 1) for f in read(tmp_path / "part" / f"{n}.obj")]
    flat = next(f for f in faces if all(abs(corner[2] - 0.5) < 1e-9 for corner in f))
    (ax, ay, _), (bx, by, _), (cx, cy, _) = flat
    assert (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) > 0  # counter-clockwise seen from above


@needs_assimp
def test_faces_with_inconsistent_edges_get_their_own_vertices(tmp_path):
    (tmp_path / "part.dae").write_text(collada(red_triangles=(0, 1, 2, 1, 2, 3)))
    mesh_conversion.convert(tmp_path / "part.dae", tmp_path / "part")
    for number in (0, 1):
        lines = (tmp_path / "part" / f"{number}.obj").read_text().splitlines()
        faces = [[c.split("//")[0] for c in line.split()[1:]] for line in lines if line[0] == "f"]
        edges = [(f[i - 1], f[i]) for f in faces for i in range(3)]
        assert len(edges) == len(set(edges))


def test_triangles_without_area_are_dropped():
    assert mesh_conversion.fan([(1, 1), (2, 1), (1, 2)]) == []
    assert len(mesh_conversion.fan([(1, 1), (2, 1), (3, 1), (4, 1)])) == 2


def test_bounding_box_of_collada(tmp_path):
    (tmp_path / "part.dae").write_text(collada())
    low, high = mesh_conversion.collada_box(tmp_path / "part.dae")
    assert low == pytest.approx((0, 0, 0.5))
    assert high == pytest.approx((0.04, 0.03, 0.57))


@needs_assimp
def test_a_displaced_mesh_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(mesh_conversion, "z_up", lambda text: tuple(text.split()[:3]))
    (tmp_path / "part.dae").write_text(collada())
    with pytest.raises(mesh_conversion.ConversionError, match="part.dae would end up elsewhere"):
        mesh_conversion.convert(tmp_path / "part.dae", tmp_path / "part")
    assert not (tmp_path / "part").exists()


@needs_assimp
def test_a_file_that_is_not_a_mesh_is_refused(tmp_path):
    (tmp_path / "part.dae").write_text("nothing")
    with pytest.raises(mesh_conversion.ConversionError, match="assimp could not convert part.dae"):
        mesh_conversion.convert(tmp_path / "part.dae", tmp_path / "part")


def test_missing_assimp_is_reported(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(mesh_conversion.ConversionError, match="assimp-utils"):
        mesh_conversion.convert(tmp_path / "part.dae", tmp_path / "part")
