# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The shortest possible script."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


class ConstantCommand:
    def starting(self, state: Any, model: Any) -> None:
        self.command = np.zeros(7)

    def update(self, state: Any, model: Any, period: float) -> NDArray[np.float64]:
        return self.command
