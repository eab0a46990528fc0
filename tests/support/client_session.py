# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A genuine client in an interpreter of its own, which executes the statements of a test."""

import json
import os
import subprocess
import textwrap
from contextlib import contextmanager
from pathlib import Path

from lines import Lines

INTERPRETER = Path(__file__).resolve().parent / "genuine" / "interpreter.py"
# With them the library requests checks certificates against its caller's setting.
BUNDLES = ("REQUESTS_CA_BUNDLE", "CURL_CA_BUNDLE")
PATIENCE = 90.0  # [s]; the longest call of a client is a self-test of 8 s (chosen here)


class ClientError(AssertionError):
    """An exception in the client; `kind` is the name of its class, `text` its text."""

    def __init__(self, kind: str, text: str):
        super().__init__(f"{kind}: {text}")
        self.kind, self.text = kind, text


class ClientSession:
    """Executes Python in the client's process, one task after the other."""

    def __init__(self, python: os.PathLike | str, environment: dict[str, str], log):
        inherited = {name: value for name, value in os.environ.items() if name not in BUNDLES}
        inherited["LC_NUMERIC"] = "C"  # aiofranka's MuJoCo reads no mesh with a decimal comma
        self.process = subprocess.Popen(
            [python, INTERPRETER],
            env={**inherited, **environment},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=log,
            text=True,
        )
        self._lines = Lines(self.process.stdout)

    def begin(self, statements: str) -> None:
        """Begins to execute statements; `end` waits for their end."""
        self._send({"run": textwrap.dedent(statements)})

    def end(self, timeout: float = PATIENCE):
        """The value of the task that was begun. Raises ClientError with the client's exception."""
        line = self._lines.next(timeout)
        assert line is not None, f"The client has ended, or has not answered for {timeout:g} s."
        answer = json.loads(line)
        if "error" in answer:
            raise ClientError(answer["error"], answer["text"])
        return answer["value"]

    def run(self, statements: str, timeout: float = PATIENCE) -> None:
        self.begin(statements)
        self.end(timeout)

    def value(self, expression: str, timeout: float = PATIENCE):
        self._send({"value": expression})
        return self.end(timeout)

    def _send(self, task: dict) -> None:
        self.process.stdin.write(json.dumps(task) + "\n")
        self.process.stdin.flush()


@contextmanager
def client_session(python, home: Path, **environment: str):
    """A session whose client keeps its files (control tokens, configuration) in the folder `home`."""
    for name in ("XDG_RUNTIME_DIR", "XDG_STATE_HOME", "XDG_CONFIG_HOME"):
        environment.setdefault(name, str(home))
    (home / ".cache").mkdir(parents=True, exist_ok=True)
    with open(home / "client.log", "a") as log:
        session = ClientSession(python, {"HOME": str(home), **environment}, log)
        try:
            yield session
        except BaseException:
            print((home / "client.log").read_text()[-4000:])
            raise
        finally:
            session.process.kill()
            session.process.wait()
            session.process.stdin.close()
