# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Signatures of functions in C++, read from the words in which pybind11 shows them."""

import inspect
from collections.abc import Sequence

OPENING, CLOSING = "([{<", ")]}>"


def signature(text: str) -> inspect.Signature:
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


def without_other_names(signatures: Sequence[inspect.Signature]) -> list[inspect.Signature]:
    """The names of arguments in other packages are further signatures with the same types."""
    found: dict[tuple[str, ...], inspect.Signature] = {}
    for each in signatures:
        found.setdefault(tuple(parameter.annotation for parameter in each.parameters.values()), each)
    return [*found.values()]
