# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every citation of docs/design has a heading there, and the files and tests that its pages name exist.

The forms are `(decision 14)`, `(decisions 2, 3)`, `(protocol 5.3)`, `(protocol 3.1, 3.2)` and `(faults 4)`; a
citation is on one line.
"""

import re
import subprocess
from functools import cache
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
LIBFRANKA = TOP / "catkin_ws" / "src" / "libfranka"
DESIGN = TOP / "docs" / "design"
PAGES = {path.stem: path.read_text(encoding="utf-8") for path in sorted(DESIGN.glob("**/*.md"))}
DECISIONS = {path.name: PAGES[path.stem] for path in sorted(DESIGN.glob("decisions/*.md"))}
CITING_TESTS = {**PAGES, "fidelity": (TOP / "docs/fidelity.md").read_text(encoding="utf-8")}

CITATION = re.compile(r"\((decision|protocol(?= \d+\.)|fault)s? (\d+(?:\.\d+)?(?:, \d+(?:\.\d+)?)*)\)")
HEADINGS = {
    "decision": ("\n".join(DECISIONS.values()), r"^# Decision (\d+): \S"),
    "protocol": (PAGES["protocol"], r"^#{2,3} (\d+(?:\.\d+)?) \S"),
    "fault": (PAGES["faults"], r"^## (\d+) \S"),
}
# Documents outside the repository, and ours without their folder.
OUTSIDE = re.compile(
    r"\b(?:fci|franka_ros|ros_control|mujoco|debian|users_ask|style)\.md\b|\bmanual\.txt\b"
    r"|(?<![\w/(\[-])(?:decisions|protocol|faults|fidelity|desk)\.md\b"
)
NAMED_FILE = re.compile(r"`([\w.-]+/[\w./-]*\w|\w+\.(?:cpp|h|py|sh|yaml|md|xacro))`")
NAMED_TEST = re.compile(r"`([A-Z]\w*\.[A-Z]\w*|test_\w+)`")


def tracked() -> list[str]:
    """The repository's files, and new ones that are not ignored."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listing = subprocess.check_output(command, cwd=TOP).decode()
    return [name for name in listing.split("\0") if name and (TOP / name).is_file()]


def text_of(name: str) -> str:
    try:
        return (TOP / name).read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return ""


TEXTS = {name: text_of(name) for name in tracked() if name != "tests/test_citations.py"}


def test_cited_numbers_are_headings():
    known = {kind: set(re.findall(pattern, text, re.M)) for kind, (text, pattern) in HEADINGS.items()}
    found = [(name, *match) for name, text in TEXTS.items() for match in CITATION.findall(text)]
    assert {kind for _, kind, _ in found} == set(known)
    assert not [
        f"{name}: {kind} {number}"
        for name, kind, numbers in found
        for number in numbers.split(", ")
        if number not in known[kind]
    ]


def rows_of_decisions() -> list[str]:
    """The row of each decision in the page that lists them."""
    rows = []
    for name, text in DECISIONS.items():
        head = re.match(r"# Decision (\d+): (.+)\n\nDate: ([\d-]+)\. Status: (.+)\.\n\n", text)
        assert head and int(head[1]) == int(name.partition("-")[0]), name
        status = re.sub(r"\]\((?=\d)", "](decisions/", head[4])
        rows.append(f"| [{head[1]}](decisions/{name}) {head[2]} | {head[3]} | {status} |")
    return rows


def test_the_page_of_decisions_has_the_date_and_status_of_each():
    assert re.findall(r"^\| \[.*$", PAGES["decisions"], re.M) == rows_of_decisions()


def test_no_file_cites_documents_outside():
    assert not [
        f"{name}: {match[0]}"
        for name, text in TEXTS.items()
        for match in OUTSIDE.finditer(text)
        if not (name.startswith("docs/") and (TOP / name).with_name(match[0]).is_file())
    ]


def is_tracked(name: str) -> bool:
    """Whether a tracked file has this name; folders in between may be left out: `fci/host.cpp`."""
    *folders, base = name.split("/")
    for file in TEXTS:
        *steps, last = file.split("/")
        way = iter(steps)
        if last == base and all(folder in way for folder in folders):
            return True
    return False


@pytest.mark.parametrize("page", PAGES)
def test_named_files_exist(page):
    assert not [name for name in NAMED_FILE.findall(PAGES[page]) if not is_tracked(name)]


@cache
def cases() -> frozenset[str]:
    """The names of all tests and of all files."""
    sources = "\n".join(text for name, text in TEXTS.items() if re.search(r"test[^/]*/.*\.(cpp|h|py)$", name))
    declared = re.findall(r"\b(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\(\s*(\w+),\s*(\w+)", sources)
    found = {f"{suite}.{case}" for suite, case in declared} | {Path(name).stem for name in TEXTS}
    return frozenset(found | set(re.findall(r"\bdef (test_\w+)", sources)))


@pytest.mark.parametrize("page", CITING_TESTS)
def test_named_tests_exist(page):
    assert set(NAMED_TEST.findall(CITING_TESTS[page])) <= cases()


def rows(section: str) -> list[list[str]]:
    """The table rows of a section of the protocol page."""
    text = re.search(rf"^### {section} .*?(?=^##)", PAGES["protocol"], re.MULTILINE | re.DOTALL).group(0)
    table = [line.strip("|").split("|") for line in text.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in row] for row in table]


def test_the_protocol_page_has_the_numbers_and_sizes_of_the_code():
    table = (LIBFRANKA / "src/fci/command_table.h").read_text(encoding="utf-8")
    code = {}
    for name, cells in re.findall(r"\{Command::k(\w+), ([^}]*)\}", table):
        code[name] = [int(cell) for cell in cells.replace("kAbsent", "-1").split(", ")]
    numbers, sizes = {}, {}
    for name, *cells in rows("3.1")[1:]:
        listed = re.sub(r" \(.*\)", "", name).split(", ")
        for i, command in enumerate(listed):
            numbers[command] = [-1 if cell == "–" else int(cell.split(", ")[i]) for cell in cells]
    for name, size, _ in rows("3.2")[1:]:
        for command in name.split(", "):
            sizes[command] = int(size.split(";")[0])
    assert numbers == {name: cells[:4] for name, cells in code.items()}
    assert sizes == {name: 12 + cells[4] for name, cells in code.items()}
