# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Finds packages with rospkg, as `$(find package)` does in ROS 1."""

import functools
import os

import rospkg


class PackageNotFoundError(KeyError):
    """No package of that name is on ROS_PACKAGE_PATH."""

    def __str__(self) -> str:
        """Return the message itself, not its repr as KeyError does."""
        return str(self.args[0])


def get_package_share_directory(package_name: str) -> str:
    """Return the directory of a package: its sources in a devel space, else its share directory.

    Raises PackageNotFoundError if there is no such package.
    """
    path = os.environ.get("ROS_PACKAGE_PATH", "")
    try:
        return str(_packages(path).get_path(package_name))
    except rospkg.ResourceNotFound:
        raise PackageNotFoundError(
            f"The package '{package_name}' was not found. Is it built, and is the setup.bash of "
            f"its workspace sourced? ROS_PACKAGE_PATH is '{path}'."
        ) from None


@functools.lru_cache(maxsize=4)
def _packages(path: str) -> rospkg.RosPack:
    """Return the packages on `path`; cached, because the search is slow."""
    return rospkg.RosPack(rospkg.get_ros_paths({"ROS_PACKAGE_PATH": path}))
