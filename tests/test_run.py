# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The runner of the tests: programs that die or hang are failures, flaky cases are told from failed ones."""

import socket
import subprocess
import sys
import textwrap
from pathlib import Path

import programs
import pytest
import run
from tally import Tally

TOP = Path(__file__).resolve().parent.parent
DIES = {
    "by a signal": "import os\ndef test_dies(): os.kill(os.getpid(), 9)\n",
    "with status 0": "import os\ndef test_dies(): os._exit(0)\n",
    "before its cases": "import sys\nsys.exit(0)\n",
    "without a case": "",
}
# Fails the first time.
FLAKY = """
from pathlib import Path
def test_passes(): pass
def test_flaky():
    mark = Path(__file__).with_name("mark")
    there = mark.exists()
    mark.touch()
    assert there
def test_fails(): assert {passes}
"""
PASSED = '<testsuite><testcase classname="Arm" name="Moves" status="run"/></testsuite>'


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A folder that the runner takes for the project's."""
    for module in (programs, run):
        monkeypatch.setattr(module, "TOP", tmp_path)
    monkeypatch.setattr(run, "BUILD", tmp_path)
    monkeypatch.setattr(run, "PYTEST_RESULTS", tmp_path)
    monkeypatch.setattr(run, "HISTORY", tmp_path / "history.jsonl")
    return tmp_path


def run_file(project: Path, text: str) -> Tally:
    """What the runner finds in a file of pytest, with the stage `again`."""
    file = project / "test_arm.py"
    file.write_text(text)
    return finished({}, [file])


def finished(tests: dict, files: list[Path]) -> Tally:
    cases = run.run_all(tests, files)
    flaky = run.run_again(cases)
    return Tally([case for found in cases.values() for case in found], flaky)


@pytest.mark.parametrize("how", DIES)
def test_a_pytest_that_dies_is_a_failure(how, project):
    tally = run_file(project, DIES[how])
    assert any("test_arm" in name for name in tally.failed) and tally.passed == 0
    assert tally.lines()[-1] == f"0 passed, {len(tally.failed)} failed"


@pytest.mark.parametrize("passes", [True, False])
def test_a_case_that_failed_runs_once_more_alone(passes, project):
    tally = run_file(project, FLAKY.format(passes=passes))
    if passes:
        assert not tally.failed and tally.passed == 3
        (flaky,) = tally.flaky
        assert f"FLAKY {flaky}" in tally.lines() and flaky.endswith("test_arm.test_flaky")
        assert "2 passed" not in tally.lines()[-1]
    else:
        assert any(name.endswith("test_fails") for name in tally.failed)


@pytest.mark.parametrize(
    "failure",
    [
        "os.kill(os.getpid(), 11)",
        "raise AssertionError('ERROR: ThreadSanitizer: data race')",
        "raise AssertionError('the node ended with SIGABRT')",
    ],
)
def test_what_dies_does_not_run_again(failure, project):
    text = f"import os\nif not there: {failure}"
    tally = run_file(project, FLAKY.format(passes=True).replace("assert there", text.replace("\n", "\n    ")))
    assert tally.failed and not tally.flaky


def test_a_case_that_is_flaky_in_two_of_ten_runs_is_red(project, monkeypatch):
    name, other = "tests: often", "tests: once"
    for number in range(12):
        monkeypatch.setattr(run.time, "time", lambda number=number: number)
        flaky = [name] if number == 2 else [other]
        cases = [run.Case(each, "passed") for each in (name, other)]
        assert run.often_flaky([name]) == ([name] if 2 < number < 12 else [])
        run.write_history(Tally(cases, flaky))
    assert run.often_flaky([name, other]) == [other]


FORMS = """
import pytest
def test_of_the_gate(): pass
@pytest.mark.long_form("a soak")
def test_long(): pass
@pytest.mark.realtime("pace")
def test_realtime(): pass
"""


ALONE = """
import socket
import own_network
why_not = own_network.enter()
print(why_not or socket.create_server(("127.0.0.1", {port})).getsockname()[1])
"""


def test_the_gate_has_a_network_of_its_own(monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(TOP / "tests" / "support"))
    with socket.create_server(("127.0.0.1", 0)) as server:
        for port in (server.getsockname()[1], 443):  # one that is taken outside, and one of root
            printed = subprocess.check_output([sys.executable, "-c", ALONE.format(port=port)], text=True)
            assert printed.strip() in (str(port), "Operation not permitted")


