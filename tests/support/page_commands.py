# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The commands on a page of the documentation, and whether what they name of this project exists: packages,
launch files and their arguments, nodes, options, topics, services, and lines for simulated robots.
"""

import json
import re
import shlex
import subprocess
from functools import cache
from pathlib import Path

import code_blocks
from code_blocks import SHELL, blocks_in, commands_in, script_of
from docsite.nodes import nodes_of
from docsite.packages import packages
from docsite.paths import SITE, TOP
from markdown_it import MarkdownIt
from operator_table import operator_table

Words = list[str]

# Programs of Debian's tf-tools and tf2-tools, which the pages say to install.
FROM_TOOLS = {("tf", "tf_monitor"), ("tf", "tf_echo"), ("tf2_ros", "static_transform_publisher")}
MAKES_A_PACKAGE = re.compile(r"(?:(?:new_controller|catkin_create_pkg|create pkg) |tests/out_of_tree/)(\w+)")
# Names that a page may use for what its reader has.
PLACEHOLDER = re.compile(r"my_\w+|[A-Z][A-Z-]*|\.\.\.")
# Commands in the text between blocks. A name alone is none.
INLINE = re.compile(
    r"(?:\./franka|ros(?:launch|run|service|topic|param|bag)|franka_(?:sim|info|desk)) .*"
    r"|echo '\w.* \| nc .*",
    re.S,
)
VERBS = {"echo", "hz", "pub", "list", "info", "type", "bw", "find", "call", "args", "uri"}


def scripts_of(text: str) -> list[str]:
    """The blocks of shell of a page, and the commands in its text."""
    scripts = [script_of(block) for block in blocks_in(text, "") if block.language in SHELL]
    for token in MarkdownIt().enable("table").parse(text):
        inline = [child.content for child in token.children or [] if child.type == "code_inline"]
        scripts += [" ".join(each.split()) for each in inline if INLINE.fullmatch(each)]
    return scripts


def commands_of(page: Path) -> list[Words]:
    """The words of a page's commands."""
    text = page.read_text(encoding="utf-8")
    return [words for script in scripts_of(text) for words in commands_in(script)]


def faults_in(text: str) -> list[str]:
    """Commands of a text in Markdown that could not run, with the reason."""
    made = set(MAKES_A_PACKAGE.findall(text))
    found = []
    for script in scripts_of(text):
        commands = commands_in(script)
        for words, receiver in zip(commands, [*commands[1:], [""]], strict=True):
            reason = (
                check_line(words) if words[0] == "echo" and receiver[0] == "nc" else wrong_in(words, made)
            )
            if reason:
                found.append(f"{shlex.join(words)}: {reason}")
    return found


def wrong_in(words: Words, made: set[str]) -> str:
    """The reason why a command could not run; empty if there is none. made: packages of the reader."""
    if words[:2] == ["./franka", "shell"] and len(words) > 2:
        return wrong_in(words[2:], made)
    # Packages of the reader, and topics in their namespaces.
    if words[0].startswith("ros") and any(f"/{name}" in f"/{word}" for name in made for word in words):
        return ""
    return CHECKS[words[0]](words) if words[0] in CHECKS else ""


# ---- programs --------------------------------------------------------------------------------------------


@cache
def own_commands() -> set[str]:
    result = subprocess.run([str(TOP / "franka"), "complete"], text=True, capture_output=True, check=True)
    return {*result.stdout.split(), "help", "-h"}


def check_franka(words: Words) -> str:
    if len(words) < 2 or words[1] in own_commands() or PLACEHOLDER.fullmatch(words[1]):
        return ""
    return f"./franka has no command {words[1]}"


@cache
def help_of(*command: str) -> str:
    result = subprocess.run([*command, "--help"], text=True, capture_output=True, timeout=60, check=False)
    return result.stdout + result.stderr


def check_options(words: Words) -> str:
    """Of a program that lists all its options."""
    subcommand = [word for word in words[1:2] if word == "record"]
    known = set(re.findall(r"--[a-z][\w-]*", help_of(words[0], *subcommand)))
    wrong = [word for word in words if word.startswith("--") and word.split("=")[0] not in known]
    return f"{words[0]} has no {wrong[0]}" if wrong else ""


