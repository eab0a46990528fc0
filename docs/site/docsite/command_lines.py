# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Command lines: the --help text of each program and of ./franka."""

import hashlib
import json
import os
import re
import subprocess
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
    """A program: its package and its file."""

    package: str
    path: Path


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
    """Scripts in the sources and built programs; each name once per package."""
    found: dict[tuple[str, str], Program] = {}
    for package in packages():
        built = [*DEVEL.glob(f"lib/{package.name}/*")]
        for path in sorted([*package.files("scripts/*"), *built]):
            if is_program(path):
                found.setdefault((package.name, path.name), Program(package.name, path))
    known = {name for _, name in found}
    for path in sorted(DEVEL.glob("bin/*")):
        if is_program(path) and path.name not in known:
            package = home_of(path.name)
            found[package, path.name] = Program(package, path)
    return [found[key] for key in sorted(found)]


def fingerprint(path: Path) -> str:
    """Changes when the program changes; a script's text also depends on its modules."""
    parts = [path, *path.parent.parent.glob("src/**/*.py")]
    text = "".join(f"{part} {part.stat().st_mtime_ns}" for part in parts)
    return hashlib.sha256(text.encode()).hexdigest()


def help_of(path: Path, *words: str) -> str:
    """The --help text of the program, after these words.

    Raises RuntimeError with its name and its output if it does not answer.
    """
    result = subprocess.run(
        [str(path), *words, "--help"],
        env={**os.environ, "ROS_MASTER_URI": NO_MASTER, "COLUMNS": "100", "TERM": "dumb"},
        text=True,
        capture_output=True,
        stdin=subprocess.DEVNULL,
        timeout=120,
    )
    if result.returncode != 0:
        raise RuntimeError(f"{path} --help failed: {result.stderr or result.stdout}")
    return result.stdout.replace(f"{TOP}/", "").rstrip()


def subcommands_in(text: str) -> tuple[str, ...]:
    """The words that a help offers first on the command line."""
    found = re.search(r"^ *\{?(\w+(?:[,|]\w+)+)\}?$", text, re.M)
    if found:
        return tuple(re.split("[,|]", found[1]))
    return tuple(re.findall(r"^\w+ (\w+) --help:", text, re.M))


def all_help(found: list[Program]) -> dict[tuple[Path, str], str]:
    """The help of programs, and of their subcommands; that of unchanged ones is kept from the last run."""
    kept = json.loads(KEPT.read_text()) if KEPT.is_file() else {}
    keys = {
        (each.path, word): f"{each.path} {word} {fingerprint(each.path)}"
        for each in found
        for word in ("", *SUBCOMMANDS.get(each.path.name, ()))
    }
    new = [call for call, key in keys.items() if key not in kept]
    with ThreadPoolExecutor(2) as pool:
        answers = pool.map(lambda call: help_of(call[0], *call[1].split()), new)
        kept.update(zip((keys[call] for call in new), answers))
    KEPT.parent.mkdir(parents=True, exist_ok=True)
    KEPT.write_text(json.dumps({key: kept[key] for key in keys.values()}))
    return {call: kept[key] for call, key in keys.items()}


def describe(program: Program, answers: dict[tuple[Path, str], str]) -> str:
    """A section about a program."""
    parts = [f"## {program.path.name}", block("text", answers[program.path, ""])]
    for word in SUBCOMMANDS.get(program.path.name, ()):
        parts += [f"### {program.path.name} {word}", block("text", answers[program.path, word])]
    return "\n\n".join(parts)


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
