# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a page of the documentation as its reader does: types its commands, writes its files, compares what is
printed, looks at its pictures.

Blocks are used in the order of the page:

* ```bash: each command is typed into a terminal, a shell in the project's folder, and must succeed.
* ```text after it: what the reader sees. Its lines are printed in this order; `...` stands for any text.
* Any other block after `<!-- file: ~/path -->`: is written to this file.
* Any other block after `<!-- run with: COMMAND -->`: the command gets it as a file, and must succeed.

Comments, each on a line of its own, say what a reader knows from the text:

* `<!-- terminals: COMMAND -->`: typed first in each terminal of the page, such as `./franka shell`.
* `<!-- terminal 2 -->`: from here on commands are typed into this terminal (1 at the beginning).
* `<!-- type: COMMAND -->`: a command of the text, which keeps running.
* `<!-- keeps running -->`: the last command of the next block does not end.
* `<!-- press Ctrl-C in terminal 1 -->`
* `<!-- fails -->`: the last command of the next block ends with an error.
* `<!-- status: 0 or 1 -->`: the last command of the next block ends with one of these.
* `<!-- takes minutes -->`: a command of the next block may take half an hour.
* `<!-- run by: tests/test_x.py::test_y -->`: the next block is not typed, but used by this test.
* `<!-- only parsed: REASON -->`: the next block is not typed. What it is written in can read it, and the
  commands that it names exist (test_docs_code.py, test_page_commands.py). The reason is one of ONLY_PARSED.
