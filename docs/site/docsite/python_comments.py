# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Public names of Python without a docstring: functions, classes, and methods and properties of classes."""

import importlib
import inspect
import re
from collections.abc import Iterator

from docsite.python_api import MODULES, public_names

SIGNATURE = re.compile(r"(\d+\. )?\w+\(.*\) -> |\w+\(\*args, \*\*kwargs\)$")


def has_docstring(value) -> bool:
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


def is_value(value) -> bool:
    """A constant, or a value of an enumeration: its class describes it."""
    return not (isinstance(value, type) or callable(value))


def undocumented() -> list[str]:
    found = []
    for each in MODULES:
        module = importlib.import_module(each.name)
        if not has_docstring(module):
            found.append(each.name)
        for name in public_names(module):
            value = getattr(module, name)
            if is_value(value):
                continue
            if not has_docstring(value):
                found.append(f"{each.name}.{name}")
            if isinstance(value, type):
                inside = [part for part, member in members(value) if not has_docstring(member)]
                found += [f"{each.name}.{name}.{part}" for part in inside]
    return found
