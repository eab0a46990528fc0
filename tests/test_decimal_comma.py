# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Processes with a decimal comma, in which the long form runs all tests, and programs of ours in them."""

import os
import subprocess
import sys

import decimal_comma
import pytest


@pytest.fixture(scope="module")
def environment():
    return {**os.environ, **decimal_comma.environment()}


def test_every_program_has_a_decimal_comma(environment):
    code = "import locale; print(locale.localeconv()['decimal_point'])"
    for variables, point in ((environment, ","), ({**environment, "LD_PRELOAD": ""}, ".")):
        printed = subprocess.check_output([sys.executable, "-c", code], env=variables, text=True)
        assert printed == f"{point}\n"


@pytest.mark.parametrize(
    "words, status, sentence",
    [
        (["franka_sim", "--linger", "0.5", "--ip", "192.0.2.1"], 1, "does not have that address"),
        (["franka_sim", "--linger", "0,5"], 2, "seconds from 0 to 60, not 0,5"),
        (["franka_info", "127.0.99.117", "0.5"], 2, "cannot be used"),
        (["franka_info", "127.0.99.117", "0,5"], 3, "up to 3600 s"),
        (["franka_info", "record", "127.0.99.117", "x.csv", "10.5"], 2, "cannot be used"),
    ],
)
def test_numbers_of_command_lines_have_a_point(words, status, sentence, environment, tmp_path):
    done = subprocess.run(
        words, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == status, done.stderr
    assert sentence in done.stderr
