# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The pages of docs/troubleshooting: the sources of the named programs have their messages."""

import re
import sys
from functools import lru_cache
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
PAGES = sorted((TOP / "docs/troubleshooting").glob("*.md"))
SOURCES = TOP / "catkin_ws/src"
LIBRARIES = "/usr/lib/*-linux-gnu"
PYTHON = "/usr/lib/python3/dist-packages"

# Files with the messages of each program. Ours are searched for string literals, those of Debian for bytes.
OURS = {
    "libfranka": ["libfranka/src", "libfranka/include"],
    "the robot": ["libfranka/include/franka_core"],
    "franka_info": ["libfranka/tools"],
    "franka_control_node": ["franka_hw/src", "franka_control/src"],
    "franka_combined_control_node": ["franka_hw/src", "franka_control/src"],
    "franka_gripper_node": ["franka_gripper"],
    "the controller manager": ["ros_control"],
    "spawner": ["ros_control/controller_manager"],
    "the simulation": ["franka_sim", "franka_sim_mujoco"],
    "franka_sim": ["franka_sim"],
    "the example controllers": ["franka_example_controllers/src"],
    "parameter_sliders": ["franka_example_controllers/scripts"],
    "new_controller": ["franka_example_controllers/scripts"],
    "pyfranka": ["../../python/src"],
    "`./franka`": ["../../franka"],
}
OF_DEBIAN = {
    "roslaunch": [f"{PYTHON}/roslaunch/*.py"],
    "rostopic, rosnode, rosservice": [f"{PYTHON}/ros{name}/*.py" for name in ("topic", "node", "service")],
    "rosservice": [f"{PYTHON}/rosservice/*.py"],
    "rospack": [f"{LIBRARIES}/librospack.so*"],
    "tf2": [f"{LIBRARIES}/libtf2.so*"],
    "rviz": [f"{LIBRARIES}/librviz*.so*"],
    "class_loader": ["/usr/include/class_loader/class_loader/*.hpp"],
    "CMake": ["/usr/bin/cmake"],
    "g++": [
        "/usr/bin/*g++*",
        "/usr/lib/gcc/*/*/cc1plus",
        "/usr/libexec/gcc/*/*/cc1plus",
        f"{LIBRARIES}/libc.so.6",
        "/usr/lib/locale/*",
        "/lib/*/libc.so.6",
    ],
    "bash": ["/usr/bin/bash", f"{LIBRARIES}/libc.so.6"],
    "the dynamic linker": ["/lib64/ld-linux*", "/usr/lib/*-linux-gnu/ld-linux*", "/lib/ld-linux*"],
    "roscpp": [f"{LIBRARIES}/librostime.so*"],
    "apt": [f"{LIBRARIES}/libapt-private.so*"],
    "pip": [
        f"{folder}/pip/_internal/**/*.py" for folder in (PYTHON, f"{sys.prefix}/lib/python3*/site-packages")
    ],
    "Python": ["/usr/lib/python3.*/importlib/_bootstrap.py"],
    "numpy": [f"{PYTHON}/numpy/core/*.so", f"{PYTHON}/numpy/_core/*.so"],
}
LITERALS = re.compile(r'//[^\n]*|(?:[frR]{0,2}"(?:\\.|[^"\\\n])*"\s*)+', re.S)
ONE = re.compile(r'"((?:\\.|[^"\\\n])*)"')
FORMATS = re.compile(r"%[-.0-9]*l*[a-z]|\{[^{}]*\}|\$\w+|\$\([^()]*(?:\([^()]*\))*[^()]*\)|\$\{[^}]*\}|\n")
MIN_LENGTH = 8  # characters of a part of a message that is found within a literal


class Symptom:
    def __init__(self, page: Path, heading: str, body: str):
        self.page, self.heading, self.body = page, heading, body
        self.messages = re.findall(r"`([^`]+)`", heading)
        printed = re.search(r"^Printed by: (.+)\.$", body, re.M)
        self.program = printed[1] if printed else ""

    def __repr__(self):
        return f"{self.page.stem}: {self.heading}"


def symptoms() -> list[Symptom]:
    found = []
    for page in PAGES:
        if page.name != "index.md":
            parts = re.split(r"^## (.+)$", page.read_text(encoding="utf-8"), flags=re.M)
            found += [Symptom(page, *pair) for pair in zip(parts[1::2], parts[2::2], strict=True)]
    return found


SYMPTOMS = symptoms()


