# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The module in C++, with the names that users import. All of pyfranka imports _pyfranka through this one, so
that the module knows its public name when it is loaded."""

import builtins

import _pyfranka
from _pyfranka import _sim as _sim

# The largest change of a commanded torque, joint by joint [Nm/s].
MAX_TORQUE_RATE = _pyfranka.MAX_TORQUE_RATE
NAMES = {name: value for name, value in vars(_pyfranka).items() if not name.startswith("_")}
# `from pyfranka import *` does not hide Python's own Exception; FrankaException is another name of ours.
STARRED = [name for name in NAMES if not hasattr(builtins, name)]
