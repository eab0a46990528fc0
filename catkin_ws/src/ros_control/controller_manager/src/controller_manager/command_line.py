# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Command lines that take every number, also -1e-05, -1. and -inf, which argparse takes for options."""

import argparse
import re
from typing import Any


class Parser(argparse.ArgumentParser):
    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._negative_number_matcher = re.compile(r"-(\d.*|\.\d.*|inf|infinity|nan)$", re.IGNORECASE)
