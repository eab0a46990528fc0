# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The wheel of pyfranka, in an environment of its own without ROS and without Debian's packages."""

import json
import os
import re
import shutil
import subprocess
import sys
import textwrap
import xml.etree.ElementTree as ElementTree
import zipfile
from email.parser import Parser
from pathlib import Path

import pytest
from genuine_clients import files, locked, pip

TOP = Path(__file__).resolve().parent.parent
SUPPORT = TOP / "tests" / "support"
PICK_AND_PLACE = SUPPORT / "wheel_pick_and_place.py"
PACKAGE = TOP / "python" / "src" / "pyfranka"
# The build of the wheel has a limit of its own: from an empty compiler cache it takes minutes.
pytestmark = pytest.mark.timeout(func_only=True)
ALL_EXTRAS = "[gym,cluster,plot,desk]"
with_extras = pytest.mark.long_form("downloads the packages of all extras")
# What the wheel takes from the machine: libraries of every Debian that has Python.
OF_THE_SYSTEM = {
    "ld-linux-x86-64.so.2",
    *(
        f"lib{name}.so.{number}"
        for name, number in (("c", 6), ("m", 6), ("dl", 2), ("pthread", 0), ("rt", 1))
    ),
    *("libstdc++.so.6", "libgcc_s.so.1", "libz.so.1"),
}
# Variables with which a build would find the workspace.
OF_A_WORKSPACE = {"PYTHONPATH", "PYTHONHOME", "LD_LIBRARY_PATH", "CMAKE_PREFIX_PATH"}


@pytest.fixture(scope="session")
def archive(wheel):
    with zipfile.ZipFile(wheel) as archive:
        yield archive


class Environment:
    """A virtual environment with the wheel and what it requires, and nothing of this machine's packages."""

    def __init__(self, folder: Path, wheel: Path, lock: str = "wheel", extras: str = ""):
        self.folder, self.wheel, self.place = folder, wheel, folder / "venv of mine"
        self.bin = self.place / "bin"
        venv = ["/usr/bin/python3", "-m", "venv", "--without-pip", self.place]
        subprocess.run(venv, check=True, timeout=300)
        # What the wheel requires has to be in the lock.
        self.install(*files(lock))
        self.install("--no-index", f"{wheel}{extras}")

    def install(self, *words: str):
        """Installs packages by another environment's pip."""
        result = pip(sys.executable, f"--python={self.bin / 'python'}", "install", "--no-compile", *words)
        assert result.returncode == 0, result.stderr

    def run(self, program: str, *arguments: str, variables=None) -> subprocess.CompletedProcess:
        """Runs a program of it, without this process's variables."""
        return subprocess.run(
            [self.bin / program, *arguments],
            env={"PATH": "/usr/bin:/bin", "HOME": str(self.folder), "LANG": "C.UTF-8", **(variables or {})},
            cwd=self.folder,
            text=True,
            capture_output=True,
            timeout=300,
        )

    def install_command(self, extra: str) -> str:
        """What messages advise for an extra; the name alone finds nothing on PyPI."""
        return f"pip install 'pyfranka[{extra}] @ {self.wheel.as_uri()}'"

    def python(self, code: str) -> str:
        """The output of a program, which must end well."""
        result = self.run("python", "-c", textwrap.dedent(code))
        assert result.returncode == 0, result.stderr
        return result.stdout


@pytest.fixture(scope="session")
def environment(wheel, tmp_path_factory) -> Environment:
    folder = tmp_path_factory.mktemp("wheel")
    (folder / "a folder").mkdir()
    return Environment(folder, Path(shutil.copy(wheel, folder / "a folder")))


@pytest.fixture(scope="session", params=["locked", "oldest", "newest"])
def complete(request, wheel, archive, tmp_path_factory) -> Environment:
    """With the packages of all extras: of the lock, or the oldest or newest ones that the wheel allows."""
    folder = tmp_path_factory.mktemp("complete")
    if request.param == "locked":
        return Environment(folder, wheel, "wheel-extras", ALL_EXTRAS)
    environment = Environment(folder, wheel)
    environment.install(*files("wheel-pytest"))
    resolution = {"oldest": "lowest-direct", "newest": "highest"}[request.param]
    # The wheel's requirements are given directly: the oldest versions are chosen for these alone.
    requirements = [
        re.sub(r"\s*;.*", "", line)
        for line in Parser().parsestr(metadata(archive, "METADATA")).get_all("Requires-Dist")
    ]
    tools = tmp_path_factory.mktemp("tools")
    subprocess.run(["/usr/bin/python3", "-m", "venv", tools], check=True, timeout=300)
    result = pip(tools / "bin" / "python", "install", *locked("uv"))
    assert result.returncode == 0, result.stderr
    options = [f"--resolution={resolution}", "--only-binary=:all:", f"--python={environment.bin / 'python'}"]
    command = [tools / "bin" / "uv", "pip", "install", "--upgrade", *options, *requirements]
    subprocess.run(command, check=True, timeout=1200)
    return environment


