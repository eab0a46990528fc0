# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The Debian packages: what describes them; in the long form they are built, installed on a bare Debian,
used, and removed without a trace."""

import importlib.util
import json
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
import yaml
from bare_debian import BareDebian, bare_debian
from franka_sim_mujoco.session import free_port
from tutorial import read

TOP = Path(__file__).resolve().parent.parent
SOURCES = TOP / "catkin_ws" / "src"
PACKAGING = TOP / "packaging"
PREFIX = "/opt/franka_ros"
RELEASES = ["bookworm", "trixie"]
# Packages of ours that stand for no ROS package.
FURTHER = {"ros-franka-setup", "ros-franka-dev", "ros-franka-sweep"}


def load_make_source():
    spec = importlib.util.spec_from_file_location("make_source", PACKAGING / "make_source.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


make_source = load_make_source()


def ros_packages() -> dict[str, ElementTree.Element]:
    """package.xml of each package of the workspace, by name; those of tests belong to no release."""
    files = [path for path in SOURCES.rglob("package.xml") if "test" not in path.parts]
    files.append(TOP / "python" / "package.xml")  # a link in the workspace
    roots = [ElementTree.parse(path).getroot() for path in files]
    return {root.findtext("name"): root for root in roots}


def paragraphs(text: str) -> dict[str, dict[str, str]]:
    """The binary packages of a file debian/control, by name."""
    found = {}
    for block in text.strip().split("\n\n"):
        fields, name = {}, ""
        for line in block.splitlines():
            if line.startswith(" "):
                fields[name] += "\n" + line
            else:
                name, _, fields[name] = line.partition(": ") if ": " in line else line.partition(":")
        if "Package" in fields:
            assert fields["Package"] not in found
            found[fields["Package"]] = fields
    return found


def names(field: str) -> dict[str, str]:
    """Names of a list of packages, with the versions required."""
    parts = [part.strip() for part in field.split(",") if part.strip()]
    return {part.split(" ")[0]: "".join(re.findall(r"\((.*)\)", part)) for part in parts}


@pytest.fixture(scope="module", params=RELEASES)
def debian(request, tmp_path_factory) -> Path:
    """The folder debian/ for a release."""
    folder = tmp_path_factory.mktemp("debian") / "debian"
    make_source.write_debian(folder, make_source.read_packages(SOURCES), request.param)
    return folder


@pytest.fixture(scope="module")
def control(debian) -> dict[str, dict[str, str]]:
    return paragraphs((debian / "control").read_text())


def test_each_ros_package_is_one_deb(debian, control):
    expected = {f"ros-franka-{name.replace('_', '-')}" for name in ros_packages()}
    assert len(expected) > 30
    assert set(control) == expected | FURTHER
    folders = dict(line.split() for line in (debian / "folders").read_text().splitlines())
    assert set(folders) == expected
    for deb, folder in folders.items():
        name = ElementTree.parse(SOURCES / folder / "package.xml").getroot().findtext("name")
        assert deb == f"ros-franka-{name.replace('_', '-')}"


def test_versions_are_those_of_the_package_xml_files(debian, control):
    (release,) = [name for name in RELEASES if f" {name};" in (debian / "changelog").read_text()]
    number = make_source.NUMBERS[release]
    own = ros_packages()["franka_sim"].findtext("version")
    versions = dict(line.split() for line in (debian / "versions").read_text().splitlines())
    assert set(versions) == set(control)
    for name, root in ros_packages().items():
        version = root.findtext("version")
        replaced = "" if version == own else f"{version}+franka"
        assert versions[f"ros-franka-{name.replace('_', '-')}"] == f"{replaced}{own}~deb{number}"
    changelog = subprocess.check_output(["dpkg-parsechangelog", "-l", debian / "changelog"], text=True)
    assert f"Version: {own}~deb{number}\n" in changelog


def test_dependencies_of_package_xml_become_those_of_the_deb(debian, control):
    versions = dict(line.split() for line in (debian / "versions").read_text().splitlines())
    table = yaml.safe_load((PACKAGING / "dependencies.yaml").read_text())
    ours = ros_packages()
    for name, root in ours.items():
        deb = control[f"ros-franka-{name.replace('_', '-')}"]
        depends, recommends = names(deb["Depends"]), names(deb.get("Recommends", ""))
        assert depends["ros-franka-setup"] == f"= {versions['ros-franka-setup']}"
        for kind in ("depend", "exec_depend", "build_export_depend"):
            for key in (each.text for each in root.findall(kind)):
                if key in ours:
                    other = f"ros-franka-{key.replace('_', '-')}"
                    assert depends[other] == f"= {versions[other]}"
                elif isinstance(table[key], list):
                    assert set(table[key]) <= set(depends), (name, key)
                elif isinstance(table[key], dict):
                    assert set(table[key]["recommends"]) <= set(recommends)
                else:
                    assert table[key] in ("linked", "build")


def test_metapackage_depends_on_every_ros_package(control):
    reached, open_ones = set(), {"ros-franka-franka-ros"}
    while open_ones:
        deb = open_ones.pop()
        reached.add(deb)
        open_ones |= {name for name in names(control[deb]["Depends"]) if name in control} - reached
    # The stand-ins of ros_control that none of our packages uses are installed by those who use them.
    assert {name for name in control if "franka-" in name.removeprefix("ros-franka-")} <= reached
    assert names(control["ros-franka-franka-ros"]["Provides"]).keys() == {"franka-ros"}


def test_an_unknown_dependency_is_refused():
    packages = make_source.read_packages(SOURCES)
    first = packages[0]
    strange = make_source.RosPackage(**{**vars(first), "keys": ("libteleport-dev",)})
    with pytest.raises(
        make_source.PackagingError, match="does not say which Debian package is libteleport-dev"
    ):
        make_source.relations(strange, packages, make_source.Versions(packages, "trixie"))


def test_the_copyright_file_names_every_holder():
    copyright_file = (PACKAGING / "debian" / "copyright").read_text()
    holders = re.findall(r"Copyright (?:\(c\) )?(\d[\d-]* .+)", (TOP / "NOTICE").read_text())
    assert len(holders) > 4
    for holder in holders:
        text = re.sub(r"^(\S+) Franka Robotics$", r"\1 Franka Robotics GmbH", holder.rstrip("., "))
        assert text in copyright_file, text
    assert "xacro" in copyright_file and "BSD-3-clause" in copyright_file


def in_script(code: str, **variables: str) -> subprocess.CompletedProcess:
    """Shell code with the functions of ./franka."""
    return subprocess.run(
        ["bash", "-c", f"source {TOP / 'franka'}; {code}"],
        env={**os.environ, **variables},
        text=True,
        capture_output=True,
        timeout=60,
    )


def test_the_packages_become_a_repository(tmp_path):
    made = tmp_path / "out" / "deb"
    folder = made / "one"
    (folder / "DEBIAN").mkdir(parents=True)
    (folder / "DEBIAN" / "control").write_text(
        "Package: one\nVersion: 1\nArchitecture: all\nMaintainer: a <a@example.org>\nDescription: one\n"
    )
    subprocess.run(["dpkg-deb", "--build", folder, made], check=True, capture_output=True)
    old = tmp_path / "dist" / "deb" / "old_1_all.deb"
    old.parent.mkdir(parents=True)
    old.touch()
    done = in_script(f"top={tmp_path}; publish_deb")
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in old.parent.iterdir()) == ["Packages", "one_1_all.deb"]
    assert "Filename: ./one_1_all.deb\n" in (old.parent / "Packages").read_text()


def test_lintian_error_fails_the_command(tmp_path):
    program = tmp_path / "lintian"
    program.write_text("#!/bin/sh\necho 'W: one: small'\necho 'E: one: large'\nexit 2\n")
    program.chmod(0o755)
    (tmp_path / "out").mkdir()
    done = in_script(f"top={tmp_path}; lint_deb", PATH=f"{tmp_path}:{os.environ['PATH']}")
    assert done.returncode == 1 and done.stderr == "E: one: large\n"


# ---- long form -------------------------------------------------------------------------------------------

BUILDS_DEBS = pytest.mark.long_form("builds the Debian packages, for a bare Debian")
# Folders whose contents are not part of packages: logs, caches and lists of apt and dpkg, other file systems.
OUTSIDE = ("dev", "proc", "sys", "tmp", "run", "root", "var/cache", "var/log", "var/lib/apt", "var/lib/dpkg")
PAGE = read(TOP / "docs/how_to/packages.md")
REPOSITORY = "/srv/franka"  # as the page says
# The launch ends with the commands' namespace of processes. The network is this machine's.
MOVES = """
export ROS_HOSTNAME=localhost ROS_MASTER_URI=http://localhost:{port}
(
{launch}) >/tmp/launch.log 2>&1 &
source /opt/franka_ros/setup.bash
timeout 400 /usr/bin/python3 /tmp/moves.py || {{ cat /tmp/launch.log; exit 1; }}
"""
MOVES_PY = """
import rospy
from sensor_msgs.msg import JointState

