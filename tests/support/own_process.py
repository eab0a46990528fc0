# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A plugin of pytest for tests whose process becomes a node: rospy can join one master per process only.

Tests with the mark `own_process` run in child processes of pytest, which send their reports to this one:

    pytestmark = pytest.mark.own_process            one process for the module
    pytestmark = pytest.mark.own_process("robot")   one process for each value of the parameter `robot`
    @pytest.mark.own_process                        one process for each case of this test

The tests of one process share their module's fixtures. If all tests of a run need the same one, it is that of
the run itself.
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
import uuid
from contextlib import suppress
from pathlib import Path

import pytest

REPORTS = "FRANKA_TEST_REPORTS"  # set in a child: the descriptor to which it writes its reports
GROUP = "FRANKA_TEST_GROUP"  # set in a child and in all that it starts: a text of this group only
LAST_LINES = 60  # of a log, with each failure

logs: list[Path] = []  # whose last lines are shown with each failure


def pytest_configure(config):
    config.addinivalue_line(
        "markers", "own_process(*parameters): run in a child process, one for each value of the parameters"
    )
    descriptor = os.environ.pop(REPORTS, None)
    config.pluginmanager.register(LastLines())
    config.pluginmanager.register(Child(config, int(descriptor)) if descriptor else Parent())


def group_of(item):
    """Items of the same group share a process; None: the item needs none of its own."""
    for node, mark in item.iter_markers_with_node("own_process"):
        parameters = item.callspec.params if hasattr(item, "callspec") else {}
        return node.nodeid, *(repr(parameters.get(name)) for name in mark.args)
    return None


def kill_processes_with(variable: str, value: str) -> None:
    """Kills the processes that have inherited this variable of the environment."""
    mark = f"{variable}={value}".encode()
    for entry in Path("/proc").iterdir():
        with suppress(OSError):
            if entry.name.isdigit() and mark in (entry / "environ").read_bytes().split(b"\0"):
                os.kill(int(entry.name), signal.SIGKILL)


class Group:
    """A child process that runs the items of a group."""

    def __init__(self, items):
        config = items[0].config
        # Its plugin imports all of hypothesis at the end, which takes seconds; none of these tests needs it.
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:hypothesispytest"]
        command += [f"--rootdir={config.rootpath}"]
        command += [f"--capture={config.option.capture}", f"--timeout={config.getoption('timeout') or 0}"]
        command += ["--long"] * config.getoption("long") + [item.nodeid for item in items]
        self.last = items[-1]
        read, write = os.pipe()
        self._mark = uuid.uuid4().hex
        self._output = tempfile.TemporaryFile()
        self._process = subprocess.Popen(
            command,
            cwd=config.rootpath,
            env={**os.environ, REPORTS: str(write), GROUP: self._mark},
            pass_fds=[write],
            stdout=None if config.option.capture == "no" else self._output,
            stderr=None if config.option.capture == "no" else subprocess.STDOUT,
        )
        os.close(write)
        self._reports = os.fdopen(read, encoding="utf-8")

    def reports_of(self, item):
        """Those of the next item, as soon as they are made."""
        for line in self._reports:
            report = item.config.hook.pytest_report_from_serializable(
                config=item.config, data=json.loads(line)
            )
            if report.nodeid == item.nodeid:
                if report.skipped and isinstance(report.longrepr, list):  # a tuple before it was JSON
                    report.longrepr = tuple(report.longrepr)
                yield report
                if report.when == "teardown":
                    return
        status = self._process.wait()  # it prints until its end
        self._output.seek(0)
        printed = self._output.read().decode(errors="replace")
        text = f"The process of this test ended with status {status}:\n{printed}"
        yield pytest.TestReport(item.nodeid, item.location, {}, "failed", text, "call")

    def end(self):
        """A child that has died, as Xlib or a signal may end it, has left what it started."""
        self._reports.close()
        self._process.wait()
        kill_processes_with(GROUP, self._mark)


class Parent:
    """Starts the child processes and passes their reports on."""

    def __init__(self):
        self._groups = {}
        self._is_alone = False

    def pytest_collection_finish(self, session):
        keys = {group_of(item) for item in session.items if not item.get_closest_marker("skip")}
        self._is_alone = len(keys) == 1 and None not in keys
        if self._is_alone:
            os.environ[GROUP] = uuid.uuid4().hex

    def _key(self, item):
        return None if self._is_alone or item.get_closest_marker("skip") else group_of(item)

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item):
        key = self._key(item)
        if key is None:
            return None
        if key not in self._groups:
            self._groups[key] = Group([one for one in item.session.items if self._key(one) == key])
        item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
        for report in self._groups[key].reports_of(item):
            item.ihook.pytest_runtest_logreport(report=report)
        item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
        # Between two items of a group others may stand, such as a skipped one.
        if item is self._groups[key].last:
            self._groups.pop(key).end()
        return True

    def pytest_sessionfinish(self):
        for group in self._groups.values():
            group.end()
        if self._is_alone:
            kill_processes_with(GROUP, os.environ.pop(GROUP))

    @pytest.hookimpl(tryfirst=True)
    def pytest_timeout_set_timer(self, item, settings):
        """The child watches the time, so that it reports where the test was."""
        return True if self._key(item) else None


class LastLines:
    """Of logs, in reports of failures."""

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_makereport(self, item):
        report = (yield).get_result()
        if report.failed:
            for log in logs:
                lines = log.read_text(errors="replace").splitlines()[-LAST_LINES:]
                report.sections.append((str(log), "\n".join(lines)))


class Child:
    """Sends each report to the parent."""

    def __init__(self, config, descriptor: int):
        os.set_inheritable(descriptor, False)
        self._config, self._out = config, os.fdopen(descriptor, "w", encoding="utf-8", buffering=1)

    def pytest_runtest_logreport(self, report):
        data = self._config.hook.pytest_report_to_serializable(config=self._config, report=report)
        self._out.write(json.dumps(data) + "\n")
