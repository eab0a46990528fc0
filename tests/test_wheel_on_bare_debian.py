# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The wheel of pyfranka, and pip's own build of its sources, on a bare Debian."""

import json
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from bare_debian import BareDebian, bare_debian
from genuine_clients import LOCKS, client_python, locked
from page_output import Example
from tutorial import read

TOP = Path(__file__).resolve().parent.parent
SUPPORT = TOP / "tests" / "support"
PICK_AND_PLACE, GENUINE_CLIENT = SUPPORT / "wheel_pick_and_place.py", SUPPORT / "wheel_genuine_client.py"
DESK_PAGE = SUPPORT / "wheel_desk_page.py"
HOUR = 3600.0  # [s]
pytestmark = [
    pytest.mark.long_form("makes a bare Debian"),
    pytest.mark.timeout(3 * HOUR),
]


@pytest.fixture(scope="session")
def bare(wheel, tmp_path_factory):
    """A bare Debian of this machine's release with Python's venv, in it an environment with the wheel."""
    with bare_debian(tmp_path_factory.mktemp("bare"), "python3-venv") as bare:
        install_on(bare, wheel)
        yield bare


def install_on(bare: BareDebian, wheel: Path):
    shutil.copy(wheel, bare.root / "root")
    for file in (PICK_AND_PLACE, GENUINE_CLIENT, DESK_PAGE, LOCKS / "wheel.txt", LOCKS / "panda.txt"):
        shutil.copy(file, bare.root / "root")
    bare.must("python3", "-m", "venv", "/env")
    bare.must("/env/bin/pip", "install", "--quiet", *locked("wheel", Path("/root")))
    bare.must("/env/bin/pip", "install", "--quiet", "--no-index", f"/root/{wheel.name}")


def check_simulation_on(bare: BareDebian, quick_start: Example):
    quick_start.check(bare.must("/env/bin/python", "-c", quick_start.code))
    seen = json.loads(bare.must("/env/bin/python", f"/root/{PICK_AND_PLACE.name}"))
    assert seen["grasped"] and seen["held"] and seen["away"] < 0.01
    # Pictures need drivers, which are not here.
    assert seen["picture"].startswith("No pictures can be drawn (EGL: libEGL.so.1 cannot be loaded")
    assert "install the packages libegl1 and libgl1-mesa-dri, or libosmesa6" in seen["picture"]
    window = bare.run("/env/bin/franka_sim", "--viewer", "--ip", "127.0.61.3")
    assert window.returncode == 1 and "install the package libglfw3" in window.stderr, window
    return seen["hash"]


def check_meshes_on(bare: BareDebian):
    assert "the meshes are in place" not in bare.must("/env/bin/pyfranka-meshes")
    assert "the meshes are in place" in bare.must("/env/bin/pyfranka-meshes")
    code = """
        import pyfranka.meshes
        from pyfranka.sim import FR3, Panda, Simulation
        for robot in ("panda", "fr3"):
            with open(f"/tmp/{robot}.urdf", "w") as file:
                file.write(pyfranka.meshes.urdf(robot))
        with_meshes = [Panda(urdf="/tmp/panda.urdf"), FR3(base=(0, 1, 0), urdf="/tmp/fr3.urdf")]
        for robots in (with_meshes, [Panda(), FR3(base=(0, 1, 0))]):
            with Simulation(robots=robots) as sim:
                sim.step(100)
                print(sim["panda"].state_hash(), sim["fr3"].state_hash())
    """
    with_meshes, without = bare.must("/env/bin/python", "-c", textwrap.dedent(code)).splitlines()
    assert with_meshes == without, "meshes change no motion"


def check_desk_on(bare: BareDebian, wheel: Path):
    bare.must("/env/bin/pip", "install", "--quiet", f"/root/{wheel.name}[desk]")
    assert bare.must("/env/bin/python", f"/root/{DESK_PAGE.name}").split() == ["1", "True"]


def check_genuine_client_on(bare: BareDebian):
    bare.must("python3", "-m", "venv", "/genuine")
    bare.must(
        "/genuine/bin/pip", "install", "--quiet", "--only-binary=:all:", *locked("panda", Path("/root"))
    )
    arguments = ["/genuine/bin/python", f"/root/{GENUINE_CLIENT.name}", "/env/bin/franka_sim", "127.0.61.4"]
    assert json.loads(bare.must(*arguments)) == {"cycles": 1000, "mode": "RobotMode.kIdle"}


def test_simulations_run_on_a_bare_debian(bare, quick_start):
    in_workspace = subprocess.check_output([sys.executable, PICK_AND_PLACE], text=True, timeout=300)
    assert check_simulation_on(bare, quick_start) == json.loads(in_workspace)["hash"]


def test_desk_serves_its_page_on_a_bare_debian(bare, wheel):
    check_desk_on(bare, wheel)


def test_meshes_are_installed_on_a_bare_debian(bare):
    check_meshes_on(bare)


def test_genuine_panda_python_drives_its_robot_on_a_bare_debian(bare):
    client_python("panda")  # skips if PyPI has none for this Python
    check_genuine_client_on(bare)


def test_pip_builds_it_from_its_sources_in_an_environment_of_its_own(quick_start, tmp_path):
    """With the packages that the page names, and what pyproject.toml requires from PyPI."""
    packed = subprocess.run([TOP / "franka", "wheel", "--sdist"], text=True, capture_output=True, timeout=600)
    assert packed.returncode == 0, packed.stdout + packed.stderr
    sources = Path(re.search(r"The sources: (\S+)", packed.stdout).group(1))
    assert sources.stat().st_size <= 3e6
    install = read(TOP / "docs" / "franka_sim.md").block_with("apt-get install")
    install = install.replace("apt-get install", "apt-get install -y --no-install-recommends python3-dev")
    with bare_debian(tmp_path, "python3-venv") as bare:
        bare.must("sh", "-ec", f"apt-get update\n{install}", timeout=HOUR)
        shutil.copy(sources, bare.root / "root")
        bare.must("python3", "-m", "venv", "/env")
        bare.must("/env/bin/pip", "install", f"/root/{sources.name}", timeout=HOUR)
        quick_start.check(bare.must("/env/bin/python", "-c", quick_start.code))