def metadata(archive: zipfile.ZipFile, file: str) -> str:
    (name,) = [name for name in archive.namelist() if name.endswith(f".dist-info/{file}")]
    return archive.read(name).decode()


def test_the_wheel_is_named_after_the_release_and_this_python(wheel):
    version = ElementTree.parse(TOP / "python" / "package.xml").getroot().findtext("version")
    python = subprocess.check_output(
        ["/usr/bin/python3", "-c", "import sys; print('cp%d%d' % sys.version_info[:2])"], text=True
    ).strip()
    assert re.fullmatch(rf"pyfranka-{version}-{python}-{python}-manylinux_\w+\.whl", wheel.name)
    assert f"`{wheel.name}`" in (TOP / "docs" / "python.md").read_text(encoding="utf-8")


def test_it_is_small_enough_for_a_slow_network(wheel):
    assert wheel.stat().st_size <= 12e6


def test_every_file_of_the_package_is_in_the_wheel(archive):
    ours = subprocess.check_output(["git", "ls-files", PACKAGE], cwd=PACKAGE.parent, text=True).split()
    assert {"pyfranka/__init__.py", "pyfranka/py.typed"} <= set(ours)
    assert set(ours) <= set(archive.namelist())


def test_the_page_of_desk_comes_with_its_libraries(archive):
    page = "pyfranka/desk/page"
    names = set(archive.namelist())
    assert {f"{page}/index.html", f"{page}/js/main.js", f"{page}/css/theme.css"} <= names
    for library, module in (("three", "three.module.js"), ("uplot", "uPlot.esm.js")):
        assert {f"{page}/vendor/{library}/{module}", f"{page}/vendor/{library}/LICENSE"} <= names
    of_page = [info.compress_size for info in archive.infolist() if info.filename.startswith(f"{page}/")]
    assert sum(of_page) < 1e6


def test_only_libraries_of_every_debian_are_missing(archive, tmp_path):
    archive.extractall(tmp_path)
    files = [path for path in tmp_path.rglob("*") if path.is_file()]
    programs = [path for path in files if path.read_bytes()[:4] == b"\x7fELF"]
    there = {path.name for path in programs} | OF_THE_SYSTEM
    assert {"franka_sim", "franka_info", "libfranka_sim_physics.so"} <= there
    missing = {}
    for path in programs:
        printed = subprocess.check_output(["readelf", "--dynamic", "--wide", path], text=True)
        if lost := set(re.findall(r"\(NEEDED\).*\[(.*)\]", printed)) - there:
            missing[path.name] = lost
    assert not missing
    # Nor does it look for anything in this machine's clone.
    assert [path.name for path in files if os.fsencode(TOP) in path.read_bytes()] == []


def test_licenses_of_bundled_libraries_are_included(archive):
    folders = {Path(name).parent.name for name in archive.namelist() if ".dist-info/licenses/" in name}
    bundled = [Path(name).name for name in archive.namelist() if name.startswith("pyfranka.libs/")]
    assert bundled and any(name.startswith("libmujoco") for name in bundled)
    assert any(folder.startswith("libmujoco") for folder in folders)


def test_the_quick_start_of_the_page_runs(environment, quick_start):
    quick_start.check(environment.python(quick_start.code))


def test_pick_and_place_has_the_bits_of_the_workspace(environment):
    result = environment.run("python", PICK_AND_PLACE)
    assert result.returncode == 0, result.stderr
    seen = json.loads(result.stdout)
    assert seen["grasped"] and seen["held"] and seen["away"] < 0.01
    in_workspace = subprocess.check_output([sys.executable, PICK_AND_PLACE], text=True, timeout=300)
    assert seen["hash"] == json.loads(in_workspace)["hash"]


