# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The tests' own summary: results of gtest and pytest are counted, and skips need an allowed reason."""

import subprocess
import sys
from pathlib import Path

import pytest
from tally import Tally, cases_of, is_allowed

TOP = Path(__file__).resolve().parent.parent


@pytest.fixture(autouse=True)
def gate(monkeypatch):
    """Not CI, and not the long form, in which a missing package is a failure."""
    for name in ("CI", "FRANKA_TEST_LONG"):
        monkeypatch.delenv(name, raising=False)


@pytest.mark.parametrize(
    ("reason", "forms"),
    [
        ("assimp is not installed", {"gate"}),
        ("PyPI has no wheel of panda-python==1.1.1 for Python 3.13.5", {"gate", "CI"}),
        ("takes 20 s: ./franka test --long", {"gate", "CI"}),
        ("only root can make a bare Debian: run ./franka test --long as root", set()),
        ("no reason", set()),
    ],
)
def test_a_reason_is_allowed_in_some_forms(reason, forms, monkeypatch):
    for form, variable in (("gate", {}), ("CI", {"CI": "true"}), ("long", {"FRANKA_TEST_LONG": "1"})):
        with monkeypatch.context() as environment:
            for name, value in variable.items():
                environment.setenv(name, value)
            assert is_allowed(reason) == (form in forms), form


GTEST = """<testsuites><testsuite name="Arm">
  <testcase name="Moves" status="run" classname="Arm" />
  <testcase name="Searches" status="run" result="skipped" classname="Arm">
    <skipped message="../test/arm_test.cpp:7&#x0A;{reason}" />
  </testcase>
</testsuite></testsuites>
"""
PYTEST = """
import pytest
def test_moves(): pass
def test_skipped(): pytest.skip("{reason}")
"""


def pytest_results(folder: Path, text: str) -> Path:
    (folder / "test_arm.py").write_text(text)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:hypothesispytest", "-c", TOP / "pytest.ini"]
    command += [f"--rootdir={TOP}", f"--junitxml={folder / 'results.xml'}", folder / "test_arm.py"]
    subprocess.run(command, cwd=TOP, timeout=120, check=False)
    return folder / "results.xml"


@pytest.mark.parametrize("kind", ["gtest", "pytest"])
@pytest.mark.parametrize("reason", ["assimp is not installed", "the machine stalled"])
def test_a_skip_is_counted_by_its_reason_or_fails(kind, reason, tmp_path):
    if kind == "gtest":
        results = tmp_path / "results.xml"
        results.write_text(GTEST.format(reason=reason))
    else:
        results = pytest_results(tmp_path, PYTEST.format(reason=reason))
    tally = Tally(cases_of(results))
    assert tally.passed == 1
    if is_allowed(reason):
        assert not tally.failed and f"    1  {reason}" in "\n".join(tally.table_of_skips())
    else:
        assert [name.rpartition(": ")[2] for name in tally.failed] == [reason]
