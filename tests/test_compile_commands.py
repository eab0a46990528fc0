# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""How the workspace is built: several sources of a library at a time, named in compile_commands.json."""

import importlib.util
import json
import subprocess
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
WORKSPACE = TOP / "catkin_ws"


def module():
    spec = importlib.util.spec_from_file_location("compile_commands", WORKSPACE / "compile_commands.py")
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


def test_an_entry_of_several_sources_becomes_one_for_each(tmp_path):
    several = tmp_path / "Unity" / "unity_0_cxx.cxx"
    several.parent.mkdir()
    several.write_text('/* made by CMake */\n\n#include "/a/one.cpp"\n\n#include "/a/two.cpp"\n')
    alone = {"directory": "/b", "command": "c++ -c /a/three.cpp", "file": "/a/three.cpp"}
    entry = {"directory": "/b", "command": f"c++ -O3 -c {several}", "file": str(several)}
    commands = tmp_path / "compile_commands.json"
    commands.write_text(json.dumps([alone, entry]))
    module().main(commands)
    expected = [
        alone,
        *(
            {"directory": "/b", "command": f"c++ -O3 -c /a/{name}.cpp", "file": f"/a/{name}.cpp"}
            for name in ("one", "two")
        ),
    ]
    assert json.loads(commands.read_text()) == expected
    module().main(commands)  # a build that does not configure again
    assert json.loads(commands.read_text()) == expected


def test_the_workspaces_file_names_the_sources_of_its_libraries():
    files = {entry["file"] for entry in json.loads((TOP / "compile_commands.json").read_text())}
    assert not [name for name in files if "/Unity/" in name]
    for source in ("libfranka/src/franka/robot.cpp", "franka_sim/src/app/main.cpp"):
        assert str(WORKSPACE / "src" / source) in files


def test_cmake_runs_again_when_a_message_changes_and_no_program_checks_them_in_each_build():
    query = ["ninja", "-C", WORKSPACE / "build", "-t", "query", "build.ninja"]
    inputs = subprocess.check_output(query, text=True, timeout=60)
    messages = [path for kind in ("msg", "srv") for path in (WORKSPACE / "src").glob(f"**/{kind}/*.{kind}")]
    assert len(messages) > 50 and not [path for path in messages if str(path) not in inputs]
    assert "genmsg_check_deps" not in (WORKSPACE / "build" / "build.ninja").read_text()