@lru_cache
def literals(file: Path) -> frozenset[str]:
    """The fixed parts of all string literals of a source file; adjacent literals count as one."""
    text = file.read_text(encoding="utf-8")
    parts = set()
    for found in LITERALS.findall(text):
        joined = "".join(ONE.findall(found)) if not found.startswith("//") else ""
        joined = joined.replace(r"\"", '"').replace(r"\n", "\n")
        parts |= {part for part in FORMATS.split(joined) if part.strip()}
    return frozenset(parts)


@lru_cache
def our_files(program: str) -> tuple[Path, ...]:
    files = []
    for name in OURS[program]:
        place = (SOURCES / name).resolve()
        files += [place] if place.is_file() else [f for f in place.rglob("*") if f.is_file()]
    kinds = (".cpp", ".h", ".py", "")
    return tuple(
        f for f in files if f.suffix in kinds and not {"test", "bench", "__pycache__"} & set(f.parts[:-1])
    )


@lru_cache
def parts_of(program: str) -> tuple[str, tuple[str, ...]]:
    """All literals of a program, joined; and those that are short, but more than one letter."""
    parts = frozenset().union(*(literals(file) for file in our_files(program)))
    short = {part.strip() for part in parts if len(part.strip()) < MIN_LENGTH}
    return "\0".join(parts), tuple(part for part in short if len(part) > 1 or not part.isalnum())


def covered(text: str, program: str) -> bool:
    """Whether a text can be put together from literals: whole ones, or long pieces of them."""
    text = text.strip()
    together, short = parts_of(program)
    reached = {0}
    for begin in range(len(text)):
        if begin not in reached:
            continue
        if text[begin] == " ":
            reached.add(begin + 1)
        reached |= {begin + len(part) for part in short if text.startswith(part, begin)}
        end = begin + MIN_LENGTH
        while end <= len(text) and text[begin:end] in together:
            reached.add(end)
            end += 1
    return len(text) in reached


def missing_of_ours(message: str, program: str) -> list[str]:
    """Parts of a message that no source of the program has, also if put together from several files."""
    return [text for text in message.split("…") if text.strip() and not covered(text, program)]


@lru_cache
def bytes_of_debian(program: str) -> bytes:
    files = [file for place in OF_DEBIAN[program] for file in Path("/").glob(place[1:]) if file.is_file()]
    return b"\n".join(file.read_bytes() for file in files)


def missing_of_debian(message: str, program: str) -> list[str]:
    text = bytes_of_debian(program)
    words = [part.strip(" '.") for part in re.split(r"…|'[^']+'|: ", message)]
    return [part for part in words if len(part) > 2 and part.encode() not in text]


def test_each_symptom_has_one_entry():
    headings = [symptom.heading for symptom in SYMPTOMS]
    assert len(headings) == len(set(headings)) > 0


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_symptom_names_a_program_or_has_no_message(page):
    for symptom in SYMPTOMS:
        if symptom.page == page:
            assert bool(symptom.messages) == bool(symptom.program), symptom
            assert not symptom.program or symptom.program in OURS or symptom.program in OF_DEBIAN, symptom
            assert len(symptom.body.split()) > 8, f"{symptom} has no remedy"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_messages_exist_in_the_sources(page):
    wrong = {}
    for symptom in SYMPTOMS:
        for message in symptom.messages if symptom.page == page else []:
            ours = symptom.program in OURS
            if not ours and not bytes_of_debian(symptom.program):
                continue  # not installed
            missing = (missing_of_ours if ours else missing_of_debian)(message, symptom.program)
            if missing:
                wrong[message] = (symptom.program, missing)
    assert not wrong


def test_an_invented_message_is_not_found():
    assert missing_of_ours("libfranka: The robot has no more coffee.", "libfranka")
    assert missing_of_ours("libfranka: Connection to FCI refused. Please install FCI features", "libfranka")
    assert missing_of_debian("[…] is neither a launch file nor a rocket", "roslaunch")


def test_every_error_of_the_robot_has_an_entry():
    header = (SOURCES / "libfranka/include/franka_core/robot_error.h").read_text()
    names = set(re.findall(r'"(\w+_\w+)"', header[header.index("kErrorNames") :]))
    explained = {message for symptom in SYMPTOMS for message in symptom.messages}
    belong_to_desk = {name for name in names if name.startswith("joint_p2p_")}
    assert len(names) > 35
    assert names - belong_to_desk <= explained
