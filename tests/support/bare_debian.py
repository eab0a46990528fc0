# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A Debian with its smallest system and some packages, in a folder. Needs root and debootstrap."""

import os
import platform
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
# How this machine reaches PyPI.
OF_THE_NETWORK = ("/etc/resolv.conf", "/etc/pip.conf", "/etc/ssl/certs/ca-certificates.crt")
IN_ROOT = """
mount --rbind --make-rslave /dev "$0/dev"
mount -t proc proc "$0/proc"
exec chroot "$0" "$@"
"""


class BareDebian:
    """The folder, with process numbers and mounts of its own and this machine's network."""

    def __init__(self, root: Path):
        self.root = root

    def run(self, *command: str, timeout: float = 600) -> subprocess.CompletedProcess:
        """Runs a command in it, with the environment of a new system and the network's settings."""
        kept = {
            name: value for name, value in os.environ.items() if name.lower().endswith(("_proxy", "_cert"))
        }
        return subprocess.run(
            [
                "unshare",
                "--mount",
                "--pid",
                "--fork",
                "--kill-child",
                "sh",
                "-ec",
                IN_ROOT,
                self.root,
                *command,
            ],
            env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LANG": "C.UTF-8", **kept},
            text=True,
            capture_output=True,
            timeout=timeout,
            stdin=subprocess.DEVNULL,
        )

    def must(self, *command: str, **options) -> str:
        """The output of a command that must end well."""
        result = self.run(*command, **options)
        assert result.returncode == 0, f"{command}: {result.stdout}{result.stderr}"
        return result.stdout


def copy_project(folder: Path) -> None:
    """Copies the files that git knows, as they stand, into a new folder."""
    folder.mkdir()
    names = subprocess.check_output(["git", "ls-files", "-z"], cwd=TOP)
    pack = ["tar", "--create", "--null", "--files-from=-", "--ignore-failed-read", "--file=-"]
    packed = subprocess.run(pack, input=names, cwd=TOP, check=True, stdout=subprocess.PIPE)
    subprocess.run(["tar", "--extract"], input=packed.stdout, cwd=folder, check=True)


@contextmanager
def bare_debian(folder: Path, *packages: str, release: str = "") -> Iterator[BareDebian]:
    """Yields one of a release (this machine's), and removes it at the end."""
    assert os.geteuid() == 0, "Only root can make a bare Debian: run ./franka test --long as root."
    root = folder / "root"
    own = platform.freedesktop_os_release()["VERSION_CODENAME"]
    mirror = subprocess.check_output(
        ["apt-get", "indextargets", "--format", "$(SITE)", f"Codename: {own}"], text=True
    ).split()[0]
    include = f"--include={','.join(['ca-certificates', *packages])}"
    made = subprocess.run(
        ["debootstrap", "--variant=minbase", include, release or own, root, mirror],
        text=True,
        capture_output=True,
        timeout=1800,
    )
    try:
        assert made.returncode == 0, made.stdout[-2000:] + made.stderr
        for file in OF_THE_NETWORK:
            if os.path.exists(file):
                shutil.copy(file, root / file[1:])
        # Debian's installer and containers write it; debootstrap does not.
        (root / "etc/hosts").write_text("127.0.0.1 localhost\n::1 localhost\n")
        yield BareDebian(root)
    finally:
        shutil.rmtree(root)
