#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a source tree from which dpkg-buildpackage makes the .deb packages: the workspace, what .venv has
from PyPI, and debian/. Names, versions and dependencies come from the package.xml files, apt-packages.txt and
dependencies.yaml. Runs with the Python of .venv.
"""

import argparse
import platform
import re
import shutil
import subprocess
import sys
import textwrap
import time
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from email.utils import formatdate
from importlib import metadata
from pathlib import Path

import yaml
from packaging.requirements import Requirement

HERE = Path(__file__).resolve().parent
TOP = HERE.parent
SOURCES = Path("catkin_ws") / "src"
NUMBERS = {"bookworm": "12", "trixie": "13"}  # of the Debian releases
SOURCE = "franka-ros"
META = "franka_ros"  # the ROS package that depends on all others
OWN = "franka_sim"  # not in the place of an original: its version is that of the project
SETUP = "ros-franka-setup"
DEVELOPMENT = "ros-franka-dev"
SWEEPS = "ros-franka-sweep"
# Parts of PyPI's packages that a program does not load.
NOT_LOADED = {"tests", "__pycache__", "include", "RECORD", "INSTALLER", "REQUESTED", "direct_url.json"}
# Groups of apt-packages.txt, and single packages, without which the workspace builds.
NOT_FOR_BUILDS = {
    "the documentation site",
    "tests and benchmarks",
    "pictures of the examples in Python",
    "lines for the control interface of simulated robots, as the pages send them",
}
TOOLS = {"build-essential", "ccache", "catkin-tools", "python3-venv"}
# Libraries that a simulation loads only for a picture or a window.
LOADED_LATER = ["libegl1", "libgl1-mesa-dri", "libglfw3", "libosmesa6", "python3-tk"]
DEPENDENCIES = ("depend", "exec_depend", "build_export_depend")


class PackagingError(Exception):
    """An error whose message includes the action to take."""


@dataclass(frozen=True)
class RosPackage:
    """One package.xml of the workspace."""

    name: str
    version: str
    description: str
    maintainer: str
    folder: str  # below catkin_ws/src
    everywhere: bool  # without compiled code
    keys: tuple[str, ...]  # of other packages that its users need

    @property
    def deb(self) -> str:
        return f"ros-franka-{self.name.replace('_', '-')}"


def read_packages(sources: Path) -> list[RosPackage]:
    """All ROS packages of the workspace, sorted by name."""
    packages = []
    for file in sorted([*sources.glob("*/package.xml"), *sources.glob("ros_control/*/package.xml")]):
        root = ElementTree.parse(file).getroot()
        maintainer = root.find("maintainer")
        assert maintainer is not None
        keys = sorted({key.text or "" for kind in DEPENDENCIES for key in root.findall(kind)})
        packages.append(
            RosPackage(
                name=root.findtext("name", ""),
                version=root.findtext("version", ""),
                description=" ".join(root.findtext("description", "").split()),
                maintainer=f"{maintainer.text} <{maintainer.get('email')}>",
                folder=str(file.parent.relative_to(sources)),
                everywhere=root.find("export/architecture_independent") is not None,
                keys=tuple(keys),
            )
        )
    return sorted(packages, key=lambda package: package.name)


class Versions:
    """Versions of the .deb packages: that of package.xml and the Debian release. A package in the place of an
    original has the original's version, and the project's behind it, so that a new release replaces it.
    """

    def __init__(self, packages: list[RosPackage], release: str):
        (self.own,) = [package.version for package in packages if package.name == OWN]
        self.project = f"{self.own}~deb{NUMBERS[release]}"

    def of(self, package: RosPackage) -> str:
        if package.version == self.own:
            return self.project
        return f"{package.version}+franka{self.project}"


def apt_packages(file: Path, release: str) -> dict[str, list[str]]:
    """The names for a release in a file such as apt-packages.txt, by group."""
    groups: dict[str, list[str]] = {}
    group = ""
    for line in file.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            group = line.removeprefix("#").strip()
        elif match := re.fullmatch(r"([a-z0-9.+-]+)\s*(?:\[(\w+)\])?\s*", line):
            if match[2] in (None, release):
                groups.setdefault(group, []).append(match[1])
    return groups


def build_packages(release: str) -> list[str]:
    """The Debian packages that the workspace's build needs besides build-essential."""
    groups = apt_packages(TOP / "apt-packages.txt", release)
    if unknown := NOT_FOR_BUILDS - set(groups):
        raise PackagingError(f"apt-packages.txt has no group {sorted(unknown)}; correct {__file__}.")
    return [
        name
        for group, names in groups.items()
        if group not in NOT_FOR_BUILDS
        for name in names
        if name not in TOOLS
    ]


