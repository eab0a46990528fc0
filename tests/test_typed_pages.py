# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The how-to pages, README.md and the pages of franka_sim, Desk and the examples do what they say: their
blocks are typed and run as they stand (tests/support/tutorial.py), in the long form.

The short form types some pages.
"""

import os
import shutil
from pathlib import Path

import pytest
from code_blocks import SHELL, all_blocks
from screen import virtual_screen
from test_tutorials import follow
from tutorial import (
    MORE_PAGES,
    PAGES,
    PICTURES,
    SCREEN,
    TOP,
    read,
)

# Pages that take less than a minute together.
SHORT = {"shell", "ci", "containers", "packages", "sim_to_real", "examples_python"}
# Pages with commands or programs that are not typed here, and what runs them.
ELSEWHERE = {
    "CONTRIBUTING.md": "tests/test_entry.py and test_style.py run these commands, on small examples",
    "docs/index.md": "README.md has the same block",
    "docs/python.md": "python/test/test_sim.py, test_sweep.py and test_pytest_plugin.py run its programs",
    "docs/gym.md": "python/test/test_gym.py runs its program",
    "docs/write_your_own.md": "tests/test_new_controller.py and the tutorials make such packages",
}
# Their commands are for faults, which a machine without them cannot show.
TROUBLESHOOTING = "docs/troubleshooting/"


def named(path: Path) -> str:
    return str(path.relative_to(TOP)).removeprefix("docs/")


def parameters(path: Path):
    marks = () if path.stem in SHORT else pytest.mark.long_form("follows a page that takes longer")
    return pytest.param(path, id=named(path), marks=marks)


@pytest.mark.parametrize("path", [*map(parameters, MORE_PAGES)])
def test_page_does_what_it_says(path, tmp_path):
    with virtual_screen(SCREEN):
        pictures = follow(read(path), tmp_path)
    if os.environ.get("FRANKA_UPDATE_PICTURES"):
        for name, picture in pictures.items():
            shutil.copy(picture, PICTURES / name)


# ---- what can be checked without following a page --------------------------------------------------------


def test_pages_with_commands_are_typed_or_run_elsewhere():
    typed = {str(path.relative_to(TOP)) for path in [*PAGES, *MORE_PAGES]}
    runnable = {block.page for block in all_blocks() if block.language in {*SHELL, "python", "cpp", "xml"}}
    left = {page for page in runnable - typed if not page.startswith(TROUBLESHOOTING)}
    assert left == set(ELSEWHERE)
