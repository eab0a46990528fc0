# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Finds controller managers, and lists and filters their controllers."""

from collections.abc import Iterable
from typing import Any

import rosgraph
import rospy
import rosservice

from controller_manager_msgs.srv import ListControllers

#: The services that make a controller manager, by name, with their types.
cm_services = {
    "list_controllers": "controller_manager_msgs/ListControllers",
    "list_controller_types": "controller_manager_msgs/ListControllerTypes",
    "load_controller": "controller_manager_msgs/LoadController",
    "unload_controller": "controller_manager_msgs/UnloadController",
    "switch_controller": "controller_manager_msgs/SwitchController",
    "reload_controller_libraries": "controller_manager_msgs/ReloadControllerLibraries",
}


def _join(namespace: str, name: str) -> str:
    return str(rosgraph.names.ns_join(namespace, name))


def _is_service(name: str, kind: str) -> bool:
    try:
        return bool(rosservice.get_service_type(name) == kind)
    except rosservice.ROSServiceIOException:
        return False


def is_controller_manager(namespace: str) -> bool:
    """Whether all services of a controller manager are offered in this namespace."""
    return bool(namespace) and all(
        _is_service(_join(namespace, name), kind) for name, kind in cm_services.items()
    )


def get_controller_managers(namespace: str = "/", initial_guess: Iterable[str] | None = None) -> list[str]:
    """Namespaces of the controller managers at or below a namespace, sorted.

    `initial_guess` is the result of an earlier call: for managers that still exist the services are not
    looked up again, which makes repeated calls cheap.
    """
    try:
        services = rosservice.get_service_list()
    except rosservice.ROSServiceIOException:
        return []
    root = namespace.rstrip("/") + "/"
    candidates = set()
    for service in services:
        owner, _, name = service.rpartition("/")
        if name == "list_controllers" and (owner + "/").startswith(root):
            candidates.add(owner or "/")
    known = candidates & set(initial_guess or [])
    return sorted(known | {one for one in candidates - known if is_controller_manager(one)})


class ControllerManagerLister:
    """Called, it returns the controller managers at or below a namespace, sorted."""

    def __init__(self, namespace: str = "/"):
        self._namespace = namespace
        self._managers: list[str] = []

    def __call__(self) -> list[str]:
        self._managers = get_controller_managers(self._namespace, self._managers)
        return self._managers


class ControllerLister:
    """Called, it returns the controllers of one manager; an empty list on failure."""

    def __init__(self, namespace: str = "/controller_manager"):
        self._name = _join(namespace, "list_controllers")
        self._service = self._connect()

    def _connect(self) -> Any:
        return rospy.ServiceProxy(self._name, ListControllers, persistent=True)

    def __call__(self) -> Any:
        # The manager may have been restarted since the last call: connect again.
        for _ in range(2):
            try:
                return self._service().controller
            except (rospy.ServiceException, rospy.ROSException, OSError):
                self._service.close()
                self._service = self._connect()
        return []


def _matches(value: str, pattern: str, match_substring: bool) -> bool:
    return pattern in value if match_substring else pattern == value


def filter_by_name(ctrl_list: Iterable[Any], ctrl_name: str, match_substring: bool = False) -> list[Any]:
    """Controllers of this name."""
    return [one for one in ctrl_list if _matches(one.name, ctrl_name, match_substring)]


def filter_by_type(ctrl_list: Iterable[Any], ctrl_type: str, match_substring: bool = False) -> list[Any]:
    """Controllers of this type."""
    return [one for one in ctrl_list if _matches(one.type, ctrl_type, match_substring)]


def filter_by_state(ctrl_list: Iterable[Any], ctrl_state: str, match_substring: bool = False) -> list[Any]:
    """Controllers in this state."""
    return [one for one in ctrl_list if _matches(one.state, ctrl_state, match_substring)]


def filter_by_hardware_interface(
    ctrl_list: Iterable[Any], hardware_interface: str, match_substring: bool = False
) -> list[Any]:
    """Controllers that use this hardware interface."""
    return [
        one
        for one in ctrl_list
        if any(
            _matches(claimed.hardware_interface, hardware_interface, match_substring)
            for claimed in one.claimed_resources
        )
    ]


def filter_by_resources(
    ctrl_list: Iterable[Any],
    resources: Iterable[str],
    hardware_interface: str | None = None,
    match_any: bool = False,
) -> list[Any]:
    """Controllers that claim all, or any, of the resources, on the given interface if any."""
    requested = set(resources)
    result = []
    for one in ctrl_list:
        claimed: set[str] = set()
        for entry in one.claimed_resources:
            if hardware_interface in (None, entry.hardware_interface):
                claimed.update(entry.resources)
        if (requested & claimed) if match_any else requested <= claimed:
            result.append(one)
    return result


def get_rosparam_controller_names(namespace: str = "/") -> list[str]:
    """Names below a namespace that have a type on the parameter server, sorted."""
    root = namespace.rstrip("/") + "/"
    names = set()
    for parameter in rospy.get_param_names():
        if parameter.startswith(root):
            parts = parameter[len(root) :].split("/")
            if len(parts) == 2 and parts[1] == "type":
                names.add(parts[0])
    return sorted(names)
