# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_plot: what it draws of logs, bags and robots, and what it says about other input."""

import re
import subprocess
import sys
from itertools import combinations, product
from pathlib import Path

import matplotlib
import numpy as np
import pyfranka
import pytest
from matplotlib.legend import Legend
from pyfranka import franka_plot, plot
from pyfranka.franka_sim import FrankaSim
from pyfranka.plot.recording import ERRORS, FIELDS, Abort, Recording, kind_of, of_log
from pyfranka.plot.signals import EVIDENCE, SIGNALS, worst
from pyfranka.plot.sources import read_bag, read_log
from pyfranka.sim import FR3, Panda, Simulation

UNLIMITED = {"limit_rate": False, "cutoff_frequency": 1000.0}
EXCESS = re.compile(
    r"^(\w+): (?:the )?(joint \d|translation|rotation) was commanded [a-z ]+ of (\S+) \S+; the limit is "
    r"(\S+) \((\d+) ms before the end of the log\)",
    re.M,
)


def joint_velocity(robot, velocity):
    """Drives joint 1. @param velocity [rad/s] of the tick"""
    ticks = iter(range(10000))
    robot.control_joint_velocities(
        lambda state, period: pyfranka.JointVelocities([velocity(next(ticks)), 0, 0, 0, 0, 0, 0]), **UNLIMITED
    )


def jump_of_velocity(robot):
    joint_velocity(robot, lambda tick: min(1e-3 * tick, 0.1) + (0.05 if tick > 150 else 0.0))


def jump_of_acceleration(robot):
    joint_velocity(robot, lambda tick: 9e-3 * tick)


def too_fast(robot):
    joint_velocity(robot, lambda tick: 4e-3 * tick)


def jump_of_torque(robot):
    ticks = iter(range(10000))
    robot.control_torques(
        lambda state, period: pyfranka.Torques([0, 0, 0, 0, 0, 0, 3.0 if next(ticks) > 60 else 0.0]),
        limit_rate=False,
    )


def jump_of_twist(robot):
    ticks = iter(range(10000))
    robot.control_cartesian_velocities(
        lambda state, period: pyfranka.CartesianVelocities(
            [0, 0, 0.05 if next(ticks) > 60 else 0.0, 0, 0, 0]
        ),
        **UNLIMITED,
    )


def jump_of_pose(robot):
    ticks, first = iter(range(10000)), []

    def pose(state, period):
        first or first.append(state.O_T_EE_c.copy())
        target = first[0].copy()
        target[2, 3] += 1e-3 if next(ticks) > 60 else 0.0
        return pyfranka.CartesianPose(target)

    robot.control_cartesian_pose(pose, **UNLIMITED)


ABORTS = [
    jump_of_velocity,
    jump_of_acceleration,
    too_fast,
    jump_of_torque,
    jump_of_twist,
    jump_of_pose,
]


def aborted(robot, motion):
    with pytest.raises(pyfranka.ControlException) as raised:
        motion(robot)
    robot.automatic_error_recovery()
    return raised.value


class Robot:
    """What the tests need to know of a robot: its version, its client's limits, and aborts of motions."""

    Q = np.array([2.6, -1.7, 0.0, -0.3, -2.8, 4.4, 0.1])  # [rad] where its limits are asked for

    def __init__(self, connection):
        self.version = connection.server_version()
        self.lower = connection.get_lower_joint_velocity_limits(self.Q)
        self.upper = connection.get_upper_joint_velocity_limits(self.Q)
        self.aborts = {motion: aborted(connection, motion) for motion in ABORTS}


@pytest.fixture(scope="module")
def robots():
    """Robots that have ended: a connection in lock-step would get states while figures are drawn."""
    described = Panda(realism="ideal"), FR3(base=(0, 2, 0), realism="ideal")
    with FrankaSim(*described, pace="lockstep") as server:
        return {kind: Robot(server[kind].connect()) for kind in ("panda", "fr3")}


@pytest.mark.parametrize("name", ["panda", "fr3"])
@pytest.mark.parametrize("motion", ABORTS)
def test_the_marked_value_is_that_of_the_reason(robots, name, motion, tmp_path):
    """The marks come from the plotted values, the sentences from libfranka: of the states, and of a file."""
    robot, error = robots[name], robots[name].aborts[motion]
    reported = EXCESS.findall(str(error))
    assert reported, str(error)
    file = tmp_path / "log.csv"
    file.write_text(pyfranka.log_to_csv(error.log))
    file.with_suffix(".txt").write_text(f"{error}\nRobot's protocol version: {robot.version}\n")
    recordings = of_log(error.log, robot.version), read_log(file)[0]
    for recording in recordings:
        assert recording.version == robot.version
        for flag, part, value, limit, age in reported:
            (signal,) = EVIDENCE[flag]
            excess = worst(signal, recording)
            assert excess.beyond and SIGNALS[signal].parts[excess.part] == part, (flag, excess)
            assert excess.value == pytest.approx(float(value), rel=2e-3)
            assert excess.limit == pytest.approx(float(limit), rel=2e-3)
            assert round(1e3 * (recording.time[-1] - recording.time[excess.row])) == int(age)


