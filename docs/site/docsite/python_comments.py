# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Public names of Python without a description: functions, classes with their methods, properties and fields,
and constants."""

import dataclasses
import importlib
import inspect
import re
from collections.abc import Iterator

from docsite.python_api import MODULES, comment_of_constant, public_names

SIGNATURE = re.compile(r"(\d+\. )?\w+\(.*\) -> |\w+\(\*args, \*\*kwargs\)$")


def has_docstring(value: object) -> bool:
    """Whether the object has its own docstring or inherits one; a signature of pybind11 does not count."""
    text = inspect.getdoc(value) or ""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return bool([line for line in lines if not SIGNATURE.match(line) and line != "Overloaded function."])


def members(cls: type) -> Iterator[tuple[str, object]]:
    """Public methods and properties that the class itself defines."""
    of_enumeration = {"name", "value"} if hasattr(cls, "__members__") else set()
    for name, value in vars(cls).items():
        if name.startswith("_") or name in of_enumeration:
            continue
        if inspect.isroutine(value) or isinstance(value, (property, classmethod, staticmethod)):
            yield name, getattr(cls, name)


def fields(cls: type) -> list[str]:
    """Fields of a dataclass or of a named tuple."""
    if dataclasses.is_dataclass(cls):
        return [each.name for each in dataclasses.fields(cls)]
    return list(getattr(cls, "_fields", ()))


def describes_field(cls: type, name: str) -> bool:
    """Whether the docstring of the class names the field, or the field has a comment that Sphinx shows."""
    in_docstring = re.search(rf"\b{name}\b", inspect.getdoc(cls) or "")
    return bool(in_docstring or re.search(rf"^ +{name}: .*  #: \S", inspect.getsource(cls), re.M))


def undocumented() -> list[str]:
    found = []
    for each in MODULES:
        module = importlib.import_module(each.name)
        if not has_docstring(module):
            found.append(each.name)
        for name in public_names(module):
            value = getattr(module, name)
            is_constant = not callable(value)
            if not (comment_of_constant(module, name) if is_constant else has_docstring(value)):
                found.append(f"{each.name}.{name}")
            if isinstance(value, type):
                inside = [part for part, member in members(value) if not has_docstring(member)]
                inside += [part for part in fields(value) if not describes_field(value, part)]
                found += [f"{each.name}.{name}.{part}" for part in inside]
    return found
