# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What a sweep runs: function, cases and seeds, and the identity by which its output is recognized."""

from __future__ import annotations

import functools
import hashlib
import inspect
import io
import numbers
import operator
import pickle
import typing
from collections.abc import Callable, Iterable, Sequence
from types import CodeType

import numpy

Function = Callable[[typing.Any, int], object]


def check_number(name: str, value: object, least: int) -> int:
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or value < least:
        raise ValueError(f"{name} must be a whole number from {least}, not {value!r}.")
    return operator.index(value)


def seed_of(seed: int, index: int) -> int:
    """The seed of a case, 63 bits; it does not depend on the numbers of cases and workers. Raises ValueError
    for other arguments than whole numbers from 0.

    >>> seed_of(1, 0) == seed_of(1, 0), seed_of(1, 0) == seed_of(1, 1)
    (True, False)
    """
    key = (check_number("index", index, 0),)
    child = numpy.random.SeedSequence(check_number("seed", seed, 0), spawn_key=key)  # as its spawn()
    return int(child.generate_state(1, numpy.uint64)[0] >> numpy.uint64(1))


class Plan:
    """Function, cases and seeds of a sweep, and the identity by which its output is recognized."""

    def __init__(self, function: Function, cases: int | Iterable[object], seed: int):
        if not callable(function):
            raise TypeError(f"function is called with a case and a seed; {function!r} cannot be called.")
        try:
            inspect.signature(function).bind(0, 0)
        except TypeError as error:
            name = getattr(function, "__name__", repr(function))
            raise TypeError(
                f"function is called with a case and a seed; '{name}' cannot be: {error}."
            ) from None
        except ValueError:
            pass  # functions in C: signature not available
        self.seed = check_number("seed", seed, 0)
        self.counted = isinstance(cases, numbers.Integral)
        if self.counted:
            self.cases: Sequence[typing.Any] = range(check_number("cases", cases, 1))
        elif isinstance(cases, Iterable) and not isinstance(cases, (str, bytes)):
            self.cases = list(cases)
        else:
            raise TypeError(f"cases must be a number or a list of cases, not {cases!r}.")
        if not self.cases:
            raise ValueError("There are no cases.")
        self.payload = _pickled(function, "function")
        self._function = function

    def __len__(self) -> int:
        return len(self.cases)

    def seed_of(self, index: int) -> int:
        return seed_of(self.seed, index)

    def pickled_case(self, index: int) -> bytes:
        return _pickled(self.cases[index], f"case {index}")

    @functools.cached_property
    def identity(self) -> str:
        """Function, cases and seed, with short digests."""
        cases = str(len(self))
        if not self.counted:
            digest = hashlib.sha256()
            for index, case in enumerate(self.cases):
                digest.update(_stable(case, f"case {index}"))
            cases += f"-{digest.hexdigest()[:8]}"
        return f"{_name(self._function)}-{_digest(self._function)[:8]}/{cases}/{self.seed}"


def _pickled(value: object, what: str) -> bytes:
    from pyfranka._sweep_pickle import dumps  # cloudpickle comes with Dask

    try:
        return dumps(value)
    except Exception as error:  # any exception of a value's own pickling
        raise TypeError(f"{what} cannot be sent to a worker: {error}.") from error


class _StablePickler(pickle._Pickler):
    """Pickles sets in an order that does not depend on the hashes of texts, which differ in each process."""

    def reducer_override(self, value: object) -> typing.Any:
        if not isinstance(value, (set, frozenset)):
            return NotImplemented
        return type(value), (sorted(map(_stable_pickle, value)),), getattr(value, "__dict__", None)


def _stable_pickle(value: object) -> bytes:
    file = io.BytesIO()
    _StablePickler(file, protocol=5).dump(value)
    return file.getvalue()


def _stable(value: object, what: str) -> bytes:
    """Bytes that are the same in each run. Those of cloudpickle contain random numbers for classes of
    scripts."""
    try:
        return _stable_pickle(value)
    except Exception:  # any exception of a value's own pickling
        return _pickled(value, what)


def _name(function: Function) -> str:
    while isinstance(function, functools.partial):
        function = function.func
    return getattr(function, "__qualname__", type(function).__qualname__).replace("/", "_")


def _digest(function: Function) -> str:
    """Digest of the function's own source and of the values bound to it, not of the functions that it
    calls."""
    digest = hashlib.sha256()
    while isinstance(function, functools.partial):
        digest.update(_stable((function.args, sorted(function.keywords.items())), "function"))
        function = function.func
    if inspect.ismethod(function):
        digest.update(_stable(function.__self__, "function"))
        function = function.__func__
    function = inspect.unwrap(function)
    if not inspect.isfunction(function):
        digest.update(_stable(function, "function"))
        return digest.hexdigest()
    try:
        digest.update(inspect.getsource(function).encode())
    except OSError:  # typed into an interpreter
        digest.update(_code_text(function.__code__).encode())
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or ()):
        try:
            value = cell.cell_contents
        except ValueError:  # the variable has no value yet
            digest.update(f"no {name}".encode())
            continue
        if not callable(value):
            digest.update(_stable(value, "function"))
    return digest.hexdigest()


def _code_text(code: CodeType) -> str:
    constants = [
        _code_text(c) if isinstance(c, CodeType) else _stable(c, "function").hex() for c in code.co_consts
    ]
    return f"{code.co_code.hex()} {code.co_names} {constants}"
