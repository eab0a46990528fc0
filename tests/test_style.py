# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The style checks themselves, one case each, on small repositories."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import style

TOP = Path(__file__).resolve().parent.parent
LICENSE = f"// {style.HEADER}\n// SPDX-License-Identifier: Apache-2.0\n"
PYTHON = f"# {style.HEADER}\n"
HOMES = "/home"
LAYERS = """[importlinter]
root_package = arms

[importlinter:contract:arms]
name = Layers
type = layers
containers = arms
layers =
    robot
    errors
"""


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
    for name in (".clang-format", ".clang-tidy", ".codespellrc", "mypy.ini", "ruff.toml"):
        shutil.copy(TOP / name, tmp_path)
    return Repository(tmp_path)


def run(*arguments: str, monkeypatch) -> int:
    monkeypatch.setattr(sys, "argv", ["style.py", *arguments])
    return style.main()


TEXTS = [  # a rule of ours: a file, lines that it accepts, and those that it refuses
    ("a.h", "#pragma once", ""),
    ("catkin_ws/src/libfranka/a.cpp", "#include <franka/robot.h>", "#include <ros/ros.h>"),
    ("a.cpp", "/// Steps. Real-time safe.", "/// Steps. Real-time\n/// safe: no lock."),
    ("a.cpp", "const auto number = readNumber(text);", "const double number = std::stod(text);"),
    ("a.cpp", 'std::printf("%g", x);', 'std::snprintf(a, n,\n              "%i %.3f", i, x);'),
    ("a.cpp", "localtime_r(&now, &parts);", "parts = *std::localtime(&now);"),
    ("a.cpp", "int i = 0;", "int i = 0;  // TODO"),
    ("a.cpp", "// The center. There is no number.", '// The centre.\n// "x" is no number.'),
    ("a.cpp", 'open("/tmp/file");', f'open("{HOMES}/me/file");'),
]
TESTS = [  # the same of tests that judge the wall clock (wall_clock.py)
    ("time.sleep(1.0)  # the fault itself", "time.sleep(1.0)"),
    ("assert time.monotonic() - begin < 30", "assert time.monotonic() - begin < 5"),
    ("while not moves(): times.append(time.time())", "while time.monotonic() < end: step()"),
    ("sleep_until(next);  // the loop's period", "std::this_thread::sleep_for(milliseconds(1));"),
    ("EXPECT_LT(steady_clock::now() - begin, 30s);", "EXPECT_LT(steady_clock::now() - begin, 2s);"),
    ("while (steps < 5) { step(); }", "while (std::chrono::steady_clock::now() < end) { step(); }"),
]


def own_rules():
    for name, clean, dirty in TEXTS:
        yield name, f"{LICENSE}{clean}\n", f"{LICENSE}{dirty}\n"
    for clean, dirty in TESTS[:3]:
        yield "test/test_arm.py", *(f"{PYTHON}def test_arm():\n    {line}\n" for line in (clean, dirty))
    for clean, dirty in TESTS[3:]:
        yield "test/arm_test.cpp", *(f"{LICENSE}TEST(Arm, Moves) {{\n{line}\n}}\n" for line in (clean, dirty))


@pytest.mark.parametrize(
    "check, name, clean, dirty",
    [
        *(("text", *rule) for rule in own_rules()),
        ("text", "b.cpp", LICENSE, "int i = 0;\n"),
        ("ruff", "a.py", "import os\n\nprint(os.name)\n", "import os\n"),
        ("ruff", "a.py", "a = 1\n", "a = 1  # TODO\n"),
        ("ruff", "program", "#!/usr/bin/env python3\nprint(1)\n", "#!/usr/bin/env python3\nprint( 1 )\n"),
        (
            "mypy",
            "program",
            "#!/usr/bin/env python3\nimport rospy\n\n\ndef rate() -> float:\n    return 1.0\n",
            "#!/usr/bin/env python3\nimport rospy\n\n\ndef rate():\n    return 1.0\n",
        ),
        ("imports", "python/src/arms/errors.py", "", "def find():\n    from arms.robot import Robot\n"),
        ("clang-format", "a.cpp", "int a = 1;\n", "int a=1;\n"),
        ("shellcheck", "script", '#!/bin/sh\necho "$1"\n', "#!/bin/sh\necho $1\n"),
        ("codespell", "a.md", "the word and numberIn\n", "teh word\n"),  # codespell:ignore
    ],
)
def test_check_passes_clean_file_and_fails_dirty_one(repository, check, name, clean, dirty, monkeypatch):
    if check == "imports":
        repository.add(".importlinter", LAYERS)
        for module in ("__init__", "robot"):
            repository.add(f"python/src/arms/{module}.py", "")
    repository.add(name, clean)
    assert run(check, monkeypatch=monkeypatch) == 0
    repository.add(name, dirty)
    assert run(check, monkeypatch=monkeypatch) == 1


