# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""docs/fidelity.md: each line has its kind and names existing tests.

Its figures, and those of docs/design/limits.md, equal the values in the code (page_figures.py).
"""

import re
from pathlib import Path

import page_figures
import pytest

TOP = Path(__file__).resolve().parent.parent
SOURCES = TOP / "catkin_ws/src"
TEST = re.compile(r"`((?:[A-Z]\w*\.[A-Za-z]\w*)|(?:test_\w+(?:\.py)?))`")
# Not figures: text in backticks and targets of links (names, paths, expressions), digits that belong to
# a name (q4, FR3), and numbers of joints or of protocol versions.
NAMES = re.compile(
    r"`[^`]*`|\]\([^)]*\)|\b(?:joints?|protocol|version)\s\d+(?:(?:,| to| and|, and)\s\d+)*", re.IGNORECASE
)
# A quantity in words is also reported: figures must have digits, so that they can be compared.
IN_WORDS = (
    r"\b(?:an?|half|one|two|three|four|five|six|seven|eight|nine|ten|twenty|hundred|thousand)\s"
    r"(?:(?:milli|micro)?seconds?|minutes?|(?:milli|centi)?meters?|degrees|percent|times)\b"
)
FIGURE = re.compile(rf"(?<![\w.]){page_figures.NUMBER}(?!\w)|{IN_WORDS}")
ENTRIES = {"docs/fidelity.md": page_figures.fidelity, "docs/design/limits.md": page_figures.limits}
KINDS = {"physics", "exact", "approximation"}


def lines():
    """Table rows, and list items with their continuation lines joined."""
    found = []
    for line in (TOP / "docs/fidelity.md").read_text().splitlines():
        if line.startswith(("| ", "* ")) and not line.endswith("held by |"):
            found.append(line)
        elif line.startswith("  ") and found:
            found[-1] += " " + line.strip()
    return found


@pytest.fixture(scope="module")
def known():
    """The names of all tests."""
    names = set()
    for file in SOURCES.rglob("*_test.cpp"):
        cases = re.findall(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", file.read_text(), re.MULTILINE)
        names.update(f"{suite}.{case}" for suite, case in cases)
    for folder in (SOURCES, TOP / "python", TOP / "tests"):
        for file in folder.rglob("*test*.py"):
            names.add(file.name)
            names.update(re.findall(r"^ *def (test_\w+)\(", file.read_text(), re.MULTILINE))
    return names


@pytest.mark.parametrize("line", lines(), ids=lambda line: line[2:34])
def test_each_line_cites_existing_tests(line, known):
    named = TEST.findall(line)
    assert named, "No test holds it."
    assert [name for name in named if name not in known] == []


def test_rows_have_a_known_kind():
    for line in lines():
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        if len(cells) == 4:
            assert cells[1] in KINDS, line


def text_of(page):
    """The text in one line, without the table of docs/design/limits.md: test_limits_page.py compares it."""
    text = (TOP / page).read_text()
    if page == "docs/design/limits.md":
        text = re.sub(r"^\|.*$", "", text, flags=re.MULTILINE)
    return " ".join(text.split())


def faults(text, entries):
    """Messages about wrong, missing and unknown figures of a text."""
    known = {place for name in NAMES.finditer(text) for place in range(*name.span())}
    for words, value in entries:
        expected = value if isinstance(value, list) else [value]
        places = list(page_figures.pattern(words).finditer(text))
        if not places:
            yield f"No such words on the page: {words}"
        for place in places:
            shown = [page_figures.number(figure) for figure in place.groups()]
            size = max(len(shown), len(expected))
            pairs = [numbers * size if len(numbers) == 1 else numbers for numbers in (shown, expected)]
            if pairs[0] != pytest.approx(pairs[1], rel=1e-9, abs=0):
                yield f"{words}: the page says {shown}, the code {expected}"
            known.update(place.start(i + 1) for i in range(len(shown)))
    for figure in FIGURE.finditer(text):
        if figure.start() not in known:
            yield f"Not compared with the code: {text[max(0, figure.start() - 30) : figure.end() + 20]}"


@pytest.mark.parametrize("page", ENTRIES)
def test_figures_are_those_of_the_code(page):
    found = list(faults(text_of(page), ENTRIES[page]()))
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    "text, entries",
    [
        ("a 100 Hz low-pass", [("# Hz low-pass", 30.0)]),
        ("the 1, 2 and 4 Nm", [("#, # and # Nm", [1.0, 2.0, 3.0])]),
        ("1.4·√K", [("#·√K", [1.4, 1.5])]),
        ("no filter", [("# Hz low-pass", 100.0)]),
        ("joint 5 of an FR3 within 0.2 s", []),
        ("half a millisecond", []),
    ],
)
def test_wrong_missing_and_unknown_figures_are_reported(text, entries):
    assert len(list(faults(text, entries))) == 1


def test_a_constant_that_is_gone_is_reported():
    with pytest.raises(AssertionError, match="state_estimator.h has 0 values of: kNothing = #;"):
        page_figures.constant("franka_sim/src/robot/estimator/state_estimator.h", "kNothing = #;")