@pytest.mark.parametrize(
    "form, passed, skipped",
    [
        ("", {"of_the_gate"}, {"long", "realtime"}),
        ("REALTIME", {"realtime"}, set()),
        ("LONG", {"of_the_gate", "long", "realtime"}, set()),
    ],
)
def test_cases_of_other_forms_are_left_out(form, passed, skipped, project, monkeypatch):
    for name in ("LONG", "REALTIME"):
        monkeypatch.delenv(f"FRANKA_TEST_{name}", raising=False)
    if form:
        monkeypatch.setenv(f"FRANKA_TEST_{form}", "1")
    text = (TOP / "conftest.py").read_text(encoding="utf-8")
    (project / "conftest.py").write_text(text.replace("(__file__).parent", f"({str(TOP)!r})"))
    found = {"passed": set(), "skipped": set()}
    for case in run_file(project, FORMS).cases:
        found[case.verdict].add(case.parts[1].removeprefix("test_"))
    assert (found["passed"], found["skipped"]) == (passed, skipped)


def registered(project: Path, script: str) -> list[programs.Registered]:
    """A gtest that is a program in Python, as CTest knows it."""
    (project / "arm.py").write_text(f"import sys, time, os\nfrom pathlib import Path\n{script}")
    command = f'"{sys.executable}" "{project}/arm.py" "{project}/gtest-arm.xml"'
    (project / "CTestTestfile.cmake").write_text(f"add_test(_ctest_a_gtest_arm {command})\n")
    return programs.registered(project, "_gtest_")


@pytest.mark.parametrize(
    "script, failure",
    [
        ("time.sleep(1000)", "its program left no results"),  # the fault itself
        ("os.kill(os.getpid(), 9)", "its program left no results"),
        ("sys.exit(0)", "its program left no results"),
        (f"Path(sys.argv[1]).write_text({PASSED!r})\nsys.exit(1)", "did not end well"),
        (f"Path(sys.argv[1]).write_text({PASSED[:40]!r})", "the result file is broken"),
    ],
)
def test_a_gtest_that_hangs_or_dies_is_a_failure(script, failure, project, monkeypatch):
    monkeypatch.setattr(programs, "CTEST_LIMIT", 2)
    (project / "gtest-arm.xml").write_text(PASSED)  # of an earlier run
    tally = finished(registered(project, script), [])
    assert len(tally.failed) == 1 and failure in tally.failed[0], tally


def test_a_gtest_whose_assertion_failed_runs_once_more(project):
    failed = PASSED.replace("/></", "><failure message='Expected 1'/></testcase></")
    script = "first = not Path('mark').exists()\nPath('mark').touch()\n"
    script += f"Path(sys.argv[1]).write_text({failed!r} if first else {PASSED!r})\nsys.exit(first)"
    tally = finished(registered(project, script), [])
    assert tally.passed == 1 and not tally.failed
    assert [name.rpartition(": ")[2] for name in tally.flaky] == ["Arm.Moves"]


def test_results_of_rostest_are_those_of_the_tests_in_its_launch_file(tmp_path):
    about = '<testsuite><testcase classname="rostest" name="testarm">{}</testcase></testsuite>'
    test = programs.Registered("_ctest_a_rostest_arm.test", tmp_path / "rostest-arm.xml")
    test.results.write_text(about.format(""))
    (missing,) = test.cases(ended_well=True)
    assert missing.verdict == "failed" and "rosunit-arm" in missing.name
    (tmp_path / "rosunit-arm.xml").write_text(PASSED)
    assert [case.verdict for case in test.cases(ended_well=True)] == ["passed"]
    test.results.write_text(about.format('<failure message="a node died"/>'))
    assert [case.verdict for case in test.cases(ended_well=False)] == ["failed"]


def test_the_gate_has_no_realtime_priorities():
    code = """
        import subprocess, run
        run.refuse_realtime_priorities()
        print(subprocess.run(["chrt", "--fifo", "1", "true"], capture_output=True, text=True).stderr)
    """
    seen = subprocess.check_output(
        [sys.executable, "-c", textwrap.dedent(code)], cwd=TOP / "tests", text=True, timeout=60
    )
    assert "Operation not permitted" in seen