def test_clang_tidy_fails_on_a_name_in_a_changed_file_only(repository, monkeypatch, capfd):
    monkeypatch.setenv("LC_NUMERIC", "C")  # clang-tidy 22 ends when it reads numbers with a decimal comma
    old = repository.add("old.cpp", "class old_name {};\n")
    including = '#include "tests/through.h"\n'
    new = repository.add("new.cpp", including)
    repository.add("tests/through.h", '#pragma once\n#include "shared.h"\n')
    repository.add("tests/shared.h", "#pragma once\n")
    repository.describe_build(old, new)
    repository.commit()
    repository.commit()
    assert run("clang-tidy", monkeypatch=monkeypatch) == 0
    for shown in ("class new_name {};\n", ""):  # a header that others include is seen where they are
        repository.add("new.cpp", including + shown)
        repository.add("tests/shared.h", "#pragma once\n" + ("" if shown else "class new_name {};\n"))
        assert run("clang-tidy", monkeypatch=monkeypatch) == 1
        printed = capfd.readouterr().out
        assert "invalid case style for class 'new_name'" in printed and "old_name" not in printed
    assert run("clang-tidy", "--long", monkeypatch=monkeypatch) == 1
    assert "old_name" in capfd.readouterr().out


NOTHROW = """\
#include <stdexcept>
#include <vector>
namespace franka {
void limit();
void show() noexcept;
void shape() noexcept { limit(); }
struct Motion { ~Motion() { limit(); } };
int third(const std::vector<int>& list) noexcept { return list.at(2); }
void jump() noexcept { throw std::logic_error("j"); }
void move() { Motion motion; show(); }
void append(std::vector<int>& list) noexcept { list.push_back(1); }
void caught() noexcept { try { limit(); } catch (const std::exception&) {} }
void known() noexcept { limit(); }  // NOLINT(nothrow): it does not throw here
}
"""
ESCAPES = {  # by the lines of NOTHROW
    6: "franka::shape is noexcept, but franka::limit may throw",
    7: "franka::move is noexcept, but franka::limit may throw",
    8: "franka::third is noexcept, but std::__throw_out_of_range_fmt may throw",
    9: "franka::jump is noexcept, but throw of std::logic_error may throw",
}


def test_nothrow_names_each_noexcept_function_that_calls_what_throws(repository, monkeypatch, capfd):
    source = repository.add("src/a.cpp", NOTHROW)
    in_test = repository.add("src/test/a_test.cpp", NOTHROW)  # what tests do is not checked
    repository.describe_build(source, in_test)
    assert run("nothrow", "--long", monkeypatch=monkeypatch) == 1
    found = [line for line in capfd.readouterr().out.splitlines() if not line.startswith("nothrow: ")]
    assert set(found) == {f"src/a.cpp:{line}: {what}" for line, what in ESCAPES.items()}


@pytest.mark.parametrize("check, tool", [("ruff", "ruff"), ("nothrow", "clang++-22")])
def test_missing_tool_fails_with_a_message(repository, check, tool, monkeypatch, capsys):
    repository.add("a.py", "")
    monkeypatch.setattr(sys, "executable", str(repository.folder / "python3"))
    monkeypatch.setattr(style, "VENV", repository.folder)
    monkeypatch.setattr(style.shutil, "which", lambda name: None)
    assert run(check, monkeypatch=monkeypatch) == 1
    assert f"{tool} is missing: run ./franka install test" in capsys.readouterr().err


def test_a_check_whose_tool_debian_lacks_is_a_skip_but_in_ci(repository, monkeypatch, capsys):
    repository.add("a.py", "")
    monkeypatch.delenv("CI", raising=False)
    lacking = repository.folder / "not_in_debian"
    lacking.write_text("clang-22\n")
    monkeypatch.setattr(style, "NOT_IN_DEBIAN", lacking)
    monkeypatch.setattr(style.shutil, "which", lambda name: None)
    skips = repository.folder / "skips"
    assert run("nothrow", f"--skips={skips}", monkeypatch=monkeypatch) == 0
    assert skips.read_text() == "nothrow\tclang-22 is not installed: this Debian does not have it\n"
    assert "clang-22 is not installed" in capsys.readouterr().err
    assert run("nothrow", "--long", monkeypatch=monkeypatch) == 1
    monkeypatch.setenv("CI", "true")
    assert run("nothrow", monkeypatch=monkeypatch) == 1
