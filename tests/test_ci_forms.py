# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The forms for continuous integration (ci/), as GitHub's and GitLab's services run them."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from tutorial import read

TOP = Path(__file__).resolve().parent.parent
DEVEL = TOP / "catkin_ws" / "devel"
RUN = DEVEL / "bin" / "pyfranka-run"
pytestmark = pytest.mark.usefixtures("leaves_no_process")
READ = """
import os, pyfranka
robot = pyfranka.Robot(os.environ["FRANKA_ROBOT_IP"], pyfranka.RealtimeConfig.Ignore)
"""
PAGE = read(TOP / "docs/how_to/ci.md")
ACTION = yaml.safe_load((TOP / "ci" / "github" / "action.yml").read_text(encoding="utf-8"))
GITLAB = yaml.safe_load((TOP / "ci" / "gitlab" / "franka.yml").read_text(encoding="utf-8"))[".franka"]


def of_service(folder: Path, **variables: str) -> dict[str, str]:
    """The environment of a job, with the workspace instead of installed packages."""
    ours = {"PATH": "/usr/bin:/bin", "HOME": str(folder), "FRANKA_PREFIX": str(DEVEL)}
    return ours | {"MARK": os.environ["MARK"]} | variables


def test_the_action_uses_each_input_once_and_none_in_its_scripts():
    steps = ACTION["runs"]["steps"]
    used = [
        re.fullmatch(r"\$\{\{ inputs\.(\w+) \}\}", text)[1] for step in steps for text in step["env"].values()
    ]
    assert sorted(used) == sorted(ACTION["inputs"])
    assert not [step for step in steps if "${{" in step["run"]]
    assert all(given.get("required") or "default" in given for given in ACTION["inputs"].values())
    assert all(given["description"] for given in ACTION["inputs"].values())


def action(folder: Path, **inputs: str) -> subprocess.CompletedProcess:
    """Runs the steps as GitHub does; ends with the first that fails."""
    given = {name: str(each.get("default", "")) for name, each in ACTION["inputs"].items()} | inputs
    done = None
    for step in ACTION["runs"]["steps"]:
        script = folder / "step.sh"
        script.write_text(step["run"])
        variables = {
            name: re.sub(r"\$\{\{ inputs\.(\w+) \}\}", lambda match: given[match[1]], text)
            for name, text in step["env"].items()
        }
        done = subprocess.run(
            ["bash", "--noprofile", "--norc", "-eo", "pipefail", script],
            env=of_service(folder, GITHUB_ACTION_PATH=str(TOP / "ci" / "github"), **variables),
            cwd=folder,
            text=True,
            capture_output=True,
            timeout=200,
        )
        if done.returncode != 0:
            break
    return done


def write_tests(folder: Path) -> None:
    """A user's folder tests/."""
    (folder / "tests").mkdir(parents=True)
    (folder / "tests" / "test_mine.py").write_text(
        READ + "def test_mode():\n    assert robot.read_once().robot_mode == pyfranka.RobotMode.Idle\n"
    )


def with_our_pytest(command: str) -> str:
    """A job's image has the program pytest."""
    assert "pytest tests" in command
    return command.replace("pytest", f"{sys.executable} -m pytest -q -p no:cacheprovider")


def write_package(folder: Path, name: str) -> str:
    """A user's package with a test of rostest; returns where packages are found then."""
    (folder / name).mkdir(parents=True)
    (folder / name / "package.xml").write_text(f"<package><name>{name}</name></package>")
    (folder / name / "my.test").write_text(
        '<launch><test test-name="mine" pkg="rostest" type="publishtest"><rosparam>\n'
        "topics: [{name: /joint_states, timeout: 30, negative: False}]\n"
        "</rosparam></test></launch>"
    )
    return f"{folder}:{os.environ['ROS_PACKAGE_PATH']}"


