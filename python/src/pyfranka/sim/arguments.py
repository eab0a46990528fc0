# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Arguments, and a sentence for each that cannot be used: TypeError or ValueError."""

from __future__ import annotations

import operator
import os
import typing
from collections.abc import Iterable, Mapping, Sequence

import numpy
from numpy.typing import NDArray

LARGEST_SEED = 2**63 - 1  # robots count on from it


def whole(value: typing.Any, name: str, least: int | None = None, most: int | None = None) -> int:
    """A whole number within bounds."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {value!r}.") from None
    if (least is not None and number < least) or (most is not None and number > most):
        bounds = f"{least} or more" if most is None else f"{least} to {most}"
        raise ValueError(f"{name} must be {bounds}, not {number}.")
    return number


def seed_of(value: typing.Any) -> int:
    """The seed of random numbers."""
    return whole(value, "seed", 0, LARGEST_SEED)


def numbers(value: typing.Any, name: str, *sizes: int) -> NDArray[numpy.float64]:
    """Finite numbers in a row, as many as one of the sizes says; a single one may stand alone."""
    try:
        values = numpy.asarray(value)
        if values.dtype.kind not in "biuf" or values.ndim > 1:
            raise ValueError
        values = numpy.array(values, dtype=float).ravel()
    except (TypeError, ValueError):
        values = numpy.full(1, numpy.nan)
    if values.size not in sizes or not numpy.isfinite(values).all():
        what = "a finite number" if sizes == (1,) else f"{' or '.join(map(str, sizes))} finite numbers"
        raise ValueError(f"{name} must be {what}, not {value!r}.")
    return values


def inertia(value: typing.Any, name: str) -> NDArray[numpy.float64]:
    """The nine numbers of an inertia: 3x3, or in a row."""
    return numbers(numpy.ravel(value) if numpy.shape(value) == (3, 3) else value, name, 9)


def no_robot(name: str, robots: Iterable[str]) -> str:
    """The sentence for a name that none of the robots has."""
    return f"There is no robot '{name}'; there are: {', '.join(robots) or 'none'}."


def path(value: typing.Any, name: str) -> str:
    """The name of a file."""
    try:
        result = os.fspath(value)
    except TypeError:
        raise TypeError(f"{name} must be the name of a file, not {value!r}.") from None
    result = os.fsdecode(result)
    if result.lstrip().startswith("<") or "\n" in result:
        raise ValueError(
            f"{name} must be the name of a file, not its text ({len(result)} characters that begin with "
            f"{result.strip()[:20]!r}). Write the text to a file."
        )
    return result


def text(value: typing.Any, name: str) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a text, not {value!r}.")
    return value


def items(value: typing.Any, name: str, what: str) -> Sequence[typing.Any]:
    """The items of a sequence, or of another iterable that is neither a text nor a mapping."""
    if isinstance(value, (str, bytes, Mapping)):
        raise TypeError(f"{name} must be a list of {what}, not {value!r}.")
    try:
        return list(value)
    except TypeError:
        raise TypeError(f"{name} must be a list of {what}, not {value!r}.") from None


def mapping(value: typing.Any, name: str, what: str) -> Mapping[str, typing.Any]:
    """A mapping, empty for None."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise TypeError(f"{name} must be a dict of {what}, not {value!r}.")
    return value
