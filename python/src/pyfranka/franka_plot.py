# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The program franka_plot."""

from __future__ import annotations

import argparse
import math
import os
import signal
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from pyfranka.command_line import Parser, install_command

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from pyfranka.plot.figure import Panel
    from pyfranka.plot.sources import Live

TOPIC = "/franka_state_controller/franka_states"  # as in sources.py, which takes a while to import
KINDS = ("panda", "fr3")
SECONDS = 10.0

DESCRIPTION = """\
Plots a robot's states, commands, limits and errors: in a window, or with --output to a file.
Limits are dashed lines, errors red lines, and the background shows the robot's mode."""

EPILOG = """\
examples:
  franka_plot robot 172.16.0.2                       live, from the network, without ROS
  franka_plot topic -s q+q_d,tau_J                   live, from the state controller
  franka_plot bag demo.bag -j 4 -o demo.png -o demo.svg
  franka_plot log franka_abort_panda_2026-01-31_12-00-00_5120.csv   why a motion was aborted

The status is 0; 1 if there is nothing to plot; 2 for invalid arguments."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the program; returns its exit status."""
    words = _parser().parse_args(arguments)
    if words.list:
        return _list()
    if not words.source:
        _parser().error("say what to plot: robot, topic, bag or log (see --help)")
    try:
        import matplotlib

        matplotlib.rcParams["svg.fonttype"] = "none"  # text stays text
        from pyfranka.plot.recording import BadInput
    except ModuleNotFoundError as error:
        if error.name not in ("matplotlib", "scipy"):
            raise
        print(
            f"franka_plot: it needs the Python package {error.name}: {install_command('plot')}.",
            file=sys.stderr,
        )
        return 1
    try:
        return _run(words)
    except BadInput as error:
        print(f"franka_plot: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="franka_plot",
        description=DESCRIPTION,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--list", action="store_true", help="list the signals and end")
    common = Parser(add_help=False)
    common.add_argument(
        "-s",
        "--signals",
        type=_words,
        default=[],
        metavar="NAME,NAME",
        help="a panel for each: q, or q+q_d for two in one (--list: all)",
    )
    common.add_argument(
        "-j", "--joints", type=_joints, default=[], metavar="N,N", help="only these joints, 1 to 7"
    )
    common.add_argument(
        "-o",
        "--output",
        action="append",
        type=_picture,
        default=[],
        metavar="FILE",
        help="write .png, .svg or .pdf and open no window; may be repeated",
    )
    common.add_argument(
        "--robot", choices=KINDS, help="whose limits are drawn (by the connection, or the arm's name)"
    )
    common.add_argument(
        "--limits",
        choices=("auto", "all", "none"),
        default="auto",
        help="auto: those that a signal comes near; all: all set the scale (%(default)s)",
    )
    common.add_argument("--title", default="", help="above the plot")
    live = Parser(add_help=False)
    live.add_argument(
        "--seconds",
        type=_seconds,
        default=SECONDS,
        metavar="S",
        help="shown in the window, or recorded for --output (%(default)g)",
    )
    sources = parser.add_subparsers(dest="source", metavar="robot|topic|bag|log")

    robot = sources.add_parser(
        "robot",
        parents=[common, live],
        help="a robot on the network, by the FCI",
        description="Reads a robot's states by the FCI, without ROS. It listens only: nothing moves. A robot "
        "serves one client at a time; while a controller runs, use topic.",
    )
    robot.add_argument("address", metavar="ADDRESS", help="name or IP address, maybe with a port, HOST:PORT")
    topic = sources.add_parser(
        "topic", parents=[common, live], help="the state controller's topic", description="Live, by ROS."
    )
    topic.add_argument("topic", nargs="?", default=TOPIC, metavar="TOPIC", help="(%(default)s)")
    bag = sources.add_parser(
        "bag",
        parents=[common],
        help="a bag of that topic",
        description="States that rosbag recorded: franka_msgs/FrankaState.",
    )
    bag.add_argument("file", type=Path, metavar="FILE")
    bag.add_argument("--topic", default="", help="if the bag has several")
    log = sources.add_parser(
        "log",
        parents=[common],
        help="the log of an aborted motion",
        description="The last states and commands of a motion, as franka_control and log_to_csv write them. "
        "If the reason of the abort is known, the value that broke a limit is marked.",
    )
    log.add_argument("file", type=Path, metavar="FILE", help=".csv")
    log.add_argument(
        "--reason", type=Path, metavar="FILE", help="text of the exception (the .txt beside the .csv)"
    )
    return parser


def _words(text: str) -> list[str]:
    return [word for word in text.split(",") if word]


def _joints(text: str) -> list[int]:
    for word in _words(text):
        if word not in tuple("1234567"):
            raise argparse.ArgumentTypeError(f'"{word}" is not a joint: 1 to 7')
    return [int(word) for word in _words(text)]


def _seconds(word: str) -> float:
    try:
        seconds = float(word)
    except ValueError:
        seconds = math.nan
    if not 0.1 <= seconds <= 1800.0:
        raise argparse.ArgumentTypeError(f'"{word}" is not a time: 0.1 to 1800 s')
    return seconds


def _picture(word: str) -> Path:
    path = Path(word)
    if path.suffix.lower() not in (".png", ".svg", ".pdf"):
        raise argparse.ArgumentTypeError(f'"{word}": a file is .png, .svg or .pdf')
    if not path.absolute().parent.is_dir():
        raise argparse.ArgumentTypeError(f'"{word}": there is no folder {path.parent}')
    return path


def _list() -> int:
    from pyfranka.plot.signals import SIGNALS, is_command

    width = max(map(len, SIGNALS))
    for name, about in SIGNALS.items():
        where = "; in motion logs" if is_command(name) else ""
        print(f"{name:{width}}  {about.text} [{about.unit}]{where}")
    return 0


def _run(words: argparse.Namespace) -> int:
    from pyfranka.plot import sources
    from pyfranka.plot.figure import DEFAULT, panels_of, plot, plot_abort
    from pyfranka.plot.recording import KINDS as VERSIONS
    from pyfranka.plot.recording import BadInput

    version = VERSIONS.get(words.robot, 0)
    style = {"joints": words.joints, "limits": words.limits, "title": words.title}
    try:
        panels = panels_of(words.signals or DEFAULT)  # before anything is read
    except BadInput as error:
        print(f"franka_plot: {error}", file=sys.stderr)
        return 2
    if words.source == "log":
        recording, abort = sources.read_log(words.file, words.reason, version)
        figure = plot_abort(recording, abort, words.signals, **style)
    elif words.source == "bag":
        recording = sources.read_bag(words.file, words.topic, version)
        figure = plot(recording, words.signals or DEFAULT, **style)
    else:
        return _run_live(words, panels, version)
    _note_limits(recording.version)
    return _show(figure, words, recording.name)


def _run_live(words: argparse.Namespace, panels: Sequence[Panel], version: int) -> int:
    from pyfranka.plot import sources
    from pyfranka.plot.figure import Plot
    from pyfranka.plot.live import LiveWindow
    from pyfranka.plot.recording import BadInput
    from pyfranka.plot.signals import fields_of, is_command

    names = [name for panel in panels for name in panel.names]
    commands = [name for name in names if is_command(name)]
    if commands:
        raise BadInput(f"{', '.join(commands)}: states have no commands; franka_plot log shows them.")
    fields = fields_of(names)
    most = int(1.1e3 * words.seconds) + 100  # at 1 kHz
    source: Live
    if words.source == "robot":
        source = sources.FromRobot(words.address, fields, most, version)
    else:
        source = sources.FromTopic(words.topic, fields, most, version)
    drawn = Plot(panels, parts=words.joints, limits=words.limits)
    with source:
        source.await_first()
        _note_limits(source.collector.version)
        if not words.output:
            name = words.title or f"franka_plot {source.collector.name}"
            LiveWindow(source, drawn, words.seconds, name).run()
            return 0
        _collect(source, words.seconds)
        drawn.draw(source.collector.recording(), title=words.title)
        _save(drawn.figure, words.output)
        if source.error:
            print(f"franka_plot: {source.error}", file=sys.stderr)
    return 0


def _collect(source: Live, seconds: float) -> None:
    """Waits so long, or until Ctrl-C or the end of the source."""
    end = time.monotonic() + seconds
    stop = []
    before = signal.signal(signal.SIGINT, lambda *_: stop.append(True))
    try:
        while not stop and time.monotonic() < end and not source.ended.wait(0.05):
            pass
    finally:
        signal.signal(signal.SIGINT, before)


def _note_limits(version: int) -> None:
    if not version:
        print(
            "franka_plot: no limits are drawn, because the arm's name does not say whether it is a Panda or "
            "an FR3: add --robot panda or --robot fr3.",
            file=sys.stderr,
        )


def _show(figure: Figure, words: argparse.Namespace, name: str) -> int:
    from pyfranka.plot.live import Window

    if words.output:
        _save(figure, words.output)
    else:
        Window(figure, words.title or f"franka_plot {name}").run()
    return 0


def _save(figure: Figure, files: Sequence[Path]) -> None:
    from pyfranka.plot.recording import BadInput

    for file in files:
        try:
            figure.savefig(file, dpi=110)
        except OSError as error:
            raise BadInput(f"{file} cannot be written: {error.strerror}.") from None
        print(file)


if __name__ == "__main__":
    sys.exit(main())
