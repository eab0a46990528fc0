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
import wall_clock

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
    for name in (".clang-format", ".clang-tidy", ".codespellrc", "mypy.ini", "ruff.toml"):
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
        (
            "text",
            "a.cpp",
            LICENCE + "/// Steps. Real-time safe.\n",
            LICENCE + "/// Steps. Real-time safe: no lock.\n",
        ),
        (
            "text",
            "a.cpp",
            LICENCE + "const auto number = readNumber(text);\n",
            LICENCE + "const double number = std::stod(text);\n",
        ),
        (
            "text",
            "a.cpp",
            LICENCE + 'std::snprintf(a, n, "%i", i);\nstd::printf("%g", x);\n',
            LICENCE + 'std::snprintf(a, n,\n              "%i %.3f", i, x);\n',
        ),
        (
            "text",
            "a.cpp",
            LICENCE + 'ROS_ERROR("%s: 5 % of %i", name, i);\n',
            LICENCE + 'ROS_WARN_NAMED(kLog,\n  "%s; " "%g", name, x);\n',
        ),
        (
            "text",
            "a.cpp",
            LICENCE + "localtime_r(&now, &parts);\n",
            LICENCE + "parts = *std::localtime(&now);\n",
        ),
        ("text", "a.md", "# The center of mass\n", "# The centre of mass\n"),
        ("ruff", "a.py", "import os\n\nprint(os.name)\n", "import os\n"),
        ("ruff", "program", "#!/usr/bin/env python3\nprint(1)\n", "#!/usr/bin/env python3\nprint( 1 )\n"),
        (
            "mypy",
            "program",
            "#!/usr/bin/env python3\nimport rospy\n\n\ndef rate() -> float:\n    return 1.0\n",
            "#!/usr/bin/env python3\nimport rospy\n\n\ndef rate():\n    return 1.0\n",
        ),
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


@pytest.mark.parametrize(
    "note",
    [
        "Called by one thread. Real-time safe.",
        "Waits. (At most 5 s.) Not real-time safe. Thread-safe.",
        "Thread-safe. Real-time safe. Exception: the constructor.",
        "Runs in the real-time thread.",
    ],
)
def test_fixed_note_on_threads_passes(note):
    assert list(style.note_findings("a.h", f"/// {note}\nint step();\n")) == []


@pytest.mark.parametrize(
    "note",
    [
        "Real-time safe; one thread.",
        "Steps. Real-time\n/// safe.",
        "Steps. Not\n/// real-time safe.",
        "read() is real-time safe.",
        "Real-time safe if copying is.",
        "Thread-safe, not real-time safe.",
        "Not thread-safe.",
        "Steps. Any thread.",
        "Safe in the 1 kHz loop.",
        "Sorts; not for the\n/// control loop.",
    ],
)
def test_other_note_on_threads_is_refused(note):
    findings = list(style.note_findings("a.h", f"/// {note}\nint step();\n"))
    assert findings and "is not one of the fixed notes" in findings[0]


@pytest.mark.parametrize(
    "line", ["constexpr int kMostClients = 8;", '"x" is no number', "// Starts anew.", "// Whoever calls it"]
)
def test_replaced_word_is_refused(line):
    findings = list(style.word_findings("a.h", f"{line}\n"))
    assert findings and "docs/glossary.md" in findings[0]


@pytest.mark.parametrize(
    "line", ["// There is no number.", "// It is no longer valid.", "// an almost full list"]
)
def test_similar_words_pass(line):
    assert list(style.word_findings("a.h", line)) == []


LAYERS = '"""Layers:\n\n    errors\n    robot, tokens\n    desk\n"""\n'
UPWARD = [
    "from pyfranka.desk.desk import Desk",
    "import pyfranka.desk.desk",
    "from pyfranka.desk import errors, desk",
    "from pyfranka.desk import Desk",
    "from .desk import Desk",
    "from . import desk",
    "if typing.TYPE_CHECKING:\n    from pyfranka.desk.desk import Desk",
    "def find():\n    from pyfranka.desk.desk import Desk",
    "desk = importlib.import_module('pyfranka.desk.desk')",
    "from pyfranka.desk.tokens import Tokens",  # right of it in its own layer
]


@pytest.mark.parametrize("lines", UPWARD)
def test_upward_import_in_desk_is_refused(lines):
    (finding,) = style.layer_findings("python/src/pyfranka/desk/robot.py", lines, LAYERS)
    assert "desk/robot.py" in finding and "does not list before robot" in finding