rospy.init_node("moves")
first = rospy.wait_for_message("/joint_states", JointState, 300)
moved, end = 0.0, first.header.stamp + rospy.Duration(30)
while moved < 0.06:  # more than the fingers, whose strokes are 0.04 m
    now = rospy.wait_for_message("/joint_states", JointState, 60)
    moved = max(abs(one - other) for one, other in zip(now.position, first.position))
    if now.header.stamp > end:
        break
print("moved", moved)
"""


INSTALLED = ("franka-ros", "ros-franka-sweep")


def contents(deb: Path) -> list[str]:
    listed = subprocess.check_output(["dpkg-deb", "--contents", deb], text=True)
    return [line.split(maxsplit=5)[5].split(" -> ")[0] for line in listed.splitlines()]


@BUILDS_DEBS
def test_each_file_is_in_one_deb(repository):
    owners: dict[str, list[str]] = {}
    for deb in repository.glob("*.deb"):
        for name in contents(deb):
            if not name.endswith("/"):
                owners.setdefault(name, []).append(deb.name)
    assert {name: debs for name, debs in owners.items() if len(debs) > 1} == {}
    for name in ("lib/libfranka_hw.so", "bin/franka_sim", "setup.bash", "include/franka/robot.h"):
        assert f".{PREFIX}/{name}" in owners


@BUILDS_DEBS
def test_packages_do_not_contain_the_build_path(repository, tmp_path):
    for deb in repository.glob("*.deb"):
        subprocess.run(["dpkg-deb", "--extract", deb, tmp_path], check=True)
    files = [path for path in tmp_path.rglob("*") if path.is_file() and not path.is_symlink()]
    assert [path for path in files if os.fsencode(TOP) in path.read_bytes()] == []


@BUILDS_DEBS
def test_packages_without_compiled_code_have_none(repository, tmp_path):
    for deb in repository.glob("*_all.deb"):
        subprocess.run(["dpkg-deb", "--extract", deb, tmp_path], check=True)
    files = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert [path for path in files if path.read_bytes()[:4] == b"\x7fELF"] == []


def files_of(bare: BareDebian) -> set[str]:
    """All files and folders that packages may own, or leave."""
    found = set()
    for folder, folders, files in os.walk(bare.root):
        below = Path(folder).relative_to(bare.root)
        folders[:] = [name for name in folders if str(below / name) not in OUTSIDE]
        found |= {str(below / name) for name in [*folders, *files]}
    return found


def install_dependencies(bare: BareDebian) -> None:
    """Installs what the packages need from Debian, so that later changes are those of the packages."""
    (bare.root / "etc/apt/apt.conf.d/90tests").write_text('APT::Get::Assume-Yes "true";\n')
    sources = bare.root / "etc/apt/sources.list.d/franka-ros.list"
    sources.write_text(f"deb [trusted=yes] file:{REPOSITORY} ./\n")
    bare.must("apt-get", "update")
    planned = bare.must("apt-get", "install", "--simulate", *INSTALLED)
    needed = [name for name in re.findall(r"^Inst (\S+)", planned, re.MULTILINE) if "ros-franka" not in name]
    assert len(needed) > 100
    type_in(bare, f"apt-get install {' '.join(needed)}")
    sources.unlink()


def type_in(bare: BareDebian, commands: str) -> str:
    """Runs commands as root, whom packages ask nothing. Returns what they print."""
    return bare.must("bash", "-ec", f"export DEBIAN_FRONTEND=noninteractive\n{commands}", timeout=1800)


@BUILDS_DEBS
def test_installed_packages_simulate_and_leave_nothing(repository, tmp_path_factory):
    with bare_debian(tmp_path_factory.mktemp("deb")) as bare:
        assert PAGE.block_with("./franka deb") == "./franka deb\n"  # which has made the repository
        shutil.copytree(repository, bare.root / REPOSITORY[1:])
        shutil.copy(TOP / "ci" / "install", bare.root / "tmp")
        install_dependencies(bare)
        before = files_of(bare)

        type_in(bare, PAGE.block_with("apt-get install franka-ros"))
        type_in(bare, f"/tmp/install {REPOSITORY} ros-franka-sweep")
        (bare.root / "tmp" / "moves.py").write_text(MOVES_PY)
        launch = PAGE.block_with("roslaunch franka_gazebo panda.launch")
        printed = type_in(bare, MOVES.format(launch=launch, port=free_port()))
        assert float(re.search(r"moved (\S+)", printed)[1]) > 0.05
        demo = (
            f"source {PREFIX}/setup.bash && ROS_HOSTNAME=localhost rosrun franka_sim_mujoco pick_and_place "
            "--start --speed 0 --no-pictures --output /tmp/demo"
        )
        bare.must("bash", "-c", demo)
        report = json.loads((bare.root / "tmp" / "demo" / "report.json").read_text())
        assert report[0]["in_tray"]
        (bare.root / "tmp" / "square.py").write_text(
            "def case(index, seed):\n    return {'square': index**2}\n"
        )
        sweep = "pyfranka-sweep /tmp/square.py --cases 4 --output /tmp/squares.csv --workers 2"
        bare.must("bash", "-c", f"source {PREFIX}/setup.bash && {sweep}")
        assert ",9" in (bare.root / "tmp" / "squares.csv").read_text()
        assert {f"{PREFIX[1:]}/setup.bash", f"{PREFIX[1:]}/lib/libfranka_hw.so"} <= files_of(bare) - before

        type_in(bare, PAGE.block_with("apt-get purge"))
        # dpkg removes /opt too, as no other package has anything there. The list is the reader's.
        assert files_of(bare) - {"etc/apt/sources.list.d/franka-ros.list"} | {"opt"} == before | {"opt"}
