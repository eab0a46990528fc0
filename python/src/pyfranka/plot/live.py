# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A window with a plot: of a recording, or of states as they come."""

from __future__ import annotations

import signal

from matplotlib.figure import Figure

from pyfranka.plot.figure import Plot
from pyfranka.plot.recording import BadInput
from pyfranka.plot.sources import Live

PERIOD = 100  # [ms] between pictures (chosen here)
POINTS = 1500  # a line, in a window that is drawn again and again


class Window:
    """A window of Tk with a figure and matplotlib's tool bar. Raises BadInput without a display."""

    def __init__(self, figure: Figure, title: str):
        try:
            import tkinter

            from matplotlib.backends.backend_tkagg import FigureCanvasTkAgg, NavigationToolbar2Tk

            self.root = tkinter.Tk()
        except ImportError as error:
            raise BadInput(
                f"A window needs Tk ({error}): install python3-tk and python3-pil.imagetk, or use --output."
            ) from None
        except tkinter.TclError as error:
            raise BadInput(f"There is no display for a window ({error}); --output writes a file.") from None
        self.root.title(title)
        self.canvas = FigureCanvasTkAgg(figure, self.root)
        width, height = (int(inches * figure.dpi) for inches in figure.get_size_inches())
        height = min(height, self.root.winfo_screenheight() - 120)
        NavigationToolbar2Tk(self.canvas, self.root).pack(side="bottom", fill="x")
        self.canvas.get_tk_widget().configure(width=width, height=height)
        self.canvas.get_tk_widget().pack(side="top", fill="both", expand=True)
        self.root.protocol("WM_DELETE_WINDOW", self.root.quit)

    def run(self) -> None:
        """Until it is closed, or Ctrl-C."""
        asked: list[int] = []
        # Tk swallows exceptions of its callbacks, also KeyboardInterrupt.
        before = signal.signal(signal.SIGINT, lambda number, _: asked.append(number))

        def poll() -> None:
            if asked:
                self.root.quit()
            else:
                self.root.after(PERIOD, poll)

        try:
            self.canvas.draw()
            poll()
            self.root.mainloop()
            self.root.destroy()
        finally:
            signal.signal(signal.SIGINT, before)


class LiveWindow:
    """Shows the last seconds of a live source."""

    def __init__(self, source: Live, drawn: Plot, seconds: float, title: str):
        self._source, self._plot, self._seconds = source, drawn, seconds
        self._title, self._shown = title, -1.0
        self._window = Window(drawn.figure, title)

    def run(self) -> None:
        """Until it is closed, or Ctrl-C."""
        self._update()
        self._window.run()

    def _update(self) -> None:
        recording = self._source.collector.recording(self._seconds)
        ended = self._source.ended.is_set()
        if recording.time[-1] != self._shown or ended:
            self._shown = recording.time[-1]
            note = f"\nended: {self._source.error}" if ended and self._source.error else ""
            self._plot.draw(recording, title=self._title + note if note else "", most=POINTS)
            self._window.canvas.draw_idle()
        if not ended:
            self._window.root.after(PERIOD, self._update)
