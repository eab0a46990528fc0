# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The script install_meshes as a module."""

import importlib.machinery
import importlib.util
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[1] / "scripts" / "install_meshes"


def load():
    loader = importlib.machinery.SourceFileLoader("install_meshes", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("install_meshes", loader))
    loader.exec_module(module)
    return module
