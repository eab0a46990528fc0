# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What a caller gives, as words of a line of the control interface; refused with a sentence."""

from __future__ import annotations

import operator
import threading

import numpy
from numpy.typing import ArrayLike, NDArray

Array = NDArray[numpy.float64]


def seconds(limit: float) -> float:
    real = isinstance(limit, (int, float, numpy.integer, numpy.floating))
    if not real or not 0.0 < limit < float(threading.TIMEOUT_MAX):
        raise ValueError(f"timeout must be a positive number of seconds, not {limit!r}.")
    return float(limit)


def switch(on: bool, name: str) -> str:
    if not isinstance(on, (bool, numpy.bool_)):
        raise TypeError(f"{name} must be True or False, not {on!r}.")
    return "on" if on else "off"


def whole(number: int, name: str) -> int:
    try:
        return operator.index(number)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {number!r}.") from None


def word(text: str, name: str) -> str:
    if not isinstance(text, str) or text.split() != [text]:
        raise ValueError(f"{name} must be one word, not {text!r}.")
    return text


def number(value: float, name: str) -> Array:
    """A finite number, as an array of one."""
    try:
        if isinstance(value, (str, bytes, bytearray)):  # from which Python makes a number, too
            raise TypeError
        real = float(value)
    except (TypeError, ValueError, OverflowError):
        real = numpy.nan
    if not numpy.isfinite(real):
        raise ValueError(f"{name} must be a finite number, not {value!r}.")
    return numpy.array([real])


def numbers(values: ArrayLike, count: int, name: str) -> Array:
    """Finite numbers in a row."""
    try:
        array = numpy.asarray(values)
        good = array.dtype.kind in "biuf" and array.shape == (count,) and numpy.isfinite(array).all()
    except ValueError:  # rows of different lengths
        good = False
    if not good:
        raise ValueError(f"{name} must be {count} finite numbers, not {values!r}.")
    return array.astype(float)


def matrix(values: ArrayLike, rows: int, name: str) -> Array:
    """The numbers, column by column, of a square matrix or of such a list."""
    try:
        shape: tuple[int, ...] | None = numpy.shape(values)
    except ValueError:  # rows of different lengths
        shape = None
    if shape not in ((rows * rows,), (rows, rows)):
        raise ValueError(
            f"{name} must be {rows}x{rows}, or {rows * rows} numbers column by column, not "
            f"{repr(values) if shape is None else f'of shape {shape}'}."
        )
    return numbers(numpy.ravel(values, order="F"), rows * rows, name)


def line(command: str, *values: Array) -> str:
    """The line with the shortest texts that read as the same numbers."""
    return " ".join([command, *(repr(float(value)) for each in values for value in each)])
