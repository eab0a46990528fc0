# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every citation of docs/design resolves to a heading there, and the files and tests that it names exist.

The forms are `(decision 14)`, `(decisions 2, 3)`, `(protocol 5.3)`, `(protocol 3.1, 3.2)` and `(faults 4)`; a
citation is on one line.
"""

import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
DESIGN = TOP / "docs" / "design"
LIBFRANKA = TOP / "catkin_ws" / "src" / "libfranka"
PAGES = {path.stem: path.read_text(encoding="utf-8") for path in sorted(DESIGN.glob("*.md"))}
ARCHITECTURE = (TOP / "docs" / "architecture.md").read_text(encoding="utf-8")

DECISION = re.compile(r"\(decisions? (\d+(?:, \d+)*)\)")
PROTOCOL = re.compile(r"\(protocol (\d+\.\d+(?:, \d+\.\d+)*)\)")
FAULTS = re.compile(r"\(faults (\d+(?:, \d+)*)\)")
# A citation in another form: remaining matches in a line without the citations in the right form.
LOOSE = re.compile(
    r"\bdecisions? \d|\bprotocol \d+\.\d|\bfaults \d|\((?:decisions?|protocol|faults)$", re.IGNORECASE
)
# Documents outside the repository, and ours without their folder.
OUTSIDE = re.compile(
    r"\b(?:fci|franka_ros|ros_control|mujoco|debian|users_ask|style)\.md\b|\b(?:manual|md5)\.txt\b"
    r"|(?<![\w/(\[])(?:decisions|protocol|faults|fidelity|desk)\.md\b"
)
# Files of the repository whose names OUTSIDE would match.
OURS = {"tests/data/md5.txt"}
NAMED_FILE = re.compile(r"`([\w.-]+/[\w./-]*\w|\w+\.(?:cpp|h|py|sh|yaml|md|xacro))`")
TEST = re.compile(r"`(\w+\.\w+|test_\w+)`")
FUNCTION = re.compile(r"\b([A-Z]\w*)::([a-z]\w*)\b")
ITSELF = "tests/test_citations.py"


def tracked() -> list[str]:
    """The repository's files, and new ones that are not ignored."""
    listing = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=TOP,
        capture_output=True,
        check=True,
    ).stdout
    return [name for name in listing.decode().split("\0") if name and (TOP / name).is_file()]


FILES = tracked()


def lines() -> Iterator[tuple[str, int, str]]:
    for name in FILES:
        if name == ITSELF:
            continue
        try:
            text = (TOP / name).read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        for number, line in enumerate(text.splitlines(), 1):
            yield name, number, line


LINES = list(lines())
CPP = "\n".join(line for name, _, line in LINES if name.endswith((".h", ".cpp")))


def headings(page: str) -> set[str]:
    pattern = {
        "decisions": r"^## Decision (\d+): \S",
        "protocol": r"^#{2,3} (\d+(?:\.\d+)?) \S",
        "faults": r"^## (\d+) \S",
    }[page]
    return set(re.findall(pattern, PAGES[page], re.MULTILINE))


def cited(pattern: re.Pattern) -> Iterator[tuple[str, str]]:
    """Cited numbers with their places."""
    for name, number, line in LINES:
        for match in pattern.finditer(line):
            for cited_number in match.group(1).split(", "):
                yield cited_number, f"{name}:{number}"


@pytest.mark.parametrize(
    "pattern, page", [(DECISION, "decisions"), (PROTOCOL, "protocol"), (FAULTS, "faults")]
)
def test_cited_numbers_are_headings(pattern, page):
    known, found = headings(page), list(cited(pattern))
    assert found
    assert not [f"{place}: {page} {number}" for number, place in found if number not in known]


def test_citations_have_one_form():
    wrong = []
    for name, number, line in LINES:
        if re.match(r"#+ Decision \d+: ", line):
            continue
        rest = line
        for pattern in (DECISION, PROTOCOL, FAULTS):
            rest = pattern.sub("", rest)
        # In the pages themselves numbers may stand in sentences.
        if LOOSE.search(rest) and not name.startswith("docs/design/"):
            wrong.append(f"{name}:{number}: {line.strip()}")
    assert not wrong, "\n".join(wrong)


