# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Fetching what tests need from PyPI: a registry that does not answer costs skips, not the run."""

import os
import subprocess
import sys
from pathlib import Path

import genuine_clients
import pytest
from tally import is_allowed

PROGRAM = Path(genuine_clients.__file__)


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setattr(genuine_clients, "CACHE", tmp_path / "franka_ros")
    return tmp_path


def test_a_registry_that_does_not_answer_is_named_and_costs_skips(cache, monkeypatch):
    for name in ("CI", "FRANKA_TEST_LONG"):  # in which a missing package is a failure
        monkeypatch.delenv(name, raising=False)
    nowhere = {"PIP_INDEX_URL": "http://127.0.0.1:9/simple", "PIP_CONFIG_FILE": os.devnull}
    environment = {**os.environ, **nowhere, "XDG_CACHE_HOME": str(cache)}
    printed = subprocess.run(
        [sys.executable, PROGRAM], env=environment, text=True, capture_output=True, timeout=300
    )
    assert printed.returncode == 0, printed
    first = genuine_clients.ENVIRONMENTS[0]
    assert f"{first} could not be fetched: " in printed.stdout and "./franka test" in printed.stdout
    for name in genuine_clients.ENVIRONMENTS:
        assert is_allowed(genuine_clients.missing(name))
    with pytest.raises(pytest.skip.Exception, match=f"{first} from PyPI is not installed"):
        genuine_clients.client_python(first)


def test_a_lock_that_has_changed_has_another_folder(cache, monkeypatch):
    folder = genuine_clients.folder_of("panda")
    folder.mkdir(parents=True)
    (folder / "complete").touch()
    assert genuine_clients.missing("panda") is None
    locks = cache / "locks"
    locks.mkdir()
    (locks / "panda.txt").write_text("panda-python==2\n")
    monkeypatch.setattr(genuine_clients, "LOCKS", locks)
    assert genuine_clients.missing("panda")
