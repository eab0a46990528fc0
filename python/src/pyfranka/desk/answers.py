# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Answers of both interfaces, and errors that become answers."""

from __future__ import annotations

import json
import typing

from aiohttp import web

from pyfranka.desk.robot import Refused


class DeskError(Exception):
    """An answer that is an error. code: a word that programs compare; message: a message for the user;
    details: further codes."""

    def __init__(self, status: int, code: str, message: str, details: typing.Sequence[str] = ()):
        super().__init__(message)
        self.status, self.code, self.message, self.details = status, code, message, list(details)

    def answer(self, v1: bool) -> web.Response:
        """In the form of one of the interfaces; members of the older one come first."""
        body: dict[str, typing.Any] = {"code": self.code, "message": self.message, "details": self.details}
        if not v1:
            body = {"error": self.code, "reason": (self.details or [self.code])[0], **body}
        return json_answer(body, self.status)


def bad_request(message: str) -> DeskError:
    """The request is invalid."""
    return DeskError(400, "BadRequest", message)


def unavailable(message: str) -> DeskError:
    """The robot is not available, or not yet."""
    return DeskError(503, "ServiceUnavailable", message)


# Refusals that end after some time: clients try again.
TEMPORARY = {"SelfTestRunning", "NotReady"}


def refusal(refused: Refused) -> DeskError:
    """A refusal by the robot's rules."""
    details = [refused.code] if refused.code else []
    status = 503 if refused.code in TEMPORARY else 424
    return DeskError(status, "ActionUnavailable", refused.sentence, details)


def json_answer(value: typing.Any, status: int = 200) -> web.Response:
    """A value as JSON."""
    return web.Response(text=json.dumps(value), status=status, content_type="application/json")


def empty_answer(status: int) -> web.Response:
    """No result. Without the type of JSON, which clients would try to read."""
    return web.Response(status=status)


def text_answer(text: str, status: int = 200) -> web.Response:
    """Plain text."""
    return web.Response(text=text, status=status)
