# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Draws recordings and aborts with matplotlib."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import pyfranka
from pyfranka.plot.recording import Abort, Array, BadInput, Recording
from pyfranka.plot.signals import EVIDENCE, SIGNALS, Excess, worst
from pyfranka.sim.arguments import items, whole

# Seven colors that remain distinct with color blindness (Okabe and Ito, 2008; the yellow is darker).
COLORS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8a7a00")
STYLES = ("-", ":", "-.")  # dashes are limits
LIMIT, VIOLATION = "#666666", "#d00000"
MODES = {
    pyfranka.RobotMode.Other: ("other", "#e8e8e8"),
    pyfranka.RobotMode.Idle: ("idle", ""),
    pyfranka.RobotMode.Move: ("move", "#dff2df"),
    pyfranka.RobotMode.Guiding: ("guiding", "#dfe9fa"),
    pyfranka.RobotMode.Reflex: ("reflex", "#fadcdc"),
    pyfranka.RobotMode.UserStopped: ("user stopped", "#fdebcf"),
    pyfranka.RobotMode.AutomaticErrorRecovery: ("recovery", "#efe3f7"),
}
DEFAULT = ("q", "dq", "tau_J", "O_F_ext_hat_K")
CONTEXT = ("q", "dq", "tau_J", "success_rate")  # of an abort, below its evidence
WIDTH, PANEL = 9.0, 2.1  # [inch]
NEAR = 0.3  # share of a limit that a signal must reach for the limit to set the scale (chosen here)
LIMITS = ("auto", "all", "none")
WRAP = 105  # characters a line


@dataclass(frozen=True)
class Panel:
    """Signals in one pair of axes, such as q and q_d."""

    names: tuple[str, ...]

    @classmethod
    def of_text(cls, text: str) -> Panel:
        """`q` or `q+q_d`. Raises BadInput with a sentence for unknown names, or too many."""
        if not isinstance(text, str):
            raise BadInput(f"A signal is a name such as q or q+q_d, not {text!r}.")
        names = tuple(text.split("+"))
        for name in names:
            if name not in SIGNALS:
                raise BadInput(f'There is no signal "{name}"; franka_plot --list names all.')
        if len(names) > len(STYLES):
            raise BadInput(f"{text}: one panel shows at most {len(STYLES)} signals.")
        if len({(SIGNALS[name].unit, SIGNALS[name].parts) for name in names}) > 1:
            raise BadInput(f"{text}: signals of one panel must have one unit and the same joints or axes.")
        return cls(names)


def panels_of(texts: Sequence[str]) -> list[Panel]:
    """Raises BadInput, TypeError with a sentence."""
    texts = items(texts, "signals", "names such as q+q_d")
    return [Panel.of_text(text) for text in texts]


def require_recording(recording: object) -> None:
    """Raises TypeError with a sentence."""
    if not isinstance(recording, Recording):
        raise TypeError(f"recording must be what of_log() or read_log() has returned, not {recording!r}.")


