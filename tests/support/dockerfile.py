# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Builds stages of the project's Dockerfile in a bare Debian, without Docker: the instructions that it uses,
and no others. A mount of RUN is a copy that is there while the command runs; the folder of a cache stays."""

import json
import re
import shlex
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

from bare_debian import BareDebian, copy_project


@dataclass
class Stage:
    """FROM base AS name, and the instructions (name, text) below."""

    name: str
    base: str
    instructions: list[tuple[str, str]] = field(default_factory=list)


def stages_of(text: str) -> dict[str, Stage]:
    """All stages of a Dockerfile, by name."""
    lines = [line for line in text.splitlines() if not line.lstrip().startswith("#")]
    logical = re.sub(r"\\\n\s*", "", "\n".join(lines)).splitlines()
    arguments: dict[str, str] = {}
    stages: dict[str, Stage] = {}
    stage = None
    for line in filter(str.strip, logical):
        name, _, value = line.partition(" ")
        if name == "ARG" and stage is None:
            key, _, default = value.partition("=")
            arguments[key] = default
        elif name == "FROM":
            base, stage_name = re.fullmatch(r"(\S+) AS (\S+)", value).groups()
            for key, default in arguments.items():
                base = base.replace("${" + key + "}", default)
            stage = stages[stage_name] = Stage(stage_name, base)
        else:
            stage.instructions.append((name, value))
    return stages


class Image:
    """What the instructions leave: files, user, folder, variables, and the command that a container runs."""

    def __init__(self, bare: BareDebian, context: Path, mounts: dict[tuple[str, str], Path]):
        """mounts: folders of other stages, by stage and path there."""
        self.bare, self.context, self.mounts = bare, context, mounts
        self.user, self.folder, self.entrypoint, self.command = "0:0", "/", [], []
        self.variables: dict[str, str] = {}

    def build(self, stage: Stage) -> None:
        for name, value in stage.instructions:
            getattr(self, f"_do_{name.lower()}")(value)

    def run(self, *words: str, timeout: float = 900) -> subprocess.CompletedProcess:
        """A container: the entry point with these words, or with CMD."""
        return self._run([*self.entrypoint, *(words or self.command)], timeout)

    def _run(self, words: list[str], timeout: float) -> subprocess.CompletedProcess:
        user, group = self.user.split(":")
        entries = (line.split(":") for line in (self.bare.root / "etc" / "passwd").read_text().splitlines())
        (home,) = [entry[5] for entry in entries if entry[2] == user]
        assignments = [f"{key}={value}" for key, value in ({"HOME": home} | self.variables).items()]
        become = ["setpriv", f"--reuid={user}", f"--regid={group}", "--clear-groups"]
        return self.bare.run(*become, "env", f"--chdir={self.folder}", *assignments, *words, timeout=timeout)

    def _do_copy(self, value: str) -> None:
        source, target = value.split()
        there = self.bare.root / str(Path(self.folder, target)).lstrip("/")
        if source == ".":
            there.rmdir()
            copy_project(there)
            return
        there.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(self.context / source, there)

    def _do_run(self, value: str) -> None:
        options, command = re.fullmatch(r"((?:--\S+ +)*)(.*)", value).groups()
        copies = []
        for option in options.split():
            kind, target, stage, source = (
                dict(part.split("=", 1) for part in option.removeprefix("--mount=").split(",")).get(key, "")
                for key in ("type", "target", "from", "source")
            )
            assert kind in ("bind", "cache"), f"{kind} is a mount that this helper does not know"
            if kind == "cache":
                (self.bare.root / target.lstrip("/")).mkdir(exist_ok=True)
                continue
            copies.append(self.bare.root / target.lstrip("/"))
            shutil.copytree(self.mounts[stage, source], copies[-1])
        result = self._run(["/bin/sh", "-c", command], 5400)
        assert result.returncode == 0, f"RUN {value}: {result.stdout[-3000:]}{result.stderr[-3000:]}"
        for copy in copies:
            shutil.rmtree(copy)

    def _do_user(self, value: str) -> None:
        self.user = value

    def _do_workdir(self, value: str) -> None:
        self.folder = value
        (self.bare.root / value.lstrip("/")).mkdir(parents=True, exist_ok=True)

    def _do_env(self, value: str) -> None:
        self.variables |= dict(part.split("=", 1) for part in shlex.split(value))

    def _do_entrypoint(self, value: str) -> None:
        self.entrypoint = json.loads(value)

    def _do_cmd(self, value: str) -> None:
        self.command = json.loads(value)
