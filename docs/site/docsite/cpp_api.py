# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The C++ interface: Doxygen reads the public headers, and pages show each header with Breathe.

Public headers are those in a package's include folder, without folders named internal or detail. Of
franka_sim and franka_sim_mujoco only those that other programs use are public.
"""

import fcntl
import hashlib
import re
import shutil
import subprocess
import typing
import xml.etree.ElementTree as ET
from functools import lru_cache
from pathlib import Path

from docsite.markdown import page
from docsite.packages import packages
from docsite.paths import OUT, TOP, WORKSPACE
from docsite.tree import Tree

XML = OUT / "doxygen" / "xml"
# Public parts of packages whose other headers are internal.
PARTS = {
    "libfranka": r"/franka/|/franka_core/[^/]+\.h$",
    "franka_sim": r"/simulation/|/physics/(world|physics_config)\.h|/robot/(plant|realism|sensor_physics|"
    r"control_unit|control_unit_parameters|interface_rules|protocol_range|unit_request|unit_status)\.h|"
    r"/robot/safety/(collision|collision_thresholds|link_pair)\.h",
    "franka_sim_mujoco": r"/(robot_hw_sim|franka_hw_sim|default_robot_hw_sim)\.h",
}
# Forwarding headers of other names, and a package whose headers are for itself.
WITHOUT = {"boost_bind_compat", "pluginlib_compat", "pyfranka"}
SETTINGS = """
PROJECT_NAME = franka_ros
INPUT = {files}
STRIP_FROM_PATH = {top}
OUTPUT_DIRECTORY = {out}
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
EXTRACT_ALL = YES
EXTRACT_PRIVATE = NO
JAVADOC_AUTOBRIEF = YES
DISTRIBUTE_GROUP_DOC = YES
MACRO_EXPANSION = YES
PREDEFINED = __cplusplus=201703L
QUIET = YES
WARN_IF_INCOMPLETE_DOC = NO
WARN_AS_ERROR = FAIL_ON_WARNINGS
"""


# What Breathe shows of a header: Doxygen's kinds of sections, by their whole names.
SECTIONS = (
    "briefdescription detaileddescription innernamespace innerclass user-defined public-type public-func "
    "public-static-func public-attrib public-static-attrib func define enum typedef var"
)


class Header(typing.NamedTuple):
    """A public header: its package, its file, and how programs include it."""

    package: str
    file: Path
    include: str


@lru_cache(maxsize=1)
def public_headers() -> tuple[Header, ...]:
    found = []
    for package in packages():
        if package.name in WITHOUT:
            continue
        for file in [*package.files("include/**/*.h"), *package.files("include/**/*.hpp")]:
            inside = str(file.relative_to(package.folder))
            if re.search(r"/(internal|detail)/|_impl\.h$|hardware_interface_adapter\.h$", inside):
                continue
            if re.search(PARTS.get(package.name, ""), inside):
                include = str(file.relative_to(package.folder / "include"))
                found.append(Header(package.name, file, include))
    return tuple(found)


def run_doxygen() -> None:
    """Writes the headers' descriptions as XML, unless they exist already for these headers.

    Several processes may call it at a time.
    """
    OUT.mkdir(parents=True, exist_ok=True)
    with open(OUT / "doxygen.lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        _run_doxygen()


def _run_doxygen() -> None:
    folder = OUT / "doxygen"
    # Headers that are not public are read too: their base classes have comments.
    found = [*WORKSPACE.glob("**/include/**/*.h"), *WORKSPACE.glob("**/include/**/*.hpp")]
    files = [path for path in sorted(found) if "/test/" not in str(path)]
    settings = SETTINGS.format(files=" ".join(map(str, files)), top=TOP, out=folder)
    stamp = hashlib.sha256(settings.encode() + b"".join(path.read_bytes() for path in files)).hexdigest()
    done = folder / "done"
    if done.is_file() and done.read_text() == stamp:
        return
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "Doxyfile").write_text(settings)
    subprocess.run(["doxygen", str(folder / "Doxyfile")], cwd=TOP, check=True)
    name_files_by_their_paths()
    done.write_text(stamp)


def name_files_by_their_paths() -> None:
    """Doxygen's index names files without folders: Breathe could not distinguish two files robot.h."""
    index = ET.parse(XML / "index.xml")
    for compound in index.getroot().findall("compound[@kind='file']"):
        file = ET.parse(XML / f"{compound.get('refid')}.xml").getroot()
        name, location = compound.find("name"), file.find("compounddef/location")
        assert name is not None and location is not None
        name.text = location.get("file")
    index.write(XML / "index.xml")


def write_pages(tree: Tree) -> None:
    """A page for each package, with a section for each of its headers."""
    headers: dict[str, list[Header]] = {}
    for header in public_headers():
        headers.setdefault(header.package, []).append(header)
    for package, found in headers.items():
        parts = []
        for header in found:
            name = header.file.resolve().relative_to(TOP)
            parts.append(
                f"## {header.include}\n\n`#include <{header.include}>`\n\n"
                f"```{{doxygenfile}} {name}\n:sections: {SECTIONS}\n```"
            )
        tree.write(f"reference/cpp/{package}.md", page(f"C++: {package}", *parts))
    rows = "\n".join(f"{package}" for package in headers)
    intro = "What programs and controllers include. A page shows one package, header by header."
    tree.write(
        "reference/cpp/index.md", page("C++ interface", intro, f"```{{toctree}}\n:maxdepth: 1\n\n{rows}\n```")
    )
