# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The figures of docs/fidelity.md and docs/design/limits.md, each with its source in the code.

An entry is (words of the page, value). Each `#` in the words stands for one figure. The value, in the page's
unit, is a number for all figures or a list with one number for each; all numbers of a list must equal a
single `#`.
"""

import math
import re
from pathlib import Path

import pytest
import rigid_arm
import yaml

SOURCES = Path(__file__).resolve().parent.parent / "catkin_ws/src"
NUMBER = r"[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
SEVEN = "#, #, #, #, #, #, #"
SIX = "#, #, #, #, # and #"

CORE = "libfranka/include/franka_core/"
HEADERS = "franka_sim/include/franka_sim/"
ROBOT = "franka_sim/src/robot/"
TESTS = "franka_sim/test/"
WAYS = TESTS + "robot/limit_ways.h"
LIMITS_TEST = TESTS + "robot/unit_limits_test.cpp"
ENDS_WELL = "void expectToEndWell(const Approach& approach) { const double reached = move(approach, #);"
FAILS = "void expectToFail(const Approach& approach) { const double reached = move(approach, #);"


def number(text):
    return float(text.replace("−", "-"))


def pattern(words):
    """A regular expression for words in which each `#` is a number."""
    return re.compile(f"({NUMBER})".join(map(re.escape, words.split("#"))))


def constant(file, words):
    """The number, or the list of numbers, in these words of a source file; all occurrences must agree."""
    source = re.sub(r"(?<!:)//.*", "", (SOURCES / file).read_text())
    found = {match.groups() for match in pattern(words).finditer(" ".join(source.split()))}
    assert len(found) == 1, f"{file} has {len(found)} values of: {words}"
    numbers = [number(text) for text in found.pop()]
    return numbers if len(numbers) > 1 else numbers[0]


def arm_limits(name):
    """The fields of a table in franka_core/limits.h that the pages use."""
    words = f"{name[1].lower()}{name[2:]}() {{ ArmLimits arm{{}};"
    for field in ("q_min", "q_max", "dq", "ddq", "dddq", "tau", "dtau"):
        words += f" arm.{field} = {{{{{SEVEN}}}}};"
    numbers = constant(CORE + "limits.h", words + " arm.translation = {#, #, #}; arm.rotation = {#, #, #};")
    joints = {
        field: numbers[7 * i : 7 * i + 7]
        for i, field in enumerate(("q_min", "q_max", "dq", "ddq", "dddq", "tau", "dtau"))
    }
    return joints | {"translation_velocity": numbers[49], "rotation_velocity": numbers[52]}


def profiles(physics):
    """The entries of the table of profiles: figures of the simulation and of its test."""
    realism = TESTS + "world/realism_test.cpp"
    panda, fr3 = physics["panda"], physics["fr3"]
    seven = "#, #, #, #, #, # and #"
    inertia = panda["motors"]["inertia"]
    assert (
        inertia == fr3["motors"]["inertia"]
        and inertia[:4] == [inertia[0]] * 4
        and inertia[4:] == [inertia[4]] * 3
    )
    assert panda["bandwidth"] == fr3["bandwidth"] and panda["gripper"] == fr3["gripper"]
    comment = (SOURCES / "franka_description/config/physics.yaml").read_text()
    rotors = [
        float(figure)
        for figure in re.search(r"rotors themselves have ([\d., \n#]+) kg", comment)[1]
        .replace("#", " ")
        .split(",")
    ]
    amplitude = re.search(
        r"isPanda\(\) \? Array7\{\{(.*?)\}\}\s*: Array7\{\{(.*?)\}\}", (SOURCES / realism).read_text(), re.S
    )
    seen = [[float(figure) for figure in group.split(",")] for group in amplitude.groups()]
    assert seen[0] == pytest.approx([a / 2 for a in panda["friction"]["amplitude"]])
    assert seen[1] == [a / 2 for a in fr3["friction"]["amplitude"]]
    fit = [float(figure) for figure in re.search(r"sign alone: ([\d., ]+)", comment)[1].split(",")]
    share = 100 * constant(realism, "hysteresis, # * expected[i])")
    noise_share = 100 * constant(realism, "# * recorded.dq_noise")
    second = [data["noise"]["tau_J_second_difference"] for data in (fr3, panda)]
    ripple = panda["noise"]
    seen_ripple = constant(realism, f"isPanda() ? Array7{{{{{SEVEN}}}}} : Array7{{}};")
    assert seen_ripple == ripple["tau_J_ripple"]
    resolution = [data["noise"]["tau_J_resolution"] for data in (fr3, panda)]
    offsets = constant("franka_sim/src/physics/physics_config.cpp", f"kGravityError{{{SEVEN}}};")
    decisions = "../../docs/design/decisions.md"
    return [
        ("R2: mean # N, largest # N", constant(decisions, "a force of # N on average and # N at most in")),
        ("command after about # ms", constant(decisions, "dq follows its command after about # ms")),
        ("hand | approximation | about # s even", constant(decisions, "about # s for a gripper command")),
        ("FR3: # kg m² (joints 1 to 4) and # kg m² (joints", [inertia[0], inertia[4]]),
        ("themselves have # to # kg m²", [max(rotors), min(rotors)]),
        ("`ideal` #; `real`, `recorded`: the identified", panda["rotor_inertia"][0]),
        (f"Gaz et al.: {seven} Nm", seen[0]),
        (f"alone gives {seven} Nm", fit),
        ("the law, within # %", share),
        (f"hysteresis of {seven} Nm", seen[1]),
        ("these, within # %, with a slope", share),
        ("coasting from # rad/s", constant(realism, "setJointVelocity(*world_, joint(7), #);")),
        ("stops it in # s", constant(realism, "EXPECT_NEAR(#, time_to_tenth, 0.03);")),
        ("within # s of that", constant(realism, "EXPECT_NEAR(0.1, time_to_tenth, #);")),
        (f"first order, {seven} Hz", panda["bandwidth"]["tau_ext_hat_filtered"]),
        ("`ideal` # Hz", constant(HEADERS + "robot/plant.h", "kSignalCutoff = #;")),
        ("a push of # N along x, y or z reads", constant(realism, "force[axis] = #;")),
        ("reads # % after", round(10 * constant(realism, "O_F_ext_hat_K[axis] - before) < #)"))),
        (
            "after # to # ms",
            [constant(realism, "EXPECT_GE(ticks, #)"), constant(realism, "EXPECT_LE(ticks, #)")],
        ),
        ("freely below # rad/s", constant(realism, "EXPECT_LT(fastest, #);")),
        (
            "`real`: mean # to # N",
            [constant(realism, f"EXPECT_{what}(sum / ticks, #);") for what in ("GE", "LE")],
        ),
        ("below # N", constant(realism, "EXPECT_LT(largest, #);")),
        ("R2: # to # Nm", [min(offsets), max(offsets)]),
        (
            "FR3 # and # Nm, Panda # and # Nm",
            [resolution[0][0], resolution[0][6], resolution[1][0], resolution[1][6]],
        ),
        (
            f"R2 at rest {seven} Nm, R1 in its slowest # s {seven} Nm. `recorded`: within # %",
            second[0] + [constant(decisions, "in its slowest # s")] + second[1] + [noise_share],
        ),
        ("R1, from # to # Hz, joints", constant(realism, "bandRms(tau[i], #, #)")),
        (f"Hz, joints 1 to 6: {SIX} Nm, because", ripple["tau_J_ripple"][:6]),
        ("these, within # %, as a sine", 100 * constant(realism, "rms, # * recorded[i])")),
        ("as a sine of # or # Hz", [ripple["ripple_frequency"][0], ripple["ripple_frequency"][6]]),
        ("FR3 #, Panda # rad/s", [fr3["noise"]["dq_noise"][0], panda["noise"]["dq_noise"][0]]),
        ("rad/s. `recorded`: within # %", noise_share),
        ("adds up to # ms", constant(HEADERS + "robot/realism.h", "kMaxCommandDelay = #;")),
        ("`recorded`: # s until", panda["gripper"]["start"]),
        ("(chosen here), # s at least", panda["gripper"]["shortest"]),
    ]


def fidelity():
    """The entries of docs/fidelity.md."""
    tick = constant(CORE + "tick.h", "kTick = #;")
    panda, fr3 = arm_limits("kFerLimits"), arm_limits("kFr3Limits")
    cutoff = constant(HEADERS + "robot/plant.h", "kSignalCutoff = #;")
    elasticity = constant(ROBOT + "estimator/state_estimator.cpp", "kJointElasticity = #;")
    gravity_error = constant("franka_sim/src/physics/physics_config.cpp", f"kGravityError{{{SEVEN}}};")
    stiffness = constant(HEADERS + "robot/control_unit_parameters.h", f"kJointStiffness{{{SEVEN}}};")
    push = constant(TESTS + "robot/unit_in_world_test.cpp", "for (const double sign : {#, #})")
    physics = yaml.safe_load((SOURCES / "franka_description/config/physics.yaml").read_text())
    stops = "test_description_limits.py"
    damping = constant(ROBOT + "laws/control_laws.h", "kDampingFactor = #;")
    guiding = [
        constant(ROBOT + "laws/control_laws.cpp", f"kGuiding{what} = #;")
        for what in ("Translation", "Rotation", "Nullspace")
    ]
    yielding = constant(ROBOT + "motion/motion_generator.cpp", "kYieldTicks = #;") * tick
    rate_test = TESTS + "robot/modes_and_requests_test.cpp"
    rate_in_move = constant(rate_test, "EXPECT_EQ(#, run(5, &zero).control_command_success_rate)")
    rate_in_idle = constant(rate_test, "EXPECT_EQ(#, run(5).control_command_success_rate)")
    bottom_row = "m[3] == # && m[7] == # && m[11] == # && m[15] == #"
    drive_test = TESTS + "physics/joint_drive_test.cpp"
    wheel = TESTS + "physics/data/lift_and_wheel.urdf"
    return [
        # State
        ("# Hz low-pass", cutoff),
        ("q + tau_J/#, dq + dtau_J/#", elasticity),
        ("without gravity; # in Idle", constant(ROBOT + "motion_supervisor.cpp", "state_->tau_J_d.fill(#);")),
        (
            "singular value is below #",
            constant(ROBOT + "estimator/state_estimator.cpp", "kMinSingularValue = #;"),
        ),
        ("sign of q4 + #", round(-constant(CORE + "limits.h", "kElbowFlip = #;"), 3)),
        ("the last # commands", constant(ROBOT + "safety/safety_monitor.h", "kSlots = #;")),
        ("# outside Move", rate_in_idle),
        ("about # rad", round(max(abs(tau) / k for tau, k in zip(gravity_error, stiffness)), 4)),
        ("shows #, #, #, #, #, # and # Nm", gravity_error),
        ("push of # N", push[0]),
        ("`O_F_ext_hat_K[0] = #`", [-push[0], push[1]]),
        # Robot
        ("| # kg m² per joint", physics["panda"]["rotor_inertia"] + physics["fr3"]["rotor_inertia"]),
        ("damping #·√", damping),
        (
            "# rad outside",
            [
                constant(f"franka_description/test/{stops}", f"approx({bound} #, abs=1e-12)")
                for bound in ("lower -", "upper +")
            ],
        ),
        (
            "with # % of",
            100 * constant(ROBOT + "hands/gripper_unit.cpp", "finger_force = # * std::min(force,"),
        ),
        (
            "time constant # ms between finger pads and graspable objects (a grasp must not creep), # ms",
            [
                1000 * constant("franka_sim/src/physics/contacts.h", f'k{what}Solref = "# 1";')
                for what in ("Grasp", "Contact")
            ],
        ),
        # Profiles
        *profiles(physics),
        # Control
        ("null space # Nm/rad", constant(ROBOT + "laws/control_laws.cpp", "kNullspace = #;")),
        ("fades at # Nm/s", constant(ROBOT + "laws/control_laws.cpp", "kStep = # * kTick;")),
        ("then, for # s", yielding),
        ("# N/m, # Nm/rad, a locked elbow with # Nm/rad", guiding),
        ("up to # s", constant(ROBOT + "safety/safety_monitor.h", "kPatience = #;") * tick),
        ("# lost in a row", constant(ROBOT + "safety/safety_monitor.h", "kLostInARow = #;")),
        # Errors
        ("# rad beyond the limits", constant(ROBOT + "limits.cpp", "kPositionMargin = #;")),
        ("speed # % above", 100 * (constant(ROBOT + "limits.cpp", "kSpeedMargin = #;") - 1)),
        ("hand # m/s, FR3 #", [robot["translation_velocity"] for robot in (panda, fr3)]),
        (
            "more than # Nm for # s",
            [
                constant(ROBOT + "safety/safety_monitor.cpp", "kTolerance = #;"),
                constant(ROBOT + "safety/safety_monitor.cpp", "kPatience = #;") * tick,
            ],
        ),
        ("above # W", constant(HEADERS + "robot/limits.h", "kPowerLimit = #;")),
        ("# times the motors'", constant(ROBOT + "limits.cpp", "kTorqueMargin = #;")),
        ("# times the joints' jerk", constant(ROBOT + "motion/joint_motion.cpp", "kSolvedJerkFactor = #;")),
        ("been slower than # rad/s", constant(ROBOT + "motion_supervisor.cpp", "kStandstill = #;")),
        ("for # ms, so that", constant(ROBOT + "motion_supervisor.cpp", "kRestingTicks = #;")),
        ("or after # s in which", constant(ROBOT + "motion_supervisor.cpp", "kClosingTicks = #;") * tick),
        (
            "with # times, it would never",
            constant(TESTS + "robot/error_flags_test.cpp", "2 * limits->ddq[i], # * limits->dddq[i] * 1e-3"),
        ),
        (
            "limit to limit of the acceleration is # times",
            [2 * a / (j * tick) for robot in (panda, fr3) for a, j in zip(robot["ddq"], robot["dddq"])],
        ),
        # Commands
        ("control unit, # % of every limit", 100 * constant(LIMITS_TEST, ENDS_WELL)),
        ("and # % raises an error", 100 * constant(LIMITS_TEST, FAILS)),
        ("stop within # ms", 1000 * tick),
        ("yields for # s", yielding),
        ("rate is # Hz", round(1000 / constant("franka_sim/src/fci/hand_server.h", "kStatePeriod{#};"))),
        (
            "# degrees Celsius at rest, up to # more under # N",
            [
                constant(HEADERS + "robot/hands/gripper_unit.h", f"{what}{{#}};")
                for what in ("room_temperature", "temperature_rise", "max_force")
            ],
        ),
        (
            "time constant of # s",
            constant(HEADERS + "robot/hands/gripper_unit.h", "temperature_time{#};"),
        ),
        ("exactly # # # #", constant("libfranka/src/core/transform.cpp", bottom_row)),
        ("length #", constant("libfranka/src/core/transform.cpp", "std::abs(length - #)")),
        ("within #;", constant(CORE + "transform.h", "kTransformTolerance = #;")),
        (
            "velocity limit is #",
            constant(CORE + "limits.h", "std::max(#, std::sqrt(margin) - limits.offset[joint])"),
        ),
        # FrankaHWSim, other devices, SDF worlds, hand, ros_control
        ("is # in Move and # in Idle", [rate_in_move, rate_in_idle]),
        (
            "creeps below the limit (below # rad/s",
            constant(drive_test, "EXPECT_LT(wheel_->measure().velocity, #);"),
        ),
        (
            "at # % of it",
            100
            * constant(drive_test, "wheel_->applyEffort(#); step(500); EXPECT_LT")
            / constant(wheel, '<dynamics damping="0.5" friction="#"/>'),
        ),
        ("# cm", 100 * constant("franka_sim/src/physics/meshes.cpp", "kPlate = #;")),
        ("nothing for # s", constant("franka_gripper/src/franka_gripper/gripper_node.py", "SILENCE = #")),
        (
            "polls every # ms",
            constant(
                "ros_control/realtime_tools/include/realtime_tools/detail/publishing_schedule.h",
                "kMinWait{#};",
            )
            / 1000,
        ),
        (
            "down to every # ms",
            constant(
                "ros_control/realtime_tools/include/realtime_tools/detail/publishing_schedule.h",
                "kMaxWait{#};",
            )
            / 1000,
        ),
    ]


def radius_of_round_way(protocol):
    """Radius of the circle on which the tip of the rod moves around z of O [m]."""
    way = f"{{Part::kTranslation, {{{{{SEVEN}}}}}, {{0, 0, 1}}, #, true}}"
    *q, rod = constant(WAYS, f"{{{protocol}, kVelocityOnly, {way}")
    hand = constant(
        "franka_sim/include/franka_sim/robot/control_unit_parameters.h", "0, 0, 0, 0, 1, 0, 0, 0, #, 1};"
    )
    flange = rigid_arm.poses(q)[rigid_arm.FLANGE]
    return math.hypot(*(flange[:2, 3] + (hand + rod) * flange[:2, 2]))


def longest_way(velocity, acceleration, tick):
    """Longest way of a joint that approaches its velocity limit: `reach` of limit_profile.h [rad]."""
    profile = TESTS + "robot/limit_profile.h"
    ramp, hold = constant(profile, "kRamp = #;"), constant(profile, "kHold = #;")
    effort = constant(profile, "double effort = #)")
    slow = constant(profile, "std::min(# * kRamp, full / 2)") * ramp
    full = math.ceil(velocity / (effort * acceleration * tick))
    return velocity * tick * (full + slow + hold)


def limits():
    """The entries of docs/design/limits.md, except its table, which test_limits_page.py compares."""
    tick = constant(CORE + "tick.h", "kTick = #;")
    panda, fr3 = arm_limits("kFerLimits"), arm_limits("kFr3Limits")
    way = TESTS + "robot/limit_way.h"
    straight_ways = []
    for protocol, limit in ((5, panda["translation_velocity"]), (10, fr3["translation_velocity"])):
        share = constant(WAYS, f"{{{protocol}, #, {{Part::kTranslation")
        straight_ways.append([100 * share, limit, round(share * limit, 1)])
    joint_5 = fr3["q_max"][4] - fr3["q_min"][4]
    radii = [radius_of_round_way(protocol) for protocol in (5, 10)]
    # Rounding of joint 4 in the middle of its range to a float's 24 bits; its effect on a third difference.
    power = 2 ** (math.frexp((panda["q_min"][3] + panda["q_max"][3]) / 2)[1] - 1)
    rounding = power * 2**-24
    jerk = (1 + 3 + 3 + 1) * rounding / tick**3
    good, bad = (100 * constant(LIMITS_TEST, words) for words in (ENDS_WELL, FAILS))
    return [
        ("unit at # kHz", 1 / tick / 1000),
        ("**# %** of that one limit", good),
        ("with **# %** it ends", bad),
        ("recovery # % runs", good),
        # Where
        ("is # rad of #", [round(longest_way(fr3["dq"][4], fr3["ddq"][4], tick), 2), round(joint_5, 2)]),
        ("paths at # %", 100 * constant(TESTS + "robot/limit_search.h", "double share{#};")),
        (
            "# times their jerk",
            [
                constant(way, "kSolvedJerk = #;"),
                constant(ROBOT + "motion/joint_motion.cpp", "kSolvedJerkFactor = #;"),
            ],
        ),
        ("# rad before", constant(way, "kRangeMargin = #;")),
        ("# m between", constant(way, "kCollisionMargin = #;")),
        (
            "# as smallest singular value",
            [
                constant(way, "kSingular = #;"),
                constant(ROBOT + "motion/cartesian_motion.cpp", "kNearlySingular = #;"),
            ],
        ),
        # What was found
        ("# % of the Panda's # m/s (# m/s)", straight_ways[0]),
        ("# % of the FR3's # m/s (# m/s)", straight_ways[1]),
        ("faster by # %", 100 * constant(WAYS, "kTooMuch = #;")),
        ("none of #", constant(WAYS, "kStraightDraws = #;")),
        ("a rod of # m", constant(WAYS, "{0, 0, 1}, #, true}")),
        ("distance of # m", [round(radius, 1) for radius in radii]),
        (
            "turns at # % (Panda) and # %",
            [
                round(100 * robot["translation_velocity"] / radius / robot["rotation_velocity"])
                for robot, radius in zip((panda, fr3), radii)
            ],
        ),
        ("ends.** # % and # %", [good, bad]),
        ("its value at # rad/s", constant(LIMITS_TEST, "kCruise = #;")),
        ("at # to # rad by", [power, 2 * power]),
        ("up to # rad;", round(rounding, 9)),
        ("difference over # ms", 1000 * tick),
        ("jerk of up to # rad/s³", round(jerk, -1)),
        ("# to # % of the limit", [round(100 * jerk / robot["dddq"][3]) for robot in (panda, fr3)]),
        ("# % of the jerk is", good),
    ]
