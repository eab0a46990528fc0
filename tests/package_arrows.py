#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Which part of the project includes or imports which, read from the sources.

Prints a table: lines of product (C++, Python, JavaScript and shell, without tests and benchmarks), and the
other parts that a part uses. `--docs` writes it into docs/architecture.md, without the lines; `--dot` prints
the same as a graph, which `dot -Tsvg` draws. The style check `arrows` fails if a part uses one that PARTS
lists above it, if a package is too large, or if the document has other arrows.
"""

import argparse
import ast
import re
import sys
from collections.abc import Callable, Iterable, Iterator
from fnmatch import fnmatch
from functools import cache
from pathlib import Path
from typing import NamedTuple

TOP = Path(__file__).resolve().parent.parent
WORKSPACE = TOP / "catkin_ws" / "src"
PAGE = TOP / "docs" / "architecture.md"
BEGIN, END = "<!-- made by tests/package_arrows.py -->\n", "<!-- end -->"
MAX_LINES = 13000
# What still breaks these rules, and goes.
UPWARD = {("pyfranka", "pyfranka.sweep")}  # its name, for type checkers
TOO_LARGE = {"franka_sim", "python"}
NOT_PRODUCT = {"test", "tests", "bench", "docs", "ci", "tools"}
LANGUAGES = {".cpp", ".h", ".hpp", ".py", ".pyi", ".js"}
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.M)


class Part(NamedTuple):
    """A part of the project. patterns: its files; of several parts that match a file the last one has it."""

    name: str
    also: str  # libraries of others, and what the part is for if its name does not say it
    patterns: tuple[str, ...]


def package(name: str, also: str = "", folder: str = "") -> Part:
    return Part(name, also, (f"catkin_ws/src/{folder or name}/*",))


def folder_of(name: str, folder: str, also: str = "") -> Part:
    """A folder of a package, with its public headers."""
    home = f"catkin_ws/src/{name}"
    return Part(f"{name}/{folder}", also, (f"{home}/src/{folder}/*", f"{home}/include/{name}/{folder}/*"))


def modules(name: str, *patterns: str, also: str = "") -> Part:
    return Part(name, also, tuple(f"python/src/pyfranka/{pattern}" for pattern in patterns))


# From above to below: a part may use those that come after it.
PARTS = (
    Part("examples", "programs to begin with", ("examples/*",)),
    package("gazebo_ros", "names only"),
    package("franka_gazebo", "names only"),
    package("franka_example_controllers"),
    package("franka_sim_mujoco", "tf, rviz"),
    package("franka_control"),
    package("franka_visualization"),
    package("franka_gripper"),
    modules("pyfranka.desk", "desk/*", also="aiohttp, cryptography; the robot by its control interface only"),
    modules("pyfranka.sweep", "sweeps.py", "_sweep*.py", also="dask"),
    modules("pyfranka.gym", "gym/*", also="Gymnasium, SciPy"),
    modules("pyfranka.plot", "plot/*", "franka_plot.py", also="Matplotlib, SciPy; rospy for topics and bags"),
    Part("pyfranka", "pybind11", ("python/*",)),
    package("franka_hw", "KDL"),
    folder_of("franka_sim", "app", "CLI11"),
    folder_of("franka_sim", "simulation", "oneTBB"),
    folder_of("franka_sim", "serve", "sockets"),
    folder_of("franka_sim", "fci", "sockets"),
    folder_of("franka_sim", "physics", "MuJoCo, assimp, meshoptimizer, GLFW, EGL, OSMesa"),
    folder_of("franka_sim", "robot", "computation only"),
    # Two public headers of franka_core convert into its types, and no source of franka_core includes them.
    Part(
        "libfranka",
        "sockets",
        (
            "catkin_ws/src/libfranka/*",
            "catkin_ws/src/libfranka/include/franka_core/to_franka.h",
            "catkin_ws/src/libfranka/include/franka_core/diagnose_log.h",
        ),
    ),
    Part(
        "franka_core",
        "Eigen, urdfdom, tinyxml2",
        tuple(
            f"catkin_ws/src/libfranka/{pattern}"
            for pattern in (
                "src/core/*",
                "src/fci/*",
                "include/franka_core/*",
                "include/research_interface/*",
            )
        ),
    ),
    package("rospy_connections", "rospy"),
    package("franka_description"),
    package("franka_msgs", "names only"),
    package("gazebo_msgs", "names only"),
    Part("ros_controllers", "roscpp, tf", ("catkin_ws/src/ros_control/*_controller*/*",)),
    Part("ros_control", "roscpp, pluginlib", ("catkin_ws/src/ros_control/*",)),
)
RANK = {part.name: rank for rank, part in enumerate(PARTS)}


# ---- files -----------------------------------------------------------------------------------------------


def files_of_product() -> list[Path]:
    """Sources of the product, relative to the root."""
    sys.path.insert(0, str(TOP / "docs" / "site"))
    from docsite.paths import files_of_repository

    found = []
    for path in files_of_repository():
        place = path.relative_to(TOP)
        if not NOT_PRODUCT & set(place.parts) and (path.suffix in LANGUAGES or is_script(path)):
            found.append(place)
    return found


def is_script(path: Path, program: bytes = b"") -> bool:
    with path.open("rb") as file:
        first = file.readline(80)
    return not path.suffix and first.startswith(b"#!") and program in first


@cache
def part_of(place: Path) -> str:
    """The part that has a file; that with the longest pattern if several match. Empty: none."""
    found = [
        (len(pattern), part.name) for part in PARTS for pattern in part.patterns if fnmatch(place, pattern)
    ]
    return max(found)[1] if found else ""


def package_of(place: Path) -> Path:
    """The folder of a file's package."""
    if place.parts[0] == "catkin_ws":
        return Path(*place.parts[: 4 if "ros_control" in place.parts else 3])
    return Path(place.parts[0])


