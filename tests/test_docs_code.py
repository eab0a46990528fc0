# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Blocks of code in the site's pages can be read by what reads them, and C++ compiles.

What commands name is checked by test_page_commands.py; test_typed_pages.py and test_tutorials.py run them.
"""

import ast
import json
import re
import subprocess
import textwrap
import xml.etree.ElementTree as ET

import pytest
import yaml
from code_blocks import SHELL, TYPED, Block, all_blocks, blocks_in, script_of
from docsite.packages import packages
from docsite.paths import TOP
from page_commands import MAKES_A_PACKAGE
from page_output import examples_in

BLOCKS = all_blocks()
PLAIN = {"text", "ini", "toml", "cmake", "diff", "dockerfile", "markdown", "css", "csv"}
LANGUAGES = SHELL | PLAIN | {"python", "cpp", "yaml", "xml", "json"}


def of(*languages: str) -> list[Block]:
    return [block for block in BLOCKS if block.language in languages]


def named(block: Block) -> str:
    return str(block)


def test_every_block_has_a_language_that_is_checked():
    unknown = [
        f"{block}: {block.language}" for block in BLOCKS if block.language and block.language not in LANGUAGES
    ]
    assert not unknown


def test_blocks_of_text_hold_no_commands():
    typed = [
        block for block in of("text") if TYPED.match(block.text) and not block.text.startswith("franka_")
    ]
    assert not [str(block) for block in typed]


def test_indented_commands_are_blocks_of_shell():
    text = "Call:\n\n    roslaunch franka_gazebo panda.launch\n\nIt says:\n\n    franka_sim: ready\n"
    assert [block.language for block in blocks_in(text, "page.md")] == ["bash", ""]


def made_on(page: str) -> set[str]:
    """Packages that a reader of the page makes."""
    return set(MAKES_A_PACKAGE.findall((TOP / page).read_text()))


# ---- what can be read ------------------------------------------------------------------------------------


@pytest.mark.parametrize("block", of("python"), ids=named)
def test_python_can_be_read(block):
    ast.parse(textwrap.dedent(block.text))


def test_python_has_no_undefined_name(tmp_path):
    for block in of("python"):
        name = f"{block}.py".replace("/", "_")
        (tmp_path / name).write_text(textwrap.dedent(block.text))
    ruff = [TOP / ".venv" / "bin" / "ruff", "check", "--isolated", "--no-cache", "--select", "F821", tmp_path]
    found = subprocess.run([*ruff, "--output-format=concise"], text=True, capture_output=True, timeout=60)
    assert found.returncode == 0, found.stdout + found.stderr


def prints_without_output(text: str, page: str) -> list[str]:
    """Programs in Python that print, and are not files of the reader, before a block without their output."""
    lines = text.splitlines()
    return [
        f"{page}:{each.line}"
        for each in examples_in(text, page)
        if "print(" in each.code and not each.output and not lines[each.line - 2].startswith("<!-- file: ")
    ]


def test_programs_in_python_show_what_they_print():
    pages = sorted({block.page for block in of("python")})
    assert not [place for page in pages for place in prints_without_output((TOP / page).read_text(), page)]


def test_a_program_without_its_output_is_found():
    program, output = "```python\nprint(1, [2.5])\n```\n", "```text\n1 [2.5 ]\n```\n"
    assert prints_without_output(f"# A page\n\n{program}\nText.\n\n{output}", "page.md") == ["page.md:3"]
    assert prints_without_output(f"<!-- file: ~/a.py -->\n{program}", "page.md") == []
    (example,) = examples_in(f"# A page\n\n{program}\n{output}", "page.md")
    example.check("1 [2.5]\n")
    example.check("1 [2.4]\n", tolerance=0.2)
    for other in ("1 [2.4]", "1", "1 2.5 3", "one [2.5]"):
        with pytest.raises(AssertionError, match="page.md:3 shows"):
            example.check(other)


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


def test_wrong_cpp_is_found(tmp_path):
    file = tmp_path / "snippet.cpp"
    file.write_text(program_of("robot.noSuchCall();"))
    command = ["/usr/bin/c++", "-std=c++17", "-fsyntax-only", *include_folders(), str(file)]
    result = subprocess.run(command, text=True, capture_output=True, timeout=200)
    assert "has no member named" in result.stderr


# ---- shell -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("block", of(*SHELL), ids=named)
def test_shell_can_be_read(block):
    result = subprocess.run(["bash", "-n"], input=script_of(block), text=True, capture_output=True)
    assert result.returncode == 0, result.stderr


def test_prompts_of_a_console_are_left_out():
    block = Block("page.md", 1, "console", "$ ./franka dance\noutput\n$ echo a \\\n  b\nb\n")
    assert script_of(block) == "./franka dance\necho a \\\n  b\n"


def test_blocks_are_found_with_their_languages():
    text = "```bash\nls\n```\n\n    indented\n\n```{code-block} python\n:linenos:\n\nx = 1\n```\n"
    text += "\n```{toctree}\na\n```\n"
    assert [(block.language, block.text) for block in blocks_in(text, "page.md")] == [
        ("bash", "ls\n"),
        ("", "indented\n"),
        ("python", "x = 1\n"),
    ]