class Plot:
    """A figure with a panel below the other, drawn once or again and again.

    parts: numbers of joints (or axes), from 1; empty: all.
    limits: "auto": those that a signal comes near to set the scale; "all": all do; "none".
    """

    def __init__(self, panels: Sequence[Panel], *, parts: Sequence[int] = (), limits: str = "auto"):
        if limits not in LIMITS:
            raise BadInput(f"limits is one of {', '.join(LIMITS)}, not {limits!r}.")
        if not panels:
            raise BadInput("There is no signal to plot.")
        self._panels, self._limits = list(panels), limits
        self._parts = {
            whole(part, "The number of a joint", 1, 7) for part in items(parts, "joints", "numbers")
        }
        self.figure = Figure(figsize=(WIDTH, 1.3 + PANEL * len(self._panels)), layout="constrained")
        self._axes: list[Axes] = list(
            self.figure.subplots(len(self._panels), 1, sharex=True, squeeze=False)[:, 0]
        )

    def draw(self, recording: Recording, *, title: str = "", most: int = 0, named: bool = True) -> None:
        """Draws a recording in the place of what was drawn before.

        most: points a line; 0: all. named: whether names stand at the errors.
        """
        require_recording(recording)
        step = max(1, len(recording) // most) if most else 1
        for axes, panel in zip(self._axes, self._panels):
            axes.clear()
            self._draw_panel(axes, panel, recording, step)
            self._draw_modes(axes, recording)
            self._draw_errors(axes, recording, named=named and axes is self._axes[0])
        self._axes[-1].set_xlabel("time of the robot [s]")
        self._axes[-1].ticklabel_format(axis="x", useOffset=False)
        self._draw_mode_legend(recording)
        self.figure.suptitle(title or _title(recording), fontsize=11)

    def _chosen(self, values: Array) -> list[int]:
        """The columns to draw: those of the chosen parts that have numbers."""
        count = values.shape[1]
        known = [bool(np.isfinite(column).any()) for column in values.T]
        return [
            i for i in range(count) if known[i] and (not self._parts or count < 6 or i + 1 in self._parts)
        ]

    def _draw_panel(self, axes: Axes, panel: Panel, recording: Recording, step: int) -> None:
        axes.grid(color="#e4e4e4", linewidth=0.6)
        axes.set_axisbelow(True)
        drawn: list[tuple[str, Array]] = []
        for name in panel.names:
            values = SIGNALS[name].value(recording)
            if values is None or not self._chosen(values):
                continue
            for i in self._chosen(values):
                color = COLORS[i % len(COLORS)]
                label = SIGNALS[name].parts[i] if not drawn else None
                x, y, style = recording.time[::step], values[::step, i], STYLES[len(drawn)]
                axes.plot(x, y, style, color=color, linewidth=1.1, label=label)
            drawn.append((name, values))
        axes.set_ylabel(_label(panel))
        axes.margins(x=0.01)
        if not drawn:
            text = f"{' + '.join(panel.names)}: not in this recording"
            axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=LIMIT)
            return
        if self._limits != "none":
            self._draw_limits(axes, drawn, recording, step)
        if len(drawn) > 1:
            handles = [
                Line2D([], [], color="black", linestyle=style, label=name)
                for (name, _), style in zip(drawn, STYLES)
            ]
            axes.add_artist(axes.legend(handles=handles, loc="lower left", fontsize=7, framealpha=0.8))
        axes.legend(loc="center left", bbox_to_anchor=(1.005, 0.5), fontsize=8, frameon=False)

    def _draw_limits(
        self, axes: Axes, drawn: Sequence[tuple[str, Array]], recording: Recording, step: int
    ) -> None:
        """The limits of the first signal, and a scale that shows all signals."""
        limits = recording.limits
        signal, values = SIGNALS[drawn[0][0]], drawn[0][1]
        if limits is None or signal.limits is None:
            return
        lower, upper = signal.limits(recording, limits)
        shape = values.shape
        lower, upper = np.broadcast_to(lower, shape), np.broadcast_to(upper, shape)
        shown = np.concatenate([each[:, self._chosen(each)] for _, each in drawn], axis=1)
        low, high = np.nanmin(shown), np.nanmax(shown)
        span = max(high - low, 1e-9)
        hidden = []
        low, high = low - 0.1 * span, high + 0.1 * span
        groups: dict[tuple[bytes, bytes], list[int]] = {}
        for i in self._chosen(values):
            groups.setdefault((lower[:, i].tobytes(), upper[:, i].tobytes()), []).append(i)
        for members in groups.values():
            for bound in (lower, upper):
                line = bound[:, members[0]]
                if not self._matters(
                    values[:, members], lower[:, members], upper[:, members], bound is upper
                ):
                    hidden.append((members, line))
                    continue
                low, high = min(low, np.nanmin(line)), max(high, np.nanmax(line))
                color = LIMIT if len(groups) == 1 else COLORS[members[0] % len(COLORS)]
                axes.plot(recording.time[::step], line[::step], color=color, linewidth=1.0, dashes=(6, 3))
        margin = 0.04 * (high - low)
        axes.set_ylim(low - margin, high + margin)
        if hidden and len(hidden) == 2 * len(groups):
            axes.text(
                0.995,
                0.96,
                "limits outside: " + _ranges(groups, lower, upper, signal.parts),
                transform=axes.transAxes,
                ha="right",
                va="top",
                fontsize=7,
                color=LIMIT,
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1},
            )

    def _matters(self, values: Array, lower: Array, upper: Array, is_upper: bool) -> bool:
        """Whether a limit is to set the scale of the panel."""
        if self._limits == "all":
            return True
        middle = 0.5 * (lower + upper)
        share = (values - middle) / np.maximum(0.5 * (upper - lower), 1e-9)
        share = share[np.isfinite(share)]
        return bool(share.size and (share.max() if is_upper else -share.min()) > NEAR)

    def _draw_modes(self, axes: Axes, recording: Recording) -> None:
        for begin, end, mode in _spans(recording.modes):
            color = MODES[mode][1]
            if color:
                last = min(end, len(recording) - 1)
                axes.axvspan(recording.time[begin], recording.time[last], color=color, zorder=0, linewidth=0)

    def _draw_errors(self, axes: Axes, recording: Recording, named: bool) -> None:
        for time, names in recording.errors:
            if not names or not len(recording) or time < recording.time[0]:
                continue
            axes.axvline(time, color=VIOLATION, linewidth=1.0)
            if named:
                axes.annotate(
                    "\n".join(names),
                    (time, 0.97),
                    xycoords=("data", "axes fraction"),
                    xytext=_beside(recording, time),
                    textcoords="offset points",
                    ha="left" if _beside(recording, time)[0] > 0 else "right",
                    va="top",
                    fontsize=7,
                    color=VIOLATION,
                    bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1},
                )

    def _draw_mode_legend(self, recording: Recording) -> None:
        seen = {mode for _, _, mode in _spans(recording.modes)}
        patches = [
            Patch(facecolor=color or "white", edgecolor="#bbbbbb", label=text)
            for mode, (text, color) in MODES.items()
            if mode in seen
        ]
        if patches:
            axes = self._axes[-1]
            lines = axes.get_legend()
            axes.legend(
                handles=patches,
                loc="upper right",
                bbox_to_anchor=(1.0, -0.14),
                borderaxespad=0,
                ncol=len(patches),
                fontsize=8,
                frameon=False,
            )
            if lines:
                axes.add_artist(lines)
                lines.set_clip_on(False)  # else the layout leaves no space for it