def lines_of(place: Path) -> int:
    return len((TOP / place).read_text(encoding="utf-8", errors="replace").splitlines())


# ---- includes and imports --------------------------------------------------------------------------------


class Names:
    """What sources may name: headers by the paths behind include/ and src/, modules, and ROS packages."""

    def __init__(self, files: list[Path]):
        self.parts: dict[str, set[str]] = {}
        for place in files:
            for root in ("/include/", "/src/", "/scripts/", "/python/"):
                _, found, name = str(place).removeprefix("catkin_ws/src/").rpartition(root)
                if found:
                    self._add(name, place)
        # Headers and modules that the build makes of messages are named like the package.
        for file in [*WORKSPACE.glob("*/package.xml"), *WORKSPACE.glob("ros_control/*/package.xml")]:
            self._add(file.parent.name, file.resolve().relative_to(TOP))

    def _add(self, name: str, place: Path) -> None:
        self.parts.setdefault(name, set()).add(part_of(place))

    def part(self, name: str) -> str:
        """The only part that has the name; empty if there is none, or several."""
        found = self.parts.get(name, set())
        return next(iter(found)) if len(found) == 1 else ""


def included(place: Path, files: set[Path], names: Names) -> Iterator[str]:
    """The parts whose headers a source includes."""
    for mark, name in INCLUDE.findall((TOP / place).read_text(encoding="utf-8", errors="replace")):
        own = [each for each in (place.parent / name, package_of(place) / "src" / name) if each in files]
        if mark == '"' and own:
            yield part_of(own[0])
        else:
            yield names.part(name) or names.part(name.partition("/")[0])


