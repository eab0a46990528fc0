# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Calls of public functions with one wrong argument each, made from their signatures and kinds of arguments.

A table gives each function's arguments their kinds. What a kind does not take is written once, here. A call
must be refused with a sentence of ours that has the argument's name, and change nothing.
"""

import inspect
import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from sentences import ERRORS, unlike_ours
from signatures import signature, without_other_names

NAN, INF = math.nan, math.inf
EYE = np.eye(4)


@dataclass(frozen=True)
class Kind:
    """What an argument takes and does not take. `given` are arguments without which it has no meaning;
    `unknown` are values of the right type, which the sentence has to repeat."""

    right: Any
    wrong: tuple = ()
    word: str | None = None  # of the argument in a sentence; its name if there is none
    given: dict = field(default_factory=dict)
    unknown: tuple = ()


def numbers(right, *beyond, **more) -> Kind:
    """A row of finite numbers."""
    row = list(right)
    shapes = (row[1:], [*row, 0.0], [row] * 2, 5.0)
    return Kind(row, (object(), "a", *shapes, [NAN] * len(row), [INF] * len(row), *beyond), **more)


def pose(*beyond, **more) -> Kind:
    """A 4x4 transformation."""
    shapes = (np.eye(3), [0.1], EYE.reshape(2, 8))
    return Kind(EYE, (object(), "a", *shapes, np.full((4, 4), NAN), *beyond), **more)


def number(right, *beyond, **more) -> Kind:
    return Kind(right, (object(), "a", None, [1.0, 2.0], NAN, *beyond), **more)


def whole(right, *beyond, **more) -> Kind:
    return Kind(right, (object(), "a", None, 1.5, NAN, 2**70, *beyond), **more)


def switch(right=True, **more) -> Kind:
    return Kind(right, (object(), "yes", None, 0.5, 2), **more)


def text(right, *unknown, **more) -> Kind:
    return Kind(right, (object(), 5, None, b"a", *unknown), **more)


Table = dict[str, dict[str, Kind]]


def parameters_of(function: Callable) -> dict[str, inspect.Parameter]:
    """Without self."""
    found = list(inspect.signature(function).parameters.values())
    named = (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL)
    return {each.name: each for each in found[1:] if each.kind not in named}


def signatures_of(cls: type) -> dict[str, list[list[inspect.Parameter]]]:
    """The public functions of a class of C++, and the parameters of each signature that they have."""
    found = {}
    for name, member in vars(cls).items():
        function = getattr(member, "__func__", member)
        if not name.startswith("_") and inspect.isroutine(function):
            lines = rf"^(?:\d+\. )?{function.__name__}\((.*)\) -> "
            texts = re.findall(lines, function.__doc__, re.MULTILINE)
            signatures = without_other_names([*map(signature, texts)])
            found[name] = [[*each.parameters.values()][1:] for each in signatures]
    return found


def functions_with_arguments(cls: type) -> set[str]:
    """The public functions of a class that take arguments."""
    names = set()
    for name, function in inspect.getmembers(cls, inspect.isfunction):
        public = not name.startswith("_") or name in ("__init__", "__getitem__")
        ours = function.__module__.startswith("pyfranka") or name == "__init__"
        if public and ours and parameters_of(function):
            names.add(name)
    return names


def wrong_calls(cls: type, table: Table) -> Iterator[tuple[str, str, Callable]]:
    """Yields where a call is wrong, the word that its sentence must have, and the call of an object."""
    for function, kinds in table.items():
        parameters = parameters_of(getattr(cls, function))
        assert set(kinds) == set(parameters), f"{cls.__name__}.{function} takes {', '.join(parameters)}"
        needed = {name: kinds[name].right for name, each in parameters.items() if each.default is each.empty}
        for argument, kind in kinds.items():
            word = argument if kind.word is None else kind.word
            for value, expected in [
                *((value, word) for value in kind.wrong),
                *((value, str(value)) for value in kind.unknown),
            ]:
                if value is None and parameters[argument].default is None:
                    continue  # as if it were not given
                keywords = {**needed, **kind.given, argument: value}

                def call(thing, function=function, keywords=keywords):
                    made = cls if function == "__init__" else getattr(thing, function)
                    return made(**keywords)

                yield f"{cls.__name__}.{function}({argument}={value!r})"[:200], expected, call


def faults_of_arguments(cls: type, table: Table, thing: Any, condition: Callable[[], Any]) -> list[str]:
    """What is wrong with the refusals of a table."""
    wrong, before = [], repr(condition())
    for where, word, call in wrong_calls(cls, table):
        try:
            call(thing)
            wrong.append(f"{where}: not refused")
        except ERRORS as error:
            # KeyError shows the repr of its argument.
            sentence = str(error.args[0]) if error.args else ""
            if fault := unlike_ours(sentence):
                wrong.append(f"{where}: {fault}: {type(error).__name__}: {sentence}")
            elif word not in sentence:
                wrong.append(f"{where}: without '{word}': {type(error).__name__}: {sentence}")
        if repr(condition()) != before:
            wrong.append(f"{where}: something has changed")
            before = repr(condition())
    return wrong
