# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters that dynamic_reconfigure changes while a node runs: names, ranges and units from .cfg files.

A .cfg file is a Python program; it is run with a generator that only keeps what it is given.
"""

import sys
import types
import typing
from contextlib import suppress
from pathlib import Path
from unittest.mock import patch

from docsite.markdown import code, plain, table

MODULE = "dynamic_reconfigure.parameter_generator_catkin"
TYPES = {"double_t": "double", "int_t": "int", "bool_t": "bool", "str_t": "string"}


class Parameter(typing.NamedTuple):
    """A parameter. lowest and highest: None for a type without a range."""

    name: str
    type: str
    meaning: str
    default: typing.Any
    lowest: typing.Any
    highest: typing.Any


class Config(typing.NamedTuple):
    """A .cfg file: what it is for, and its parameters."""

    path: Path
    description: str
    parameters: list[Parameter]


class Generator:
    """Keeps what dynamic_reconfigure's ParameterGenerator would write."""

    def __init__(self, parameters: list[Parameter]):
        self._parameters = parameters

    def add(
        self,
        name: str,
        paramtype: str,
        level: int,
        description: str,
        default: typing.Any = None,
        min: typing.Any = None,  # noqa: A002
        max: typing.Any = None,  # noqa: A002
        **_: typing.Any,
    ) -> None:
        self._parameters.append(Parameter(name, paramtype, description, default, min, max))

    def add_group(self, *_: typing.Any, **__: typing.Any) -> "Generator":
        return self

    def generate(self, *_: typing.Any) -> int:
        return 0


def read_config(path: Path) -> Config:
    parameters: list[Parameter] = []
    module = types.ModuleType(MODULE)
    for name, value in {**TYPES, "ParameterGenerator": lambda: Generator(parameters)}.items():
        setattr(module, name, value)
    names: dict[str, typing.Any] = {"__name__": "__main__", "exit": sys.exit}
    replaced = {MODULE.partition(".")[0]: types.ModuleType("dynamic_reconfigure"), MODULE: module}
    with patch.dict(sys.modules, replaced), suppress(SystemExit):
        exec(compile(path.read_text(), str(path), "exec"), names)
    return Config(path, " ".join((names.get("__doc__") or "").split()), parameters)


def describe(config: Config) -> str:
    """A section about the file."""
    rows = []
    for each in config.parameters:
        limits = "" if each.lowest is None else f"{each.lowest} to {each.highest}"
        rows.append((code(each.name), each.type, str(each.default), limits, plain(each.meaning)))
    head = ("parameter", "type", "default", "range", "meaning")
    return "\n\n".join([f"### {config.path.name}", plain(config.description), table(head, rows)])
