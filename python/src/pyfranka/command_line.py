# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What the programs of pyfranka share: command lines, and what messages advise if a package is missing."""

import argparse
import json
import re
import shlex
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

# What brings the packages of an extra where pyfranka was not installed from a wheel.
WITHOUT_WHEEL = {
    "desk": "apt-get install python3-aiohttp python3-cryptography",
    "plot": "apt-get install python3-matplotlib python3-scipy",
    "gym": "./franka install extras in the workspace, and use .venv/bin/python3",
    "cluster": "./franka install extras in the workspace, and use .venv/bin/python3; "
    "or apt-get install ros-franka-sweep",
}


class Parser(argparse.ArgumentParser):
    """Takes every number, also -1e-05, -1. and -inf, which argparse takes for options."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._negative_number_matcher = re.compile(r"-(\d.*|\.\d.*|inf|infinity|nan)$", re.IGNORECASE)


def install_command(extra: str) -> str:
    """For messages: the command that installs the packages of an extra (desk, gym, plot, cluster).

    The name pyfranka is not on PyPI, so `pip install pyfranka[gym]` finds nothing: the command names the file
    of the wheel, or the packages if the file has gone.
    """
    wheel = _wheel()
    if wheel is None:
        return WITHOUT_WHEEL[extra]
    url = json.loads(wheel.read_text("direct_url.json") or "{}").get("url", "")
    file = unquote(urlsplit(url).path) if url.startswith("file:") else ""
    if url.endswith(".whl") and (not file or Path(file).exists()):
        return shlex.join(["pip", "install", f"pyfranka[{extra}] @ {url}"])
    required = (line.replace('"', "'").partition(";") for line in wheel.requires or ())
    packages = [name.strip() for name, _, marker in required if f"extra == '{extra}'" in marker]
    return shlex.join(["pip", "install", *packages])


def missing_package(what: str, package: str, extra: str) -> ModuleNotFoundError:
    """The exception of a module (what) whose extra is not installed, with the command that installs it."""
    advice = f"{what} needs the Python package {package}: {install_command(extra)}"
    if _wheel() is None:
        advice += f"; with the wheel pip install 'pyfranka-....whl[{extra}]'"
    return ModuleNotFoundError(f"{advice}.", name=package)


# The installed wheel that this module is of.
def _wheel() -> Distribution | None:
    try:
        found = distribution("pyfranka")
    except PackageNotFoundError:
        return None
    here = Path(__file__).resolve()
    ours = Path(str(found.locate_file("pyfranka/command_line.py"))).resolve() == here
    return found if ours and found.read_text("WHEEL") else None