def drawn(figure, tmp_path):
    """A figure's texts."""
    file = tmp_path / "figure.svg"
    with matplotlib.rc_context({"svg.fonttype": "none"}):
        figure.savefig(file)
    return re.sub(r"<[^>]*>|\s+", " ", file.read_text())


def test_an_abort_is_drawn_with_its_reason_and_its_limit(robots, tmp_path):
    figure = plot.abort_figure(robots["panda"].aborts[jump_of_velocity], robots["panda"].version)
    axes = figure.axes[0]
    assert axes.get_ylabel().startswith("cmd.ddq_d")
    red = [line for line in axes.lines if line.get_color() == plot.figure.VIOLATION]
    assert [15.0, 15.0] in [list(line.get_ydata()) for line in red]  # the limit of joint 1 [rad/s^2]
    text = drawn(figure, tmp_path)
    assert "15 rad/s² is allowed" in text and "limits of a Panda" in text
    assert "joint_motion_generator_velocity_discontinuity" in text
    figure.savefig(tmp_path / "abort.png")
    for legend in figure.findobj(matplotlib.legend.Legend):
        assert legend.get_window_extent().x1 <= figure.bbox.x1, (
            "the names of the lines are within the picture"
        )


def panels(part):
    """Each signal, and one of three parts of all pairs that can share a panel and of some of three."""
    alike = {}
    for name, signal in SIGNALS.items():
        alike.setdefault((signal.unit, signal.parts), []).append(name)
    several = ["+".join(pair) for names in alike.values() for pair in combinations(names, 2)]
    several += ["cmd.q_d+q+q_d", "cmd.tau_J_d+tau_J+tau_J_d"]
    return [*SIGNALS, *several[part::3]]


def is_signal(line):
    """Not a limit, which is dashed, and not a mark of an error."""
    return line.get_linestyle() != "--" and line.get_color() != plot.figure.VIOLATION


@pytest.mark.parametrize(
    "part, motion, limits, joints",
    [(0, jump_of_velocity, "auto", ()), (1, jump_of_twist, "all", (2, 7)), (2, jump_of_torque, "none", (7,))],
)
def test_all_lines_are_visible_and_in_the_legend(robots, part, motion, limits, joints):
    """With several signals one legend has their styles, another one the colors of their parts."""
    recording = of_log(robots["panda"].aborts[motion].log, robots["panda"].version)
    figure = plot.plot(recording, panels(part), limits=limits, joints=joints)
    for panel, axes in zip(panels(part), figure.axes):
        lines = [line for line in axes.lines if is_signal(line)]
        legends = [each for each in axes.findobj(Legend) if not each.get_patches()]
        entries = [line for legend in legends for line in legend.get_lines()]
        assert all(each.get_texts() for each in legends), panel
        colors = [each.get_color() for each in entries if each.get_color() != "black"]
        styles = [each.get_linestyle() for each in entries if each.get_color() == "black"] or ["-"]
        looks = [(line.get_color(), line.get_linestyle()) for line in lines]
        assert sorted(looks) == sorted(product(colors, styles)) and len({*looks}) == len(looks), panel
        low, high = axes.get_ylim()
        for line in lines:
            assert low <= np.nanmin(line.get_ydata()) <= np.nanmax(line.get_ydata()) <= high, panel


def test_a_file_may_be_a_text_or_like_a_path(tmp_path):
    class Place:
        def __fspath__(self):
            return str(tmp_path / "nothing.csv")

    for file in (str(tmp_path / "nothing.csv"), tmp_path / "nothing.csv", Place()):
        for read in (read_log, plot.read_bag):
            with pytest.raises(plot.BadInput, match="nothing.csv cannot be read|Bags need ROS"):
                read(file)


def swung(kind, version=0):
    """A recording of a robot in this process, with an error: its user stop is pressed."""
    with Simulation(robots=[kind()]) as sim:
        robot = sim[kind.kind]
        collector = plot.Collector(kind.kind, version)
        robot.joint_impedance(robot.state.q + 0.2, duration=0.3)
        for tick in range(60):
            if tick == 50:
                robot.set_user_stop(True)
            sim.step(10)
            collector.add(robot.state)
        return collector.recording()


