# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""docs/fidelity.md: each line names the tests that hold it, and figures are those of the code's constants.

test_citations.py finds the tests.
"""

import re
from pathlib import Path

import pytest
import yaml

TOP = Path(__file__).resolve().parent.parent
SOURCES = TOP / "catkin_ws/src"
PAGE = (TOP / "docs/fidelity.md").read_text(encoding="utf-8")
TEST = re.compile(r"`(?:[A-Z]\w*\.[A-Za-z]\w*|test_\w+(?:\.py)?)`")
KINDS = {"physics", "exact", "approximation"}
NUMBER = r"[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
SEVEN = "#, #, #, #, #, #, #"

CORE = "libfranka/include/franka_core"
ROBOT = "franka_sim/src/robot"
HEADERS = "franka_sim/include/franka_sim/robot"
SCHEDULE = "ros_control/realtime_tools/include/realtime_tools/detail/publishing_schedule.h"
# Words of the page with `#` for each figure, a file, the words of its constant, and how many of the page's
# units are one of the constant's.
CONSTANTS = [
    # State
    ("# Hz low-pass", f"{HEADERS}/plant.h", "kSignalCutoff = #;", 1),
    ("q + tau_J/#, dq + dtau_J/#", f"{ROBOT}/estimator/state_estimator.cpp", "kJointElasticity = #;", 1),
    (
        "without gravity; # in Idle",
        f"{ROBOT}/supervisor/motion_supervisor.cpp",
        "state_->tau_J_d.fill(#);",
        1,
    ),
    ("singular value is below #", f"{ROBOT}/estimator/external_wrench.cpp", "kMinSingularValue = #;", 1),
    ("the last # commands", f"{ROBOT}/safety/command_window.h", "kSlots = #;", 1),
    (
        "shows #, #, #, #, #, # and # Nm",
        "franka_sim/src/physics/world/physics_config.cpp",
        f"kGravityError{{{SEVEN}}};",
        1,
    ),
    # Robot
    ("damping #·√", f"{ROBOT}/laws/damping_factor.h", "kDampingFactor = #;", 1),
    ("with # % of", f"{ROBOT}/hands/gripper_unit.cpp", "finger_force = # * std::min(force,", 100),
    (
        "time constant # ms between finger pads",
        "franka_sim/src/physics/contacts/contact_parameters.h",
        'kGraspSolref = "# 1";',
        1000,
    ),
    ("adds up to # ms", f"{HEADERS}/realism.h", "kMaxCommandDelay = #;", 1),
    # Control
    ("null space # Nm/rad", f"{ROBOT}/laws/control_laws.cpp", "kNullspace = #;", 1),
    ("fades at # Nm/s", f"{ROBOT}/laws/torque_blend.cpp", "kBlendStep = # * franka_core::kTick;", 1),
    ("then, for # s", f"{ROBOT}/motion/rest_sequence.cpp", "kYieldTicks = #;", 1e-3),
    ("# N/m, ", f"{ROBOT}/laws/control_laws.cpp", "kGuidingTranslation = #;", 1),
    ("locked elbow with # Nm/rad", f"{ROBOT}/laws/control_laws.cpp", "kGuidingNullspace = #;", 1),
    ("up to # s", f"{ROBOT}/safety/loss_monitor.h", "kPatience = #;", 1e-3),
    ("# lost in a row", f"{ROBOT}/safety/loss_monitor.h", "kLostInARow = #;", 1),
    # Errors
    ("# rad beyond the limits", f"{ROBOT}/limits/measured_limits.cpp", "kPositionMargin = #;", 1),
    ("more than # Nm for", f"{ROBOT}/safety/force_watch.cpp", "kTorqueTolerance = #;", 1),
    ("above # W", f"{ROBOT}/limits/measured_limits.h", "kPowerLimit = #;", 1),
    ("# times the motors'", f"{ROBOT}/limits/measured_limits.cpp", "kTorqueMargin = #;", 1),
    ("# times the joints' jerk", f"{ROBOT}/motion/joint_motion.cpp", "kSolvedJerkFactor = #;", 1),
    ("been slower than # rad/s", f"{ROBOT}/supervisor/motion_supervisor.cpp", "kStandstill = #;", 1),
    ("for # ms, so that", f"{ROBOT}/supervisor/joint_brakes.cpp", "kRestingTicks = #;", 1),
    ("or after # s in which", f"{ROBOT}/supervisor/joint_brakes.cpp", "kClosingTicks = #;", 1e-3),
    # Commands
    ("# degrees Celsius at rest", f"{HEADERS}/hands/gripper_unit.h", "room_temperature{#};", 1),
    ("time constant of # s", f"{HEADERS}/hands/gripper_unit.h", "temperature_time{#};", 1),
    ("within #;", f"{CORE}/transform.h", "kTransformTolerance = #;", 1),
    # Worlds, hand, ros_control
    ("# cm", "franka_sim/src/physics/meshes/mesh_conversion.cpp", "kPlate = #;", 100),
    ("nothing for # s", "franka_gripper/src/franka_gripper/gripper_node.py", "SILENCE = #", 1),
    ("polls every # ms", SCHEDULE, "kMinWait{#};", 1e-3),
    ("down to every # ms", SCHEDULE, "kMaxWait{#};", 1e-3),
]


def lines() -> list[str]:
    """Table rows, and list items with their continuation lines joined."""
    found = []
    for line in PAGE.splitlines():
        if line.startswith(("| ", "* ")) and not line.endswith("held by |"):
            found.append(line)
        elif line.startswith("  ") and found:
            found[-1] += " " + line.strip()
    return found


def test_each_line_has_a_kind_and_a_test():
    for line in lines():
        assert TEST.search(line), line
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        assert len(cells) != 4 or cells[1] in KINDS, line


def figures_in(text: str, words: str) -> list[float]:
    """The numbers at the places of `#`; all occurrences of the words must agree."""
    pattern = f"({NUMBER})".join(map(re.escape, words.split("#")))
    found = {match.groups() for match in re.finditer(pattern, " ".join(text.split()))}
    assert len(found) == 1, f"There are {len(found)} values of: {words}"
    return [float(figure.replace("−", "-")) for figure in found.pop()]


def source(file: str) -> str:
    return re.sub(r"(?<!:)//.*", "", (SOURCES / file).read_text(encoding="utf-8"))


@pytest.mark.parametrize(("words", "file", "constant", "scale"), CONSTANTS, ids=[row[0] for row in CONSTANTS])
def test_a_figure_is_that_of_the_code(words, file, constant, scale):
    expected = [scale * figure for figure in figures_in(source(file), constant)]
    shown = figures_in(PAGE, words)
    assert shown == pytest.approx(expected * (len(shown) if len(expected) == 1 else 1), rel=1e-9)


def test_figures_of_the_profiles_are_those_of_the_physics():
    physics = yaml.safe_load((SOURCES / "franka_description/config/physics.yaml").read_text())
    panda, fr3 = physics["panda"], physics["fr3"]
    inertia, ripple = panda["motors"]["inertia"], panda["noise"]
    resolution = [robot["noise"]["tau_J_resolution"][joint] for robot in (fr3, panda) for joint in (0, 6)]
    for words, expected in (
        ("| # kg m² per joint", panda["rotor_inertia"][:1]),
        ("FR3: # kg m² (joints 1 to 4) and # kg m² (joints", [inertia[0], inertia[4]]),
        ("first order, #, #, #, #, #, # and # Hz", panda["bandwidth"]["tau_ext_hat_filtered"]),
        ("FR3 # and # Nm, Panda # and # Nm", resolution),
        ("Hz, joints 1 to 6: #, #, #, #, # and # Nm, because", ripple["tau_J_ripple"][:6]),
        ("as a sine of # or # Hz", [ripple["ripple_frequency"][0], ripple["ripple_frequency"][6]]),
        ("FR3 #, Panda # rad/s", [fr3["noise"]["dq_noise"][0], panda["noise"]["dq_noise"][0]]),
        ("`recorded`: # s until", [panda["gripper"]["start"]]),
        ("(chosen here), # s at least", [panda["gripper"]["shortest"]]),
    ):
        assert figures_in(PAGE, words) == expected, words
