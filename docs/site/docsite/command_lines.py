# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Command lines: the --help text of each program and of ./franka."""

import hashlib
import json
import os
import re
import subprocess
import sys
import typing
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from docsite.markdown import block, page
from docsite.packages import packages
from docsite.paths import DEVEL, OUT, TOP
from docsite.tree import Tree

# Programs of the build's tests, in the same folders as the others.
OF_TESTS = re.compile(r"_test(_node)?$|^test_|_bench$")
NO_MASTER = "http://127.0.0.1:9"  # the discard port: nothing listens there
KEPT = OUT / "help.json"
# Programs in C++, which docs need and whose targets have these names.
TARGETS = (
    "franka_sim",
    "franka_info",
    "franka_control_node",
    "franka_combined_control_node",
    "franka_sim_mujoco_node",
    "robot_joint_state_publisher",
    "gripper_joint_state_publisher",
)
# Words that come first on the command line of a program, and have options of their own.
SUBCOMMANDS = {"franka_plot": ("robot", "topic", "bag", "log"), "franka_info": ("record",)}


class Program(typing.NamedTuple):
    """A program: its package and its file, and how it is called if not by the file's name."""

    package: str
    path: Path
    called: str = ""
    note: str = ""
    start: tuple[str, ...] = ()  # the words that start it here

    @property
    def name(self) -> str:
        return self.called or self.path.name

    @property
    def command(self) -> tuple[str, ...]:
        return self.start or (str(self.path),)


WHEEL = TOP / "python" / "wheel" / "_programs.py"
ONLY_IN_THE_WHEEL = "Only [the wheel](../../python.md#without-ros-the-wheel) has it."
# Programs without a file of their name in the workspace.
OTHERS = (
    Program(
        "pyfranka",
        WHEEL,
        "pyfranka-examples",
        ONLY_IN_THE_WHEEL,
        (sys.executable, "-c", f"import runpy; runpy.run_path({str(WHEEL)!r})['examples']()"),
    ),
    Program(
        "pyfranka",
        TOP / "catkin_ws" / "src" / "franka_description" / "scripts" / "install_meshes",
        "pyfranka-meshes",
        ONLY_IN_THE_WHEEL,
    ),
)


def is_program(path: Path) -> bool:
    return (
        path.is_file()
        and os.access(path, os.X_OK)
        and not OF_TESTS.search(path.name)
        and path.suffix != ".in"
    )


def home_of(name: str) -> str:
    """The package of a program that is in the common folder."""
    if name == "franka_info":
        return "libfranka"
    return "pyfranka" if name.startswith("pyfranka") else "franka_ros"


def programs() -> list[Program]:
    """Scripts in the sources, built programs and OTHERS; each name once per package."""
    found: dict[tuple[str, str], Program] = {}
    for package in packages():
        built = [*DEVEL.glob(f"lib/{package.name}/*")]
        for path in sorted([*package.files("scripts/*"), *built]):
            if is_program(path):
                found.setdefault((package.name, path.name), Program(package.name, path))
    known = {name for _, name in found}
    for path in sorted(DEVEL.glob("bin/*")):
        if is_program(path) and path.name not in known:
            home = home_of(path.name)
            found[home, path.name] = Program(home, path)
    found |= {(each.package, each.name): each for each in OTHERS}
    return [found[key] for key in sorted(found)]


def fingerprint(path: Path) -> str:
    """Changes when the program changes; a script's text also depends on its modules."""
    parts = [path, *path.parent.parent.glob("src/**/*.py")]
    text = "".join(f"{part} {part.stat().st_mtime_ns}" for part in parts)
    return hashlib.sha256(text.encode()).hexdigest()


def help_of(*command: str) -> str:
    """The --help text of the program, after the words of a command.

    Raises RuntimeError with its name and its output if it does not answer.
    """
    result = subprocess.run(
        [*command, "--help"],
        env={**os.environ, "ROS_MASTER_URI": NO_MASTER, "COLUMNS": "100", "TERM": "dumb"},
        text=True,
        capture_output=True,
        stdin=subprocess.DEVNULL,
        timeout=120,
    )
    if result.returncode != 0:
        raise RuntimeError(f"{' '.join(command)} --help failed: {result.stderr or result.stdout}")
    return result.stdout.replace(f"{TOP}/", "").rstrip()


def subcommands_in(text: str) -> tuple[str, ...]:
    """The words that a help offers first on the command line."""
    found = re.search(r"^ *\{?(\w+(?:[,|]\w+)+)\}?$", text, re.M)
    if found:
        return tuple(re.split("[,|]", found[1]))
    return tuple(re.findall(r"^\w+ (\w+) --help:", text, re.M))


def all_help(found: list[Program]) -> dict[tuple[Program, str], str]:
    """The help of programs, and of their subcommands; that of unchanged ones is kept from the last run."""
    kept = json.loads(KEPT.read_text()) if KEPT.is_file() else {}
    keys = {
        (each, word): f"{each.name} {each.path} {word} {fingerprint(each.path)}"
        for each in found
        for word in ("", *SUBCOMMANDS.get(each.name, ()))
    }
    new = [call for call, key in keys.items() if key not in kept]
    with ThreadPoolExecutor(2) as pool:
        answers = pool.map(lambda call: help_of(*call[0].command, *call[1].split()), new)
        kept.update(zip((keys[call] for call in new), answers))
    KEPT.parent.mkdir(parents=True, exist_ok=True)
    new_file = KEPT.with_suffix(f".{os.getpid()}")  # another process may read the old one
    new_file.write_text(json.dumps({key: kept[key] for key in keys.values()}))
    new_file.replace(KEPT)
    return {call: kept[key] for call, key in keys.items()}


def describe(program: Program, answers: dict[tuple[Program, str], str]) -> str:
    """A section about a program."""
    parts = [f"## {program.name}", program.note, block("text", answers[program, ""])]
    for word in SUBCOMMANDS.get(program.name, ()):
        parts += [f"### {program.name} {word}", block("text", answers[program, word])]
    return "\n\n".join(part for part in parts if part)


def write_pages(tree: Tree) -> None:
    """A page for each package that has programs, and one for ./franka."""
    texts: dict[str, list[str]] = {}
    found = programs()
    answers = all_help(found)
    for each in found:
        texts.setdefault(each.package, []).append(describe(each, answers))
    for package, parts in texts.items():
        intro = f"In `./franka shell` they are found by their names, and by `rosrun {package} NAME`."
        tree.write(f"reference/programs/{package}.md", page(f"Programs of {package}", intro, *parts))
    own = subprocess.run([str(TOP / "franka"), "--help"], text=True, capture_output=True, check=True).stdout
    intro = "What the command of the repository can do:"
    tree.write("reference/programs/franka.md", page("./franka", intro, block("text", own)))
    names = "\n".join(["franka", *texts])
    intro = "What each program answers to `--help`."
    tree.write(
        "reference/programs/index.md",
        page("Command lines", intro, f"```{{toctree}}\n:maxdepth: 2\n\n{names}\n```"),
    )
