# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What a caller gives, as words of a line of the control interface; refused with a sentence."""

from __future__ import annotations

import operator
import threading
from collections.abc import Iterable

import numpy
from numpy.typing import ArrayLike, NDArray

Array = NDArray[numpy.float64]


def seconds(limit: float) -> float:
    real = isinstance(limit, (int, float, numpy.integer, numpy.floating))
    if not real or not 0.0 < limit < float(threading.TIMEOUT_MAX):
        raise ValueError(f"A time limit is a positive number of seconds, not {limit!r}.")
    return float(limit)


def switch(on: bool) -> str:
    if not isinstance(on, (bool, numpy.bool_)):
        raise TypeError(f"Give True or False, not {on!r}.")
    return "on" if on else "off"


def whole(number: int, what: str) -> int:
    try:
        return operator.index(number)
    except TypeError:
        raise TypeError(f"{what} is a whole number, not {number!r}.") from None


def word(text: str, what: str) -> str:
    if not isinstance(text, str) or text.split() != [text]:
        raise ValueError(f"{what} is one word, not {text!r}.")
    return text


def numbers(values: ArrayLike, count: int, what: str) -> Array:
    try:
        array = numpy.asarray(values)
        real = array.dtype.kind in "biuf"
    except ValueError:  # rows of different lengths
        real = False
    if not real:
        raise ValueError(f"{what} must have {count} numbers, not {values!r}.")
    if array.size != count or array.ndim != 1:
        found = array.size if array.ndim == 1 else array.shape
        raise ValueError(f"{what} must have {count} numbers, not {found}.")
    return array.astype(float)


def matrix(values: ArrayLike, rows: int, what: str) -> Array:
    """The numbers, column by column, of a square matrix or of such a list."""
    try:
        shape: tuple[int, ...] | None = numpy.shape(values)
    except ValueError:  # rows of different lengths
        shape = None
    if shape not in ((rows * rows,), (rows, rows)):
        raise ValueError(
            f"{what} is {rows}x{rows}, or {rows * rows} numbers column by column, not "
            f"{repr(values) if shape is None else f'of shape {shape}'}."
        )
    return numbers(numpy.ravel(values, order="F"), rows * rows, what)


def line(name: str, *values: Iterable[float]) -> str:
    return " ".join([name, *(number(value, name) for each in values for value in each)])


def number(value: float, name: str) -> str:
    try:
        if isinstance(value, (str, bytes, bytearray)):  # from which Python makes a number, too
            raise TypeError
        return repr(float(value))  # the shortest text that reads as the same number
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"'{name}' takes numbers, not {value!r}.") from None
