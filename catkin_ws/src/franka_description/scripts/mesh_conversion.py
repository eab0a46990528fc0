# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Converts a COLLADA mesh into OBJ files with one color each, for MuJoCo.

MuJoCo reads neither COLLADA nor the colors of an OBJ. Debian's assimp reads the file and writes a
Y-up mesh; it is rotated back to the link's Z-up frame and split by color, and its bounding box is
compared with one computed from the COLLADA file itself.
"""

from __future__ import annotations

import itertools
import pathlib
import subprocess
import tempfile
import xml.etree.ElementTree
from collections.abc import Iterable, Mapping, Sequence

COLLADA = "{http://www.collada.org/2005/11/COLLADASchema}"
BOX_TOLERANCE = 1e-4  # [m]

Color = tuple[float, ...]  # red, green, blue, alpha
Box = tuple[tuple[float, ...], tuple[float, ...]]  # lower and upper corner
Corners = list[tuple[int, int]]  # of a face: numbers of a vertex and of its normal


class ConversionError(Exception):
    """The message names the mesh and the reason."""


def convert(dae: pathlib.Path, folder: pathlib.Path) -> None:
    """Writes 0.obj, 1.obj, ... and index.yaml for the mesh `dae` into the new folder `folder`.

    Raises ConversionError if assimp fails or the result has another bounding box than the original.
    """
    with tempfile.TemporaryDirectory(prefix="franka_meshes_") as scratch:
        obj = pathlib.Path(scratch, "mesh.obj")
        run_assimp(dae, obj)
        colors = read_colors(obj.with_suffix(".mtl"))
        mesh = ObjMesh(obj.read_text(encoding="ascii"))
    check_box(dae, mesh)
    parts = mesh.parts(colors)
    folder.mkdir(parents=True)
    index = []
    for number, (rgba, faces) in enumerate(parts.items()):
        name = f"{number}.obj"
        (folder / name).write_text(mesh.text(faces), encoding="ascii")
        index.append(f"- {{file: {name}, rgba: [{', '.join(map(str, rgba))}]}}\n")
    (folder / "index.yaml").write_text("".join(index), encoding="ascii")


def run_assimp(dae: pathlib.Path, obj: pathlib.Path) -> None:
    try:
        result = subprocess.run(
            ["assimp", "export", str(dae), str(obj)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            check=False,
        )
    except FileNotFoundError:
        raise ConversionError("assimp is not installed (Debian package assimp-utils)") from None
    if result.returncode != 0 or not obj.is_file():
        printed = result.stdout.strip().splitlines()[-1:] or ["nothing"]
        raise ConversionError(f"assimp could not convert {dae.name}; its output: {printed[0]}")


def read_colors(mtl: pathlib.Path) -> dict[str, Color]:
    """Material name -> (red, green, blue, alpha), each 0 to 1."""
    colors: dict[str, Color] = {}
    name = ""
    for line in mtl.read_text(encoding="utf-8", errors="replace").splitlines():
        word, _, rest = line.strip().partition(" ")
        if word == "newmtl":
            name = rest
            colors[name] = (1.0, 1.0, 1.0, 1.0)
        elif word == "Kd":
            colors[name] = (*map(float, rest.split()), colors[name][3])
        elif word == "d":
            colors[name] = (*colors[name][:3], float(rest))
    return colors


class ObjMesh:
    """An OBJ file of assimp's, turned from Y-up to Z-up."""

    def __init__(self, text: str):
        self.vertices: list[tuple[str, str, str]] = []
        self.normals: list[tuple[str, str, str]] = []
        self.faces: list[tuple[str, Corners]] = []  # with the material
        material = ""
        for line in text.splitlines():
            word, _, rest = line.partition(" ")
            if word == "v":
                self.vertices.append(z_up(rest))
            elif word == "vn":
                self.normals.append(z_up(rest))
            elif word == "usemtl":
                material = rest
            elif word == "f":
                corners = [(int(c[0]), int(c[-1])) for c in (t.split("/") for t in rest.split())]
                self.faces.append((material, corners))

    def box(self) -> Box:
        """Lower and upper corner [m] of the faces."""
        used = {corner[0] for _, corners in self.faces for corner in corners}
        return bounding_box(tuple(map(float, self.vertices[v - 1])) for v in used)

    def parts(self, colors: Mapping[str, Color]) -> dict[Color, list[Corners]]:
        """Faces by color, in the file's order."""
        parts: dict[Color, list[Corners]] = {}
        for material, corners in self.faces:
            parts.setdefault(colors.get(material, (1.0, 1.0, 1.0, 1.0)), []).append(corners)
        return parts

    def text(self, faces: Iterable[Corners]) -> str:
        """OBJ text of some of the faces with the vertices and normals they use."""
        vertices: dict[tuple[int, int], int] = {}
        normals: dict[int, int] = {}
        lines: list[str] = []
        edges: set[tuple[int, int]] = set()
        for triangle in itertools.chain.from_iterable(map(fan, faces)):
            # MuJoCo refuses meshes in which two faces run along an edge in the same direction, and
            # CAD meshes have some: the second of them gets its own vertices and looks the same.
            directed = {(triangle[i - 1][0], triangle[i][0]) for i in range(3)}
            copy = 0 if edges.isdisjoint(directed) else len(lines)
            if copy == 0:
                edges |= directed
            corners = [
                f"{vertices.setdefault((v, copy), len(vertices) + 1)}"
                f"//{normals.setdefault(n, len(normals) + 1)}"
                for v, n in triangle
            ]
            lines.append("f " + " ".join(corners))
        head = ["v " + " ".join(self.vertices[v - 1]) for v, _ in vertices]
        head += ["vn " + " ".join(self.normals[n - 1]) for n in normals]
        return "\n".join(head + lines) + "\n"


