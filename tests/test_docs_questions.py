# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A reader who knows only the site's start page finds the answer to a newcomer's question in two clicks.

The labels are those of links in the text of the start page, then in the text or the table of contents of
the page that the first one opens. An answer is a section: its heading, and words in its text.
"""

import typing
from pathlib import Path

import pytest
from site_pages import Page, follow, read_page

builds_the_site = pytest.mark.long_form("builds the documentation site")


class Question(typing.NamedTuple):
    """A question, the labels to click, the heading of the answer, and words of its section."""

    text: str
    labels: tuple[str, ...]
    heading: str
    words: tuple[str, ...]


QUESTIONS = [
    Question(
        "How long does the installation take, and what is the command?",
        ("Get started with ROS",),
        "1. Build",
        ("./franka build", "five to seven minutes", "twenty"),
    ),
    Question(
        "How do I start a simulated arm with a controller?",
        ("Get started with ROS", "3. Use it"),
        "3. Use it",
        ("roslaunch franka_gazebo panda.launch", "controller:="),
    ),
    Question(
        "How does a program in C++ move an arm?",
        ("Get started with libfranka and C++", "2. Move it with a program in C++"),
        "2. Move it with a program in C++",
        ("joint_positions 127.0.0.1", "find_package(Franka"),
    ),
    Question(
        "How do I build my own program for libfranka?",
        ("Programs for libfranka", "5. Write your own program"),
        "5. Write your own program",
        ("find_package(Franka REQUIRED)", "Franka::Franka"),
    ),
    Question(
        "Can I use it from Python without ROS?",
        ("Get started with Python", "1. Get it"),
        "1. Get it",
        ("Without ROS", "./franka wheel", "pip install"),
    ),
    Question(
        "What do I type first when I have a real robot?",
        ("Get started with a real robot", "1. Check the robot"),
        "1. Check the robot",
        ("franka_info 172.16.0.2", "activate the FCI"),
    ),
    Question(
        "Do I need a real-time kernel, and how do I install it?",
        ("Moving to a real robot", "Step 2: Real-time kernel"),
        "Step 2: Real-time kernel",
        ("linux-image-rt-amd64", "ulimit -r"),
    ),
    Question(
        "How do I connect the computer to the robot?",
        ("Moving to a real robot", "Step 3: Network"),
        "Step 3: Network",
        ("One cable", "172.16.0.1/24", "firewall"),
    ),
    Question(
        "How do I move the arm in rviz?",
        ("First motion in rviz", "3. Move the hand"),
        "3. Move the hand",
        ("drag one of the arrows",),
    ),
    Question(
        "How do I recover after a collision?",
        ("Recover from errors", "In ROS"),
        "In ROS",
        ("/franka_control/error_recovery/goal",),
    ),
    Question(
        "How do I set the load that the arm carries?",
        ("Call the services", "The robot's settings"),
        "The robot's settings",
        ("set_load", "after each grasp"),
    ),
    Question(
        "How do I grasp an object?",
        ("Use the gripper",),
        "Use the gripper",
        ("/franka_gripper/grasp/goal", "epsilon"),
    ),
    Question(
        "How do I record what the robot does?",
        ("Record data", "With rosbag"),
        "With rosbag",
        ("rosbag record", "publish_rate"),
    ),
    Question(
        "How do I see why a motion was aborted?",
        ("Plot a robot", "Why a motion was aborted"),
        "Why a motion was aborted",
        ("franka_plot log", "red dot"),
    ),
    Question(
        "How do I control two arms with one controller?",
        ("Use two arms", "One controller for both arms"),
        "One controller for both arms",
        ("franka_combined_control.launch", "torques only"),
    ),
    Question(
        "How do I begin a controller of my own in C++?",
        ("A torque controller in C++", "1. Make a package"),
        "1. Make a package",
        ("new_controller spring_controller",),
    ),
    Question(
        "Can a ROS controller be written in Python?",
        ("Write your own controller", "In Python"),
        "In Python",
        ("PythonController", "def update"),
    ),
    Question(
        "Which interfaces may a controller claim together?",
        ("Write your own controller", "Allowed claims"),
        "Allowed claims",
        ("effort", "All other combinations are refused"),
    ),
    Question(
        "How do I pause the simulation, or run it as fast as possible?",
        ("Call the services", "The world"),
        "The world",
        ("pause_physics", "as fast as possible"),
    ),
    Question(
        "How do I train a policy?",
        ("Tasks as environments of Gymnasium",),
        "Tasks as environments of Gymnasium",
        ("gymnasium.make", "PickAndPlace"),
    ),
    Question(
        "How do I record episodes for imitation learning?",
        ("Tasks as environments of Gymnasium", "Export of episodes"),
        "Export of episodes",
        ("RecordEpisodes", "LeRobot", "[gym,lerobot]"),
    ),
    Question(
        "How do I run many cases on all cores or on a cluster?",
        ("Simulated robots in a Python program", "Sweeps"),
        "Sweeps",
        ("pyfranka.sweep", "0.0", "tcp://host:8786"),
    ),
    Question(
        "Why does pip find nothing for pyfranka[gym], and what works?",
        ("Simulated robots in a Python program", "Without ROS: the wheel"),
        "Without ROS: the wheel",
        ("alone finds nothing", ".whl[gym,plot]", "lerobot"),
    ),
    Question(
        "What does the exit code of a program mean?",
        ("The shell", "Exit codes"),
        "Exit codes",
        ("franka_info", "cannot be reached", "pyfranka-examples", "franka_control_node"),
    ),
    Question(
        "Does panda-python work with the simulated robot?",
        ("Other people's clients: panda-python and pylibfranka", "3. Move the Panda with panda-python"),
        "3. Move the Panda with panda-python",
        ("pip install panda-python",),
    ),
    Question(
        "How do I test my project with a robot in GitHub's CI?",
        ("Test your project with a robot in CI", "GitHub"),
        "GitHub",
        ("ci/github", "run: pytest tests"),
    ),
    Question("Is there a container?", ("Run in containers", "Run"), "Run", ("docker run", "franka_sim")),
    Question(
        "Can I install it with apt?",
        ("Install Debian packages", "Install them"),
        "Install them",
        ("apt-get install franka-ros",),
    ),
    Question(
        "What must I change in a package for Noetic?",
        ("Porting from Noetic", "Step 2: package.xml and CMakeLists.txt"),
        "Step 2: package.xml and CMakeLists.txt",
        ("CMAKE_CXX_STANDARD 17",),
    ),
    Question(
        "What do users of MoveIt do?",
        ("Porting from Noetic", "Step 6: MoveIt"),
        "Step 6: MoveIt",
        ("Debian has no MoveIt", "follow_joint_trajectory"),
    ),
    Question(
        "What are the joint limits of an FR3?",
        ("Limits of the robots", "Joints of an FR3"),
        "Joints of an FR3",
        ("highest position [rad]", "torque [Nm]"),
    ),
    Question(
        "What does communication_constraints_violation mean?",
        ("Motions and reflexes", "communication_constraints_violation"),
        "communication_constraints_violation",
        ("Twenty commands in a row", "The network is late"),
    ),
    Question(
        "What do I do about UDP receive: Timeout?",
        ("Connecting", "libfranka: UDP receive: Timeout"),
        "libfranka: UDP receive: Timeout",
        ("firewall",),
    ),
    Question(
        "Why does the arm not move although the controller runs?",
        ("Controllers and ROS", 'The controller is "running", but the arm does not move'),
        'The controller is "running", but the arm does not move',
        ("has_error", "robot_mode"),
    ),
    Question(
        "What differs between the simulated robot and a real one?",
        ("From the simulated robot to a real one", "What does not carry over"),
        "What does not carry over",
        ("Elastic gears", "not published"),
    ),
    Question(
        "How do I unlock a simulated robot in a browser?",
        ("Desk: the robot's web interface", "The page"),
        "The page",
        ("log in", "unlock"),
    ),
    Question(
        "Which topics and services does the hardware node have?",
        ("The hardware nodes", "franka_control_node"),
        "franka_control_node",
        ("~error_recovery", "~has_error", "~set_load"),
    ),
    Question(
        "What does NE or K mean?",
        ("Glossary", "Frames and signals"),
        "Frames and signals",
        ("nominal end effector", "stiffness frame"),
    ),
]


class NotFound(AssertionError):
    """A click leads nowhere, or the answer is not there; the message names the page."""


def click(page: Page, label: str) -> tuple[Page, str]:
    """The page and the anchor behind the link with this label."""
    places = {
        follow(page, target)
        for target, text in zip(page.own_links, page.labels, strict=True)
        if text == label
    }
    if len(places) != 1:
        raise NotFound(f"{page.path.name} has {len(places)} places behind the label {label!r}")
    path, anchor = places.pop()
    return read_page(path), anchor


def answer(site: Path, question: Question) -> str:
    """The text of the section to which the labels lead. Raises NotFound."""
    assert 1 <= len(question.labels) <= 2
    page, anchor = read_page(site / "index.html"), ""
    for label in question.labels:
        page, anchor = click(page, label)
    for section in page.sections:
        if section.heading == question.heading and anchor in ("", section.anchor):
            return section.text
    raise NotFound(f"{page.path.name}#{anchor} has no heading {question.heading!r}")


def test_there_are_thirty_questions():
    assert len({question.text for question in QUESTIONS}) >= 30


@builds_the_site
@pytest.mark.parametrize("question", QUESTIONS, ids=[question.text for question in QUESTIONS])
def test_an_answer_is_found_in_two_clicks(site, question):
    text = answer(site, question)
    assert not [word for word in question.words if word not in text]


START = """<nav><a href='a.html'>In a menu</a></nav><section id='s'><h1>Start<a href='#s'>¶</a></h1>
<p><a href='a.html'>One</a> <a href='b.html'>Two</a> <a href='a.html'>Two</a></p></section>"""
PAGE = """<section id='a'><h1>A</h1><p>words of A</p><section id='b'><h2><code>B</code> part
<a href='#b'>¶</a></h2><p>words of <em>B</em></p></section></section>
<aside class='toc-drawer'><a href='#b'>B part</a></aside>"""


@pytest.mark.parametrize(
    ("labels", "heading", "text"),
    [
        (("One",), "A", "words of A"),
        (("One",), "B part", "words of B"),
        (("One", "B part"), "B part", "words of B"),
        (("One", "B part"), "A", None),
        (("One",), "C", None),
        (("In a menu",), "A", None),
        (("Two",), "A", None),
    ],
)
def test_clicks_lead_to_the_section_or_nowhere(tmp_path, labels, heading, text):
    (tmp_path / "index.html").write_text(START)
    for name in ("a.html", "b.html"):
        (tmp_path / name).write_text(PAGE)
    question = Question("", labels, heading, ())
    if text is None:
        with pytest.raises(NotFound):
            answer(tmp_path, question)
    else:
        assert answer(tmp_path, question) == text
