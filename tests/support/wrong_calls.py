# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Calls of public functions with one wrong argument each, made from their signatures and kinds of arguments.

A table gives each argument its kind by its name. What a kind does not take is written once, here. A call
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
OF_TYPE_OR_VALUE = (TypeError, ValueError)
VARIADIC = (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL)


@dataclass(frozen=True)
class Kind:
    """What an argument takes and does not take. `given` are arguments without which it has no meaning;
    `unknown` are names of nothing, which the sentence has to repeat; `unnamed` are values of which the
    sentence may say something else than the argument's name."""

    right: Any
    wrong: tuple = ()
    word: str | None = None  # of the argument in a sentence; its name if there is none
    given: dict = field(default_factory=dict)
    unknown: tuple = ()
    unnamed: tuple = ()


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
    return Kind(right, (object(), 5, None, b"a"), unknown=unknown, **more)


def bound(name: str, right) -> Kind:
    """An argument of a function in C++, whose signature excludes types."""
    shapes = (right[1:], [right] * 2) if isinstance(right, list) else ()
    nan: tuple = ()
    if isinstance(right, list):
        nan = ((NAN * np.array(right)).tolist(),)
    elif isinstance(right, (int, float)) and not isinstance(right, bool):
        nan = (NAN,)
    return Kind(right, (object(), "a", *shapes), word=name.rpartition("_")[2], unnamed=nan)


def parameters_of(function: Callable) -> dict[str, inspect.Parameter]:
    """Without self."""
    found = inspect.signature(function).parameters
    return {name: each for name, each in found.items() if name != "self" and each.kind not in VARIADIC}


def signatures_of(owner: Any) -> dict[str, list[list[inspect.Parameter]]]:
    """The public functions of a class or module of C++, and the parameters of each signature that they
    have."""
    found = {}
    for name, member in vars(owner).items():
        function = getattr(member, "__func__", member)
        if (not name.startswith("_") or name == "__init__") and inspect.isroutine(function):
            lines = rf"^(?:\d+\. )?{function.__name__}\((.*)\) -> "
            texts = re.findall(lines, function.__doc__ or "", re.MULTILINE)
            signatures = without_other_names([*map(signature, texts)])
            if signatures:
                found[name] = [
                    [p for p in each.parameters.values() if p.name != "self"] for each in signatures
                ]
    return found


def functions_of(owner: Any) -> dict[str, list[list[inspect.Parameter]]]:
    """The public functions of a class or of a folder of functions, and the parameters of their
    signatures."""
    if type(owner).__name__ == "pybind11_type":
        return signatures_of(owner)
    found = signatures_of(owner) if not inspect.isclass(owner) else {}
    for name, function in inspect.getmembers(owner, inspect.isfunction):
        public = not name.startswith("_") or name in ("__init__", "__getitem__")
        if public and (function.__module__.startswith("pyfranka") or name == "__init__"):
            found[name] = [[*parameters_of(function).values()]]
    return found


def wrong_calls(
    owner: Any, table: dict[str, Kind], without: tuple[str, ...] = ()
) -> Iterator[tuple[str, str, Any, Callable]]:
    """Yields where a call is wrong, the word that its sentence must have, its wrong value, and the call of
    an object. The kind of an argument is that of `function.argument` in the table, or of `argument`."""
    for function, signatures in functions_of(owner).items():
        for parameters in signatures if function not in without else ():
            kinds = {
                each.name: table.get(f"{function}.{each.name}") or table[each.name] for each in parameters
            }
            needed = {each.name: kinds[each.name].right for each in parameters if each.default is each.empty}
            for parameter in parameters:
                argument, kind = parameter.name, kinds[parameter.name]
                word = argument if kind.word is None else kind.word
                for value, expected in [
                    *((value, word) for value in kind.wrong),
                    *((value, str(value)) for value in kind.unknown),
                    *((value, "") for value in kind.unnamed),
                ]:
                    if value is None and parameter.default is None:
                        continue  # as if it were not given
                    keywords = {**needed, **kind.given, argument: value}

                    def call(thing, function=function, keywords=keywords):
                        made = owner if function == "__init__" else getattr(thing, function)
                        return made(**keywords)

                    name = getattr(owner, "__name__", "")
                    yield f"{name}.{function}({argument}={value!r})"[:200], expected, value, call


def right_calls(thing: Any, table: dict[str, Kind], without: set[str] = frozenset()) -> dict[str, Callable]:
    """A call of each public function of an object with right arguments, as far as it needs any."""
    calls = {}
    for name, (parameters, *_) in functions_of(type(thing)).items():
        if not name.startswith("_") and name not in without:
            keywords = {}
            for each in parameters:
                kind = table.get(f"{name}.{each.name}") or table.get(each.name)
                if each.default is each.empty:
                    keywords[each.name] = kind.right
            calls[name] = lambda name=name, keywords=keywords: getattr(thing, name)(**keywords)
    return calls


def faults_of_calls(calls, thing: Any, condition: Callable[[], Any]) -> list[str]:
    """What is wrong with the refusals of wrong calls."""
    wrong, before = [], repr(condition())
    for where, word, value, call in calls:
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
            elif type(value) is object and not isinstance(error, OF_TYPE_OR_VALUE):
                wrong.append(f"{where}: raises {type(error).__name__}: {sentence}")
        if repr(condition()) != before:
            wrong.append(f"{where}: something has changed")
            before = repr(condition())
    return wrong