* `<!-- with a simulated robot: 172.16.0.2 is 127.0.0.1 -->`: what is typed here instead, in all blocks.
* `<!-- expect: TEXT -->`: printed by the last block of this terminal, sooner or later.
* `<!-- await: COMMAND == TEXT -->`: the reader waits until a command prints this.
* `<!-- picture: ~/made.png is name.png -->`: a picture that the commands have made.
* `<!-- window: TITLE is name.png -->`: a picture of a window.
* `<!-- drag: TITLE 100,200 to 300,250 -->`: drags the mouse in a window.
* `<!-- with an FR3: panda.launch is fr3.launch -->`: what the reader types who has an FR3.
"""

import codecs
import os
import pty
import re
import signal
import subprocess
import threading
import time
import uuid
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from franka_sim_mujoco.session import free_port
from own_process import kill_processes_with
from PIL import Image, ImageChops, ImageStat
from screen import drag, move_window, picture_of, window_of
from waiting import holds

TOP = Path(__file__).resolve().parents[2]
PAGES = sorted((TOP / "docs").glob("get_started/*.md")) + sorted((TOP / "docs").glob("tutorials/*.md"))
# Other pages whose blocks are typed.
MORE_PAGES = [
    *sorted((TOP / "docs").glob("how_to/*.md")),
    *(
        TOP / "docs" / f"{name}.md"
        for name in ("franka_sim", "examples_cpp", "examples_python", "desk", "sim_to_real")
    ),
    TOP / "README.md",
]
# Why a block can only be parsed here.
ONLY_PARSED = {"needs Docker", "changes the system"}
PICTURES = TOP / "docs" / "pictures" / "tutorials"
SCREEN = "2400x900x24"  # for virtual_screen
WINDOWS_AT = 1200  # [pixels] from the left: beside the simulation's own window
WINDOW_SIZE = (1200, 860)
LIMIT = 240.0  # [s] for a command, and for anything that is awaited
LONG_LIMIT = 1800.0  # [s] for a command that compiles a whole library

SUFFIXES = {"python": "py", "xml": "xml", "yaml": "yaml"}
PROMPT = re.compile(r"(?:\(franka\) )?\[:(\d+|more):\] ")
# Without line editing and echo, the terminal shows only what programs print.
BASHRC = "set +o emacs +o vi\nstty -echo\nPS1='[:$?:] '\nPS2='[:more:] '\nunset PROMPT_COMMAND\n"
# Only roslaunch takes the port from ROS_MASTER_URI.
BASHRC += 'roscore() { command roscore -p "${ROS_MASTER_URI##*:}" "$@"; }\n'
ESCAPES = re.compile(r"\x1b\][^\x07]*\x07|\x1b\[[0-9;?]*[a-zA-Z]|\x1b[()=>][B0]?|\r")
COMMENT = re.compile(r"^\s*<!-- (.*) -->\s*$")
FENCE = re.compile(r"^(\s*)```(\w*)\s*$")


class PageError(AssertionError):
    """A step of a page does not do what the page says; the message names file and line."""


@dataclass
class Step:
    """A block or a comment of a page."""

    kind: str  # bash, text, file, or the first word of a comment
    text: str
    line: int
    path: str = ""  # of a file
    language: str = ""
    options: set[str] = field(default_factory=set)  # of a bash block
    mark: str = ""  # of a block that is not typed: `run by: ...` or `only parsed: ...`


@dataclass
class Page:
    """A page and what it says in the order of its lines."""

    path: Path
    steps: list[Step]
    first: str = ""  # typed first in each terminal

    def of(self, kind: str) -> list[Step]:
        return [step for step in self.steps if step.kind == kind]

    def block_with(self, text: str) -> str:
        """The only block of commands, or block that a test uses, with this text in it."""
        (block,) = (step.text for step in self.of("bash") if text in step.text)
        return block


VARIANT = "<!-- with an FR3: "
SIMULATED = "<!-- with a simulated robot: "
COMMENTS = ("terminal", "press", "type:", "expect:", "await:", "picture:", "window:", "drag:")
OPTIONS = ("keeps running", "fails", "status", "takes minutes")
MARKS = ("run by", "only parsed")


def has_variant(path: Path) -> bool:
    """Whether the page says what changes with an FR3."""
    return VARIANT in path.read_text(encoding="utf-8")


def read(path: Path, variant: bool = False) -> Page:
    """Reads a page, as it stands or with what changes with an FR3. Raises PageError for a comment or a block
    that means nothing."""
    steps, options, file, command, mark, first = [], set(), "", "", "", ""
    fence, block, begin = None, [], 0
    lines = path.read_text(encoding="utf-8").splitlines()
    for kind in (SIMULATED, *([VARIANT] if variant else [])):
        changes = [line.removeprefix(kind).removesuffix(" -->") for line in lines if line.startswith(kind)]
        for old, new in (change.split(" is ") for change in changes):
            lines = [line if line.startswith(kind) else line.replace(old, new) for line in lines]
    for number, line in enumerate(lines, 1):
        where = f"{path.name}:{number}"
        if fence is not None:
            if line.strip() != "```":
                block.append(line.removeprefix(fence[0]))
                continue
            text, language = "\n".join(block) + "\n", fence[1]
            if file:
                steps.append(Step("file", text, begin, file, language))
            elif command:
                steps.append(Step("program", text, begin, command, language))
            elif language == "bash" or mark:
                if mark:
                    check_mark(mark, where)
                steps.append(Step("bash", text, begin, language=language, options=options, mark=mark))
            elif language == "text":
                steps.append(Step("text", text, begin, language=language))
            elif language:
                raise PageError(f"{where}: a block of {language} without <!-- file: ... -->")
            fence, options, file, command, mark = None, set(), "", "", ""
            continue
        opened, comment = FENCE.match(line), COMMENT.match(line)
        if opened:
            fence, block, begin = opened.groups(), [], number
        elif not comment or line.startswith((VARIANT, SIMULATED)):
            continue
        elif comment[1].startswith("file: "):
            file = comment[1].removeprefix("file: ")
        elif comment[1].startswith("run with: "):
            command = comment[1].removeprefix("run with: ")
        elif comment[1].startswith("terminals: "):
            first = comment[1].removeprefix("terminals: ")
        elif comment[1].partition(":")[0] in OPTIONS:
            options.add(comment[1])
        elif comment[1].partition(":")[0] in MARKS:
            mark = comment[1]
        elif kind := next((k for k in COMMENTS if comment[1].startswith(k + " ")), None):
            steps.append(Step(kind.rstrip(":"), comment[1].removeprefix(kind).strip(), number))
        else:
            raise PageError(f"{where}: unknown comment <!-- {comment[1]} -->")
    if fence is not None:
        raise PageError(f"{path.name}:{begin}: this block does not end")
    return Page(path, steps, first)


def check_mark(mark: str, where: str) -> None:
    """Raises PageError for a test that does not exist, or another reason why a block is only parsed."""
    kind, _, value = mark.partition(": ")
    if kind == "run by":
        file, _, case = value.partition("::")
        if not (TOP / file).is_file() or f"def {case}(" not in (TOP / file).read_text(encoding="utf-8"):
            raise PageError(f"{where}: there is no test {value}")
    elif value not in ONLY_PARSED:
        raise PageError(f"{where}: `{value}` is not in ONLY_PARSED")


def lines_in_order(expected: str, printed: str) -> str | None:
    """The first expected line that is not printed after those before it; None if all are."""
    here, rest = 0, printed.splitlines()
    for line in expected.splitlines():
        if not line.strip() or line.strip() == "...":
            continue
        pattern = re.compile(".*".join(re.escape(part.strip()) for part in line.split("...")))
        for index in range(here, len(rest)):
            if pattern.search(rest[index]):
                here = index + 1
                break
        else:
            return line
    return None


def is_expected(status: str, options: set[str]) -> bool:
    """Whether the last command of a block may end with this status."""
    for option in options:
        if option.startswith("status: "):
            return status in option.removeprefix("status: ").split(" or ")
    return (status not in ("0", "more")) == ("fails" in options)


class Terminal:
    """A shell on a terminal of its own, into which lines are typed."""

    def __init__(self, environment: dict[str, str]):
        ours, theirs = pty.openpty()
        self._process = subprocess.Popen(
            ["setsid", "--ctty", "bash", "-i"],
            stdin=theirs,
            stdout=theirs,
            stderr=theirs,
            cwd=TOP,
            env=environment,
        )
        os.close(theirs)
        self._file, self.raw = ours, ""  # what it has shown so far; written by one thread
        self._begin = 0  # of what the last block has printed
        self.busy, self._started = False, 0  # whether a program keeps running, and since which output
        self._shell = b""  # the command line of the shell that has started it
        threading.Thread(target=self._read, daemon=True).start()
        self._prompt(0, LIMIT)

    def _read(self) -> None:
        decoder = codecs.getincrementaldecoder("utf-8")("replace")
        with suppress(OSError):
            while data := os.read(self._file, 65536):
                self.raw += decoder.decode(data)

    @property
    def printed(self) -> str:
        """What the last block has printed so far."""
        return PROMPT.sub("", ESCAPES.sub("", self.raw[self._begin :]))

    def _prompt(self, begin: int, limit: float) -> str | None:
        """Waits for the next prompt; returns the status, or "more" for an unfinished command."""
        holds(lambda: PROMPT.search(self.raw, begin), limit)
        found = PROMPT.search(self.raw, begin)
        return found and found[1]

    def type(self, text: str, options: set[str]) -> None:
        """Types a block, command by command."""
        if self.busy:
            raise PageError("a program is still running in this terminal")
        self._begin = len(self.raw)
        lines = text.rstrip("\n").split("\n")
        for index, line in enumerate(lines):
            begin, last = len(self.raw), index == len(lines) - 1
            keeps_running = last and "keeps running" in options
            if keeps_running:
                self._shell = self._foreground()
            os.write(self._file, line.encode() + b"\n")
            if keeps_running:
                self.busy, self._started = True, begin
                return
            limit = LONG_LIMIT if "takes minutes" in options else LIMIT
            status = self._prompt(begin, limit)
            if status is None:
                raise PageError(f"`{line}` did not end within {limit:.0f} s:\n{self.tail()}")
            if not (is_expected(status, options) if last else status in ("0", "more")):
                raise PageError(f"`{line}` ended with status {status}:\n{self.tail()}")
            if last and status == "more":
                raise PageError(f"`{line}` is not a complete command")

    def prints(self, check, limit: float) -> bool:
        """Waits until what the last block has printed passes a check."""
        if self.busy:
            holds(lambda: check(self.printed) or PROMPT.search(self.raw, self._started), limit)
        return check(self.printed)

    def _foreground(self) -> bytes:
        """The command line of what Ctrl-C would interrupt; empty if it has just ended."""
        with suppress(OSError):
            return Path(f"/proc/{os.tcgetpgrp(self._file)}/cmdline").read_bytes()
        return b""

    def _program_runs(self) -> bool:
        """Whether the shell has started a program. Before, Ctrl-C would interrupt the shell in its fork."""
        return self._foreground() not in (b"", self._shell)

    def interrupt(self) -> None:
        """Presses Ctrl-C once the program runs, and waits for the prompt."""
        if not holds(lambda: PROMPT.search(self.raw, self._started) or self._program_runs(), LIMIT):
            raise PageError(f"the shell has not started the program:\n{self.tail()}")
        if not PROMPT.search(self.raw, self._started):  # at the prompt, Ctrl-C would print a second one
            os.write(self._file, b"\x03")
        if self._prompt(self._started, LIMIT) is None:
            raise PageError(f"the program did not end after Ctrl-C:\n{self.tail()}")
        self.busy = False

    def tail(self) -> str:
        return "\n".join(self.printed.splitlines()[-40:])

    def close(self) -> None:
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGHUP)
            try:
                self._process.wait(5)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        os.close(self._file)


def check_picture(path: Path) -> None:
    """A picture is large enough and has something on it, up to a reasonable distance from its edges."""
    if not path.exists():
        raise PageError(f"there is no picture {path.name}")
    with Image.open(path) as picture:
        gray = picture.convert("L")
        if min(picture.size) < 300:
            raise PageError(f"{path.name} has {picture.size} pixels only")
        width, height = gray.size
        middle = gray.crop((width // 4, height // 4, 3 * width // 4, 3 * height // 4))
        if min(max(ImageStat.Stat(part).stddev) for part in (gray, middle)) < 5.0:
            raise PageError(f"{path.name} has nothing on it")


class Reader:
    """Follows pages: its home is a new folder, its ROS master has a port of its own."""

    def __init__(self, home: Path, **variables: str):
        self.home, self._mark = home, uuid.uuid4().hex
        self.log = home.with_suffix(".log")  # at the end: what all terminals have shown
        home.mkdir(parents=True, exist_ok=True)
        (home / ".bashrc").write_text(BASHRC)
        kept = ("DISPLAY", "LIBGL_ALWAYS_SOFTWARE", "CCACHE_DIR")
        self._environment = {
            "HOME": str(home),
            "PATH": "/usr/local/bin:/usr/bin:/bin",
            "LANG": "C.UTF-8",
            "TERM": "xterm",
            "ROS_MASTER_URI": f"http://localhost:{free_port()}",
            "ROS_HOME": str(home / ".ros"),
            "ROS_LOG_DIR": str(home / ".ros" / "log"),
            "TUTORIAL_READER": self._mark,
            **{name: os.environ[name] for name in kept if name in os.environ},
            **variables,
        }
        self._terminals: dict[str, Terminal] = {}
        self.pictures: dict[str, Path] = {}  # made so far, by their names in docs/pictures
        self._first, self._programs = "", 0

    def __enter__(self) -> "Reader":
        return self

    def __exit__(self, *_) -> None:
        for terminal in self._terminals.values():
            if terminal.busy:
                with suppress(AssertionError, OSError):
                    terminal.interrupt()
        self.log.write_text("\n".join(terminal.raw for terminal in self._terminals.values()))
        kill_processes_with("TUTORIAL_READER", self._mark)
        for terminal in self._terminals.values():
            terminal.close()

    def follow(self, page: Page) -> None:
        """Fails at the first step that does not do what the page says."""
        self._first = page.first
        self._terminal = self.terminal("1")
        for step in page.steps:
            begin = time.monotonic()
            try:
                getattr(self, f"_do_{step.kind}")(step)
            except AssertionError as error:
                others = [t.tail() for t in self._terminals.values() if t.busy and t is not self._terminal]
                others_output = "".join(f"\n---- meanwhile, in another terminal:\n{tail}" for tail in others)
                raise PageError(f"{page.path.name}:{step.line}: {error}{others_output}") from error
            took = time.monotonic() - begin
            if took > 1.0:
                print(f"{page.path.name}:{step.line}: {step.kind} {took:.1f} s", flush=True)

    def _do_bash(self, step: Step) -> None:
        if not step.mark:
            self._terminal.type(step.text, step.options)

    def _do_text(self, step: Step) -> None:
        terminal = self._terminal
        if not terminal.prints(lambda printed: lines_in_order(step.text, printed) is None, LIMIT):
            line = lines_in_order(step.text, terminal.printed)
            raise PageError(f"the line `{line}` was not printed, but:\n{terminal.tail()}")

    def _do_expect(self, step: Step) -> None:
        if not self._terminal.prints(lambda printed: step.text in printed, LIMIT):
            raise PageError(f"`{step.text}` was not printed, but:\n{self._terminal.tail()}")

    def _do_file(self, step: Step) -> None:
        path = self._path(step.path)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(step.text, encoding="utf-8")

    def _do_program(self, step: Step) -> None:
        self._programs += 1
        path = self.home / f"program_{self._programs}.{SUFFIXES.get(step.language, 'txt')}"
        path.write_text(step.text, encoding="utf-8")
        self._terminal.type(f"(cd && {step.path} {path})", set())

    def _do_type(self, step: Step) -> None:
        self._terminal.type(step.text, {"keeps running"})

    def _do_terminal(self, step: Step) -> None:
        self._terminal = self.terminal(step.text)

    def terminal(self, name: str) -> Terminal:
        if name not in self._terminals:
            self._terminals[name] = Terminal(self._environment)
            if self._first:
                self._terminals[name].type(self._first, set())
        return self._terminals[name]

    def _do_press(self, step: Step) -> None:
        self.terminal(step.text.removeprefix("Ctrl-C in terminal ")).interrupt()

    def _do_await(self, step: Step) -> None:
        command, _, text = step.text.partition(" == ")
        typed, options = [TOP / "franka", "shell", "bash", "-c", command], {"env": self._environment}
        options |= {"text": True, "stdin": subprocess.DEVNULL, "stderr": subprocess.STDOUT}

        def printed() -> str:
            return subprocess.run(typed, stdout=subprocess.PIPE, timeout=LIMIT, **options).stdout

        if not holds(lambda: text in printed(), LIMIT):
            others = f"{printed()}\n{self._terminal.tail()}"
            raise PageError(f"`{command}` still does not print `{text}`, but {others}")

    def _do_picture(self, step: Step) -> None:
        made, name = step.text.split(" is ")
        path = self._path(made)
        check_picture(path)
        self.pictures[name] = path

    def _do_window(self, step: Step) -> None:
        title, name = step.text.split(" is ")
        path = self.home / name
        if not holds(lambda: self._is_drawn(title, path), LIMIT, 0.5):
            raise PageError(f"there is no window {title}, or it stays empty")
        check_picture(path)
        self.pictures[name] = path

    def _is_drawn(self, title: str, path: Path) -> bool:
        """Takes a picture of a window; whether it shows a scene, and the same one as the picture before."""
        before = path.with_name(f"before_{path.name}")
        if path.exists():
            path.rename(before)
        if not picture_of(title, path, WINDOWS_AT, 0, WINDOW_SIZE) or not before.exists():
            return False
        scenes = []
        for picture in (before, path):
            with Image.open(picture) as whole:  # without panels and the line that counts frames
                width, height = whole.size
                box = (width // 2, height // 8, width, 7 * height // 8)
                scenes.append(whole.convert("RGB").crop(box))
        # Edges of an arm at rest may flicker.
        if scenes[0].size != scenes[1].size or max(ImageStat.Stat(ImageChops.difference(*scenes)).mean) > 0.2:
            return False
        return max(ImageStat.Stat(scenes[1]).stddev) > 10.0

    def _do_drag(self, step: Step) -> None:
        found = re.fullmatch(r"(.*) (\d+),(\d+) to (\d+),(\d+)", step.text)
        if not holds(lambda: window_of(found[1]), LIMIT):
            raise PageError(f"there is no window {found[1]}")
        # Nothing covers it there; there is no window manager.
        move_window(window_of(found[1]), WINDOWS_AT, 0, WINDOW_SIZE)
        x, y, to_x, to_y = map(int, found.groups()[1:])
        drag(WINDOWS_AT + x, y, WINDOWS_AT + to_x, to_y)

    def _path(self, written: str) -> Path:
        return Path(written.replace("~", str(self.home), 1)) if written[0] == "~" else TOP / written