def plot(
    recording: Recording,
    signals: Sequence[str] = DEFAULT,
    *,
    joints: Sequence[int] = (),
    limits: str = "auto",
    title: str = "",
) -> Figure:
    """A figure of a recording, with a panel for each of `signals` (`q`, or `q+q_d` in one).

    Raises BadInput for unknown signals and those that share no panel; TypeError, ValueError for other values.

    >>> pyfranka.plot.plot(pyfranka.plot.of_log(error.log), ["q", "dq"]).savefig(folder / "log.png")
    """
    drawn = Plot(panels_of(signals), parts=joints, limits=limits)
    drawn.draw(recording, title=title)
    return drawn.figure


def plot_abort(
    recording: Recording,
    abort: Abort | None = None,
    signals: Sequence[str] = (),
    *,
    joints: Sequence[int] = (),
    limits: str = "auto",
    title: str = "",
) -> Figure:
    """A motion's last states and commands. The value that broke a limit is marked, with that limit.

    signals: panels; without any those in which the abort's errors show, and some more.
    Raises what plot() raises.

    >>> figure = pyfranka.plot.plot_abort(pyfranka.plot.of_log(error.log))
    >>> figure.savefig(folder / "abort.png")
    """
    require_recording(recording)
    if not isinstance(abort, Abort | None):
        raise TypeError(f"abort must be an Abort, as Abort.of_text() makes it, not {abort!r}.")
    evidence = _evidence(recording, abort.errors if abort else ())
    panels = panels_of(signals or _panels_of_abort(recording, evidence))
    drawn = Plot(panels, parts=joints, limits=limits)
    drawn.draw(
        recording,
        title=title or f"{recording.name}: the last {len(recording)} states{_kind(recording)}",
        named=not (abort and abort.text),
    )
    marked = False
    for axes, panel in zip(drawn.figure.axes, panels):
        for name in panel.names:
            if name in evidence:
                excess = worst(name, recording)
                marked = True
                if excess:
                    _mark(axes, name, excess, recording)
    if abort and abort.text:
        text = "\n".join(
            part for line in abort.text.splitlines() for part in textwrap.wrap(line, WRAP) or [""]
        )
        drawn.figure.axes[0].set_title(text, fontsize=8, loc="left", color=VIOLATION if marked else "black")
        size = drawn.figure.get_size_inches()
        drawn.figure.set_size_inches(size[0], size[1] + 0.16 * (text.count("\n") + 1))
    return drawn.figure


