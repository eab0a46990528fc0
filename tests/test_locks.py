# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The locks: they satisfy their sources, and .venv has their packages and no others."""

import os
import re
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

TOP = Path(__file__).resolve().parent.parent
LOCKS = TOP / "locks"
NAMES = sorted(path.stem for path in LOCKS.glob("*.in"))
PYTHONS = ("3.11", "3.13")
SEEDED = {"pip", "setuptools"}  # what the module venv itself puts into an environment


def requirements(path: Path) -> list[Requirement]:
    """Of a source, with those of the files that it includes."""
    found = []
    for line in path.read_text().splitlines():
        line = line.partition("#")[0].strip()
        if line.startswith("-r "):
            found += requirements(path.parent / line[3:])
        elif line:
            found.append(Requirement(line))
    return found


def locked(name: str, python: str) -> dict[str, str]:
    """The versions of a lock by canonical name, for a version of Python on Linux."""
    environment = {"python_version": python, "python_full_version": f"{python}.0", "sys_platform": "linux"}
    versions = {}
    for entry in re.split(r"\n(?=[a-z0-9])", (LOCKS / f"{name}.txt").read_text()):
        if entry.startswith("#"):
            continue
        text, *hashes = entry.replace("\\\n", "").split("--hash=")
        requirement = Requirement(text.strip())
        assert hashes and all(each.startswith("sha256:") for each in hashes), text
        if requirement.marker is None or requirement.marker.evaluate(environment):
            (pin,) = requirement.specifier
            assert pin.operator == "==" and requirement.name not in versions, text
            versions[canonicalize_name(requirement.name)] = pin.version
    return versions


@pytest.mark.parametrize("python", PYTHONS)
@pytest.mark.parametrize("name", NAMES)
def test_a_lock_has_what_its_source_asks_for(name, python):
    versions = locked(name, python)
    environment = {"python_version": python, "python_full_version": f"{python}.0"}
    for requirement in requirements(LOCKS / f"{name}.in"):
        if requirement.marker is None or requirement.marker.evaluate(environment):
            assert requirement.specifier.contains(versions[canonicalize_name(requirement.name)]), requirement


@pytest.mark.parametrize("python", PYTHONS)
@pytest.mark.parametrize("name", [name for name in NAMES if name.startswith("venv-")])
def test_a_group_has_versions_of_the_whole_environment(name, python):
    group = locked(name, python)
    assert group and group.items() <= locked("venv", python).items()


def test_the_environment_equals_its_lock():
    """Nothing is missing, has another version, or was installed in addition."""
    folders = [str(folder) for folder in Path(sys.prefix).glob("lib/python*/site-packages")]
    assert Path(sys.prefix) == TOP / ".venv"
    there = {canonicalize_name(each.name): each.version for each in metadata.distributions(path=folders)}
    for name in SEEDED:
        there.pop(name, None)
    expected = locked("venv", f"{sys.version_info.major}.{sys.version_info.minor}")
    # pip leaves out what Debian has in the same version.
    of_debian = {name for name in expected.keys() - there.keys() if metadata.version(name) == expected[name]}
    assert there == {name: version for name, version in expected.items() if name not in of_debian}


SCRIPT = """
source {franka}
top={top} venv={top}/.venv
offline() {{ false; }}
install_locked() {{ [ -n "$reachable" ] && touch "$venv/$(basename "$2" .txt)"; }}
{code}
"""


def in_project(top: Path, code: str, reachable: str = "yes") -> subprocess.CompletedProcess:
    """Runs code with the entry script's functions in another project, with a registry that answers or not."""
    (top / "locks").mkdir(exist_ok=True)
    for name in ("venv", "venv-run", "venv-wheel"):
        (top / "locks" / f"{name}.txt").touch()
    return subprocess.run(
        ["bash", "-c", SCRIPT.format(franka=TOP / "franka", top=top, code=code)],
        env={**os.environ, "reachable": reachable},
        text=True,
        capture_output=True,
        timeout=120,
    )


@pytest.fixture(scope="module")
def first(tmp_path_factory) -> Path:
    """A project whose .venv has the group run."""
    top = tmp_path_factory.mktemp("project") / "first"
    top.mkdir()
    made = in_project(top, 'python_ready && exit 9; step "Making" install_python; python_ready')
    assert made.returncode == 0 and "making it again" not in made.stdout, made
    return top


@pytest.fixture
def project(first, tmp_path) -> Path:
    return shutil.copytree(first, tmp_path / "project", symlinks=True)


def groups_in(project: Path) -> set[str]:
    return {path.name for path in (project / ".venv").glob("venv*")}


def test_an_environment_of_an_earlier_lock_is_noticed_and_made_anew(project):
    (project / ".venv" / "left_over").touch()
    (project / "locks" / "venv.txt").write_text("another==1\n")
    assert in_project(project, "python_ready").returncode == 1
    made = in_project(project, "install_python && python_ready")
    assert made.returncode == 0 and "making it again" in made.stdout, made
    assert not (project / ".venv" / "left_over").exists()


def test_an_environment_of_another_python_is_noticed(project):
    assert in_project(project, "python_ready").returncode == 0
    assert in_project(project, "readlink() { echo /usr/bin/python3.99; }; python_ready").returncode == 1


def test_a_group_is_added_to_the_environment(project):
    (project / ".venv" / "of_the_first").touch()
    assert in_project(project, "python_ready wheel").returncode == 1
    assert in_project(project, "install_python wheel && python_ready wheel && python_ready").returncode == 0
    assert groups_in(project) == {"venv-run", "venv-wheel"}
    assert in_project(project, "install_python test && python_ready && python_ready wheel").returncode == 0
    assert (project / ".venv" / "of_the_first").exists()


def test_a_group_that_pip_did_not_finish_makes_the_environment_incomplete(project):
    failed = in_project(project, 'step "Adding" install_python wheel', reachable="")
    assert failed.returncode == 1 and "Adding failed" in failed.stderr
    assert in_project(project, "python_ready").returncode == 1
    made = in_project(project, "install_python && python_ready")
    assert made.returncode == 0 and "incomplete" in made.stdout, made


def test_the_whole_environment_is_locked_before_its_groups(tmp_path):
    (tmp_path / "locks").mkdir()
    for name in ("other", "venv", "venv-run"):
        (tmp_path / "locks" / f"{name}.in").touch()
    uv = tmp_path / "uv"
    uv.write_text('#!/bin/sh\necho "$@" >>../log\n')
    uv.chmod(0o755)
    made = in_project(tmp_path, f'install_locked() {{ cp {uv} "${{1%/*}}"; }}; cmd_lock --upgrade')
    assert made.returncode == 0, made
    sources = [line.split()[-1] for line in (tmp_path / "log").read_text().splitlines()]
    assert sources == ["venv.in", "other.in", "venv-run.in"]
