# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Functions and cases of a sweep as bytes, for workers."""

import io
from collections.abc import Callable
from types import CodeType
from typing import Any

import cloudpickle


class _Pickler(cloudpickle.Pickler):
    """cloudpickle's, but code that travels by value keeps the name of its file, which a failed case reports:
    cloudpickle 3.1.3 and later replace it."""

    def reducer_override(self, obj: Any) -> Any:
        if not isinstance(obj, CodeType):
            return super().reducer_override(obj)
        make, arguments = self.dispatch_table[CodeType](obj)[:2]
        return _code_of_file, (make, arguments, obj.co_filename)


def _code_of_file(make: Callable[..., CodeType], arguments: tuple[Any, ...], file: str) -> CodeType:
    return make(*arguments).replace(co_filename=file)


def dumps(value: object) -> bytes:
    """A function or a case; functions and classes of scripts by value. Raises what pickling them raises."""
    with io.BytesIO() as file:
        _Pickler(file).dump(value)
        return file.getvalue()
