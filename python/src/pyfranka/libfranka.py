# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka with the values of pylibfranka and panda-python, for scripts that were written for them.

    from pyfranka import libfranka                 # for: from panda_py import libfranka
    from pyfranka import libfranka as pylibfranka  # for: import pylibfranka

Names are those of pyfranka. Values are lists and may be changed; matrices are flat lists, column by column:
state.O_T_EE[14] is the height of the end effector. Frames, units, errors and threads are as in pyfranka.
"""

import functools
import typing

import _pyfranka
import numpy
from _pyfranka import *  # noqa: F403

from pyfranka._native import STARRED

__all__ = [*STARRED]


def _plain(value: typing.Any) -> typing.Any:
    """A value of pyfranka as those packages give it."""
    if isinstance(value, numpy.ndarray):
        return value.ravel(order="F").tolist()
    if isinstance(value, tuple):
        return tuple(map(_plain, value))
    if isinstance(value, dict):
        return {name: _plain(each) for name, each in value.items()}
    convert = _CLASSES.get(type(value))
    return convert(value) if convert else value


def _given(argument: typing.Any) -> typing.Any:
    """An argument of a function for pyfranka; callbacks get a state that gives lists."""
    if isinstance(argument, _Wrapper):
        return argument.wrapped
    if callable(argument):
        return lambda state, *period: argument(RobotState(state), *period)
    return argument


def _gives_plain_values(function: typing.Callable[..., typing.Any]) -> typing.Callable[..., typing.Any]:
    @functools.wraps(function)
    def call(*args: typing.Any, **kwargs: typing.Any) -> typing.Any:
        given = {name: _given(value) for name, value in kwargs.items()}
        return _plain(function(*map(_given, args), **given))

    return call


class _Wrapper:
    """Base of classes whose objects only the robot makes."""

    __slots__ = ("wrapped",)

    def __init__(self, wrapped: typing.Any) -> None:
        self.wrapped = wrapped


def _derive(ours: type, base: type | None = None) -> typing.Any:
    """A class like pyfranka's whose attributes and methods give lists; derived from it, or from `base`."""
    members: dict[str, typing.Any] = {"__doc__": ours.__doc__, "__module__": __name__, "__slots__": ()}
    for name, member in vars(ours).items():
        if isinstance(member, property):
            assert member.fget is not None
            members[name] = property(_gives_plain_values(member.fget), member.fset, doc=member.__doc__)
        elif callable(member) and (not name.startswith("_") or name in ("__copy__", "__enter__", "__exit__")):
            members[name] = _gives_plain_values(member)
    return type(ours.__name__, (base or ours,), members)


ActiveControl = ActiveControlBase = _derive(_pyfranka.ActiveControl, _Wrapper)
Model = _derive(_pyfranka.Model, _Wrapper)
RobotState = _derive(_pyfranka.RobotState)
Torques = _derive(_pyfranka.Torques)
JointPositions = _derive(_pyfranka.JointPositions)
JointVelocities = _derive(_pyfranka.JointVelocities)
CartesianPose = _derive(_pyfranka.CartesianPose)
CartesianVelocities = _derive(_pyfranka.CartesianVelocities)
Robot = _derive(_pyfranka.Robot)
limit_rate = _gives_plain_values(_pyfranka.limit_rate)

_CLASSES = {
    getattr(_pyfranka, convert.__name__): convert
    for convert in (
        ActiveControl,
        CartesianPose,
        CartesianVelocities,
        JointPositions,
        JointVelocities,
        Model,
        RobotState,
        Torques,
    )
}