def relations(package: RosPackage, packages: list[RosPackage], versions: Versions) -> dict[str, list[str]]:
    """Depends and Recommends of its .deb, by the keys of its package.xml."""
    ours = {other.name: other for other in packages}
    table = yaml.safe_load((HERE / "dependencies.yaml").read_text(encoding="utf-8"))
    depends, recommends = [], []
    for key in package.keys:
        if key in ours:
            other = ours[key]
            depends.append(f"{other.deb} (= {versions.of(other)})")
            continue
        try:
            entry = table[key]
        except KeyError:
            raise PackagingError(
                f"{package.name}: packaging/dependencies.yaml does not say which Debian package is {key}."
            ) from None
        if isinstance(entry, list):
            depends += entry
        elif isinstance(entry, dict):
            recommends += entry["recommends"]
        elif entry not in ("linked", "build"):
            raise PackagingError(
                f'packaging/dependencies.yaml: {key} has "{entry}"; it may have "linked", "build" or a list.'
            )
    if package.name == "franka_sim":
        recommends += LOADED_LATER
    return {"Depends": depends, "Recommends": recommends}


def description(synopsis: str, text: str) -> str:
    lines = textwrap.wrap(text, 76)
    return "\n".join([f"Description: {synopsis}", *(f" {line}" for line in lines)])


def paragraph(name: str, architecture: str, lists: dict[str, list[str]], synopsis: str, text: str) -> str:
    lines = [f"Package: {name}", f"Architecture: {architecture}"]
    for field, names in lists.items():
        if names:
            lines.append(f"{field}:\n " + ",\n ".join(dict.fromkeys(names)))
    return "\n".join([*lines, description(synopsis, text)])


def bundled() -> tuple[list[metadata.Distribution], list[str]]:
    """PyPI's packages for sweeps and what they need: those in this Python's environment, and the Debian
    packages that have the others."""
    names = [line for line in (TOP / "requirements.txt").read_text().splitlines() if line and line[0] != "#"]
    open_ones = [Requirement(line) for line in names if not line.startswith("xacro")]
    found: dict[str, metadata.Distribution] = {}
    while open_ones:
        requirement = open_ones.pop()
        if requirement.marker is not None and not requirement.marker.evaluate({"extra": ""}):
            continue
        if requirement.name.lower() in found:
            continue
        try:
            distribution = metadata.distribution(requirement.name)
        except metadata.PackageNotFoundError:
            raise PackagingError(
                f"this Python ({sys.executable}) has no {requirement}; run ./franka install."
            ) from None
        found[requirement.name.lower()] = distribution
        open_ones += [Requirement(line) for line in distribution.requires or []]
    inside, debian = [], []
    for distribution in found.values():
        if sys.prefix in str(distribution.locate_file("")):
            inside.append(distribution)
        else:
            debian.append(owner(distribution))
    return sorted(inside, key=lambda each: each.metadata["Name"].lower()), sorted(debian)


def owner(distribution: metadata.Distribution) -> str:
    """The Debian package that has a Python distribution."""
    folder = distribution.locate_file("")
    name = distribution.metadata["Name"]
    pattern = f"{folder}/{re.sub('[-_.]', '?', name)}-*"
    search = subprocess.run(["dpkg-query", "--search", pattern], capture_output=True, text=True)
    if search.returncode != 0:
        raise PackagingError(
            f"{name} in {folder} is not a Debian package; install it with apt or into .venv."
        )
    return search.stdout.split(":")[0]


def copy_bundled(distributions: list[metadata.Distribution], target: Path) -> None:
    """Their modules, with licenses, into a folder of their own."""
    for distribution in distributions:
        for file in distribution.files or []:
            if file.parts[0] == ".." or NOT_LOADED & set(file.parts) or file.suffix in {".pyc", ".a", ".pxd"}:
                continue
            there = target / file
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file.locate(), there)