def test_numbers_in_sentences_of_the_pages_are_headings():
    known = headings("decisions")
    for page, text in PAGES.items():
        for group in re.findall(r"\bdecisions? (\d+(?:(?:, | and | or )\d+)*)", text):
            for number in re.findall(r"\d+", group):
                assert number in known, f"{page}: decision {number}"
    known = headings("protocol")
    for number in re.findall(r"\bsection (\d+\.\d+)", PAGES["protocol"]):
        assert number in known, number


def test_no_file_cites_documents_outside():
    wrong = [
        f"{name}:{number}: {line.strip()}"
        for name, number, line in LINES
        for match in OUTSIDE.finditer(line)
        if not any(ours.endswith(match.group(0)) for ours in OURS)
        and not (name.startswith("docs/") and (TOP / name).with_name(match.group(0)).is_file())
    ]
    assert not wrong, "\n".join(wrong)


def is_tracked(name: str) -> bool:
    """Whether a tracked file has this name; folders in between may be left out: `fci/host.cpp`."""
    *folders, base = name.split("/")
    for file in FILES:
        *steps, last = file.split("/")
        way = iter(steps)
        if last == base and all(folder in way for folder in folders):
            return True
    return False


@pytest.mark.parametrize("page", PAGES)
def test_named_files_exist(page):
    assert not [name for name in NAMED_FILE.findall(PAGES[page]) if not is_tracked(name)]


@pytest.mark.parametrize("page", PAGES)
def test_named_functions_exist(page):
    """`Class::function`: C++ sources declare the class, and call or declare a function of that name."""
    missing = [
        f"{scope}::{function}"
        for scope, function in set(FUNCTION.findall(PAGES[page]))
        if not re.search(rf"\b{function}\(", CPP)
        or not re.search(rf"\b(?:class|struct) {scope}\b|\b{scope}::{function}\(", CPP)
    ]
    assert not missing


def test_answers_of_the_architecture_page_are_in_the_files_that_it_links():
    table = ARCHITECTURE.split("## Where to look")[1].split("\n## ")[0]
    answers = re.findall(r"\]\(\.\./([^)]+)\) `(?:\w+::)?(\w+)`", table)
    assert len(answers) > 8
    missing = [
        f"{file}: {function}"
        for file, function in answers
        if not re.search(rf"^[^ /].*\b{function}\(", (TOP / file).read_text(encoding="utf-8"), re.MULTILINE)
    ]
    assert not missing


def test_tests_named_in_faults_exist():
    sources = "\n".join(
        (TOP / name).read_text(encoding="utf-8")
        for name in FILES
        if re.search(r"test[^/]*/.*\.(cpp|h|py)$", name) and name != ITSELF
    )
    named = set(TEST.findall(PAGES["faults"]))
    assert len(named) > 50
    missing = []
    for name in sorted(named):
        if name.endswith(".py"):
            found = is_tracked(name)
        elif name.startswith("test_"):
            found = re.search(rf"\bdef {name}\b", sources)
        elif re.search(r"\.(h|cpp)$", name):
            found = is_tracked(name)
        else:
            suite, test = name.split(".")
            found = re.search(rf"\bTEST(?:_F|_P)?\(\s*{suite},\s*{test}\b", sources)
        if not found:
            missing.append(name)
    assert not missing


def rows(section: str) -> list[list[str]]:
    """The table rows of a section of the protocol page."""
    text = re.search(rf"^### {section} .*?(?=^##)", PAGES["protocol"], re.MULTILINE | re.DOTALL).group(0)
    table = [line.strip("|").split("|") for line in text.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in row] for row in table]


def test_the_protocol_page_has_the_numbers_and_sizes_of_the_code():
    table = (LIBFRANKA / "src/fci/command_table.h").read_text(encoding="utf-8")
    commands = (LIBFRANKA / "include/franka_core/fci/commands.h").read_text(encoding="utf-8")
    enumeration = re.search(r"enum class Command [^{]*\{(.*?)\};", commands, re.DOTALL).group(1)
    names = re.findall(r"^  k(\w+),", enumeration, re.MULTILINE)
    code = {}
    for name, cells in re.findall(r"\{Command::k(\w+), ([^}]*)\}", table):
        code[name] = [int(cell) for cell in cells.replace("kAbsent", "-1").split(", ")]
    assert list(code) == names
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
