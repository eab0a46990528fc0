# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Modules of an installed package whose __init__ needs what is not installed."""

import importlib.util
import sys
import types


def bare_package(name: str, **modules: dict) -> None:
    """Makes `import name.module` work without name/__init__.py. modules: what stands in replaced modules."""
    package = types.ModuleType(name)
    package.__path__ = list(importlib.util.find_spec(name).submodule_search_locations)
    sys.modules[name] = package
    for module, names in modules.items():
        replaced = types.ModuleType(f"{name}.{module}")
        vars(replaced).update(names)
        sys.modules[replaced.__name__] = replaced
