# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The rotations of franka_sim_mujoco.geometry are those of SciPy, which the simulation does not need."""

import numpy as np
import pytest
from franka_sim_mujoco.geometry import rotation_of, rotation_vector
from scipy.spatial.transform import Rotation

ANGLES = [0.0, 1e-12, 1e-6, 0.1, 1.0, 2.0, 3.0, 3.14]  # [rad]


@pytest.mark.parametrize("angle", ANGLES)
def test_rotation_vectors_agree_with_scipy(angle):
    for axis in np.random.default_rng(7).normal(size=(50, 3)):
        vector = axis / np.linalg.norm(axis) * angle
        matrix = Rotation.from_rotvec(vector).as_matrix()
        assert rotation_of(vector) == pytest.approx(matrix, abs=1e-15)
        assert rotation_vector(matrix) == pytest.approx(vector, rel=1e-9, abs=1e-14)
