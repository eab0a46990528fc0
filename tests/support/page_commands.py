# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The commands on a page of the documentation, and whether what they name exists: programs, launch files and
their arguments, options, topics, services, types with their fields, files, and lines for simulated robots.
"""

import re
import shlex
import shutil
import subprocess
from functools import cache
from pathlib import Path

import code_blocks
import genpy
import roslib.message
import yaml
from code_blocks import SHELL, blocks_in, commands_in, script_of
from docsite.nodes import nodes_of
from docsite.packages import packages
from docsite.paths import SITE, TOP
from markdown_it import MarkdownIt

Words = list[str]

# Programs that are not installed with this project: readers have them, or install them as the page says.
ELSEWHERE = {
    *("addgroup", "adduser", "apt", "apt-cache", "apt-get", "chrt", "code", "cpupower", "cyclictest"),
    *("docker", "ethtool", "gh", "git", "ip", "nc", "nft", "nmcli", "ping", "pyfranka-meshes", "reboot"),
    *("scp", "ss", "ssh", "stress-ng", "sudo", "sysctl", "systemctl", "udevadm", "update-grub", "usermod"),
}
# Programs of Debian's tf-tools and tf2-tools, which the pages say to install.
FROM_TOOLS = {("tf", "tf_monitor"), ("tf", "tf_echo"), ("tf2_ros", "static_transform_publisher")}
# Folders that a reader has made before, and the page says how.
OF_THE_READER = re.compile(r"(~|\$\w+|\$\{\w+\}|build|env|\.venv|devel|install|\.)/")
MAKES_A_PACKAGE = re.compile(r"(?:(?:new_controller|catkin_create_pkg|create pkg) |tests/out_of_tree/)(\w+)")
# Names that a page may use for what its reader has.
PLACEHOLDER = re.compile(r"my_\w+|[A-Z][A-Z-]*|\.\.\.")
# Commands in the text between blocks. A name alone is none.
INLINE = re.compile(
    r"(?:\./franka|ros(?:launch|run|service|topic|param|bag)|franka_(?:sim|info|desk)) .*"
    r"|echo '\w.* \| nc .*",
    re.S,
)
TOPIC_VERBS = {"echo", "hz", "pub", "list", "info", "type", "bw", "find"}
SERVICE_VERBS = {"call", "info", "type", "args", "list", "find", "uri"}


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


def faults(page: Path) -> list[str]:
    """Commands of a page that could not run, with the reason."""
    return faults_in(page.read_text(encoding="utf-8"))


def faults_in(text: str) -> list[str]:
    """The same for a text in Markdown."""
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
    if words[0] in CHECKS:
        return CHECKS[words[0]](words)
    return check_program(words[0])


# ---- programs and files ----------------------------------------------------------------------------------


@cache
def words_of_bash() -> set[str]:
    result = subprocess.run(["bash", "-c", "compgen -bkA function"], text=True, capture_output=True)
    return set(result.stdout.split())


def check_program(name: str) -> str:
    if name in words_of_bash() | ELSEWHERE | {"VALUE"} or shutil.which(name):
        return ""
    if OF_THE_READER.match(name) or PLACEHOLDER.fullmatch(name) or (TOP / name).is_file():
        return ""
    return f"there is no command {name}"


@cache
def own_commands() -> set[str]:
    result = subprocess.run([str(TOP / "franka"), "complete"], text=True, capture_output=True, check=True)
    return {*result.stdout.split(), "help", "-h"}


def check_franka(words: Words) -> str:
    if len(words) < 2 or words[1] in own_commands() or PLACEHOLDER.fullmatch(words[1]):
        return ""
    return f"./franka has no command {words[1]}"


def check_python(words: Words) -> str:
    given = [word for word in words[1:] if not word.startswith("-")]
    if "-m" in words or "-c" in words or not given or "/" not in given[0] or OF_THE_READER.match(given[0]):
        return ""
    return "" if (TOP / given[0]).exists() else f"there is no {given[0]}"


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
def types_by_name() -> dict[str, set[str]]:
    """Types by the last parts of the names of topics, services and actions that the reference has."""
    types: dict[str, set[str]] = {name: set() for name in ("joint_states", "tf", "rosout", "diagnostics")}
    for file in (SITE / "nodes").glob("*.yaml"):
        for node in nodes_of(file.stem):
            for names in node.names.values():
                for name, (kind, *_) in names.items():
                    types.setdefault(last_part(name), set()).add(kind)
    table = (TOP / "docs" / "franka_control.md").read_text()
    for name in re.findall(r"^\| `([~/][\w/]+)`", table, re.M):
        types.setdefault(last_part(name), set())
    return types


def last_part(name: str) -> str:
    return name.rsplit("/", 1)[-1].lstrip("~")


def check_name(name: str) -> str:
    # The goal of an action is a topic below its name.
    known = any(part in types_by_name() for part in name.split("/") if part)
    return "" if known else f"the reference has no {name}"


def check_rostopic(words: Words) -> str:
    given = positional(words[1:], with_value={"-n", "-r", "--rate", "-b", "--filter", "-w", "--window"})
    if not given or given[0] not in TOPIC_VERBS:
        return f"rostopic has no command {' '.join(given[:1])}"
    if len(given) < 2:
        return ""
    verb, name, *rest = given
    return check_name(name) or (check_message(*rest) if verb == "pub" else "")


def check_rosservice(words: Words) -> str:
    given = positional(words[1:], with_value=set())
    if not given or given[0] not in SERVICE_VERBS:
        return f"rosservice has no command {' '.join(given[:1])}"
    if len(given) < 2:
        return ""
    verb, name, *rest = given
    return check_name(name) or (check_request(name, rest) if verb == "call" else "")


def positional(words: Words, with_value: set[str]) -> Words:
    """Words without options, of which some have a value as the next word."""
    found, skip = [], False
    for word in words:
        if not skip and (not word.startswith("-") or ":" in word):
            found.append(word)
        skip = word in with_value
    return found


def check_message(kind: str = "", *values: str) -> str:
    cls = roslib.message.get_message_class(kind)
    return filled(cls(), values) if cls else f"there is no type {kind}"


def check_request(name: str, values: Words) -> str:
    """The values must be a request of one of the types that services of this name have."""
    classes = [roslib.message.get_service_class(kind) for kind in sorted(types_by_name()[last_part(name)])]
    reasons = [filled(cls._request_class(), values) for cls in classes if cls]
    return "" if "" in reasons or not reasons else reasons[0]


def filled(message, values) -> str:
    """The reason why values in YAML cannot fill a message; empty if they can."""
    given = [yaml.safe_load(value) for value in values]
    if given in ([], [{}], [None]):
        return ""
    try:
        genpy.message.fill_message_args(message, given)
    except (genpy.MessageException, ValueError, TypeError) as error:
        return str(error)
    return ""


# ---- lines for simulated robots --------------------------------------------------------------------------


@cache
def control_lines() -> set[str]:
    """First words of the lines of franka_sim's control port."""
    sources = [file.read_text() for file in (TOP / "catkin_ws/src/franka_sim/src").rglob("*.cpp")]
    return {"help"} | {word for text in sources for word in re.findall(r'\.add\(\s*"(\w+)', text)}


def check_line(words: Words) -> str:
    """Of `echo 'LINE' | nc`."""
    word = words[1].split()[0]
    return "" if word in control_lines() else f"no line {word} of the control port"


# ---- images ----------------------------------------------------------------------------------------------


def check_docker(words: Words) -> str:
    """The stages and the arguments of the Dockerfile that a build names."""
    text = (TOP / "Dockerfile").read_text(encoding="utf-8")
    for option, value in zip(words, words[1:], strict=False):
        name = value.partition("=")[0]
        pattern = {"--target": rf"^FROM .* AS {name}$", "--build-arg": rf"^ARG {name}\b"}.get(option)
        if pattern and not re.search(pattern, text, re.MULTILINE):
            return f"the Dockerfile has no {name}"
    return ""


CHECKS = {
    "./franka": check_franka,
    "docker": check_docker,
    "roslaunch": check_roslaunch,
    "rosrun": check_rosrun,
    "rostopic": check_rostopic,
    "rosservice": check_rosservice,
    "python3": check_python,
    **dict.fromkeys(["franka_sim", "franka_info", "franka_desk"], check_options),
}