def test_libraries_of_a_sourced_workspace_are_not_used(environment):
    code = "import pyfranka.sim; print(open('/proc/self/maps').read())"
    variables = {"LD_LIBRARY_PATH": f"{TOP}/catkin_ws/devel/lib:/usr/lib/x86_64-linux-gnu"}
    result = environment.run("python", "-c", code, variables=variables)
    loaded = {
        line.split(maxsplit=5)[5]
        for line in result.stdout.splitlines()
        if "libfranka" in line or "libmujoco" in line
    }
    assert any("libmujoco" in path for path in loaded) and any("libfranka_core" in path for path in loaded)
    assert [path for path in loaded if not Path(path).is_relative_to(environment.folder)] == []


def test_its_robot_serves_its_client(environment):
    code = """
        import subprocess, sys, pyfranka
        address = sys.argv[1]
        program = [sys.prefix + "/bin/franka_sim", "--robot", "panda", "--ip", address, "--pace", "lockstep"]
        with subprocess.Popen(program, stdout=subprocess.PIPE, text=True) as served:
            print(served.stdout.readline().strip())
            robot = pyfranka.Robot(address, pyfranka.RealtimeConfig.Ignore)
            ticks = []
            def hold(state, period):
                ticks.append(period)
                torques = pyfranka.Torques([0.0] * 7)
                torques.motion_finished = len(ticks) == 500
                return torques
            robot.control_torques(hold)
            print(len(ticks), robot.read_once().robot_mode, robot.load_model().mass(robot.read_once()).shape)
            served.terminate()
        print(served.returncode)
    """
    result = environment.run("python", "-c", textwrap.dedent(code), "127.0.61.1")
    assert result.returncode == 0, result.stderr
    lines = result.stdout.splitlines()
    assert "waits for clients at 127.0.61.1" in lines[0]
    assert lines[1:] == ["500 RobotMode.Idle (7, 7)", "0"]


def test_desk_names_the_packages_that_it_needs(environment):
    # franka_sim finds franka_desk, which is not on PATH here.
    result = environment.run("franka_sim", "--ip=127.0.61.9", "--desk")
    assert result.returncode == 1
    advice = f"Desk needs the Python package aiohttp: {environment.install_command('desk')}."
    assert advice in result.stderr and "Desk has ended before it was ready" in result.stderr


PROGRAMS = [
    *("franka_sim", "franka_info", "pyfranka-examples", "pyfranka-meshes", "pyfranka-run", "pyfranka-sweep")
]


@pytest.mark.parametrize("program", PROGRAMS)
def test_its_programs_answer_help(environment, program):
    result = environment.run(program, "--help")
    assert result.returncode == 0 and "usage" in result.stdout.lower()


def test_a_sweep_names_the_packages_that_it_needs(environment):
    script = environment.folder / "cases.py"
    script.write_text("def case(index, seed):\n    return index\n")
    result = environment.run("pyfranka-sweep", str(script), "--cases", "4")
    assert result.returncode == 2 and f": {environment.install_command('cluster')}." in result.stderr


def test_a_plot_names_the_packages_that_it_needs(environment):
    result = environment.run("franka_plot", "robot", "127.0.61.8")
    assert result.returncode == 1 and f": {environment.install_command('plot')}." in result.stderr


OF_EXTRAS = [
    ("gym", "import pyfranka.gym"),
    ("plot", "import pyfranka.plot"),
]


@pytest.mark.parametrize(("extra", "code"), OF_EXTRAS)
def test_a_module_names_the_extra_that_it_needs(environment, extra, code):
    result = environment.run("python", "-c", code)
    assert result.returncode == 1
    assert result.stderr.endswith(f": {environment.install_command(extra)}.\n"), result.stderr


def test_packages_are_named_if_the_file_of_the_wheel_has_gone(environment):
    code = "from pyfranka.command_line import install_command; print(install_command('gym'))"
    assert environment.python(code) == f"{environment.install_command('gym')}\n"
    moved = environment.wheel.rename(environment.folder / "moved")
    try:
        assert environment.python(code) == "pip install 'gymnasium>=1.1' 'scipy>=1.10'\n"
    finally:
        moved.rename(environment.wheel)


def examples_of(environment: Environment, folder: Path) -> subprocess.CompletedProcess:
    return environment.run("pyfranka-examples", str(folder))


