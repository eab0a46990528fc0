# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The pages of docs/troubleshooting: the sources of the named programs have their messages."""

import re
from functools import cache
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
PAGES = sorted((TOP / "docs/troubleshooting").glob("*.md"))
SOURCES = TOP / "catkin_ws/src"

# Folders with the messages of each program of ours.
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
LITERALS = re.compile(r'//[^\n]*|(?:[frR]{0,2}"(?:\\.|[^"\\\n])*"\s*)+')
ONE = re.compile(r'"((?:\\.|[^"\\\n])*)"')
# Where programs put a message together, and what they put in.
COMPOSED = re.compile(r'…|: |"[^"]+"\)?!?| command (?:rejected|aborted)')
WORDS = 3  # in a row, of a part of a message


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


@cache
def literals(program: str) -> str:
    """The strings of a program's sources; adjacent ones count as one."""
    found = []
    for place in ((SOURCES / name).resolve() for name in OURS[program]):
        for file in [place] if place.is_file() else place.rglob("*"):
            if file.suffix in (".cpp", ".h", ".py", "") and file.is_file() and "test" not in file.parts:
                text = LITERALS.findall(file.read_text(encoding="utf-8", errors="replace"))
                found += ["".join(ONE.findall(each)) for each in text if not each.startswith("//")]
    return "\n".join(found).replace(r"\"", '"')


def missing(message: str, program: str) -> list[str]:
    """Parts of a message whose words are not in a row in the program's sources."""
    found = []
    for part in COMPOSED.split(message):
        words = part.split()
        runs = [" ".join(words[i : i + WORDS]) for i in range(len(words) - WORDS + 1)]
        if not all(run in literals(program) for run in runs):
            found.append(part)
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_messages_exist_in_the_sources(page):
    ours = [each for each in SYMPTOMS if each.page == page and each.program in OURS]
    absent = [(each, missing(message, each.program)) for each in ours for message in each.messages]
    assert not [(each, parts) for each, parts in absent if parts]


def test_an_invented_message_is_not_found():
    assert missing("libfranka: There is not any coffee.", "libfranka")


def test_every_error_of_the_robot_has_an_entry():
    header = (SOURCES / "libfranka/include/franka_core/robot_error.h").read_text()
    names = set(re.findall(r'"(\w+_\w+)"', header[header.index("kErrorNames") :]))
    explained = {message for symptom in SYMPTOMS for message in symptom.messages}
    belong_to_desk = {name for name in names if name.startswith("joint_p2p_")}
    assert len(names) > 35
    assert names - belong_to_desk <= explained
