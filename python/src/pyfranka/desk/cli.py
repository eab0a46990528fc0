# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The program franka_desk."""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import errno
import logging
import os
import secrets
import signal
import sys
import typing
from collections.abc import Sequence

from pyfranka.command_line import Parser, install_command
from pyfranka.desk.addresses import place_of, url_of
from pyfranka.desk.profiles import PROFILES
from pyfranka.desk.robot import PORT, DeskRobot
from pyfranka.desk.settings import USER, Options, Settings

if typing.TYPE_CHECKING:
    from aiohttp import web

    from pyfranka.desk.server import Site

PASSWORD = "FRANKA_DESK_PASSWORD"
HTTPS, OTHER_HTTPS = 443, 8443
FIRST_REPORT = 3.0  # [s] to wait for the robots before Desk listens (chosen here)
NICE = 5  # robots come first (chosen here)


class CannotListen(Exception):
    """Desk cannot listen; the text is a sentence."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the program; returns its exit status."""
    words = _parser().parse_args(arguments)
    try:
        settings, generated = _settings(words)
        robots = [place_of(word, PORT) for word in words.robot or ["127.0.0.1"]]
        listen = place_of(words.listen, 0) if words.listen else None
    except ValueError as error:
        print(f"franka_desk: {error}", file=sys.stderr)
        return 2
    if generated:
        print(f"franka_desk: user {settings.user}, password {settings.password}", flush=True)
    logging.basicConfig(format="franka_desk: %(message)s", level=logging.WARNING)
    # It writes a traceback for each request that is not HTTP; the client gets an answer anyway.
    logging.getLogger("aiohttp.server").setLevel(logging.CRITICAL)
    _lower_priority()
    try:
        return asyncio.run(_run(robots, listen, settings, words.child))
    except ModuleNotFoundError as error:
        print(
            f"franka_desk: Desk needs the Python package {error.name}: {install_command('desk')}.",
            file=sys.stderr,
        )
    except CannotListen as error:
        print(f"franka_desk: {error}", file=sys.stderr)
    return 1


# A program that has controlled a robot has real-time priority, which the programs that it starts inherit.
def _lower_priority() -> None:
    with contextlib.suppress(OSError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
        os.nice(NICE)


def _parser() -> Parser:
    parser = Parser(
        prog="franka_desk",
        description="The web interface of Franka robots, for robots that franka_sim serves.",
        epilog=f"The password comes from the variable {PASSWORD}; without it a new one is printed.",
    )
    parser.add_argument(
        "--robot",
        action="append",
        metavar="ADDRESS[:PORT]",
        help=f"a robot's control interface (127.0.0.1:{PORT}); may be given several times",
    )
    parser.add_argument(
        "--listen",
        metavar="ADDRESS:PORT",
        help=f"where Desk listens; further robots at the next ports (the robots' addresses, port {HTTPS}, or "
        f"{OTHER_HTTPS} if that is not allowed)",
    )
    parser.add_argument("--user", default=USER, help="name of the first user (%(default)s)")
    parser.add_argument(
        "--profile", default="", choices=list(PROFILES), help="generation of the interface (by the robot)"
    )
    parser.add_argument(
        "--option",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="see docs/desk.md; may be repeated",
    )
    parser.add_argument(
        "--child",
        type=int,
        metavar="N",
        help="for franka_sim: end when standard input ends; the addresses go to descriptor N, one a line",
    )
    return parser


def _settings(words: argparse.Namespace) -> tuple[Settings, bool]:
    password = os.environ.pop(PASSWORD, "")
    options = Options.of(words.option)
    settings = Settings(password or secrets.token_urlsafe(12), words.user, words.profile, options)
    return settings, not password


async def _run(
    places: list[tuple[str, int]], listen: tuple[str, int] | None, settings: Settings, child: int | None
) -> int:
    from pyfranka.desk.server import app_of, make_desks  # aiohttp takes a while

    end = _end(child is not None)
    robots = [DeskRobot(*place) for place in places]
    await asyncio.gather(*(robot.start(FIRST_REPORT) for robot in robots))
    desks = make_desks(robots, settings)
    sites = []
    for number, robot in enumerate(robots):
        sites.append(await _open(app_of(desks, number), _ports(listen, robot, number)))
        desks[number].power.site = sites[-1]
    for desk, site in zip(desks, sites):
        url = url_of(site.address, site.port)
        print(f"franka_desk: robot at {desk.robot.place}: {url}", flush=True)
    if child is not None:
        with os.fdopen(child, "w") as addresses:
            addresses.writelines(f"{url_of(site.address, site.port)}\n" for site in sites)
    await end.wait()
    for site in sites:
        await site.cleanup()
    for desk in desks:
        await desk.close()
        await desk.robot.stop()
    return 0


def _ports(listen: tuple[str, int] | None, robot: DeskRobot, number: int) -> list[tuple[str, int]]:
    if listen is None:
        return [(robot.address, HTTPS), (robot.address, OTHER_HTTPS)]
    return [(listen[0], listen[1] + number if listen[1] else 0)]


async def _open(app: web.Application, places: list[tuple[str, int]]) -> Site:
    from pyfranka.desk.certificate import tls_context
    from pyfranka.desk.server import Site

    for address, port in places:
        site = Site(app, address, port, tls_context(address))
        try:
            await site.open()
            return site
        except OSError as error:
            if (address, port) == places[-1] or error.errno not in (errno.EACCES, errno.EPERM):
                why = os.strerror(error.errno) if error.errno else str(error)
                raise CannotListen(
                    f"Desk cannot listen at {address}, port {port}: {why}. Choose another place with "
                    "--listen ADDRESS:PORT."
                ) from None
    raise AssertionError("there is no place")


def _end(child: bool) -> asyncio.Event:
    """Is set when the program shall end."""
    loop, end = asyncio.get_running_loop(), asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, end.set)
    if child:
        loop.add_reader(sys.stdin.fileno(), _read_input, end)
    return end


def _read_input(end: asyncio.Event) -> None:
    if not os.read(sys.stdin.fileno(), 4096):
        asyncio.get_running_loop().remove_reader(sys.stdin.fileno())
        end.set()
