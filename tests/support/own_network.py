# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A network of this process's own: the loopback and nothing else.

The gate runs in one: it needs no registry, two runs on a machine do not meet, and a robot's Desk may listen
on port 443 without root.
"""

import ctypes
import fcntl
import os
import pwd
import shutil
import socket
import struct
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

# linux/sched.h and linux/sockios.h, net/if.h
CLONE_NEWUSER, CLONE_NEWNET = 0x10000000, 0x40000000
SIOCSIFFLAGS, IFF_UP = 0x8914, 0x1

ENTERED = "FRANKA_TEST_NETWORK"  # set when the program is started in its own network


def enter() -> str:
    """Moves this process, which has one thread, and its later children. Where the kernel refuses that to an
    ordinary user (in a chroot, some containers), the same user starts the program again by sudo, if that asks
    no password. @returns why not, or nothing"""
    if os.environ.pop(ENTERED, ""):
        return ""
    user, group = os.getuid(), os.getgid()
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.unshare(CLONE_NEWNET | (CLONE_NEWUSER if user else 0)):
        reason = os.strerror(ctypes.get_errno())
        root = ["sudo", "-n", "unshare", "--net"]
        if user and shutil.which("sudo") and not subprocess.call([*root, "true"], stderr=subprocess.DEVNULL):
            environment = [f"{name}={value}" for name, value in os.environ.items()]
            begins = [sys.executable, __file__, str(user), str(group), sys.executable, *sys.orig_argv[1:]]
            os.execvp("sudo", [*root, "env", "-i", *environment, f"{ENTERED}=1", *begins])
        return reason
    if user:  # the same user as outside; until the next exec with every right over the new network
        Path("/proc/self/setgroups").write_text("deny", encoding="ascii")
        Path("/proc/self/uid_map").write_text(f"{user} {user} 1", encoding="ascii")
        Path("/proc/self/gid_map").write_text(f"{group} {group} 1", encoding="ascii")
    begin()
    return ""


def begin() -> None:
    """The loopback of a new network, where every user may listen on every port."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as control:
        fcntl.ioctl(control, SIOCSIFFLAGS, struct.pack("16sH14x", b"lo", IFF_UP))
    with suppress(OSError):  # read-only in some containers
        Path("/proc/sys/net/ipv4/ip_unprivileged_port_start").write_text("0", encoding="ascii")


if __name__ == "__main__":  # as root: see enter()
    begin()
    os.initgroups(pwd.getpwuid(int(sys.argv[1])).pw_name, int(sys.argv[2]))
    os.setgid(int(sys.argv[2]))
    os.setuid(int(sys.argv[1]))
    os.execv(sys.argv[3], sys.argv[3:])
