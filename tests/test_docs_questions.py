# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Someone who knows only the start page finds the answers to these questions with two clicks.

A click is on a link in the text of a page or in its table of contents. The second one leads to the heading
of the answer, and the words of the answer stand below it.
"""

import typing
from pathlib import Path

import pytest
from site_pages import Page, Section, follow, read_page


class Question(typing.NamedTuple):
    """What is asked, the words of the links that are clicked, and words of the answer."""

    asked: str
    clicks: tuple[str, str]
    answer: tuple[str, ...]


CONNECTING, MOTIONS, CONTROLLERS = "Connecting", "Motions and reflexes", "Controllers and ROS"
REAL_ROBOT, NOETIC = "Moving to a real robot", "Porting from Noetic"
NODES = "The hardware nodes"
FRANKA_SIM = "franka_sim: robots on the network, without ROS"

QUESTIONS = [
    Question("How do I install and build it?", ("Get started with ROS", "1. Build"), ("./franka build",)),
    Question(
        "How do I see the arm move for the first time?",
        ("First motion in rviz", "1. Start the arm"),
        ("roslaunch franka_gazebo panda.launch", "rviz:=true"),
    ),
    Question(
        "How do I write a torque controller in C++?",
        ("A torque controller in C++", "2. Write the control law"),
        ("tau = K (q_d - q) - D dq + coriolis",),
    ),
    Question(
        "How do I run a controller in Python under ROS?",
        ("A torque controller in Python", "4. Run it as a controller in ROS"),
        ("PythonController", "--python"),
    ),
    Question(
        "How do I simulate a robot in a Python program?",
        ("Get started with Python", "2. A robot in your program"),
        ("from pyfranka.sim import", "Simulation"),
    ),
    Question(
        "How do I use it without ROS, with pip?",
        ("Simulated robots in a Python program", "Without ROS: the wheel"),
        ("./franka wheel", "pip"),
    ),
    Question(
        "How do I simulate an FR3?",
        ("franka_gazebo", "fr3.launch"),
        ("roslaunch franka_gazebo fr3.launch", "A simulated FR3"),
    ),
    Question(
        "Which arguments does the simulation take?",
        ("franka_gazebo", "panda.launch"),
        ("real_time_factor", "reflexes", "initial_joint_positions"),
    ),
    Question(
        "How do I control two arms?",
        (NODES, "franka_combined_control_node"),
        ("Several arms", "robot_hardware", "FrankaCombinableHW"),
    ),
    Question(
        "How do I use the gripper?", (NODES, "franka_gripper_node"), ("~grasp", "~homing", "default_speed")
    ),
    Question(
        "What is communication_constraints_violation?",
        (MOTIONS, "communication_constraints_violation"),
        ("too late", "Real-time kernel"),
    ),
    Question(
        "A program refuses my kernel: what now?",
        (CONNECTING, "libfranka: Running kernel does not have realtime capabilities."),
        ("realtime_config:=ignore", "kIgnore"),
    ),
    Question(
        "How do I install a real-time kernel?",
        (REAL_ROBOT, "Step 2: Real-time kernel"),
        ("linux-image-rt-amd64",),
    ),
    Question(
        "The user stop was pressed: how do I go on?",
        (MOTIONS, "libfranka: Move command aborted: User Stop pressed!"),
        ("Release it", "recover"),
    ),
    Question(
        "How do I recover from an error?",
        ("First motion in rviz", "5. Recover"),
        ("error_recovery", "franka_msgs/ErrorRecoveryActionGoal"),
    ),
    Question(
        "How do I change the stiffness of the impedance controller?",
        ("franka_example_controllers", "franka_example_controllers/CartesianImpedanceExampleController"),
        ("translational_stiffness", "N/m"),
    ),
    Question(
        "How do I tell the robot what it carries?",
        ("franka_msgs", "franka_msgs/SetLoad"),
        ("mass", "F_x_center_load", "load_inertia"),
    ),
    Question("Where is MoveIt?", (NOETIC, "Step 6: MoveIt"), ("Debian has no MoveIt",)),
    Question(
        "The URDF has other joints than the controller: what now?",
        (CONTROLLERS, "the arm is called"),
        ("arm_id",),
    ),
    Question(
        "How do I test my project in CI?", ("Test your project with a robot in CI", "GitHub"), ("jobs:",)
    ),
    Question("How do I get repeatable runs over the network?", (FRANKA_SIM, "Pace"), ("lockstep",)),
    Question(
        "How do I log in to Desk of a simulated robot?",
        ("Desk: the robot's web interface", "Options"),
        ("password",),
    ),
    Question(
        "Robot and library have other versions: what now?",
        (CONNECTING, "libfranka: Robot and library speak different protocols"),
        ("franka_info", "versions"),
    ),
    Question(
        "The controller runs, but nothing moves: why?",
        (CONTROLLERS, 'The controller is "running", but the arm does not move'),
        ("has_error", "robot_mode", "/clock"),
    ),
    Question(
        "Why does rviz show no meshes?", (CONTROLLERS, "Could not load mesh resource"), ("./franka install",)
    ),
    Question(
        "The node says that it is the wrong robot: what now?",
        (CONTROLLERS, "the robot is an FR3"),
        ("robot:=fr3", "ignore_robot_mismatch"),
    ),
    Question(
        "What does UDP receive: Timeout mean?", (CONNECTING, "libfranka: UDP receive: Timeout"), ("firewall",)
    ),
    Question(
        "How do I install Debian packages?", ("Install Debian packages", "Install them"), ("apt-get install",)
    ),
    Question(
        "How real is the simulated robot?",
        ("From the simulated robot to a real one", "Profiles"),
        ("ideal", "real", "recorded"),
    ),
    Question(
        "How do I put an object into the world?",
        ("franka_sim_mujoco", "franka_sim_mujoco/SpawnObject"),
        ("name", "pose"),
    ),
    Question(
        "What does a callback of libfranka get, and how often?",
        ("libfranka", "franka/robot.h"),
        ("Callbacks get the newest state", "1 ms"),
    ),
    Question(
        "How do I randomize a task for learning?",
        ("Tasks as environments of Gymnasium", "Domain randomization"),
        ("friction",),
    ),
    Question(
        "Which parameters does a hardware node take?",
        (NODES, "Parameters of an arm"),
        ("robot_ip", "realtime_config", "cutoff_frequency"),
    ),
]


def click(page: Page, words: str) -> tuple[Path, str]:
    """The target of the link with these words, or that begin with them where they are long."""
    for link in page.own_links:
        if link.words == words or len(words) > 12 and link.words.startswith(words):
            return follow(page, link.target)
    pytest.fail(
        f"{page.path.name} has no link '{words}'; it has {sorted({link.words for link in page.own_links})}"
    )


def answer(site: Path, clicks: tuple[str, ...]) -> Section:
    """The section that is reached with these clicks."""
    page, anchor = read_page(site / "index.html"), ""
    for words in clicks:
        path, anchor = click(page, words)
        page = read_page(path)
    section = page.section_at(anchor)
    assert section is not None
    return section


def test_there_are_thirty_questions():
    assert len({question.asked for question in QUESTIONS}) >= 30
    assert all(len(question.clicks) <= 2 for question in QUESTIONS)


@pytest.mark.parametrize("question", QUESTIONS, ids=lambda question: question.asked)
def test_answer_is_reachable_with_two_clicks(site, question):
    section = answer(site, question.clicks)
    assert section.heading.startswith(question.clicks[-1])
    assert not [words for words in question.answer if words not in section.text], section.text[:2000]


def test_missing_link_is_reported(site):
    with pytest.raises(pytest.fail.Exception, match="index.html has no link 'Cooking'"):
        answer(site, ("Cooking",))


def test_the_text_of_a_section_ends_at_the_next_heading(tmp_path):
    path = tmp_path / "page.html"
    path.write_text(
        "<nav><a href='x.html'>menu</a></nav>"
        "<section id='a'><h1>A<a href='#a'>¶</a></h1><p>one</p>"
        "<section id='b'><h2>B</h2><p>two</p></section></section>"
        "<aside class='toc-drawer'><a href='#b'>B</a></aside>"
        "<aside class='sidebar-drawer'><a href='#b'>C</a></aside>"
    )
    page = Page(path)
    assert [section.text for section in page.sections] == ["one", "two"]
    assert page.section_at("b").heading == "B" and page.section_at("").heading == "A"
    assert [link.words for link in page.own_links] == ["", "B"]
