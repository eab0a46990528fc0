# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""One client's connection to Desk that writes the lines it is given, no others."""

import base64
import http.client
import json
import os
import ssl
import struct
from contextlib import nullcontext

from desk_sequences import HeaderLines, Sequence, Step, Stream, digest_of
from waiting import wait_for

LIMIT = 60.0  # [s] to wait for an answer


class Wire:
    """A connection over TLS, without a check of the certificate, as all these clients have it."""

    def __init__(self, desk):
        self.desk = desk
        context = ssl._create_unverified_context()  # noqa: S323 - which these clients use
        self.connection = http.client.HTTPSConnection(desk.address, desk.port, timeout=LIMIT, context=context)

    def request(self, method: str, path: str, headers: HeaderLines, body: str | None = None):
        """@returns status and body of the answer."""
        self.connection.putrequest(method, path, skip_accept_encoding=True)
        for name, value in headers:
            self.connection.putheader(name, value)
        self.connection.endheaders(body.encode() if body else None)
        answer = self.connection.getresponse()
        return answer.status, answer.read().decode()

    def close(self) -> None:
        self.connection.close()


class Socket(Wire):
    """A WebSocket of the library websockets, by hand."""

    def __init__(self, desk, path: str, login: str):
        super().__init__(desk)
        key = base64.b64encode(os.urandom(16)).decode()
        self.connection.putrequest("GET", path, skip_accept_encoding=True)
        for name, value in (
            ("Upgrade", "websocket"),
            ("Connection", "Upgrade"),
            ("Sec-WebSocket-Key", key),
            ("Sec-WebSocket-Version", "13"),
            ("Sec-WebSocket-Extensions", "permessage-deflate; client_max_window_bits"),
            ("authorization", login),
        ):
            self.connection.putheader(name, value)
        self.connection.endheaders()
        self.bytes = self.connection.sock.makefile("rb")
        status = self.bytes.readline().decode()
        assert " 101 " in status, status
        while line := self.bytes.readline().strip():
            assert not line.lower().startswith(b"sec-websocket-extensions"), "The frames may be compressed."

    def message(self) -> dict:
        """The next text message as JSON."""
        while True:
            head, length = self.bytes.read(2)
            if length == 126:
                (length,) = struct.unpack(">H", self.bytes.read(2))
            payload = self.bytes.read(length)
            if head == 0x81:
                return json.loads(payload)


class Player:
    """Plays the steps of one client over one connection, and keeps what its answers say."""

    def __init__(self, sequence: Sequence, desk):
        self.sequence, self.desk, self.wire = sequence, desk, Wire(desk)
        digest = digest_of(desk.user, desk.password, unbroken=sequence.unbroken)
        self.kept = {"user": desk.user, "digest": json.dumps(digest)[1:-1]}

    def play(self, steps) -> None:
        for step in steps:
            with self.desk.held(f"button {step.press}") if step.press else nullcontext():
                self._stream(step) if isinstance(step, Stream) else self._step(step)

    def _step(self, step: Step) -> None:
        text = self._send(step)
        if step.until is not None:
            wait_for(lambda: step.until(json.loads(self._send(step)), self.kept), step.path)
        assert step.text in text, (step, text)
        for name in step.keep:
            self.kept[name] = text if name == "login" else json.loads(text)[name]

    def _send(self, step: Step) -> str:
        body = step.body and self._filled(step.body)
        sent = Step(step.method, self._filled(step.path), body, step.kind, with_token=step.with_token)
        headers = self.sequence.headers(sent, self.kept)
        status, text = self.wire.request(sent.method, sent.path, headers, body)
        assert status == step.status, (sent, status, text)
        return text

    def _stream(self, step: Stream) -> None:
        socket = Socket(self.desk, step.path, self.kept["login"])
        while not step.until(socket.message()):
            pass
        socket.close()

    def _filled(self, text: str) -> str:
        for name, value in self.kept.items():
            text = text.replace("{" + name + "}", str(value))
        return text
