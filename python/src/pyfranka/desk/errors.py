# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What goes wrong: refusals by the robot, its loss, and requests that get an error as their answer."""

from __future__ import annotations

import typing


class Refused(Exception):
    """The robot has refused a line. code: of pyfranka.refusals, or empty; sentence: the robot's message."""

    def __init__(self, code: str, sentence: str):
        super().__init__(sentence)
        self.code, self.sentence = code, sentence


class RobotGone(Exception):
    """The robot does not answer; the text is a sentence."""


class DeskError(Exception):
    """An answer that is an error. code: a word that programs compare; message: a message for the user;
    details: further codes."""

    def __init__(self, status: int, code: str, message: str, details: typing.Sequence[str] = ()):
        super().__init__(message)
        self.status, self.code, self.message, self.details = status, code, message, list(details)


def bad_request(message: str) -> DeskError:
    """The request is invalid."""
    return DeskError(400, "BadRequest", message)


def unavailable(message: str) -> DeskError:
    """The robot is not available, or not yet."""
    return DeskError(503, "ServiceUnavailable", message)