def fan(corners: Corners) -> list[Corners]:
    """The triangles of a convex polygon, without those in which a vertex repeats."""
    triangles = ([corners[0], b, c] for b, c in itertools.pairwise(corners[1:]))
    return [triangle for triangle in triangles if len({v for v, _ in triangle}) == 3]


def z_up(text: str) -> tuple[str, str, str]:
    """The three numbers of a Y-up vector as those of the same vector with Z up, still as text."""
    x, y, z = text.split()[:3]
    return x, z[1:] if z.startswith("-") else "-" + z, y


def check_box(dae: pathlib.Path, mesh: ObjMesh) -> None:
    if not mesh.faces:
        raise ConversionError(f"assimp found no face in {dae.name}")
    expected, found = collada_box(dae), mesh.box()
    worst = max(abs(expected[corner][axis] - found[corner][axis]) for corner in (0, 1) for axis in range(3))
    if worst > BOX_TOLERANCE:
        raise ConversionError(
            f"{dae.name} would end up elsewhere: its bounding box is {expected}, after conversion"
            f" {found} (allowed difference {BOX_TOLERANCE} m)"
        )


def bounding_box(points: Iterable[Sequence[float]]) -> Box:
    axes = list(zip(*points, strict=True))
    return tuple(map(min, axes)), tuple(map(max, axes))


def collada_box(dae: pathlib.Path) -> Box:
    """Lower and upper corner [m] of the triangles of a Z-up COLLADA file, by its own numbers."""
    root = xml.etree.ElementTree.parse(dae).getroot()
    unit = root.find(f"{COLLADA}asset/{COLLADA}unit")
    scale = float(unit.get("meter", "1")) if unit is not None else 1.0
    shapes = {g.get("id"): triangle_points(g) for g in root.iter(COLLADA + "geometry")}
    points: list[tuple[float, ...]] = []
    for node in root.iter(COLLADA + "node"):
        matrix = node.find(COLLADA + "matrix")
        m = numbers(matrix) if matrix is not None else IDENTITY
        for instance in node.findall(COLLADA + "instance_geometry"):
            points += [transform(m, p, scale) for p in shapes[instance.attrib["url"].lstrip("#")]]
    if not points:
        raise ConversionError(f"{dae.name} holds no triangles")
    return bounding_box(points)


IDENTITY = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]


def transform(m: Sequence[float], p: Sequence[float], scale: float) -> tuple[float, ...]:
    rows = (m[0:4], m[4:8], m[8:12])
    return tuple(scale * (a * p[0] + b * p[1] + c * p[2] + d) for a, b, c, d in rows)


def child(element: xml.etree.ElementTree.Element, path: str) -> xml.etree.ElementTree.Element:
    """The first element of this path. Raises ConversionError without one."""
    found = element.find(path)
    if found is None:
        what = path.replace(COLLADA, "")
        raise ConversionError(f"a {element.tag.replace(COLLADA, '')} of a mesh has no {what}")
    return found


def numbers(element: xml.etree.ElementTree.Element) -> list[float]:
    return [float(word) for word in (element.text or "").split()]


def triangle_points(geometry: xml.etree.ElementTree.Element) -> list[list[float]]:
    """The corners of a geometry's triangles; lines are left out, as in the converted mesh."""
    mesh = child(geometry, COLLADA + "mesh")
    positions = child(mesh, f"{COLLADA}vertices/{COLLADA}input[@semantic='POSITION']")
    source = positions.attrib["source"].lstrip("#")
    values = numbers(child(mesh, f"{COLLADA}source[@id='{source}']/{COLLADA}float_array"))
    used: set[int] = set()
    for triangles in mesh.findall(COLLADA + "triangles"):
        inputs = triangles.findall(COLLADA + "input")
        stride = 1 + max(int(i.attrib["offset"]) for i in inputs)
        offset = next(int(i.attrib["offset"]) for i in inputs if i.get("semantic") == "VERTEX")
        used.update(map(int, (child(triangles, COLLADA + "p").text or "").split()[offset::stride]))
    return [values[3 * i : 3 * i + 3] for i in used]
