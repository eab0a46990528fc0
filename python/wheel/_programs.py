# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of the wheel: they become the programs that it contains."""

import os
import sys
import sysconfig
from pathlib import Path


def path(name: str) -> Path:
    """The file of a program, such as franka_sim."""
    return Path(__file__).parent / "bin" / name


def _become(name: str) -> None:
    os.execv(path(name), [name, *sys.argv[1:]])


def franka_sim() -> None:
    """A simulated robot on the network. It finds the other commands of the wheel, such as franka_desk."""
    folders = os.environ.get("PATH", os.defpath).split(os.pathsep)
    os.environ["PATH"] = os.pathsep.join([*folders, sysconfig.get_path("scripts")])
    _become("franka_sim")


def franka_info() -> None:
    """A robot's type, the quality of the connection, and its readiness."""
    _become("franka_info")


def examples() -> int:
    """Copies the examples of the wheel into a folder; @returns the exit status."""
    import argparse  # the other programs start without these
    import shutil

    parser = argparse.ArgumentParser(
        prog="pyfranka-examples",
        description="Copies programs to begin with. Each draws a picture; they need matplotlib, and those of "
        "Gymnasium and of sweeps the extras gym and cluster.",
    )
    parser.add_argument("folder", type=Path, help="where to; it is made, and no file there is overwritten")
    folder = parser.parse_args().folder
    sources = sorted((path("franka_sim").parents[1] / "share" / "examples").glob("*.py"))
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if there := [file.name for file in sources if (folder / file.name).exists()]:
            raise FileExistsError(f"{folder} has {', '.join(there)} already; give another folder.")
        for file in sources:
            shutil.copyfile(file, folder / file.name)
    except OSError as error:
        print(f"pyfranka-examples: {error}", file=sys.stderr)
        return 1
    print(f"{len(sources)} files are in {folder}; for example: python {folder / 'first_steps.py'}")
    return 0