def test_downward_imports_in_desk_pass_and_an_unlisted_module_is_refused(repository, monkeypatch):
    repository.add(style.LAYERS, f"# {style.HEADER}\n{LAYERS}")
    lines = (
        "from pyfranka.desk import errors\nfrom pyfranka.desk.robot import Robot\nimport pyfranka.desktop\n"
    )
    text = f"# {style.HEADER}\n{lines}"
    repository.add("python/src/pyfranka/desk/desk.py", text)
    assert run("text", monkeypatch=monkeypatch) == 0
    repository.add("python/src/pyfranka/desk/unlisted.py", text)
    assert run("text", monkeypatch=monkeypatch) == 1


WALL_CLOCK = {  # tests whose verdict depends on the machine, and similar ones whose verdict does not
    ".py": (
        [
            "time.sleep(1.0)",
            "assert time.monotonic() - begin < 5",
            "assert 0.1 < time.perf_counter() - begin <= LIMIT",
            "took = time.monotonic() - begin; assert 2.5 > took",
            "took = time.monotonic() - begin; self.assertLess(took, 2.0)",
            "late.append(time.time() - begin); assert max(late) < 0.05",
            "time.sleep(0.01)  # between two looks",
            "while time.monotonic() < end: step()",
            "while not moves(): assert time.monotonic() < begin + 60",
        ],
        [
            "time.sleep(1.0)  # the fault itself",
            "while not moves(): times.append(time.monotonic())",
            "assert time.monotonic() - begin < 30",
            "assert time.monotonic() - begin > 0.5",
            "assert state.time - begin < 5",
            "assert time.monotonic() - begin < PATIENCE",
        ],
    ),
    ".cpp": (
        [
            "std::this_thread::sleep_for(milliseconds(1));",
            "EXPECT_LT(steady_clock::now() - begin, milliseconds(20));",
            "const auto took = steady_clock::now() - begin; ASSERT_LE(took, 2s);",
            "while (std::chrono::steady_clock::now() < end) { step(); }",
            "const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(60.0);",
        ],
        [
            "std::this_thread::sleep_for(kStall);  // the fault itself",
            "std::this_thread::sleep_until(next);  // the loop's period",
            "EXPECT_LT(steady_clock::now() - begin, std::chrono::seconds(30));",
            "EXPECT_GE(steady_clock::now() - begin, milliseconds(20));",
            "EXPECT_LT(state.time - begin, 2.0);",
        ],
    ),
}


@pytest.mark.parametrize("suffix", WALL_CLOCK)
def test_a_test_that_judges_the_wall_clock_is_refused(suffix):
    frame = {
        ".py": "LIMIT = 2.0\nPATIENCE = 40.0\n{}def test_arm(self):\n    {}\n",
        ".cpp": "{}(Arm{}, Moves) {{\n  {}\n}}\n",
    }[suffix]

    def found(line: str, realtime: bool = False, name: str = "test/arm_test") -> list[str]:
        if suffix == ".py":
            text = frame.format("@pytest.mark.realtime('pace')\n" * realtime, line)
        else:
            text = frame.format("TEST", "OnWallClock" * realtime, line)
        return list(wall_clock.findings(name + suffix, text))

    refused, accepted = WALL_CLOCK[suffix]
    for line in refused:
        assert len(found(line)) == 1, line
        assert not found(line, realtime=True) and not found(line, name="src/arm"), line
    for line in accepted:
        assert not found(line), line


def test_clang_tidy_fails_on_a_name_in_a_changed_file_only(repository, monkeypatch, capfd):
    monkeypatch.setenv("LC_NUMERIC", "C")  # clang-tidy 22 ends when it reads numbers with a decimal comma
    old = repository.add("old.cpp", "class old_name {};\n")
    new = repository.add("new.cpp", "class NewName {};\n")
    repository.describe_build(old, new)
    repository.commit()
    repository.commit()
    assert run("clang-tidy", monkeypatch=monkeypatch) == 0
    repository.add("new.cpp", "class new_name {};\n")
    assert run("clang-tidy", monkeypatch=monkeypatch) == 1
    printed = capfd.readouterr().out
    assert (
        "new.cpp:1:7: error: invalid case style for class 'new_name'" in printed and "old_name" not in printed
    )
    assert run("clang-tidy", "--long", monkeypatch=monkeypatch) == 1
    assert "old_name" in capfd.readouterr().out


def test_clang_tidy_without_a_build_fails_with_a_message(repository, monkeypatch, capsys):
    repository.commit()
    repository.add("new.cpp", "class NewName {};\n")
    assert run("clang-tidy", monkeypatch=monkeypatch) == 1
    assert "run ./franka build" in capsys.readouterr().err


