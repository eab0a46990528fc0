# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The rotations of franka_sim_mujoco.geometry are those of SciPy, which the simulation does not need. An arm
that has sent no state does not move."""

import numpy as np
import pytest
from franka_sim_mujoco.geometry import rotation_of, rotation_vector
from franka_sim_mujoco.pick_and_place import Arm, TaskError
from scipy.spatial.transform import Rotation

ANGLES = [0.0, 1e-12, 1e-6, 0.1, 1.0, 2.0, 3.0, 3.14]  # [rad]


@pytest.mark.parametrize("angle", ANGLES)
def test_rotation_vectors_agree_with_scipy(angle):
    for axis in np.random.default_rng(7).normal(size=(50, 3)):
        vector = axis / np.linalg.norm(axis) * angle
        matrix = Rotation.from_rotvec(vector).as_matrix()
        assert rotation_of(vector) == pytest.approx(matrix, abs=1e-15)
        assert rotation_vector(matrix) == pytest.approx(vector, rel=1e-9, abs=1e-14)


def test_an_arm_without_a_state_refuses_to_move_with_a_sentence():
    arm = object.__new__(Arm)  # without topics
    arm._state = arm._target = None
    for use in (lambda: arm.pose, lambda: arm.move(np.eye(4))):
        with pytest.raises(TaskError, match=r"call wait_ready\(\) first"):
            use()
