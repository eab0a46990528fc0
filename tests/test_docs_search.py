# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The site's search leads from what people type to the page with the answer.

The search runs in the browser: its own code, with the built index (searchindex.js), ranks the pages.
"""

from __future__ import annotations

import page_browser
import pytest
from page_browser import browser, wait_for

pytestmark = [
    pytest.mark.skipif(bool(page_browser.missing()), reason=page_browser.missing()),
    pytest.mark.long_form("builds the documentation site"),
]

# The answer is among so many results: what a person sees without scrolling.
SEEN = 5
STARTING, CONNECTING, MOTIONS = (f"troubleshooting/{name}" for name in ("starting", "connecting", "motions"))
CONTROLLERS, GRIPPER, SIMULATION = (
    f"troubleshooting/{name}" for name in ("controllers", "gripper", "simulation")
)
PYTHON, DEBIAN = "troubleshooting/python", "troubleshooting/debian"
# What people type, and the page with the answer.
QUERIES = [
    ("emergency stop", MOTIONS),
    ("enabling device", MOTIONS),
    ("packet loss", MOTIONS),
    ("velocity discontinuity", MOTIONS),
    ("false collision", MOTIONS),
    ("robot drifts", MOTIONS),
    ("NaN torque", MOTIONS),
    ("UDP receive: Timeout", CONNECTING),
    ("wrong libfranka", CONNECTING),
    ("PREEMPT_RT", CONNECTING),
    ("control token", CONNECTING),
    ("RLException", STARTING),
    ("exit code -11", STARTING),
    ("use_sim_time", STARTING),
    ("conda rospy", STARTING),
    ("Ubuntu", STARTING),
    ("resource conflict", CONTROLLERS),
    ("GOAL_TOLERANCE_VIOLATED", CONTROLLERS),
    ("no meshes in rviz", CONTROLLERS),
    ("gripper cannot be interrupted", GRIPPER),
    ("object slips", GRIPPER),
    ("port 443", PYTHON),
    ("missing extra", PYTHON),
    ("GLIBC", PYTHON),
    ("no display", SIMULATION),
    ("headless rendering", SIMULATION),
    ("MoveIt", DEBIAN),
    ("externally-managed-environment", DEBIAN),
    ("joint velocity limits", "limits"),
    ("docker", "how_to/containers"),
    ("github action", "how_to/ci"),
    ("set_load", "how_to/services"),
    ("teleoperation", "how_to/example_controllers"),
]


@pytest.fixture(scope="module")
def tab(site):
    with browser() as opened:
        opened.open((site / "search.html").as_uri())
        wait_for(lambda: opened.run("Boolean(Search._index)"), "the index")
        yield opened


def results(tab, query: str) -> list[str]:
    """The pages that the search names, the best one first."""
    found = tab.run(
        "(() => { const parts = Search._parseQuery(arguments[0]);"
        " return Search._performSearch(...parts).reverse().map((each) => each[0]); })()",
        query,
    )
    return list(dict.fromkeys(found))


@pytest.mark.parametrize(("query", "page"), QUERIES, ids=[query for query, _ in QUERIES])
def test_a_query_finds_the_page_with_the_answer(tab, query, page):
    assert page in results(tab, query)[:SEEN]


def test_the_results_are_those_of_the_page(tab, site):
    """The order is the one that a person sees."""
    query = "packet loss"
    expected = results(tab, query)
    with browser() as other:
        other.open((site / "search.html").as_uri() + f"?q={query.replace(' ', '+')}")
        shown = wait_for(
            lambda: other.run(
                "[...document.querySelectorAll('.search li a')].map((a) => a.getAttribute('href'))"
            ),
            "results",
        )
    first = shown[0].partition("#")[0].partition("?")[0].removesuffix(".html")
    assert first == expected[0]
