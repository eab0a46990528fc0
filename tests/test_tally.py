# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The tests' own summary: results of gtest and pytest are counted, and skips need an allowed reason."""

import subprocess
import sys
from pathlib import Path

import pytest
from tally import Case, Tally, cases_of, is_allowed

TOP = Path(__file__).resolve().parent.parent
# As GoogleTest 1.12 writes it; newer versions name more attributes.
GTEST = """<?xml version="1.0" encoding="UTF-8"?>
<testsuites tests="3" failures="0" name="AllTests"><testsuite name="Arm" tests="3">
  <testcase name="Moves" status="run" result="completed" time="0.1" classname="Arm" />
  <testcase name="Searches" status="run" result="skipped" time="0" classname="Arm">
    <skipped message="../test/arm_test.cpp:7&#x0A;{reason}"><![CDATA[../test/arm_test.cpp:7
{reason}]]></skipped>
  </testcase>
</testsuite></testsuites>
"""
PYTEST = """
import pytest
def test_moves(): pass
def test_skipped(): pytest.skip("{reason}")
@pytest.mark.long_form("searches for an hour")
def test_long(): assert False
"""
WHOLE_FILE = 'import pytest\npytest.skip("{reason}", allow_module_level=True)\n'


@pytest.fixture(autouse=True)
def gate(monkeypatch):
    """Not CI, and not the long form, in which a missing package is a failure."""
    for name in ("CI", "FRANKA_TEST_LONG"):
        monkeypatch.delenv(name, raising=False)


def tally_of(path: Path) -> Tally:
    return Tally(cases_of(path))


def gtest(folder: Path, reason: str) -> Tally:
    file = folder / "gtest-arm.xml"
    file.write_text(GTEST.format(reason=reason))
    return tally_of(file)


def run_pytest(folder: Path, text: str) -> Tally:
    (folder / "test_arm.py").write_text(text)
    results = folder / "results.xml"
    command = [sys.executable, "-m", "pytest", f"--rootdir={TOP}", f"--confcutdir={TOP}", "-q"]
    command += ["-c", TOP / "pytest.ini", "-p", "no:hypothesispytest", f"--junitxml={results}"]
    # The project's conftest.py is not a parent of the folder.
    subprocess.run([*command, "-p", "conftest", folder / "test_arm.py"], cwd=TOP, timeout=120, check=False)
    return tally_of(results)


@pytest.mark.parametrize(
    ("reason", "forms"),
    [
        ("assimp is not installed", {"gate"}),
        ("chromium and chromedriver are not installed: run ./franka install test", {"gate"}),
        ("PyPI has no wheel of panda-python==1.1.1 for Python 3.13.5", {"gate", "CI"}),
        ("takes 20 s: ./franka test --long", {"gate", "CI"}),
        ("only root can make a bare Debian: run ./franka test --long as root", set()),
        ("no reason", set()),
        ("not installed", set()),
    ],
)
def test_a_reason_is_allowed_in_some_forms(reason, forms, monkeypatch):
    for form, variable in (("gate", {}), ("CI", {"CI": "true"}), ("long", {"FRANKA_TEST_LONG": "1"})):
        with monkeypatch.context() as environment:
            for name, value in variable.items():
                environment.setenv(name, value)
            assert is_allowed(reason) == (form in forms), form


def test_skips_of_gtest_are_counted_by_reason(tmp_path):
    tally = gtest(tmp_path, "searches for half a minute: ./franka test --long")
    assert (tally.passed, tally.failed) == (1, [])
    (skipped,) = [case for case in tally.cases if case.verdict == "skipped"]
    assert skipped.reason == "searches for half a minute: ./franka test --long"
    assert skipped.name.endswith(": Arm.Searches")


def test_a_skip_of_gtest_for_another_reason_fails(tmp_path):
    tally = gtest(tmp_path, "the machine stalled")
    assert tally.passed == 1
    (failure,) = tally.failed
    assert "Arm.Searches" in failure and failure.endswith(
        "skipped for a reason that is not allowed: the machine stalled"
    )


def test_a_disabled_test_of_gtest_fails(tmp_path):
    file = tmp_path / "gtest-arm.xml"
    file.write_text('<testsuites><testsuite><testcase name="Off" status="notrun"/></testsuite></testsuites>')
    assert len(tally_of(file).failed) == 1


def test_skips_of_pytest_are_counted_by_reason(tmp_path):
    tally = run_pytest(tmp_path, PYTEST.format(reason="assimp is not installed"))
    assert (tally.passed, tally.failed) == (1, [])
    assert {case.reason for case in tally.cases if case.verdict == "skipped"} == {
        "assimp is not installed",
        "searches for an hour: ./franka test --long",
    }


@pytest.mark.parametrize("text", [PYTEST, WHOLE_FILE])
def test_a_skip_of_pytest_for_another_reason_fails(text, tmp_path):
    tally = run_pytest(tmp_path, text.format(reason="it's the machine"))
    (failure,) = tally.failed
    assert failure.endswith("is skipped for a reason that is not allowed: it's the machine")


def test_a_table_lists_how_many_tests_each_reason_skips():
    a, d = "a is not installed", "d is not installed"
    skips = [("one: A.b", a), ("two: D.e", d), ("one: A.c", a)]
    tally = Tally([Case(name, "skipped", reason=reason) for name, reason in skips])
    assert tally.table_of_skips() == [
        "3 skipped:",
        "    2  a is not installed  one: A.b",
        "    1  d is not installed  two: D.e",
    ]
    assert Tally().table_of_skips() == []


def test_a_broken_result_file_fails(tmp_path):
    file = tmp_path / "broken.xml"
    file.write_text("<testsuites>")
    assert len(tally_of(file).failed) == 1