def _evidence(recording: Recording, errors: Sequence[str]) -> list[str]:
    """Signals in which these errors show, each once."""
    names: dict[str, None] = {}
    for error in errors:
        for name in EVIDENCE.get(error, ()):
            values = SIGNALS[name].value(recording)
            if values is not None and np.isfinite(values).any():
                names[name] = None
    return list(names)


def _panels_of_abort(recording: Recording, evidence: Sequence[str]) -> list[str]:
    names = [*evidence, *(name for name in CONTEXT if name not in evidence)]
    return [name for name in names if SIGNALS[name].value(recording) is not None]


def _mark(axes: Axes, name: str, excess: Excess, recording: Recording) -> None:
    """The worst value, and the limit that it is beyond."""
    signal = SIGNALS[name]
    time = recording.time[excess.row]
    unit = signal.unit.split(", ")[excess.part if len(signal.unit.split(", ")) > 1 else 0]
    part = signal.parts[excess.part]
    verb = "allowed" if excess.beyond else "the limit"
    low, high = axes.get_ylim()
    edge = 0.12 * (max(high, excess.value, excess.limit) - min(low, excess.value, excess.limit))
    axes.set_ylim(
        min(low, excess.value - edge, excess.limit - edge),
        max(high, excess.value + edge, excess.limit + edge),
    )
    if excess.beyond:
        axes.axhline(excess.limit, color=VIOLATION, linewidth=1.4)
    axes.plot([time], [excess.value], "o", color=VIOLATION, markersize=6, zorder=5)
    right = time < 0.5 * (recording.time[0] + recording.time[-1])
    above = excess.value < 0.5 * sum(axes.get_ylim())
    axes.annotate(
        f"{part}: {excess.value:.4g} {unit} at {round(1e3 * time)} ms; {excess.limit:.4g} {unit} is {verb}",
        (time, excess.value),
        xytext=(10 if right else -10, 12 if above else -14),
        textcoords="offset points",
        ha="left" if right else "right",
        va="bottom" if above else "top",
        fontsize=8,
        color=VIOLATION,
        bbox={"facecolor": "white", "edgecolor": VIOLATION, "alpha": 0.9, "pad": 2, "linewidth": 0.6},
        zorder=6,
    )


def _title(recording: Recording) -> str:
    return recording.name + _kind(recording)


def _kind(recording: Recording) -> str:
    if not recording.version:
        return " (limits unknown)"
    return f" (limits of {'a Panda' if recording.version <= 5 else 'an FR3'})"


def _label(panel: Panel) -> str:
    return f"{' + '.join(panel.names)}\n[{SIGNALS[panel.names[0]].unit}]"


def _spans(modes: Sequence[int]) -> list[tuple[int, int, pyfranka.RobotMode]]:
    """First row, row after the last one, and mode."""
    if not len(modes):
        return []
    edges = [0, *(int(i) + 1 for i in np.flatnonzero(np.diff(np.asarray(modes)))), len(modes)]
    return [(a, b, pyfranka.RobotMode(modes[a])) for a, b in zip(edges, edges[1:])]


def _beside(recording: Recording, time: float) -> tuple[int, int]:
    return (4, 0) if time < 0.5 * (recording.time[0] + recording.time[-1]) else (-4, 0)


def _ranges(
    groups: Mapping[tuple[bytes, bytes], list[int]], lower: Array, upper: Array, parts: Sequence[str]
) -> str:
    """ "±2.175 rad/s for joints 1 to 4" and so on, in few words."""
    texts = []
    for members in groups.values():
        low, high = np.nanmax(lower[:, members[0]]), np.nanmin(upper[:, members[0]])
        bound = f"±{high:.4g}" if low == -high else f"{low:.4g} to {high:.4g}"
        texts.append((bound, [parts[i].removeprefix("joint ") for i in members]))
    if len(texts) == 1:
        return texts[0][0]
    return ", ".join(f"{bound} ({' '.join(names)})" for bound, names in texts)
