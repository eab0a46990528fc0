# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Objects that can be neither pickled nor copied."""

from __future__ import annotations

from collections.abc import Callable


def refused(sentence: str) -> Callable[[object], str]:
    """A __reduce__ with which pickle and copy raise TypeError. sentence: why, and what to do instead."""

    def __reduce__(self: object) -> str:
        raise TypeError(sentence)

    return __reduce__