@pytest.mark.parametrize("kind, version", [(Panda, 5), (FR3, 10)])
def test_states_are_drawn_with_limits_and_modes(kind, version, tmp_path):
    recording = swung(kind, version)
    figure = plot.plot(recording, ["q+q_d", "dq_d", "O_T_EE", "cmd.q_d"], limits="all", joints=[2])
    q, dq = figure.axes[:2]
    limits = pyfranka.ArmLimits(version)
    drawn_limits = {float(line.get_ydata()[0]) for line in q.lines if line.get_linestyle() == "--"}
    assert drawn_limits == {limits.q_min[1], limits.q_max[1]}
    measured, desired = (line.get_ydata() for line in q.lines[:2])
    np.testing.assert_array_equal(measured, recording.values["q"][:, 1])
    np.testing.assert_array_equal(desired, recording.values["q_d"][:, 1])
    lower, upper = limits.velocity_range(recording.values["q_d"])
    ends = [line.get_ydata() for line in dq.lines if line.get_linestyle() == "--"]
    np.testing.assert_array_equal(ends, [lower[:, 1], upper[:, 1]])
    text = drawn(figure, tmp_path)
    for expected in ("joint 2", "move", "user stopped", "cmd.q_d: not in this recording"):
        assert expected in text
    assert "joint 3" not in text


@pytest.mark.parametrize("field", FIELDS)
def test_signals_that_a_recording_lacks_are_none(field):
    recording = Recording("robot", np.arange(3.0), {field: np.zeros((3, FIELDS[field]))})
    values = {name: signal.value(recording) for name, signal in SIGNALS.items()}
    assert {name for name in FIELDS if name in SIGNALS and values[name] is not None} <= {field, "ddq_d"}


def test_limits_far_away_do_not_set_the_scale(tmp_path):
    recording = swung(Panda, 5)
    low, high = plot.plot(recording, ["tau_J"], joints=[1]).axes[0].get_ylim()
    assert high < 50 and "limits outside: ±87" in drawn(plot.plot(recording, ["tau_J"], joints=[1]), tmp_path)
    assert plot.plot(recording, ["tau_J"], limits="all").axes[0].get_ylim()[1] > 87
    unknown = swung(Panda)
    assert not [line for line in plot.plot(unknown).axes[0].lines if line.get_linestyle() == "--"]


def test_limits_are_those_of_the_robot(robots):
    for robot in robots.values():
        limits = pyfranka.ArmLimits(robot.version)
        lower, upper = limits.velocity_range([robot.Q, robot.Q])
        # The client's margins: of the rate limiter, and of a Panda's lost packets.
        np.testing.assert_allclose(upper[1], robot.upper, atol=0.07)
        np.testing.assert_allclose(lower[0], robot.lower, atol=0.07)
        assert limits.translation[1] > 0 and limits.rotation[2] > 0 and (limits.dtau == 1000).all()
    with pytest.raises(ValueError, match="7 joint positions"):
        limits.velocity_range([0.0] * 6)


@pytest.mark.parametrize(
    "name, version",
    [("panda_link0", 5), ("left_fr3", 10), ("panda_fr3", 0), ("arm", 0), ("my_pandas", 0), ("FR3", 10)],
)
def test_the_kind_follows_from_the_name(name, version):
    assert kind_of(name) == version


def test_errors_are_found_in_a_reason():
    assert set(EVIDENCE) <= set(ERRORS)
    assert Abort.of_text('aborted! ["tau_J_range_violation"]').errors == ("tau_J_range_violation",)


def run(*words):
    """The program's status, in this process: starting Python takes longer than most of this."""
    try:
        return franka_plot.main([str(word) for word in words])
    except SystemExit as end:
        return end.code


@pytest.fixture(scope="module")
def log(robots, tmp_path_factory):
    file = tmp_path_factory.mktemp("log") / "franka_abort_panda_1.csv"
    error = robots["panda"].aborts[jump_of_velocity]
    file.write_text(pyfranka.log_to_csv(error.log))
    file.with_suffix(".txt").write_text(str(error))
    return file


def test_a_log_is_written_as_png_and_svg(log, tmp_path):
    png, svg = tmp_path / "a.png", tmp_path / "a.svg"
    command = [sys.executable, "-m", "pyfranka.franka_plot", "log", log, "-o", png, "-o", svg]
    result = subprocess.run(command, text=True, capture_output=True, timeout=120)
    assert (result.returncode, result.stdout) == (0, f"{png}\n{svg}\n"), result.stderr
    assert png.read_bytes().startswith(b"\x89PNG") and "limits of a Panda" in svg.read_text()


def test_a_robot_is_read_from_the_network(franka_sim, tmp_path):
    robot = franka_sim("fr3", pace="realtime").robot
    file = tmp_path / "a.svg"
    assert run("robot", robot.address, "--seconds", 0.3, "-s", "q,ddq_d,success_rate", "-o", file) == 0
    text = file.read_text()
    assert "limits of an FR3" in text and "idle" in text and "ddq_d" in text


