# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Names of an earlier release: they still work, and warn."""

from __future__ import annotations

import functools
import sys
import typing
import warnings

Function = typing.TypeVar("Function", bound=typing.Callable[..., typing.Any])


def warn(old: str, new: str, stacklevel: int = 3) -> None:
    """Warns of an old name, for the caller of the function that calls this one."""
    warnings.warn(
        f"{old} is now {new}; the old name goes with 0.3.", DeprecationWarning, stacklevel=stacklevel
    )


def renamed(old: str, new: str) -> typing.Callable[[Function], Function]:
    """A decorator of a function with an old name: a call of it warns."""

    def decorate(function: Function) -> Function:
        @functools.wraps(function)
        def call(*args: typing.Any, **kwargs: typing.Any) -> typing.Any:
            warn(old, new)
            return function(*args, **kwargs)

        call.__doc__ = f"Deprecated: {old} is now {new}; the old name goes with 0.3."
        return typing.cast(Function, call)

    return decorate


def renamed_in(module: str, **names: str) -> typing.Callable[[str], typing.Any]:
    """The __getattr__ of a module, in which each old name of a class stands for a new one."""

    def get(name: str) -> typing.Any:
        if name not in names:
            raise AttributeError(f"module '{module}' has no attribute '{name}'")
        warn(f"{module}.{name}", f"{module}.{names[name]}")
        return getattr(sys.modules[module], names[name])

    return get
