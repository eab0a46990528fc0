# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The style checks themselves, on small repositories."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import style

TOP = Path(__file__).resolve().parent.parent
LICENCE = f"// {style.HEADER}\n// SPDX-License-Identifier: Apache-2.0\n"


class Repository:
    """A git repository whose files the checks read instead of ours."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.git("init", "-q", "-b", "main")
        self.git("config", "user.name", "test")
        self.git("config", "user.email", "test@example.org")

    def git(self, *arguments: str) -> str:
        command = ["git", *arguments]
        return subprocess.run(
            command, cwd=self.folder, check=True, capture_output=True, text=True
        ).stdout.strip()

    def add(self, name: str, text: str) -> Path:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        self.git("add", name)
        return path

    def commit(self) -> str:
        self.git("commit", "-q", "--allow-empty", "-m", "change")
        return self.git("rev-parse", "HEAD")

    def describe_build(self, *files: Path) -> None:
        commands = [{"directory": str(self.folder), "file": str(f), "command": f"c++ -c {f}"} for f in files]
        (self.folder / "compile_commands.json").write_text(json.dumps(commands))


@pytest.fixture
def repository(tmp_path, monkeypatch):
    monkeypatch.setattr(style, "TOP", tmp_path)
    monkeypatch.setattr(style, "COMPILE_COMMANDS", tmp_path / "compile_commands.json")
    for name in (".clang-format", ".clang-tidy", ".codespellrc", "ruff.toml"):
        shutil.copy(TOP / name, tmp_path)
    return Repository(tmp_path)


def run(*arguments: str, monkeypatch) -> int:
    monkeypatch.setattr(sys, "argv", ["style.py", *arguments])
    return style.main()


@pytest.mark.parametrize(
    "check, name, clean, dirty",
    [
        ("text", "a.h", LICENCE + "#pragma once\n", LICENCE),
        ("text", "catkin_ws/src/libfranka/a.cpp", LICENCE, LICENCE + "#include <ros/ros.h>\n"),
        ("ruff", "a.py", "import os\n\nprint(os.name)\n", "import os\n"),
        ("ruff", "program", "#!/usr/bin/env python3\nprint(1)\n", "#!/usr/bin/env python3\nprint( 1 )\n"),
        ("clang-format", "a.cpp", "int a = 1;\n", "int a=1;\n"),
        ("shellcheck", "script", '#!/bin/sh\necho "$1"\n', "#!/bin/sh\necho $1\n"),
        ("codespell", "a.md", "the word and numberIn\n", "teh word\n"),  # codespell:ignore
    ],
)
def test_check_passes_clean_file_and_fails_dirty_one(repository, check, name, clean, dirty, monkeypatch):
    repository.add(name, clean)
    assert run(check, monkeypatch=monkeypatch) == 0
    repository.add(name, dirty)
    assert run(check, monkeypatch=monkeypatch) == 1


def test_clang_tidy_fails_on_a_name_in_a_changed_file_only(repository, monkeypatch, capfd):
    old = repository.add("old.cpp", "class old_name {};\n")
    new = repository.add("new.cpp", "class NewName {};\n")
    repository.describe_build(old, new)
    repository.commit()
    repository.commit()
    assert run("clang-tidy", monkeypatch=monkeypatch) == 0
    repository.add("new.cpp", "class new_name {};\n")
    assert run("clang-tidy", monkeypatch=monkeypatch) == 1
    said = capfd.readouterr().out
    assert "new.cpp:1:7: error: invalid case style for class 'new_name'" in said and "old_name" not in said
    assert run("clang-tidy", "--long", monkeypatch=monkeypatch) == 1
    assert "old_name" in capfd.readouterr().out


def test_clang_tidy_without_a_build_fails_with_a_message(repository, monkeypatch, capsys):
    repository.commit()
    repository.add("new.cpp", "class NewName {};\n")
    assert run("clang-tidy", monkeypatch=monkeypatch) == 1
    assert "run ./franka build" in capsys.readouterr().err


@pytest.mark.parametrize("check, tool", [("ruff", "ruff"), ("clang-tidy", "clang-tidy-22")])
def test_missing_tool_fails_with_a_message(repository, check, tool, monkeypatch, capsys):
    repository.add("a.py", "")
    monkeypatch.setattr(sys, "executable", str(repository.folder / "python3"))
    monkeypatch.setattr(style, "VENV", repository.folder)
    monkeypatch.setattr(style.shutil, "which", lambda name: None)
    assert run(check, monkeypatch=monkeypatch) == 1
    assert f"{tool} is missing: run ./franka install" in capsys.readouterr().err


def test_folder_that_is_not_a_clone_fails_with_a_message(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(style, "TOP", tmp_path)
    assert run("text", monkeypatch=monkeypatch) == 1
    assert "git lists no files here" in capsys.readouterr().err


def test_unknown_check_is_refused_with_a_list_of_checks(monkeypatch, capsys):
    with pytest.raises(SystemExit) as ending:
        run("pylint", monkeypatch=monkeypatch)
    assert ending.value.code == 2
    said = capsys.readouterr().err
    assert "no check pylint" in said and "clang-tidy" in said


def test_changes_count_from_the_merge_base(repository):
    first = repository.commit()
    assert style.base_commit() == first  # there is no earlier commit
    repository.git("update-ref", "refs/remotes/origin/main", first)
    second = repository.commit()
    repository.commit()
    assert style.base_commit() == first
    repository.git("update-ref", "-d", "refs/remotes/origin/main")
    assert style.base_commit() == second


def test_changed_header_is_checked_with_the_source_of_its_name_in_its_package(repository):
    for package in ("one", "two"):
        repository.add(f"{package}/package.xml", "<package/>")
    header = repository.add("one/include/one/arm.h", "")
    sources = {
        repository.add(f"{package}/src/{name}.cpp", "") for package in ("one", "two") for name in ("arm", "b")
    }
    assert style.units_of([header], sources) == [repository.folder / "one/src/arm.cpp"]