def control(packages: list[RosPackage], release: str) -> str:
    versions = Versions(packages, release)
    (meta,) = [package for package in packages if package.name == META]
    builds = build_packages(release)
    needed = ",\n ".join(["debhelper-compat (= 13)", "dh-python", *builds])
    paragraphs = [
        f"Source: {SOURCE}\nSection: science\nPriority: optional\nMaintainer: {meta.maintainer}\n"
        f"Build-Depends:\n {needed}\nStandards-Version: 4.6.2\nRules-Requires-Root: no"
    ]
    for package in packages:
        lists = relations(package, packages, versions)
        depends = ["${misc:Depends}", "${shlibs:Depends}", "${python3:Depends}"]
        depends.append(f"{SETUP} (= {versions.project})")
        if package.everywhere:
            depends.remove("${shlibs:Depends}")
        lists["Depends"] = depends + lists["Depends"]
        if package.name == "pyfranka":
            lists["Suggests"] = [f"{SWEEPS} (= {versions.project})"]
        if package is meta:
            lists["Provides"] = [f"{SOURCE} (= {versions.project})"]
        paragraphs.append(
            paragraph(
                package.deb,
                "all" if package.everywhere else "any",
                lists,
                f"ROS 1 package {package.name} for Franka Panda and FR3 arms",
                f"{package.description} Source /opt/franka_ros/setup.bash to use it.",
            )
        )
    paragraphs.append(
        paragraph(
            SETUP,
            "all",
            {
                "Depends": [
                    "${misc:Depends}",
                    "${python3:Depends}",
                    "ros-core",
                    "ros-environment",
                    "rosbash",
                    "rospack-tools",
                ],
            },
            "environment of the ROS packages for Franka Panda and FR3 arms",
            "The setup files in /opt/franka_ros. `source /opt/franka_ros/setup.bash` makes the packages "
            "known to roslaunch, rosrun, CMake and Python.",
        )
    )
    distributions, debian = bundled()
    major, minor = sys.version_info[:2]
    contents = ", ".join(f"{each.metadata['Name']} {each.version}" for each in distributions)
    paragraphs.append(
        paragraph(
            SWEEPS,
            "any",
            {
                "Depends": [
                    "${misc:Depends}",
                    "${shlibs:Depends}",
                    "${python3:Depends}",
                    f"ros-franka-pyfranka (= {versions.project})",
                    f"python3 (>= {major}.{minor}~)",
                    f"python3 (<< {major}.{minor + 1})",
                    *debian,
                ]
            },
            "Python packages for sweeps of pyfranka",
            "The packages of PyPI that pyfranka.sweep and the program pyfranka-sweep load, and no other "
            f"program: {contents}.",
        )
    )
    paragraphs.append(
        paragraph(
            DEVELOPMENT,
            "all",
            {
                "Depends": [
                    "${misc:Depends}",
                    f"{meta.deb} (= {versions.of(meta)})",
                    "build-essential",
                    *builds,
                ]
            },
            "what builds own packages on the ROS packages for Franka arms",
            "Depends on the compilers, tools and development packages with which controllers, hardware "
            "interfaces and programs are built on the packages in /opt/franka_ros. It has no files.",
        )
    )
    return "\n\n".join(paragraphs) + "\n"


def date_of_sources() -> float:
    """The last commit's time, so that a package built again is the same; without git, the changelog's."""
    try:
        log = subprocess.run(["git", "log", "-1", "--format=%ct"], cwd=TOP, capture_output=True, text=True)
        return float(log.stdout)
    except (OSError, ValueError):
        return (TOP / "CHANGELOG.md").stat().st_mtime


def changelog(packages: list[RosPackage], release: str, seconds: float) -> str:
    versions = Versions(packages, release)
    (meta,) = [package for package in packages if package.name == META]
    return (
        f"{SOURCE} ({versions.project}) {release}; urgency=medium\n\n"
        f"  * Release {versions.own} of the project; its CHANGELOG.md has what is new.\n\n"
        f" -- {meta.maintainer}  {formatdate(seconds)}\n"
    )


