# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A package outside this repository, built and run on top of it with a clean environment."""

import shutil
import subprocess
from pathlib import Path

from franka_sim_mujoco.session import free_port


def compiler_cache(folder: Path) -> dict[str, str]:
    """Variables with which a build in a temporary folder uses the compiler's cache, where there is one."""
    if not shutil.which("ccache"):
        return {}
    ask = ["ccache", "--get-config", "cache_dir"]
    place = subprocess.run(ask, text=True, capture_output=True, check=True).stdout.strip()
    names = {"CCACHE_DIR": place, "CCACHE_BASEDIR": str(folder), "CCACHE_NOHASHDIR": "1"}
    return {**names, "CMAKE_CXX_COMPILER_LAUNCHER": "ccache"}


class Overlay:
    """A workspace with one package, on top of our devel or install space."""

    def __init__(self, underlay: Path, package: Path, folder: Path):
        self.underlay = underlay
        self.package = package
        self.folder = folder
        self.environment = {
            "HOME": str(folder),
            "PATH": "/usr/bin:/bin",
            "LANG": "C.UTF-8",
            "ROS_HOSTNAME": "localhost",
            "ROS_MASTER_URI": f"http://localhost:{free_port()}",
            "ROS_HOME": str(folder),
            **compiler_cache(folder),
        }

    def shell(self, command: str, setup: Path, timeout: float) -> subprocess.CompletedProcess:
        return subprocess.run(
            ["bash", "-c", f"source {setup}/setup.bash && {command}"],
            env=self.environment,
            text=True,
            capture_output=True,
            timeout=timeout,
            stdin=subprocess.DEVNULL,
        )

    def build(self, target: str = "all") -> str:
        """Builds a target with all warnings as errors. Returns the output."""
        command = (
            f"cmake -S {self.package} -B {self.folder}/build -DCATKIN_DEVEL_PREFIX={self.folder}/devel "
            "-DCMAKE_CXX_FLAGS='-O0 -Wall -Wextra -Werror' -DPYTHON_EXECUTABLE=/usr/bin/python3 "
            f"&& make -C {self.folder}/build -j2 {target}"
        )
        result = self.shell(command, self.underlay, timeout=600)
        assert result.returncode == 0, (result.stdout + result.stderr)[-4000:]
        return result.stdout + result.stderr

    def run(self, command: str, timeout: float = 60) -> str:
        result = self.shell(command, self.folder / "devel", timeout)
        assert result.returncode == 0, result.stdout + result.stderr
        return result.stdout

    def start(self, command: str, log: Path) -> subprocess.Popen:
        with log.open("w") as out:
            return subprocess.Popen(
                ["bash", "-c", f"source {self.folder}/devel/setup.bash && exec {command}"],
                env=self.environment,
                stdout=out,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                start_new_session=True,
            )