def test_the_commands_of_the_page_run_a_users_tests(tmp_path):
    write_tests(tmp_path)
    packages = write_package(tmp_path, "my_package")
    block = with_our_pytest(PAGE.block_with("pyfranka-run --robot")).replace("pyfranka-run", str(RUN))
    done = subprocess.run(
        ["bash", "-ec", block],
        env={**os.environ, "ROS_PACKAGE_PATH": packages},
        cwd=tmp_path,
        text=True,
        capture_output=True,
        timeout=300,
        stdin=subprocess.DEVNULL,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "1 passed" in done.stdout and "ERRORS: 0" in done.stdout


def test_the_action_runs_a_users_pytest(tmp_path):
    write_tests(tmp_path)
    (job,) = yaml.safe_load(PAGE.block_with("ci/github"))["jobs"].values()
    inputs = job["steps"][-1]["with"]
    done = action(tmp_path, **inputs | {"run": with_our_pytest(inputs["run"])})
    assert done.returncode == 0 and "1 passed" in done.stdout, done.stdout + done.stderr


def test_the_action_fails_with_its_command(tmp_path):
    done = action(tmp_path, run="false | true\necho not reached")
    assert done.returncode == 1 and "not reached" not in done.stdout
    assert "the robot's last lines" in done.stderr


def test_the_action_needs_a_command(tmp_path):
    done = action(tmp_path)
    assert done.returncode == 2 and "FRANKA_RUN is empty" in done.stderr


@pytest.fixture
def source(tmp_path):
    """A clone of the project, as GitLab's job makes it: its folder ci/."""
    folder = tmp_path / "source"
    shutil.copytree(TOP / "ci", folder / "ci")
    for words in (
        ["init", "--quiet", "--initial-branch=main"],
        ["add", "."],
        ["-c", "user.name=test", "-c", "user.email=test@example.org", "commit", "--quiet", "-m", "ci"],
    ):
        subprocess.run(["git", *words], cwd=folder, check=True)
    return f"file://{folder}"


def job_of_gitlab(folder: Path, **variables: str) -> subprocess.CompletedProcess:
    project = folder / "project"
    project.mkdir(exist_ok=True)
    script = "\n".join([*GITLAB["before_script"], *GITLAB["script"]])
    return subprocess.run(
        ["bash", "-eo", "pipefail", "-c", script],
        env=of_service(folder, **GITLAB["variables"] | variables | {"CI_PROJECT_DIR": str(project)}),
        cwd=project,
        text=True,
        capture_output=True,
        timeout=200,
    )


def test_the_job_of_gitlab_runs_a_users_rostest(tmp_path, source):
    of_page = yaml.safe_load(PAGE.block_with("extends: .franka"))["robot"]["variables"]
    assert of_page.keys() <= GITLAB["variables"].keys()
    write_package(tmp_path, "mine")
    setup = tmp_path / "setup.bash"
    setup.write_text(f"export ROS_PACKAGE_PATH={tmp_path}:$ROS_PACKAGE_PATH\n")
    done = job_of_gitlab(
        tmp_path,
        FRANKA_SOURCE=source,
        FRANKA_LAUNCH="franka_gazebo fr3.launch headless:=true "
        "controller:=joint_impedance_example_controller",
        FRANKA_SETUP=str(setup),
        FRANKA_RUN="rosservice call /controller_manager/list_controllers | grep -A1 joint_impedance | "
        "grep -q running && rostest --text --reuse-master mine my.test",
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "SUMMARY" in done.stdout and "ERRORS: 0" in done.stdout


@pytest.mark.parametrize(
    ("words", "status", "sentence"),
    [
        (["--help"], 0, "usage: ci/install [REPOSITORY"),
        (["--now"], 2, 'no option "--now"'),
        ([str(TOP)], 2, "there is no file Packages in"),
        ([], 0, "is installed already"),
    ],
)
def test_the_installer_answers(words, status, sentence):
    done = subprocess.run(
        [TOP / "ci" / "install", *words],
        env={**os.environ, "FRANKA_PREFIX": str(DEVEL)},
        text=True,
        capture_output=True,
        timeout=60,
    )
    assert done.returncode == status and sentence in done.stdout + done.stderr


def test_job_without_packages_reports_the_missing_packages(tmp_path):
    done = subprocess.run(
        [TOP / "ci" / "run"],
        env={"PATH": "/usr/bin:/bin", "FRANKA_RUN": "true", "FRANKA_PREFIX": str(tmp_path)},
        text=True,
        capture_output=True,
        timeout=60,
    )
    assert done.returncode == 2 and "ci/install installs the packages" in done.stderr
