# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Public names of C++ without a comment, according to Doxygen.

A comment for one of several overloads, for a group of members, or for one of several names of a line is a
comment for all of them. Names that say what they do need none: constructors, destructors, operators, what
overrides a base class, and types of pointers.
"""

import re
import typing
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

from docsite.cpp_api import XML, public_headers
from docsite.paths import TOP

TEXTS = ("briefdescription", "detaileddescription", "inbodydescription")
KINDS = ("function", "enum", "define", "variable", "typedef")
# Namespaces for the headers themselves.
PRIVATE = re.compile(r"(^|::)(\w*detail|internal)(::|$)|@")


class Name(typing.NamedTuple):
    """A public name: where it is, and whether it has a comment."""

    file: str
    line: int
    name: str
    described: bool


def has_text(element: ET.Element | None) -> bool:
    return element is not None and bool("".join(element.itertext()).strip())


def is_described(element: ET.Element) -> bool:
    return any(has_text(element.find(text)) for text in TEXTS)


def belongs_to(member: ET.Element, scope: str) -> bool:
    """False for a base class's function that a using-declaration repeats."""
    definition = re.sub("<.*>", "", member.findtext("definition") or "")
    definition = re.sub(r"\s*=\s.*", "", definition)  # of a type, what it stands for
    scope = re.sub("<.*>", "", scope)
    name = f"{scope}::{member.findtext('name')}" if scope else member.findtext("name", "")
    return not definition or definition.endswith(name)


def explains_itself(member: ET.Element, scope: str) -> bool:
    """Whether the member needs no comment."""
    name, arguments = member.findtext("name", ""), member.findtext("argsstring", "")
    own = re.sub("<.*", "", scope).rsplit("::", 1)[-1].strip()
    return (
        name in ("", own)
        or name.startswith(("~", "operator"))
        or arguments.endswith(("=delete", "=default"))
        or " override" in arguments
        or member.get("kind") == "typedef"
        and name.endswith("Ptr")
        or not belongs_to(member, scope)
        or member.find("reimplements") is not None
    )


def place(element: ET.Element) -> tuple[str, int]:
    location = element.find("location")
    assert location is not None
    return location.attrib["file"], int(location.attrib["line"])


def names_of(compound: ET.Element) -> Iterator[Name]:
    """A class, a namespace or a file: it itself, and its public functions, enumerations, fields, constants,
    types and macros. Of a file those that belong to no namespace."""
    is_file = compound.get("kind") == "file"
    scope = "" if is_file else compound.findtext("compoundname", "")
    if compound.get("prot", "public") != "public":
        return
    if compound.get("kind") in ("class", "struct"):
        yield Name(*place(compound), scope, is_described(compound))
    for section in compound.findall("sectiondef"):
        described = has_text(section.find("header")) or has_text(section.find("description"))
        for member in section.findall("memberdef"):
            if member.get("kind") not in KINDS or member.get("prot") != "public":
                continue
            # A file shows the members of its namespaces again.
            if is_file and "::" in (member.findtext("qualifiedname") or ""):
                continue
            if not explains_itself(member, scope):
                name = f"{scope}::{member.findtext('name')}" if scope else member.findtext("name", "")
                yield Name(*place(member), name, described or is_described(member))


def public_names() -> list[Name]:
    """The names in public headers; run_doxygen() must have run."""
    return names_in(XML, {str(header.file.resolve().relative_to(TOP)) for header in public_headers()})


def names_in(folder: Path, public: set[str]) -> list[Name]:
    """The names in these headers, as a folder of Doxygen's XML has them."""
    found: dict[tuple[str, str], Name] = {}
    for file in sorted(folder.glob("*.xml")):
        if not re.match(r"class|struct|namespace|.*_8h(pp)?\.xml$", file.name):
            continue
        for compound in ET.parse(file).getroot().iter("compounddef"):
            for each in names_of(compound):
                if each.file not in public or PRIVATE.search(each.name):
                    continue
                before = found.get((each.file, each.name))
                if before is None or not before.described:
                    found[each.file, each.name] = each
    described = {(each.file, each.line) for each in found.values() if each.described}
    return sorted(each._replace(described=(each.file, each.line) in described) for each in found.values())
