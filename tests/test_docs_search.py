# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The site's search leads from what people type to the page with the answer.

The search runs in the browser: its own code, with the built index (searchindex.js), ranks the pages.
"""

from __future__ import annotations

import page_browser
import pytest
from page_browser import browser, wait_for
from site_pages import read_page

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
# What people type, the page with the answer, and words of the answer's heading.
QUERIES = [
    ("E-stop", MOTIONS, "User Stop pressed"),
    ("emergency stop", MOTIONS, "User Stop pressed"),
    ("enabling device", MOTIONS, "User Stop pressed"),
    ("communication_constraints_violation", MOTIONS, "communication_constraints_violation"),
    ("packet loss", MOTIONS, "communication_constraints_violation"),
    ("robot stops at random", MOTIONS, "communication_constraints_violation"),
    ("velocity discontinuity", MOTIONS, "velocity_discontinuity"),
    ("jerky motion", MOTIONS, "velocity_discontinuity"),
    ("singularity", MOTIONS, "cartesian_motion_generator_joint_velocity_discontinuity"),
    ("false collision", MOTIONS, "joint_reflex"),
    ("cartesian_reflex", MOTIONS, "joint_reflex"),
    ("joint_collision at start", MOTIONS, "joint_collision"),
    ("which two links are too close", MOTIONS, "self_collision_avoidance_violation"),
    ("recovery drives back into the obstacle", MOTIONS, "After a recovery"),
    ("robot drifts", MOTIONS, "drifts"),
    ("vibration", MOTIONS, "vibrates"),
    ("current mode Reflex", MOTIONS, "Reflex"),
    ("brakes closed", MOTIONS, "Did you open the brakes"),
    ("row-major matrix", MOTIONS, "homogeneous transformation"),
    ("NaN torque", MOTIONS, "infinite or not a number"),
    ("joint out of range", MOTIONS, "joint_position_limits_violation"),
    ("UDP receive: Timeout", CONNECTING, "UDP receive"),
    ("Connection refused", CONNECTING, "Connection to FCI refused"),
    ("No route to host", CONNECTING, "Connection"),
    ("Incompatible library version", CONNECTING, "different protocols"),
    ("wrong libfranka", CONNECTING, "different protocols"),
    ("realtime kernel", CONNECTING, "realtime capabilities"),
    ("PREEMPT_RT", CONNECTING, "realtime capabilities"),
    ("aarch64 loadModel", CONNECTING, "model library"),
    ("rtprio", CONNECTING, "realtime priority"),
    ("Operation not permitted", CONNECTING, "realtime priority"),
    ("unlock joints without Desk", CONNECTING, "from a program"),
    ("control token", CONNECTING, "FCI is active"),
    ("another program is connected", CONNECTING, "did not answer"),
    ("RLException", STARTING, "neither a launch file"),
    ("Resource not found", STARTING, "Resource not found"),
    ("Permission denied", STARTING, "Permission denied"),
    ("segfault", STARTING, "process has died"),
    ("exit code -11", STARTING, "process has died"),
    ("cannot open shared object file", STARTING, "shared libraries"),
    ("undefined symbol", STARTING, "shared libraries"),
    ("use_sim_time", STARTING, "Nothing happens"),
    ("roscore is not running", STARTING, "communicate with master"),
    ("conda rospy", STARTING, "rospy"),
    ("out of memory", STARTING, "signal terminated"),
    ("Ubuntu", STARTING, "this system is"),
    ("half-made environment", STARTING, "is incomplete"),
    ("controller does nothing", CONTROLLERS, "running"),
    ("resource conflict", CONTROLLERS, "resource conflict"),
    ("pluginlib class not found", CONTROLLERS, "does not exist"),
    ("GOAL_TOLERANCE_VIOLATED", CONTROLLERS, "GOAL_TOLERANCE_VIOLATED"),
    ("Duration is out of dual 32-bit range", CONTROLLERS, "dual 32-bit"),
    ("update period jitter", CONTROLLERS, "periods other"),
    ("wrong robot", CONTROLLERS, "FR3"),
    ("extrapolation into the future", CONTROLLERS, "extrapolation"),
    ("no meshes in rviz", CONTROLLERS, "mesh"),
    ("joint states too slow 30 Hz", CONTROLLERS, "slower than 1 kHz"),
    ("hand blocked for 100 s", GRIPPER, "does not end"),
    ("gripper cannot be interrupted", GRIPPER, "does not end"),
    ("grasp fails", GRIPPER, "no object between them"),
    ("object slips", GRIPPER, "slips"),
    ("port 443", PYTHON, "Desk cannot listen"),
    ("No module named gymnasium", PYTHON, "needs the Python package"),
    ("missing extra", PYTHON, "needs the Python package"),
    ("ffmpeg", PYTHON, "ffmpeg"),
    ("concurrent access", PYTHON, "Another thread"),
    ("two robots in one process", PYTHON, "Two robots"),
    ("pip install fails", PYTHON, "No matching distribution"),
    ("GLIBC", PYTHON, "GLIBC"),
    ("ModuleNotFoundError pyfranka", PYTHON, "pyfranka"),
    ("another simulated robot runs there", SIMULATION, "Another simulated robot"),
    ("no display", SIMULATION, "no display"),
    ("simulation too slow", SIMULATION, "slower than real time"),
    ("headless rendering", SIMULATION, "No pictures"),
    ("arm passes through objects", SIMULATION, "goes through"),
    ("MoveIt", DEBIAN, "MoveIt"),
    ("externally-managed-environment", DEBIAN, "externally-managed"),
    ("gazebo_ros", DEBIAN, "Gazebo"),
    ("joint velocity limits", "limits", "Limits"),
    ("torque limits", "limits", "Limits"),
    ("docker", "how_to/containers", "containers"),
    ("github action", "how_to/ci", "CI"),
    ("set_load", "how_to/services", "services"),
    ("plot", "how_to/plots", "Plot"),
    ("teleoperation", "how_to/example_controllers", ""),
    ("reset joints of the simulation", "how_to/services", ""),
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


@pytest.mark.parametrize(("query", "page", "heading"), QUERIES, ids=[query for query, *_ in QUERIES])
def test_a_query_finds_the_page_with_the_answer(tab, site, query, page, heading):
    assert page in results(tab, query)[:SEEN]
    assert any(heading in each for each in read_page(site / f"{page}.html").headings)


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


def test_words_that_no_page_has_find_nothing(tab):
    assert results(tab, "espresso machine") == []