# ---- packages --------------------------------------------------------------------------------------------


@cache
def folder_of(package: str) -> Path | None:
    """The folder of a package of ours or of Debian."""
    ours = [each.folder for each in packages() if each.name == package]
    path = ours[0] if ours else Path("/usr/share") / package
    return path if (path / "package.xml").is_file() else None


def launch_arguments(file: Path) -> set[str]:
    return code_blocks.launch_arguments(file, folder_of)


def check_roslaunch(words: Words) -> str:
    given = [word for word in words[1:] if not word.startswith("-")]
    if not given or given[0].endswith(".launch") or PLACEHOLDER.fullmatch(given[0]):
        return ""  # a file of the reader
    package, name, *arguments = given
    if folder_of(package) is None:
        return f"there is no package {package}"
    file = next(folder_of(package).glob(f"**/{name}"), None)
    if file is None:
        return f"{package} has no {name}"
    wrong = [word for word in arguments if word.partition(":=")[0] not in launch_arguments(file)]
    return f"{name} takes no {', '.join(wrong)}" if wrong else ""


def check_rosrun(words: Words) -> str:
    package, program = [word for word in words[1:] if not word.startswith("-")][:2]
    if (package, program) in FROM_TOOLS or PLACEHOLDER.fullmatch(package):
        return ""
    if folder_of(package) is None:
        return f"there is no package {package}"
    places = [TOP / "catkin_ws/devel/lib" / package, Path("/usr/lib") / package, folder_of(package)]
    found = [path for place in places for path in place.glob(f"**/{program}") if path.is_file()]
    return "" if found else f"{package} has no program {program}"


# ---- the graph -------------------------------------------------------------------------------------------


@cache
def names_of_reference() -> set[str]:
    """The last parts of the names of topics, services and actions that the reference has."""
    nodes = [node for file in (SITE / "nodes").glob("*.yaml") for node in nodes_of(file.stem)]
    found = [name for node in nodes for names in node.names.values() for name in names]
    found += re.findall(r"^\| `([~/][\w/]+)`", (TOP / "docs" / "franka_control.md").read_text(), re.M)
    return {
        "joint_states",
        "tf",
        "rosout",
        "diagnostics",
        *(name.rsplit("/", 1)[-1].lstrip("~") for name in found),
    }


def check_name(name: str) -> str:
    # The goal of an action is a topic below its name.
    known = any(part in names_of_reference() for part in name.split("/") if part)
    return "" if known else f"the reference has no {name}"


def check_graph(words: Words) -> str:
    """Of rostopic and rosservice."""
    given = positional(words[1:], with_value={"-n", "-r", "--rate", "-b", "--filter", "-w", "--window"})
    if not given or given[0] not in VERBS:
        return f"{words[0]} has no command {' '.join(given[:1])}"
    return check_name(given[1]) if len(given) > 1 else ""


def positional(words: Words, with_value: set[str]) -> Words:
    """Words without options, of which some have a value as the next word."""
    found, skip = [], False
    for word in words:
        if not skip and (not word.startswith("-") or ":" in word):
            found.append(word)
        skip = word in with_value
    return found


# ---- lines for simulated robots --------------------------------------------------------------------------


@cache
def operator_lines() -> list[dict]:
    """The rows of the table of operator commands, of robots with both kinds of hands."""
    return [row for hand in ("gripper", "vacuum") for row in json.loads(operator_table(hand))]


def check_line(words: Words) -> str:
    """Of `echo 'LINE' | nc`."""
    line = words[1].split()
    for row in operator_lines():
        name, arguments = row["name"].split(), row["arguments"]
        least = sum(each["count"] for each in arguments if not each["optional"])
        counts = {least, sum(each["count"] for each in arguments)}
        if line[: len(name)] == name and len(line) - len(name) in counts:
            return ""
    return "" if line[0] == "help" else f"no line '{words[1]}' of the control port"


CHECKS = {
    "./franka": check_franka,
    "roslaunch": check_roslaunch,
    "rosrun": check_rosrun,
    **dict.fromkeys(["rostopic", "rosservice"], check_graph),
    **dict.fromkeys(["franka_sim", "franka_info", "franka_desk"], check_options),
}
