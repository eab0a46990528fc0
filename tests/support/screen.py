# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A virtual screen with software OpenGL, and pictures of it."""

import ctypes
import os
import re
import subprocess
from collections.abc import Callable
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

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
            patch.setenv("QT_X11_NO_MITSHM", "1")
            yield
    finally:
        server.terminate()
        server.wait(60)


def with_rviz(use: Callable[[], Any], log: Path) -> Any:
    """What `use` returns, which launches rviz with that log. If it fails because rviz has crashed, once more.

    Debian's rviz dies by signal 11 in Qt's event loop while it starts, with our displays once in more than
    a hundred starts on a busy machine: seen twice, and not in 107 starts in a row at a load of 20; once by
    signal 6 instead, for which the C library's memory had been overwritten.
    """
    try:
        return use()
    except (Exception, pytest.fail.Exception):
        text = log.read_text(errors="replace")
        # Of a required node roslaunch says in another line first that it has died.
        if not re.search(r"\[rviz\S*\] (?:has died!\s+)?process has died \[pid \d+, exit code -\d", text):
            raise
        print(text)
    return use()


def colors(path: Path, window: int | None = None) -> int:
    """Takes a picture of a window, or of all of the screen, and counts its colors."""
    subprocess.run(["import", "-window", str(window or "root"), str(path)], check=True, timeout=60)
    with Image.open(path) as picture:
        return len(picture.convert("RGB").getcolors(maxcolors=1 << 20))


def window_of(title: str) -> int | None:
    """The number of the first window whose title contains a text."""
    tree = subprocess.run(["xwininfo", "-root", "-tree"], text=True, capture_output=True, timeout=60).stdout
    found = re.search(rf'^\s*(0x[0-9a-f]+) "[^"]*{re.escape(title)}[^"]*"', tree, re.M)
    return int(found.group(1), 16) if found else None


def children_of(window: int) -> list[tuple[int, int, int, int]]:
    """Left, top, width and height on the screen of all windows in a window, the topmost first."""
    command = ["xwininfo", "-id", str(window), "-tree"]
    tree = subprocess.run(command, text=True, capture_output=True, timeout=60).stdout
    places = re.findall(r"^ +0x.* (\d+)x(\d+)\+\S+ +\+(\d+)\+(\d+)$", tree, re.M)
    found = [(int(x), int(y), int(width), int(height)) for width, height, x, y in places]
    return sorted(found, key=lambda place: place[1])


def picture_of(title: str, path: Path, x: int = 0, y: int = 0, size: tuple[int, int] | None = None) -> int:
    """Moves a window, takes a picture of it, and counts its colors: 0 if there is no such window.

    A window that has just opened may be replaced by another one.
    """
    window = window_of(title)
    with suppress(WindowIsGone, subprocess.CalledProcessError):
        if window:
            move_window(window, x, y, size)
            return colors(path, window)
    return 0


class WindowIsGone(LookupError):
    """X knows no window of that number any more."""


_errors = []


@ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
def _store_error(_display, _event):
    """Instead of Xlib's own handler, which ends the process with status 1."""
    _errors.append(True)
    return 0


@contextmanager
def _display():
    """Xlib and a connection."""
    x11 = ctypes.CDLL("libX11.so.6")
    x11.XSetErrorHandler(_store_error)
    x11.XOpenDisplay.restype = ctypes.c_void_p
    display = ctypes.c_void_p(x11.XOpenDisplay(None))
    assert display, "There is no display."
    _errors.clear()
    yield x11, display
    x11.XSync(display, 0)
    x11.XCloseDisplay(display)
    if _errors:
        raise WindowIsGone


def move_window(window: int, x: int, y: int, size: tuple[int, int] | None = None) -> None:
    """Needed without a window manager: new windows cover each other in the upper left corner."""
    with _display() as (x11, display):
        x11.XMoveWindow(display, ctypes.c_ulong(window), x, y)
        if size:
            x11.XResizeWindow(display, ctypes.c_ulong(window), *size)


def drag(x: int, y: int, to_x: int, to_y: int | None = None, hold: str = "") -> None:
    """Presses the left button, moves the pointer along a line, and releases the button.

    @param hold a key that is held meanwhile, such as Control_L
    """
    with dragged(x, y, to_x, y if to_y is None else to_y, hold):
        pass


@contextmanager
def dragged(x: int, y: int, to_x: int, to_y: int, hold: str = ""):
    """The same; the button is held within the block."""
    with _pointer() as (xtest, display, key):
        xtest.XTestFakeMotionEvent(display, -1, x, y, ctypes.c_ulong(0))
        if hold:
            key(hold, True)
        xtest.XTestFakeButtonEvent(display, 1, 1, ctypes.c_ulong(20))
        for step in range(1, 11):
            here = [round(begin + (end - begin) * step / 10) for begin, end in ((x, to_x), (y, to_y))]
            xtest.XTestFakeMotionEvent(display, -1, *here, ctypes.c_ulong(20))  # ms later
    try:
        yield
    finally:
        with _pointer() as (xtest, display, key):
            xtest.XTestFakeButtonEvent(display, 1, 0, ctypes.c_ulong(20))
            if hold:
                key(hold, False)


def move_pointer(x: int, y: int) -> None:
    """Moves it without buttons."""
    with _pointer() as (xtest, display, _):
        xtest.XTestFakeMotionEvent(display, -1, x, y, ctypes.c_ulong(0))


def click(x: int, y: int) -> None:
    """Presses and releases the left button."""
    drag(x, y, x)


def press(*names: str, hold: str = "") -> None:
    """Presses keys by their names in X, such as `a`, `period` or `Return`, below the pointer."""
    with _pointer() as (_, _, key):
        if hold:
            key(hold, True)
        for name in names:
            key(name, True)
            key(name, False)
        if hold:
            key(hold, False)


@contextmanager
def _pointer():
    """XTest, a connection, and a function that presses or releases a key."""
    xtest = ctypes.CDLL("libXtst.so.6")  # a dependency of x11-utils
    with _display() as (x11, display):
        x11.XStringToKeysym.restype = ctypes.c_ulong

        def key(name: str, pressed: bool) -> None:
            symbol = x11.XStringToKeysym(name.encode())
            assert symbol, f"There is no key {name}."
            code = x11.XKeysymToKeycode(display, ctypes.c_ulong(symbol))
            xtest.XTestFakeKeyEvent(display, code, int(pressed), ctypes.c_ulong(20))

        yield xtest, display, key