def imported(place: Path, names: Names) -> Iterator[str]:
    """The parts whose modules a source imports."""
    for node in ast.walk(ast.parse((TOP / place).read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            modules = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            modules = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        for module in modules:
            steps = module.split(".")
            candidates = ["/".join(steps[:i]) for i in range(len(steps), 0, -1)]
            paths = [f"{name}{end}" for name in candidates for end in (".py", "/__init__.py")]
            yield next((part for part in map(names.part, paths) if part), names.part(steps[0]))


def arrows(files: list[Path]) -> dict[str, dict[str, list[Path]]]:
    """For each part the others that it uses, and the files that use them."""
    names, known = Names(files), set(files)
    found: dict[str, dict[str, list[Path]]] = {part.name: {} for part in PARTS}
    for place in files:
        own = part_of(place)
        if own:
            used: Iterator[str] = iter(())
            if place.suffix in {".cpp", ".h", ".hpp"}:
                used = included(place, known, names)
            elif place.suffix == ".py" or is_script(TOP / place, b"python"):
                used = imported(place, names)
            for other in set(used) - {own, ""}:
                found[own].setdefault(other, []).append(place)
    return found


# ---- what is made of them --------------------------------------------------------------------------------


def sizes(files: list[Path], name_of: Callable[[Path], str] = part_of) -> dict[str, int]:
    """Lines of product for each part, or for other groups of files."""
    found = dict.fromkeys(RANK, 0) if name_of is part_of else {}
    for place in files:
        if part_of(place):
            found[name_of(place)] = found.get(name_of(place), 0) + lines_of(place)
    return found


def package_sizes(files: list[Path]) -> dict[str, int]:
    return sizes(files, lambda place: package_of(place).name)


def sorted_names(names: Iterable[str]) -> str:
    return ", ".join(sorted(names, key=RANK.__getitem__)) or "–"


def table(found: dict[str, dict[str, list[Path]]]) -> str:
    """The table of docs/architecture.md, from below to above."""
    rows = [f"| {part.name} | {sorted_names(found[part.name])} | {part.also} |" for part in reversed(PARTS)]
    return "\n".join(["| part | uses | and |", "|---|---|---|", *rows]) + "\n"


def direct(found: dict[str, dict[str, list[Path]]]) -> dict[str, set[str]]:
    """The arrows downwards without those that others imply."""
    below: dict[str, set[str]] = {}
    shown: dict[str, set[str]] = {}
    for part in reversed(PARTS):
        used = {other for other in found[part.name] if other in below}
        implied: set[str] = set().union(*(below[other] for other in used))
        below[part.name] = used | implied
        shown[part.name] = used - implied
    return shown


def graph(found: dict[str, dict[str, list[Path]]], lines: dict[str, int]) -> str:
    """For `dot`. Arrows that others imply are left out; those upwards are red."""
    nodes = [f'  "{name}" [label="{name}\\n{count}"];' for name, count in lines.items()]
    edges = [f'  "{name}" -> "{each}";' for name, used in direct(found).items() for each in sorted(used)]
    upward = [
        f'  "{name}" -> "{each}" [color=red];'
        for name, used in found.items()
        for each in used
        if RANK[each] < RANK[name]
    ]
    return "\n".join(["digraph parts {", "  node [shape=box, fontname=sans];", *nodes, *edges, *upward, "}"])


def findings() -> list[str]:
    """Arrows upwards, packages that are too large, files without a part, and an outdated document."""
    files = files_of_product()
    found = arrows(files)
    wrong = [
        f"{users[0]}:1: {name} must not use {other}, which PARTS of tests/package_arrows.py lists above it"
        for name, used in found.items()
        for other, users in used.items()
        if RANK[other] < RANK[name] and (name, other) not in UPWARD
    ]
    wrong += [
        f"tests/package_arrows.py:1: {name} does not use {other}: remove it from UPWARD"
        for name, other in UPWARD
        if other not in found[name]
    ]
    wrong += [
        f"tests/package_arrows.py:1: {name} has {count} lines of product; the limit is {MAX_LINES}"
        for name, count in package_sizes(files).items()
        if (count > MAX_LINES) != (name in TOO_LARGE)
    ]
    wrong += [
        f"{place}:1: belongs to no part; add one to PARTS of tests/package_arrows.py"
        for place in files
        if WORKSPACE in (TOP / place).parents and not part_of(place)
    ]
    if table(found) not in PAGE.read_text(encoding="utf-8"):
        wrong.append(
            "docs/architecture.md:1: other arrows than the sources: run tests/package_arrows.py --docs"
        )
    return wrong


def write_page() -> None:
    text = PAGE.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    PAGE.write_text(f"{before}{BEGIN}\n{table(arrows(files_of_product()))}\n{END}{rest.partition(END)[2]}")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--docs", action="store_true", help="write the table of docs/architecture.md")
    parser.add_argument("--dot", action="store_true", help="print a graph for the program dot")
    options = parser.parse_args()
    files = files_of_product()
    found, lines = arrows(files), sizes(files)
    if options.docs:
        write_page()
    elif options.dot:
        print(graph(found, lines))
    else:
        for name, used in found.items():
            print(f"{name:<27}{lines[name]:>7}  {sorted_names(used)}")
        print(f"{'all parts':<27}{sum(lines.values()):>7}")
        for name, count in package_sizes(files).items():
            if count > MAX_LINES:
                print(f"package {name:<19}{count:>7}  of at most {MAX_LINES}")
        print("\n".join(findings()))


if __name__ == "__main__":
    main()
