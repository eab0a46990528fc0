# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Blocks of code in the site's pages can be read by what reads them, and C++ compiles.

What commands name is checked by test_page_commands.py; test_typed_pages.py and test_tutorials.py run them.
"""

import json
import re
import subprocess
import textwrap
import xml.etree.ElementTree as ET

import pytest
import yaml
from code_blocks import SHELL, Block, all_blocks, script_of
from docsite.packages import packages
from docsite.paths import TOP
from page_commands import MAKES_A_PACKAGE

BLOCKS = all_blocks()


def of(*languages: str) -> list[Block]:
    return [block for block in BLOCKS if block.language in languages]


def named(block: Block) -> str:
    return str(block)


def made_on(page: str) -> set[str]:
    """Packages that a reader of the page makes."""
    return set(MAKES_A_PACKAGE.findall((TOP / page).read_text()))


# ---- what can be read ------------------------------------------------------------------------------------


def test_python_has_no_undefined_name(tmp_path):
    for block in of("python"):
        name = f"{block}.py".replace("/", "_")
        (tmp_path / name).write_text(textwrap.dedent(block.text))
    ruff = [TOP / ".venv" / "bin" / "ruff", "check", "--isolated", "--no-cache", "--select", "F821", tmp_path]
    found = subprocess.run([*ruff, "--output-format=concise"], text=True, capture_output=True, timeout=60)
    assert found.returncode == 0, found.stdout + found.stderr


@pytest.mark.parametrize("block", of("yaml", "json", "xml"), ids=named)
def test_data_can_be_read(block):
    if block.language == "yaml":
        list(yaml.safe_load_all(block.text))
    elif block.language == "json":
        json.loads(block.text)
    else:
        # Parts of a launch file or of a URDF have no root of their own.
        text = re.sub(r"<\?xml.*?\?>", "", block.text)
        ET.fromstring(f"<part>{text}</part>")


@pytest.mark.parametrize("block", of("dockerfile"), ids=named)
def test_dockerfile_has_no_findings(block):
    # The image is the reader's own: it has no version.
    hadolint = [TOP / ".venv" / "bin" / "hadolint", "--no-color", "-"]
    result = subprocess.run(hadolint, input=block.text, text=True, capture_output=True, timeout=60)
    assert result.returncode == 0, result.stdout + result.stderr


# ---- C++ -------------------------------------------------------------------------------------------------

INCLUDES = re.compile(r"^\s*#\s*include.*$", re.M)
DECLARES = re.compile(
    r"^(class|struct|namespace|template|using|typedef|enum)\b|^PLUGINLIB|^\w[\w:<>,\s*&]*\([^;]*\)[^;]*\{",
    re.M,
)


def program_of(text: str) -> str:
    """A snippet as a program: statements stand in a function, after the includes."""
    includes = "\n".join(INCLUDES.findall(text))
    rest = INCLUDES.sub("", text)
    if DECLARES.search(rest) or not rest.strip():
        return f"{includes}\n{rest}\n"
    includes += "\n#include <franka/gripper.h>\n#include <franka/model.h>\n#include <franka/robot.h>"
    return f"{includes}\nvoid snippet(franka::Robot& robot, franka::Gripper& gripper) {{\n{rest}\n}}\n"


def include_folders() -> list[str]:
    folders = [f"-I{package.folder / 'include'}" for package in packages()]
    folders += [f"-I{TOP / 'catkin_ws' / 'devel' / 'include'}", "-I/usr/include/eigen3"]
    return folders


def of_a_package_of_the_reader(block: Block) -> bool:
    """Whether the code needs a package that the page makes; tests of the tutorials build these."""
    return any(f"#include <{name}/" in block.text for name in made_on(block.page))


@pytest.mark.parametrize(
    "block", [block for block in of("cpp") if not of_a_package_of_the_reader(block)], ids=named
)
def test_cpp_compiles(block, tmp_path):
    file = tmp_path / "snippet.cpp"
    file.write_text(program_of(block.text))
    command = ["/usr/bin/c++", "-std=c++17", "-fsyntax-only", "-Wno-unused", *include_folders(), str(file)]
    result = subprocess.run(command, text=True, capture_output=True, timeout=200)
    assert result.returncode == 0, result.stderr[:3000]


# ---- shell -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("block", of(*SHELL), ids=named)
def test_shell_can_be_read(block):
    result = subprocess.run(["bash", "-n"], input=script_of(block), text=True, capture_output=True)
    assert result.returncode == 0, result.stderr
