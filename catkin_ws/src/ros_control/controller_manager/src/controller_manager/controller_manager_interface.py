# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Calls the services of the controller manager in this namespace and prints the results.

All functions return whether they succeeded, and raise rospy.ROSException without a manager.
"""

from collections.abc import Iterable
from typing import Any

import rospy
from controller_manager_msgs.srv import (
    ListControllers,
    ListControllerTypes,
    LoadController,
    ReloadControllerLibraries,
    SwitchController,
    SwitchControllerRequest,
    UnloadController,
)

MAX_WAIT = 10.0  # [s] for the manager to appear


def _call(name: str, kind: Any, *arguments: Any, **fields: Any) -> Any:
    name = "controller_manager/" + name
    rospy.wait_for_service(name, MAX_WAIT)
    return rospy.ServiceProxy(name, kind)(*arguments, **fields)


def list_controller_types() -> bool:
    """Prints the types that could be loaded."""
    for name in _call("list_controller_types", ListControllerTypes).types:
        print(name)
    return True


def _controllers() -> Any:
    return _call("list_controllers", ListControllers).controller


def reload_libraries(force_kill: bool, restore: bool = False) -> bool:
    """Reloads the plugin libraries; with `restore`, then also the present controllers."""
    print(f"Restore: {restore}")
    before = _controllers() if restore else []
    if not _call("reload_controller_libraries", ReloadControllerLibraries, force_kill).ok:
        print("Failed to reload libraries. Do you still have controllers loaded?")
        return False
    print("Successfully reloaded libraries")
    if restore:
        if not all([load_controller(controller.name) for controller in before]):
            return False
        running = [controller.name for controller in before if controller.state == "running"]
        if running and not start_controllers(running):
            return False
        print("Controllers restored to original state")
    return True


def list_controllers() -> bool:
    """Prints the loaded controllers."""
    controllers = _controllers()
    if not controllers:
        print("No controllers are loaded in mechanism control")
    for controller in controllers:
        interfaces = "+".join(one.hardware_interface for one in controller.claimed_resources)
        print(f"'{controller.name}' - '{interfaces}' ( {controller.state} )")
    return True


def load_controller(name: str) -> bool:
    """Loads a controller, which does not run then."""
    if _call("load_controller", LoadController, name).ok:
        print(f"Loaded '{name}'")
        return True
    print(f"Error when loading '{name}'")
    return False


def unload_controller(name: str) -> bool:
    """Unloads a controller that does not run."""
    if _call("unload_controller", UnloadController, name).ok:
        print(f"Unloaded '{name}' successfully")
        return True
    print(f"Error when unloading '{name}'")
    return False


def start_controller(name: str) -> bool:
    """Starts a loaded controller."""
    return start_controllers([name])


def start_controllers(names: Iterable[str]) -> bool:
    """Starts loaded controllers in one cycle."""
    return start_stop_controllers(start_controllers=names)


def stop_controller(name: str) -> bool:
    """Stops a running controller."""
    return stop_controllers([name])


def stop_controllers(names: Iterable[str]) -> bool:
    """Stops running controllers in one cycle."""
    return start_stop_controllers(stop_controllers=names)


def start_stop_controllers(
    start_controllers: Iterable[str] = (), stop_controllers: Iterable[str] = ()
) -> bool:
    """Starts and stops in one cycle; does nothing if part of it is impossible."""
    start = list(start_controllers)
    stop = list(stop_controllers)
    answer = _call(
        "switch_controller",
        SwitchController,
        start_controllers=start,
        stop_controllers=stop,
        strictness=SwitchControllerRequest.STRICT,
    )
    if not answer.ok:
        print(f"Error when starting {start} and stopping {stop}")
        return False
    if start:
        print(f"Started {start} successfully")
    if stop:
        print(f"Stopped {stop} successfully")
    return True
