# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The loop's functions, built with the RealtimeSanitizer (clang 20 and later).

It ends the program at the first allocation, lock or blocking system call below a function marked
nonblocking, also inside libraries. Without such a compiler only guard_test.cpp checks this.
"""

import pathlib
import shutil
import subprocess

import pytest

TEST = pathlib.Path(__file__).parent
PACKAGES = TEST.parents[1]
SOURCES = [
    TEST / "realtime_sanitizer_program.cpp",
    *(
        TEST.parent / "src" / name
        for name in ("command_guard.cpp", "controller_watch.cpp", "switch_request.cpp")
    ),
]
INCLUDES = [
    f"-I{PACKAGES / package / 'include'}"
    for package in (
        "boost_bind_compat",
        "controller_interface",
        "controller_manager",
        "hardware_interface",
        "realtime_tools",
    )
]
LIBRARIES = ["-lroscpp", "-lrosconsole", "-lrostime", "-lpthread"]
COMPILERS = ["clang++", *(f"clang++-{version}" for version in range(30, 19, -1))]


def accepts(compiler, folder):
    probe = folder / "probe.cpp"
    probe.write_text("int main() { return 0; }\n", encoding="utf-8")
    command = [compiler, "-fsanitize=realtime", str(probe), "-o", str(folder / "probe")]
    return subprocess.run(command, capture_output=True, check=False, timeout=60).returncode == 0


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """Built from all sources as one, because the compiler needs seconds for the headers."""
    folder = tmp_path_factory.mktemp("realtime_sanitizer")
    found = [name for name in COMPILERS if shutil.which(name) and accepts(name, folder)]
    if not found:
        pytest.skip("clang-20 or newer, which accepts -fsanitize=realtime, is not installed")
    (folder / "program.cpp").write_text("".join(f'#include "{source}"\n' for source in SOURCES))
    compiler = [found[0], "-fsanitize=realtime"]
    launcher = ["ccache"] if shutil.which("ccache") else []
    for command in (
        [*launcher, *compiler, "-std=c++17", "-O1", *INCLUDES, "-c", "program.cpp"],
        [*compiler, "program.o", "-o", "program", *LIBRARIES],
    ):
        build = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=800)
        assert build.returncode == 0, build.stderr
    return folder / "program"


def run(*command):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False, timeout=60)


def test_the_sanitizer_sees_an_allocation(program):
    result = run(program, "misbehave")
    assert result.returncode != 0, result.stdout
    assert "malloc" in result.stderr


def test_the_loop_neither_allocates_nor_blocks(program):
    result = run(program)
    assert result.returncode == 0, result.stdout + result.stderr
    assert result.stdout == "done\n"
