# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
# The names of __init__.py, which loads them when they are used. A build makes the types of the module in C++.
from _pyfranka import *

from pyfranka.sweeps import sweep as sweep