def test_examples_are_copied_and_no_file_is_overwritten(environment, tmp_path):
    folder = tmp_path / "own" / "examples"
    result = examples_of(environment, folder)
    assert result.returncode == 0 and str(folder / "first_steps.py") in result.stdout, result.stderr
    assert {file.name: file.read_text() for file in folder.iterdir()} == {
        file.name: file.read_text() for file in (TOP / "examples" / "python").glob("*.py")
    }
    changed, lost = folder / "common.py", folder / "first_steps.py"
    changed.write_text("own")
    lost.unlink()
    result = examples_of(environment, folder)
    assert result.returncode == 1 and f"{folder} has common.py, " in result.stderr
    assert changed.read_text() == "own" and not lost.exists()


def test_the_program_of_its_description_runs(environment, archive):
    description = Parser().parsestr(metadata(archive, "METADATA")).get_payload()
    program = re.search(r"```python\n(.*?)```", description, re.DOTALL).group(1)
    assert environment.python(program).startswith("[ 0.3 ")


OF_A_PROJECT = """
import pyfranka

def test_of_a_project(panda):
    robot = panda.connect()
    assert robot.read_once().robot_mode == pyfranka.RobotMode.Idle
    panda.remote.set_user_stop(True)
    assert panda.remote.state().mode == "User stopped"
"""


def check_plugin(environment: Environment):
    """Its entry point registers the fixtures; no option and no conftest.py does."""
    (environment.folder / "test_of_a_project.py").write_text(OF_A_PROJECT)
    result = environment.run("pytest", "-q", "test_of_a_project.py")
    assert result.returncode == 0 and "1 passed" in result.stdout, result.stdout + result.stderr


def test_programs_that_need_ros_print_a_message(environment):
    code = 'pyfranka.ModelKDL("<robot/>", "link0", "link8")'
    result = environment.run("python", "-c", f"import pyfranka; {code}")
    assert "RuntimeError: ModelKDL needs ROS" in result.stderr and "Robot.load_model" in result.stderr


def test_meshes_are_refused_before_they_are_installed(environment):
    code = "import pyfranka.meshes as m; m.urdf('{}')"
    result = environment.run("python", "-c", code.format("panda"))
    assert (
        "FileNotFoundError: The mesh meshes/visual/link0.dae is not installed; run pyfranka-meshes"
        in result.stderr
    )
    result = environment.run("python", "-c", code.format("r2d2"))
    assert "ValueError: There is no robot 'r2d2' with meshes; there are panda, fr3." in result.stderr


TYPED = """
import numpy
from _pyfranka import Robot
from _pyfranka._sim import ArmModel
from pyfranka import sim, sweep

def reach(case: str, seed: int) -> dict[str, float]:
    return {"error": seed / len(case)}

def mass(model: ArmModel, robot: sim.SimulatedRobot) -> numpy.ndarray:
    return model.mass(robot.state)

reveal_type(Robot("").read_once().robot_mode)
reveal_type(sim.Panda().base)
print([outcome.result["error"] for outcome in sweep(reach, ["left", "right"]) if outcome.ok])
sim.Panda(bass=(0, 0, 0))
"""
# What stubtest says of every module of pybind11, and what is there for a reason.
NOT_IN_TYPES = (
    "metaclass differs$|__pybind11_module_local_|__all__ is not present",
    'stub does not have .args parameter "args"$',  # of classes that only the robot makes
)


def test_types_are_found_by_a_type_checker(environment, archive):
    assert {"pyfranka/__init__.pyi", "_pyfranka-stubs/__init__.pyi", "_pyfranka-stubs/_sim.pyi"} <= set(
        archive.namelist()
    )
    stubs = [name for name in archive.namelist() if name.endswith(".pyi")]
    assert [name for name in stubs if b"pybind11_stubgen" in archive.read(name)] == []
    script = environment.folder / "typed.py"
    script.write_text(TYPED)
    options = ["--python-executable", environment.bin / "python", "--cache-dir", os.devnull, "--config-file="]
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", *options, script], text=True, capture_output=True, timeout=300
    )
    errors = [line for line in checked.stdout.splitlines() if "error:" in line]
    assert len(errors) == 1 and 'Unexpected keyword argument "bass"' in errors[0], (
        checked.stdout + checked.stderr
    )
    assert 'Revealed type is "_pyfranka.RobotMode"' in checked.stdout


