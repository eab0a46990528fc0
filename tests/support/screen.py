# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A virtual screen with software OpenGL, and pictures of it."""

import ctypes
import os
import re
import subprocess
from contextlib import contextmanager
from pathlib import Path

import pytest
from PIL import Image


@contextmanager
def virtual_screen(size: str = "1280x960x24"):
    """Programs started meanwhile use it as their display; X chooses its number."""
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", size],
        pass_fds=[write],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    os.close(write)
    try:
        with os.fdopen(read) as answer, pytest.MonkeyPatch.context() as patch:
            patch.setenv("DISPLAY", f":{answer.readline().strip()}")
            patch.setenv("LIBGL_ALWAYS_SOFTWARE", "1")
            yield
    finally:
        server.terminate()
        server.wait(10)


def colours(path: Path, window: int | None = None) -> int:
    """Takes a picture of a window, or of all of the screen, and counts its colours."""
    subprocess.run(["import", "-window", str(window or "root"), str(path)], check=True, timeout=30)
    with Image.open(path) as picture:
        return len(picture.convert("RGB").getcolors(maxcolors=1 << 20))


def window_of(title: str) -> int | None:
    """The number of the first window whose title contains a text."""
    tree = subprocess.run(["xwininfo", "-root", "-tree"], text=True, capture_output=True, timeout=30).stdout
    found = re.search(rf'^\s*(0x[0-9a-f]+) "[^"]*{re.escape(title)}[^"]*"', tree, re.M)
    return int(found.group(1), 16) if found else None


def children_of(window: int) -> list[tuple[int, int, int, int]]:
    """Left, top, width and height on the screen of all windows in a window, the topmost first."""
    command = ["xwininfo", "-id", str(window), "-tree"]
    tree = subprocess.run(command, text=True, capture_output=True, timeout=30).stdout
    places = re.findall(r"^ +0x.* (\d+)x(\d+)\+\S+ +\+(\d+)\+(\d+)$", tree, re.M)
    found = [(int(x), int(y), int(width), int(height)) for width, height, x, y in places]
    return sorted(found, key=lambda place: place[1])


@contextmanager
def _display():
    """Xlib and a connection."""
    x11 = ctypes.CDLL("libX11.so.6")
    x11.XOpenDisplay.restype = ctypes.c_void_p
    display = ctypes.c_void_p(x11.XOpenDisplay(None))
    assert display, "There is no display."
    yield x11, display
    x11.XSync(display, 0)
    x11.XCloseDisplay(display)


def move_window(window: int, x: int, y: int) -> None:
    """Needed without a window manager: new windows cover each other in the upper left corner."""
    with _display() as (x11, display):
        x11.XMoveWindow(display, ctypes.c_ulong(window), x, y)


def drag(x: int, y: int, to_x: int) -> None:
    """Presses the left button, moves the pointer along the line, and releases the button."""
    xtest = ctypes.CDLL("libXtst.so.6")  # a dependency of x11-utils
    with _display() as (_, display):
        xtest.XTestFakeMotionEvent(display, -1, x, y, ctypes.c_ulong(0))
        xtest.XTestFakeButtonEvent(display, 1, 1, ctypes.c_ulong(0))
        for step in range(1, 11):
            here = round(x + (to_x - x) * step / 10)
            xtest.XTestFakeMotionEvent(display, -1, here, y, ctypes.c_ulong(20))  # ms later
        xtest.XTestFakeButtonEvent(display, 1, 0, ctypes.c_ulong(20))
