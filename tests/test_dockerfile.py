# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The Dockerfile: checked by hadolint; in the long form its stages are built in a bare Debian,
and commands run in them as in containers."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from bare_debian import bare_debian
from dockerfile import Image, stages_of

TOP = Path(__file__).resolve().parent.parent
DOCKERFILE = TOP / "Dockerfile"
PAGE = TOP / "docs" / "how_to" / "containers.md"
SIZES = re.compile(r"take (\d\.\d) and (\d\.\d) GB")


def test_the_dockerfile_has_no_findings():
    done = subprocess.run(
        [TOP / ".venv" / "bin" / "hadolint", "--no-color", DOCKERFILE],
        text=True,
        capture_output=True,
        timeout=60,
    )
    assert (done.returncode, done.stdout) == (0, "")


def test_images_do_not_run_as_root():
    stages = stages_of(DOCKERFILE.read_text())
    assert list(stages) == ["packages", "runtime", "development"]
    for name in ("runtime", "development"):
        assert [value for kind, value in stages[name].instructions if kind == "USER"][-1] == "1000:1000"
    assert stages["development"].base == "runtime"
    assert (stages["packages"].base, stages["runtime"].base) == ("debian:bookworm", "debian:bookworm-slim")


# ---- long form -------------------------------------------------------------------------------------------

BUILDS_IMAGES = pytest.mark.long_form("builds the images on a bare Debian")


@pytest.fixture(scope="session")
def image(repository, tmp_path_factory):
    """The stage `runtime`."""
    with bare_debian(tmp_path_factory.mktemp("image")) as bare:
        image = Image(bare, TOP, {("packages", "/source/dist/deb"): repository})
        image.build(stages_of(DOCKERFILE.read_text())["runtime"])
        yield image


def gigabytes(image):
    """Without downloaded packages, which Docker's base image does not keep."""
    command = ["du", "--summarize", "--one-file-system", "--block-size=1", "--exclude=./var/cache/apt"]
    return int(subprocess.check_output(command, cwd=image.bare.root, text=True).split()[0]) / 1e9


def on_the_page():
    """The sizes of both images [GB]."""
    return [float(size) for size in SIZES.search(PAGE.read_text(encoding="utf-8")).groups()]


@BUILDS_IMAGES
def test_the_stage_packages_makes_them_and_so_does_install_in_a_clone(tmp_path):
    with bare_debian(tmp_path) as bare:
        Image(bare, TOP, {}).build(stages_of(DOCKERFILE.read_text())["packages"])
        made = bare.root / "source" / "dist" / "deb"
        assert (made / "Packages").exists() and len(list(made.glob("ros-franka-*.deb"))) > 10
        shutil.rmtree(made)
        bare.must("env", "CCACHE_DIR=/ccache", "/source/ci/install", timeout=5400)
        version = bare.must("/opt/franka_ros/env.sh", "rosversion", "franka_control")
        assert version == re.search(r"^## (\S+)", (TOP / "CHANGELOG.md").read_text(), re.MULTILINE)[1] + "\n"
        assert "is installed already" in bare.must("/source/ci/install")


@BUILDS_IMAGES
def test_the_runtime_image_is_as_small_as_the_page_says(image):
    assert gigabytes(image) == pytest.approx(on_the_page()[0], abs=0.1)


@BUILDS_IMAGES
def test_a_container_draws_pictures_without_a_display(image):
    done = image.run(
        *("rosrun", "franka_sim_mujoco", "pick_and_place", "--start", "--speed", "0", "--output", "demo")
    )
    assert done.returncode == 0, done.stdout + done.stderr
    demo = image.bare.root / "franka" / "demo"
    assert json.loads((demo / "report.json").read_text())[0]["in_tray"]
    assert len(list(demo.glob("*.png"))) >= 3
    assert demo.stat().st_uid == 1000


@BUILDS_IMAGES
def test_a_container_runs_a_command_with_a_robot(image):
    code = (
        "import os, pyfranka; robot = pyfranka.Robot(os.environ['FRANKA_ROBOT_IP']); "
        "print(os.getuid(), robot.server_version)"
    )
    done = image.run("pyfranka-run", "--robot", "fr3", "--", "python3", "-c", code)
    assert (done.returncode, done.stdout) == (0, "1000 10\n"), done.stderr


@BUILDS_IMAGES
def test_runtime_image_has_no_window_libraries_and_no_build_tools(image):
    for program in ("rviz", "git", "ccache", "pytest-3"):
        assert image.run("sh", "-c", f"command -v {program}").returncode != 0, program


@BUILDS_IMAGES
def test_users_build_their_packages_in_the_development_image(image):
    image.build(stages_of(DOCKERFILE.read_text())["development"])
    assert gigabytes(image) == pytest.approx(on_the_page()[1], abs=0.1)
    source = image.bare.root / "franka" / "ws" / "src"
    shutil.copytree(TOP / "tests" / "out_of_tree" / "my_arm", source / "my_arm")
    subprocess.run(["chown", "-R", "1000:1000", source.parent], check=True)
    done = image.run("bash", "-c", "cd ws && catkin_make -DPYTHON_EXECUTABLE=/usr/bin/python3", timeout=1800)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    listed = image.run(
        "bash", "-c", "source ws/devel/setup.bash && rospack plugins --attrib=plugin controller_interface"
    )
    assert "my_arm" in listed.stdout
