# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of values in requests: each returns the value or raises DeskError (400) with a sentence."""

from __future__ import annotations

import math
import typing

from pyfranka.desk.errors import bad_request

MAX_TEXT_LENGTH = 200  # [characters] (chosen here)


def text(value: typing.Any, name: str) -> str:
    """A text that is not empty and has no halves of characters, which UTF-8 cannot have."""
    if (
        not isinstance(value, str)
        or not value.strip()
        or len(value) > MAX_TEXT_LENGTH
        or any("\ud800" <= character <= "\udfff" for character in value)
    ):
        raise bad_request(f"The field {name} must be a text of 1 to {MAX_TEXT_LENGTH} characters.")
    return value


def number(value: typing.Any, name: str, limit: float = math.inf) -> float:
    """A number whose magnitude is at most the limit."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= limit:
        raise bad_request(
            f"The field {name} must be a number" + (f" up to {limit:g}." if math.isfinite(limit) else ".")
        )
    try:
        result = float(value)
    except OverflowError:  # an integer with hundreds of digits
        result = math.inf
    if not math.isfinite(result):
        raise bad_request(f"The field {name} must be a finite number.")
    return result


def numbers(value: typing.Any, count: int, name: str, limit: float = math.inf) -> list[float]:
    """A list of so many numbers."""
    if not isinstance(value, list) or len(value) != count:
        raise bad_request(f"The field {name} must be a list of {count} numbers.")
    return [number(each, name, limit) for each in value]


def members(
    value: typing.Any, names: typing.Sequence[str], name: str, limit: float = math.inf
) -> list[float]:
    """An object's members of these names, all of them numbers."""
    if not isinstance(value, dict) or not set(names) <= set(value):
        raise bad_request(f"The field {name} must be an object with {', '.join(names)}.")
    return [number(value[each], f"{name}.{each}", limit) for each in names]


def known(value: dict[str, typing.Any], names: typing.Iterable[str], name: str) -> None:
    """Raises DeskError (400) if the object has other members."""
    others = sorted(set(value) - set(names))
    if others:
        raise bad_request(f"The field {name} has no '{others[0][:50]}'.")
