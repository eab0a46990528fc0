# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Tasks for simulated robots as environments of Gymnasium (docs/gym.md).

import gymnasium
import pyfranka.gym

env = gymnasium.make("pyfranka/PickAndPlace-v0", robot="fr3", control="joint_delta")
worlds = gymnasium.make_vec("pyfranka/PickAndPlace-v0", num_envs=8)
"""

try:
    from gymnasium.envs.registration import register, registry
except ModuleNotFoundError as error:
    if not str(error.name).startswith("gymnasium"):
        raise
    from pyfranka.command_line import missing_package

    raise missing_package("pyfranka.gym", "gymnasium", "gym") from None

from .environment import Environment
from .scripted import scripted_policy
from .tasks import TASKS
from .vector_environment import VectorEnvironment

__all__ = ["Environment", "VectorEnvironment", "scripted_policy"]

for _name, _task in TASKS.items():
    if f"pyfranka/{_name}-v0" not in registry:
        register(
            id=f"pyfranka/{_name}-v0",
            entry_point="pyfranka.gym.environment:Environment",
            vector_entry_point="pyfranka.gym.vector_environment:VectorEnvironment",
            kwargs={"task": _name},
        )
