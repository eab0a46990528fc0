# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The shortest possible script."""

import numpy as np


class ConstantCommand:
    def starting(self, state, model):
        self.command = np.zeros(7)

    def update(self, state, model, period):
        return self.command
