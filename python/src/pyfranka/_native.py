# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The module in C++ under the names that users import: classes, docstrings and sentences for wrong arguments.

Everything in pyfranka imports _pyfranka through this module. The names are not given in C++, because the type
stubs of _pyfranka are made without pyfranka.
"""

from __future__ import annotations

import builtins
import datetime
import inspect
import numbers
import re
import typing
from collections.abc import Iterable, Iterator, Sequence
from types import ModuleType

import _pyfranka
from _pyfranka import _sim as _sim

MODULES = {"_pyfranka": "pyfranka", "_pyfranka._sim": "pyfranka.sim"}
WRONG_ARGUMENTS = re.compile(r"(\w*)\(\): incompatible (?:function|constructor) arguments\. ")
SIGNATURE = re.compile(r"^    \d+\. [\w.]*\((.*)\)(?: -> [^()]*)?$", re.MULTILINE)
OPENING, CLOSING = "([{<", ")]}>"
MOST_CHARACTERS = 80  # of a value in a sentence (chosen here)
# Types of arguments in pybind11's signatures: what they take, and how a sentence says it.
PLAIN: dict[str, tuple[tuple[type, ...], str]] = {
    "float": ((numbers.Real,), "a number"),
    "int": ((numbers.Integral,), "a whole number"),
    "bool": ((bool,), "True or False"),
    "str": ((str,), "a text"),
    "datetime.timedelta": ((datetime.timedelta,), "a datetime.timedelta"),
    "tuple": ((tuple,), "a tuple"),
    "dict": ((dict,), "a dict"),
}

# "Robot.stop" by the identity of what C++ knows of the function; those live as long as the module.
_names: dict[int, str] = {}


def public(text: str) -> str:
    """A text of pybind11 with the public names of modules."""
    return text.replace("_pyfranka._sim.", "pyfranka.sim.").replace("_pyfranka.", "pyfranka.")


def _publish_in(owner: ModuleType | type, prefix: str) -> None:
    for name, member in [*vars(owner).items()]:
        if isinstance(member, type) and member.__module__ in MODULES:
            member.__module__ = MODULES[member.__module__]
            _publish_in(member, f"{member.__qualname__}.")
        for function in _functions(member):
            doc = function.__doc__
            _pyfranka._publish(function, None if doc is None else public(doc))
            _names.setdefault(id(function.__self__), prefix + name)
            if function.__module__ in MODULES:
                function.__module__ = MODULES[function.__module__]


def _functions(member: typing.Any) -> Iterator[typing.Any]:
    """The functions in C++ of a class's or module's member."""
    of_property = (getattr(member, "fget", None), getattr(member, "fset", None))
    for each in of_property if any(of_property) else (member,):
        function = getattr(each, "__func__", each)
        # Those of pybind11 have a capsule there, or a record of its own type.
        own = getattr(function, "__self__", None)
        if inspect.isbuiltin(function) and own is not None and not isinstance(own, (type, ModuleType)):
            yield function


# ---- sentences ---------------------------------------------------------------------------------------------


def explain(
    function: object, text: str, arguments: Sequence[typing.Any], keywords: dict[str, typing.Any]
) -> str | None:
    """The sentence for arguments that pybind11 has refused; None for another error. text: pybind11's own,
    with the signatures that it has tried."""
    match = WRONG_ARGUMENTS.match(text)
    if not match:
        return None
    name = _names.get(id(function), match[1])
    constructs = match[1] == "__init__"
    if constructs:
        name = name.removesuffix(".__init__")
        arguments = arguments[1:]
    listed = text[: text.rfind("\nInvoked with: ")]
    signatures = [_signature(each[1]) for each in SIGNATURE.finditer(listed)]
    if [*signatures[0].parameters][-1:] == ["arg0"]:  # an attribute is assigned
        signatures = [_signature(f"self, {name.rpartition('.')[2]}: {_kind(signatures[0], 'arg0')}")]
    takes = " or ".join(dict.fromkeys(map(_form, _without_other_names(signatures))))
    faults = [_fault(each, arguments, keywords) for each in signatures]
    first = max(faults, key=lambda fault: fault.right)  # the first of them
    if first.right < 0:
        return f"{name}(): {first.what}; it takes {takes}."
    same = [each.what for each in faults if (each.right, each.argument) == (first.right, first.argument)]
    expected = " or ".join(dict.fromkeys(same))
    sentence = f"{first.argument} must be {expected}, not {_shortened(first.value)}."
    return f"{sentence} {name}() takes {takes}." if " or " in takes else sentence


class _Fault(typing.NamedTuple):
    """The first wrong argument, what it must be, and how many before it are right; -1: their number or names
    are wrong, and `what` says how."""

    right: int
    what: str
    argument: str = ""
    value: object = None


def _signature(text: str) -> inspect.Signature:
    """The signature in pybind11's words; the annotations are texts."""
    parts, depth, begin = [], 0, 0
    for i, character in enumerate(text):
        depth += (character in OPENING) - (character in CLOSING)
        if character == "," and depth == 0:
            parts.append(text[begin:i].strip())
            begin = i + 1
    parts.append(text[begin:].strip())
    starred = [part.startswith("*") for part in parts]
    return inspect.Signature(
        [_parameter(part, any(starred[:i])) for i, part in enumerate(parts) if part.strip("*/")]
    )


