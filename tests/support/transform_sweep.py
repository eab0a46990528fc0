# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Matrices with rounding errors, for every entrance of a transform (faults 22). For C++:
tests/include/transform_sweep.h.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy

EXPONENTS = range(-17, -5)


@dataclass(frozen=True)
class Perturbed:
    """A matrix with a rounding error in one entry, and whether every entrance accepts it."""

    matrix: numpy.ndarray  # 4x4
    row: int
    column: int
    error: float
    accepted: bool

    def __str__(self) -> str:
        return f"{self.error:g} on row {self.row + 1}, column {self.column + 1}"

    @property
    def column_major(self) -> list[float]:
        return [float(entry) for entry in self.matrix.T.ravel()]


def perturbations(matrix) -> Iterator[Perturbed]:
    """Errors of 1e-17 to 1e-6, of either sign, on each entry. The bottom row must be exact unless rounding
    hides the error; all other entries have a tolerance."""
    for column in range(4):
        for row in range(4):
            for exponent in EXPONENTS:
                error = (1 if exponent % 2 == 0 else -1) * 10.0**exponent
                perturbed = numpy.array(matrix, dtype=float)
                perturbed[row, column] += error
                hidden = perturbed[row, column] == matrix[row][column]
                yield Perturbed(perturbed, row, column, error, row < 3 or bool(hidden))


def check(matrix, refusal: Callable[[Perturbed], str], because: str = "exactly 0 0 0 1") -> None:
    """Sends every perturbed matrix through an entrance.

    @param refusal returns the entrance's message if it refuses a matrix, else "" @param because a part of it
    """
    disagreeing = []
    for perturbed in perturbations(matrix):
        text = refusal(perturbed)
        if perturbed.accepted != (text == "") or (text and because not in text):
            disagreeing.append(f"{perturbed}: {text or 'accepted'}")
    assert not disagreeing, "\n".join(disagreeing)


def raised(call: Callable[[], object], kind: type[Exception]) -> str:
    """The text of an exception of a kind; empty without one."""
    try:
        call()
    except kind as error:
        return str(error) or kind.__name__
    return ""
