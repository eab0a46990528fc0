# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The program franka_desk: python3 -m pyfranka.desk."""

import sys

from pyfranka.desk.cli import main

sys.exit(main())