DECLARED = """\
#include <stdexcept>
#include <string>
#include <vector>
namespace franka {
void limit();
void show() noexcept;
inline void check(int n) { if (n > 3) throw std::invalid_argument("n"); }
"""
ESCAPES = {  # a line, and what it calls
    "void shape() noexcept { limit(); }": "franka::shape is noexcept, but franka::limit may throw",
    "struct Motion { ~Motion() { limit(); } };": "franka::move is noexcept, but franka::limit may throw",
    "int third(const std::vector<int>& list) noexcept { return list.at(2); }": (
        "franka::third is noexcept, but std::__throw_out_of_range_fmt may throw"
    ),
    'void jump() noexcept { throw std::logic_error("j"); }': (
        "franka::jump is noexcept, but throw of std::logic_error may throw"
    ),
}
HARMLESS = [
    "void move() { Motion motion; show(); }",
    "void append(std::vector<int>& list) noexcept { list.push_back(1); show(); }",
    "void caught() noexcept { try { limit(); } catch (const std::exception&) {} }",
    "void swallowed() noexcept { try { limit(); } catch (...) {} }",
    "void thrower() { limit(); check(9); }",
    "void known(int n) noexcept { check(n); }  // NOLINT(nothrow): n is small",
]


def nothrow_findings(repository, lines, monkeypatch, capfd):
    source = repository.add("src/a.cpp", DECLARED + "\n".join([*lines, "}", ""]))
    # What tests do is their own matter.
    in_test = repository.add("src/test/a_test.cpp", source.read_text())
    repository.describe_build(source, in_test)
    status = run("nothrow", "--long", monkeypatch=monkeypatch)
    found = [line for line in capfd.readouterr().out.splitlines() if not line.startswith("nothrow: ")]
    assert (status == 0) == (found == [])
    return set(found)


def test_nothrow_names_each_noexcept_function_that_calls_what_throws(repository, monkeypatch, capfd):
    lines = [*ESCAPES, *HARMLESS, "void checked(int n) noexcept { check(n); }"]
    first = DECLARED.count("\n") + 1
    expected = {f"src/a.cpp:{first + i}: {what}" for i, what in enumerate(ESCAPES.values())}
    expected.add("src/a.cpp:7: franka::checked is noexcept, but throw of std::invalid_argument may throw")
    assert nothrow_findings(repository, lines, monkeypatch, capfd) == expected


def test_nothrow_passes_what_catches_throws_or_runs_out_of_memory(repository, monkeypatch, capfd):
    lines = ["struct Motion { ~Motion() { show(); } };", *HARMLESS]
    assert nothrow_findings(repository, lines, monkeypatch, capfd) == set()


def test_nothrow_reports_a_source_that_it_cannot_read(repository, monkeypatch, capfd):
    (found,) = nothrow_findings(repository, ["void shape() { unknown(); }"], monkeypatch, capfd)
    assert "a.cpp cannot be compiled by clang++-22" in found


def test_files_of_one_name_are_checked_one_after_the_other(repository):
    python = "#!/usr/bin/env python3\n"
    package = [repository.add(f"one/src/one/{name}.py", "") for name in ("__init__", "arm")]
    stub = repository.add("one/src/one/__init__.pyi", "")
    first, second = repository.add("one/scripts/arm", python), repository.add("two/scripts/arm", python)
    alone = repository.add("two/scripts/one", python + "from one import arm\n")
    files = [stub, *package, first, second, alone]
    assert style.without_clashes(files) == [[stub, package[1], first], [package[0], second], [alone]]


@pytest.mark.parametrize(
    "check, tool",
    [("ruff", "ruff"), ("mypy", "mypy"), ("clang-tidy", "clang-tidy-22"), ("nothrow", "clang++-22")],
)
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
    assert run("clang-tidy", monkeypatch=monkeypatch) == 1
    assert run("nothrow", "--long", monkeypatch=monkeypatch) == 1
    monkeypatch.setenv("CI", "true")
    assert run("nothrow", monkeypatch=monkeypatch) == 1


def test_folder_that_is_not_a_clone_fails_with_a_message(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(style, "TOP", tmp_path)
    assert run("text", monkeypatch=monkeypatch) == 1
    assert "git lists no files here" in capsys.readouterr().err


def test_unknown_check_is_refused_with_a_list_of_checks(monkeypatch, capsys):
    with pytest.raises(SystemExit) as ending:
        run("pylint", monkeypatch=monkeypatch)
    assert ending.value.code == 2
    printed = capsys.readouterr().err
    assert "no check pylint" in printed and "clang-tidy" in printed


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