def copy_sources(target: Path) -> None:
    """The workspace and the Python sources, with downloaded meshes and libraries of Desk's page."""
    made = shutil.ignore_patterns("__pycache__", "*.pyc", ".pytest_cache", ".staging-*", "*.egg-info")
    for folder in (SOURCES, Path("python")):
        shutil.copytree(TOP / folder, target / folder, symlinks=True, ignore=made)
    toplevel = target / SOURCES / "CMakeLists.txt"
    toplevel.unlink(missing_ok=True)
    toplevel.symlink_to("/usr/share/catkin/cmake/toplevel.cmake")
    for name in ("LICENSE", "NOTICE", "CHANGELOG.md", "packaging/completion.bash"):
        shutil.copy(TOP / name, target)


def copy_package(venv: Path, name: str, target: Path) -> None:
    """A PyPI package, which Debian does not have, with its license, where the build looks for it."""
    for modules in sorted(venv.glob("lib/python3*/site-packages")):
        if metadata := sorted(modules.glob(f"{name}-*.dist-info")):
            there = target / "vendor" / "lib" / "python3" / "site-packages"
            for folder in (modules / name, metadata[0]):
                ignored = shutil.ignore_patterns("__pycache__", "direct_url.json", "RECORD", "REQUESTED")
                shutil.copytree(folder, there / folder.name, ignore=ignored)
            return
    raise PackagingError(f"{venv} has no {name}; run ./franka install.")


def check_downloads() -> None:
    """A package without meshes or libraries of Desk's page would be half a package."""
    needed = {
        SOURCES / "franka_description" / "meshes" / "available.xacro": "the robots' meshes",
        Path("python") / "src" / "pyfranka" / "desk" / "page" / "vendor" / "versions.txt": (
            "the libraries of Desk's page"
        ),
    }
    for file, what in needed.items():
        if not (TOP / file).is_file():
            raise PackagingError(f"{what} are not installed; run ./franka install with a network.")


def write_debian(debian: Path, packages: list[RosPackage], release: str) -> None:
    versions = Versions(packages, release)
    shutil.copytree(HERE / "debian", debian)
    overrides = (debian / "lintian-overrides").read_text(encoding="utf-8")
    (debian / "lintian-overrides").unlink()
    (debian / "control").write_text(control(packages, release), encoding="utf-8")
    (debian / "changelog").write_text(changelog(packages, release, date_of_sources()), encoding="utf-8")
    (debian / "source").mkdir()
    (debian / "source" / "format").write_text("3.0 (native)\n", encoding="utf-8")
    folders = "".join(f"{package.deb} {package.folder}\n" for package in packages)
    (debian / "folders").write_text(folders, encoding="utf-8")
    names = {package.deb: versions.of(package) for package in packages}
    names |= {name: versions.project for name in (SETUP, DEVELOPMENT, SWEEPS)}
    lines = "".join(f"{name} {version}\n" for name, version in names.items())
    (debian / "versions").write_text(lines, encoding="utf-8")
    for name in names:
        if name != DEVELOPMENT:
            file = debian / f"{name}.lintian-overrides"
            own = file.read_text(encoding="utf-8") if file.exists() else ""
            file.write_text(overrides + own, encoding="utf-8")


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=" ".join(__doc__.split("\n\n", maxsplit=1)[0].split()))
    parser.add_argument("target", type=Path, help="the folder to write, which must not exist")
    parser.add_argument("--release", choices=sorted(NUMBERS), help="the Debian release (this machine's)")
    return parser.parse_args()


def main() -> int:
    options = parse_arguments()
    release = options.release or platform.freedesktop_os_release().get("VERSION_CODENAME", "")
    if release not in NUMBERS:
        print(f'make_source: this system\'s release is "{release}"; name one by --release.', file=sys.stderr)
        return 2
    if options.target.exists():
        print(f"make_source: {options.target} exists already.", file=sys.stderr)
        return 2
    begin = time.monotonic()
    try:
        check_downloads()
        packages = read_packages(TOP / SOURCES)
        copy_sources(options.target)
        for name in ("xacro", "pybind11_stubgen"):
            copy_package(Path(sys.prefix), name, options.target)
        copy_bundled(bundled()[0], options.target / "vendor" / "sweep")
        write_debian(options.target / "debian", packages, release)
    except PackagingError as error:
        print(f"make_source: {error}", file=sys.stderr)
        return 1
    print(f"make_source: {len(packages)} ROS packages in {time.monotonic() - begin:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