def test_a_bag_is_plotted(tmp_path):
    rosbag = pytest.importorskip("rosbag", reason="python3-rosbag is not installed")
    import rospy
    from franka_msgs.msg import FrankaState
    from geometry_msgs.msg import WrenchStamped
    from sensor_msgs.msg import JointState
    from std_msgs.msg import Header

    file = tmp_path / "states.bag"
    with rosbag.Bag(str(file), "w") as bag:
        for i in range(50):
            message = FrankaState(time=10 + 0.03 * i, q=[0.01 * i] * 7, robot_mode=1 if i < 10 else 2)
            if i >= 40:
                message.robot_mode, message.current_errors.cartesian_reflex = 4, True
            for topic in ("/a/franka_states",) if i else ("/a/franka_states", "/b/franka_states"):
                bag.write(topic, message, rospy.Time(1 + i))
        bag.write("/a/joint_states", JointState(name=["fr3_joint1"]), rospy.Time(1))
        bag.write("/b/F_ext", WrenchStamped(header=Header(frame_id="panda_K")), rospy.Time(1))
    with pytest.raises(plot.BadInput, match="several topics.*/a/franka_states, /b/franka_states"):
        read_bag(file)
    with pytest.raises(plot.BadInput, match="no topic /c"):
        read_bag(file, "/c")
    recording = read_bag(file, "/a/franka_states")
    assert recording.version == 10 and len(recording) == 50
    assert read_bag(file, "/b/franka_states").version == 5
    assert recording.errors == [(pytest.approx(11.2), ("cartesian_reflex",))]
    text = drawn(plot.plot(recording, ["q"]), tmp_path)
    assert "cartesian_reflex" in text and "reflex" in text and "idle" in text


@pytest.mark.parametrize(
    "words, status, sentence",
    [
        ([], 2, "say what to plot"),
        (["film"], 2, "invalid choice"),
        (["log", "nothing.csv"], 1, "nothing.csv cannot be read: No such file"),
        (["log", "{log}", "-s", "qq"], 2, 'There is no signal "qq"'),
        (["log", "{log}", "-s", "q+dq"], 2, "signals of one panel must have one unit"),
        (["log", "{log}", "-j", "8"], 2, '"8" is not a joint'),
        (["log", "{log}", "-o", "a.gif"], 2, "a file is .png, .svg or .pdf"),
        (["log", "{log}", "-o", "/nowhere/a.png"], 2, "there is no folder /nowhere"),
        (["log", "{log}", "--reason", "gone.txt"], 1, "gone.txt cannot be read"),
        (["log", "{log}"], 1, "There is no display for a window"),
        (["log", "{empty}"], 1, "is empty"),
        (["log", "{short}"], 1, "do not have 2 numbers"),
        (["log", "{other}"], 1, "is not a motion log"),
        (["log", "{binary}"], 1, "is not a table of numbers"),
        (["bag", "{other}"], 1, "cannot be read as a bag"),
        (["robot", "127.0.0.99", "--seconds", "nan"], 2, "is not a time"),
        (["robot", "127.0.0.99", "-s", "cmd.q_d"], 1, "states have no commands"),
        (["robot", "127.0.0.99"], 1, "127.0.0.99: libfranka: Connection"),
    ],
)
def test_bad_input_is_refused_with_a_sentence(words, status, sentence, log, tmp_path, monkeypatch, capfd):
    monkeypatch.delenv("DISPLAY", raising=False)
    texts = {"empty": "", "short": "time,state.q[0]\n1\n", "other": "a,b\n1,2\n", "binary": "a\n\0\n"}
    files = {name: tmp_path / f"{name}.csv" for name in texts}
    for name, text in texts.items():
        files[name].write_text(text)
    assert run(*(word.format(log=log, **files) for word in words)) == status
    reported = capfd.readouterr()
    assert reported.out == "" and sentence in reported.err and "Traceback" not in reported.err


def test_the_programs_of_the_page_run(panda, tmp_path, monkeypatch):
    page = (Path(__file__).resolve().parents[2] / "docs" / "how_to" / "plots.md").read_text()
    monkeypatch.chdir(tmp_path)
    for program in re.findall(r"```python\n(.*?)```", page, re.S):
        exec(program.replace("127.0.0.1", panda.address), {})
    assert (tmp_path / "abort.png").exists() and (tmp_path / "swing.svg").exists()


def test_commands_of_the_page_are_accepted(log, tmp_path):
    """Their options and sources, with other files and addresses."""
    page = (Path(__file__).resolve().parents[2] / "docs" / "how_to" / "plots.md").read_text()
    commands = re.findall(
        r"^franka_plot ([^#\n]*)", "\n".join(re.findall(r"```bash\n(.*?)```", page, re.S)), re.M
    )
    assert len(commands) == 6
    for command in commands:
        franka_plot._parser().parse_args(command.replace("~/", "").split())
