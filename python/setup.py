# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(
        packages=["pyfranka", "pyfranka.desk", "pyfranka.gym", "pyfranka.plot", "pyfranka.sim"],
        package_dir={"": "src"},
        package_data={"pyfranka": ["py.typed", "*.pyi"], "pyfranka.desk": ["page/**/*"]},
    )
)
