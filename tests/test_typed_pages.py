# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The how-to pages, README.md and the pages of franka_sim, Desk and the examples do what they say: their
blocks are typed and run as they stand (tests/support/tutorial.py), in the long form.

The short form types some pages.
"""

import os
import re
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
    PageError,
    Reader,
    check_mark,
    read,
)

# Pages that take less than a minute together.
SHORT = {"shell", "ci", "containers", "packages", "sim_to_real", "examples_python"}
# Pages with commands or programs that are not typed here, and what runs them.
ELSEWHERE = {
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


@pytest.mark.parametrize("path", [*PAGES, *MORE_PAGES], ids=named)
def test_what_a_page_assumes_stands_in_its_text(path):
    """The terminal that a reader opens, and the commands that run beside those of the blocks."""
    page = read(path)
    if page.first:
        assert f"`{page.first}`" in page.prose
    prose = " ".join(page.prose.split())
    for step in page.of("type"):
        assert f"`{step.text}`" in prose, f"{path.name}:{step.line}: the text has no {step.text}"


def reads_the_page(source: str, page: str) -> bool:
    """Whether the source of a test has the page's name, such as read(TOP / "docs/how_to/packages.md")."""
    return re.search(rf'"(docs/)?{re.escape(page)}"', source) is not None


@pytest.mark.parametrize("path", [*PAGES, *MORE_PAGES], ids=named)
def test_blocks_that_other_tests_run_are_read_from_the_page(path):
    marks = [step.mark for step in read(path).of("bash") if step.mark.startswith("run by: ")]
    tests = {mark.removeprefix("run by: ").partition("::")[0] for mark in marks}
    assert not [name for name in tests if not reads_the_page((TOP / name).read_text(), named(path))]


def documented_statuses() -> dict[str, set[str]]:
    """The exit codes 0 to 2 of each program in the table of docs/how_to/shell.md."""
    table = re.findall(r"^\| (`.*) \|$", (TOP / "docs/how_to/shell.md").read_text(), re.M)
    rows = [row.split(" | ") for row in table]
    return {
        name: {str(status) for status, meaning in enumerate(meanings[:3]) if meaning.strip()}
        for names, *meanings in rows
        for name in re.findall(r"`([^`]+)`", names)
    }


@pytest.mark.parametrize("path", [*PAGES, *MORE_PAGES], ids=named)
def test_accepted_statuses_are_documented(path):
    documented = documented_statuses()
    for step in read(path).of("bash"):
        program = re.split(r"\s+", step.text.splitlines()[-1].removeprefix("./franka shell "))[0]
        for option in step.options:
            if option.startswith("status: "):
                assert set(option.removeprefix("status: ").split(" or ")) <= documented[program], step


def test_a_test_that_does_not_read_its_page_is_found():
    assert reads_the_page('PAGE = TOP / "docs/how_to/packages.md"', "how_to/packages.md")
    assert not reads_the_page('"""Types docs/how_to/packages.md."""', "how_to/packages.md")
    assert not reads_the_page('examples("python.md")', "get_started/python.md")


@pytest.mark.parametrize(
    ("mark", "language", "text"),
    [
        ("only parsed: it is too much work", "bash", "sudo reboot"),
        ("only parsed: changes the system", "bash", "reboot"),
        ("only parsed: changes the system", "text", "sudo reboot"),
        ("run by: tests/test_none.py::test_it", "bash", "true"),
        ("run by: tests/test_deb.py::test_none", "bash", "true"),
    ],
)
def test_other_marks_are_refused(mark, language, text):
    with pytest.raises(PageError):
        check_mark(mark, language, text, "page.md:1")


def test_a_page_whose_program_fails_is_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# A page\n\n<!-- run with: python3 -->\n```python\nraise SystemExit(3)\n```\n")
    with pytest.raises(PageError, match="ended with status 3"), Reader(tmp_path / "home") as reader:
        reader.follow(read(page))


def test_programs_run_in_the_terminal_of_the_page(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        "# A page\n\n<!-- terminals: export WORD=hello -->\n<!-- type: sleep 100 -->\n"
        "<!-- press Ctrl-C in terminal 1 -->\n<!-- terminal 2 -->\n<!-- run with: python3 -->\n```python\n"
        'import os\nprint(os.environ["WORD"], os.getcwd())\n```\n<!-- expect: hello -->\n'
        f"<!-- expect: {tmp_path / 'home'} -->\n"
    )
    with Reader(tmp_path / "home") as reader:
        reader.follow(read(page))