# One after the other: pyfranka gives the classes of _pyfranka its name.
@pytest.mark.parametrize("package", ["_pyfranka", "pyfranka"])
def test_types_and_what_is_imported_have_no_difference(environment, archive, tmp_path, package):
    """By mypy's stubtest; modules of Python have their types in themselves."""
    archive.extractall(tmp_path, [name for name in archive.namelist() if name.endswith(".pyi")])
    (tmp_path / "_pyfranka-stubs").rename(tmp_path / "_pyfranka")
    settings = tmp_path / "mypy.ini"
    settings.write_text("[mypy]\nignore_missing_imports = True\n")
    installed = next((environment.place / "lib").glob("python3*/site-packages"))
    variables = {name: value for name, value in os.environ.items() if name not in OF_A_WORKSPACE}
    options = ["--concise", "--mypy-config-file", settings]
    compared = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", *options, package],
        env={**variables, "PYTHONPATH": str(installed), "MYPYPATH": str(tmp_path)},
        cwd=tmp_path,
        text=True,
        capture_output=True,
        timeout=300,
    )
    modules = "|".join(path.stem for path in (installed / "pyfranka").iterdir() if path.suffix != ".pyi")
    lines = compared.stdout.splitlines()
    found = [line for line in lines if not re.match(rf"pyfranka\.({modules})\b", line)]
    assert any(package in line for line in lines), compared.stdout + compared.stderr  # it has compared
    assert [line for line in found if not any(re.search(each, line) for each in NOT_IN_TYPES)] == []


def test_the_plugin_is_found_by_its_entry_point(environment):
    """The last one of the gate: it adds pytest to the environment, as the project of a user has it."""
    environment.install(*files("wheel-pytest"))
    check_plugin(environment)


# ---- long form -------------------------------------------------------------------------------------------


EPISODE = """
import gymnasium, pyfranka.gym
for robot in ("panda", "fr3"):
    env = gymnasium.make("pyfranka/PickAndPlace-v0", robot=robot)
    observation, info = env.reset(seed=1)
    policy, done = pyfranka.gym.scripted_policy(env), False
    while not done:
        observation, reward, terminated, truncated, info = env.step(policy(observation))
        done = terminated or truncated
    print(info["is_success"])
    env.close()
"""


@with_extras
def test_an_episode_of_gymnasium_runs_with_its_extra(complete):
    assert complete.python(EPISODE).split() == ["True", "True"]


@with_extras
def test_the_plugin_works_beside_all_extras(complete):
    check_plugin(complete)


@with_extras
def test_a_sweep_runs_with_its_extra(complete):
    script = complete.folder / "cases.py"
    script.write_text(
        "from pyfranka.sim import Simulation\n"
        "def case(index, seed):\n"
        "    with Simulation(seed=seed) as sim:\n"
        "        sim.step(100 + index)\n"
        "        return {'ticks': sim.ticks}\n"
    )
    result = complete.run("pyfranka-sweep", str(script), "--cases", "4")
    assert result.returncode == 0 and "4 cases, 0 failed" in result.stdout, result.stdout + result.stderr
    code = """
        import pyarrow.parquet
        print(pyarrow.parquet.read_table("cases.parquet")["result.ticks"].to_pylist())
    """
    assert complete.python(code) == "[100, 101, 102, 103]\n"


@with_extras
def test_copied_examples_run(complete):
    folder = complete.folder / "examples"
    assert examples_of(complete, folder).returncode == 0
    result = complete.run("python", "examples/first_steps.py", "--output", str(folder))
    # Pictures need drivers, which a machine may not have.
    assert result.returncode == 0 or "No pictures can be drawn" in result.stderr, result.stderr


@with_extras
def test_desk_serves_its_page_with_its_extra(complete):
    result = complete.run("python", SUPPORT / "wheel_desk_page.py")
    assert result.stdout.split() == ["1", "True"], result.stderr


@pytest.mark.long_form("downloads the meshes")
def test_meshes_are_in_the_pictures(environment):
    environment.python("import ensurepip; ensurepip.bootstrap()")
    meshes = environment.run("pyfranka-meshes")
    assert meshes.returncode == 0, meshes.stdout + meshes.stderr
    code = """
        import pyfranka.meshes
        from pyfranka.sim import Panda, Simulation

        def picture(**options):
            with Simulation(robots=[Panda(**options)]) as sim:
                return sim.render(width=160, height=120).rgb.astype(float)

        with open("panda.urdf", "w") as file:
            file.write(pyfranka.meshes.urdf("panda"))
        simple, meshes = picture(), picture(urdf="panda.urdf")
        print(abs(simple - meshes).mean(), (abs(simple - meshes).max(axis=2) > 20).mean())
    """
    mean, changed = map(float, environment.python(code).split())
    # The same arm at the same place, with another surface.
    assert mean > 0.5 and 0.005 < changed < 0.2