def _parameter(text: str, after_star: bool) -> inspect.Parameter:
    declared, _, default = text.partition(" = ")
    name, _, kind = declared.partition(": ")
    named = inspect.Parameter.KEYWORD_ONLY if after_star else inspect.Parameter.POSITIONAL_OR_KEYWORD
    how = {0: named, 1: inspect.Parameter.VAR_POSITIONAL}
    return inspect.Parameter(
        name.lstrip("*"),
        how.get(name.count("*"), inspect.Parameter.VAR_KEYWORD),
        default=default or inspect.Parameter.empty,
        annotation=kind,
    )


def _kind(signature: inspect.Signature, name: str) -> str:
    return str(signature.parameters[name].annotation)


def _without_other_names(signatures: Sequence[inspect.Signature]) -> list[inspect.Signature]:
    """The names of arguments in other packages are further signatures with the same types."""
    found: dict[tuple[str, ...], inspect.Signature] = {}
    for each in signatures:
        found.setdefault(tuple(_kind(each, name) for name in each.parameters), each)
    return [*found.values()]


def _form(signature: inspect.Signature) -> str:
    names = ", ".join(name for name in signature.parameters if name != "self")
    return f"({names})" if names else "no arguments"


def _fault(
    signature: inspect.Signature, arguments: Sequence[typing.Any], keywords: dict[str, typing.Any]
) -> _Fault:
    try:
        bound = signature.bind(*arguments, **keywords).arguments
    except TypeError as error:
        return _Fault(-1, str(error))
    for i, (name, value) in enumerate(bound.items()):
        if expected := _unlike(_kind(signature, name), value):
            return _Fault(i, expected, name, value)
    if not bound:
        return _Fault(-1, "it cannot be called so")
    # Of what C++ takes, whole numbers have bounds.
    bounded = [name for name in bound if _kind(signature, name) == "int"]
    name = [*bounded, [*bound][-1]][0]
    value = bound[name]
    return _Fault(len(bound), "within the range of its type", name, value)


def _shortened(value: object) -> str:
    shown = repr(value)
    return shown if len(shown) <= MOST_CHARACTERS else f"{shown[:MOST_CHARACTERS]}..."


def _unlike(kind: str, value: object) -> str:
    """What a type in pybind11's words takes, if not this value; or nothing."""
    outer = kind.partition("[")[0]
    inner = kind[len(outer) + 1 : -1]
    if outer.lower() == "optional":
        expected = value is not None and _unlike(inner, value)
        return f"{expected} or None" if expected else ""
    if outer.lower() == "list":
        iterable = isinstance(value, Iterable) and not isinstance(value, str)
        right = iterable and not any(_unlike(inner, each) for each in typing.cast(Iterable[object], value))
        return "" if right else f"a list, each {_unlike(inner, object())}"
    if outer in ("function", "Callable"):
        return "" if callable(value) else "a function"
    if outer == "numpy.ndarray":
        return "an array of numbers"
    if kind in PLAIN:
        types, expected = PLAIN[kind]
        return "" if isinstance(value, types) else expected
    if not kind.startswith("_pyfranka."):
        return ""
    cls: typing.Any = _pyfranka
    for name in kind.split(".")[1:]:
        cls = getattr(cls, name)
    if isinstance(value, cls):
        return ""
    article = "an" if cls.__name__[0] in "AEIO" else "a"
    values = [f"{cls.__qualname__}.{name}" for name in getattr(cls, "__members__", ())]
    chosen = f" ({', '.join(values[:-1])} or {values[-1]})" if values else ""
    return f"{article} {cls.__qualname__}{chosen}"


_pyfranka._explain_with(explain)
for _module in (_pyfranka, _sim):
    _publish_in(_module, "")
NAMES = {name: value for name, value in vars(_pyfranka).items() if not name.startswith("_")}
# `from pyfranka import *` does not hide Python's own Exception; FrankaException is another name of ours.
STARRED = [name for name in NAMES if not hasattr(builtins, name)]
