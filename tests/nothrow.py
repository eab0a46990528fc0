# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Finds pairs of functions of which the first is noexcept and the second may throw.

clang compiles a source to its intermediate language. There, a call that may throw within a noexcept function
(or a destructor) is an `invoke` whose other end is std::terminate. What may throw:

* a function of this project that is not noexcept and whose body another source has;
* a function whose body this source has, if it calls one that may throw;
* a `throw`, or what the standard library throws, except for the exceptions of IGNORED.

Not found: calls through pointers, which are virtual functions and std::function; functions of other projects,
which throw for wrong use (and for want of memory, which ends the program anyway).

`// NOLINT(nothrow)` at the end of a line, with the reason, accepts its call. style.py runs this check.
"""

import re
import shlex
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

COMPILER = "clang++-22"
ACCEPTED = "NOLINT(nothrow)"

# Exceptions that a noexcept function may meet: no memory, a variant that a failed assignment has emptied, an
# empty std::function, a mutex that this thread has locked already.
IGNORED = (
    "bad_alloc",
    "length_error",
    "bad_array_new_length",
    "bad_variant_access",
    "bad_function_call",
    "system_error",
    "lock_error",
)
# Functions of the standard library that throw others of no interest: a std::string of a null pointer.
IGNORED_THROWERS = ("__throw_logic_error",)

DEFINITION = re.compile(r'^(define|declare)\b.* @("[^"]+"|[\w.$]+)\(')
GROUP = re.compile(r"#(\d+)")
CALL = re.compile(r'\b(call|invoke)\b.* @("[^"]+"|[\w.$]+)\(')
UNWIND = re.compile(r"\bunwind label %([\w.]+)")
LABEL = re.compile(r"^([\w.]+):")
NEXT = re.compile(r"(?<!unwind )\blabel %([\w.]+)")
THROWN = re.compile(r"@_ZTI(\w+)")
DEBUG = re.compile(r"!dbg !(\d+)")
METADATA = re.compile(r"^!(\d+) = (?:distinct )?!(\w+)\((.*)\)$")
FIELD = re.compile(r'(\w+): (?:!(\d+)|"([^"]*)"|(\d+))')
NAMESPACE = re.compile(r"^_Z+N[KVRO]*(\d+)(\w+)")
STANDARD = re.compile(r"^_Z+N?[KVRO]*S[tabsiod]")


@dataclass
class Call:
    callee: str
    unwinds_to: str | None  # a block; None: to the caller
    nounwind: bool
    thrown: str | None  # the type's name, if it is a throw
    debug: str | None


@dataclass
class Function:
    calls: list[Call] = field(default_factory=list)
    blocks: dict[str, list[str]] = field(default_factory=dict)

    def terminates(self, block: str) -> bool:
        """Whether an exception that arrives in a block ends the program: no way from there catches it."""
        ends, seen, left = False, {block}, [block]
        while left:
            for line in self.blocks.get(left.pop(), []):
                if "@__cxa_begin_catch" in line or line.lstrip().startswith("resume "):
                    return False
                ends = ends or "@__clang_call_terminate" in line
                following = set(NEXT.findall(line)) - seen
                seen |= following
                left += following
        return ends

    def catches(self, block: str) -> bool:
        """Whether all exceptions, or those of the standard library, end there."""
        return any(re.search(r"catch ptr (null|@_ZTISt9exception)\b", x) for x in self.blocks.get(block, []))


class Module:
    """A source in the intermediate language."""

    def __init__(self, text: str, own: set[str]):
        self._own, self._lines = own, text.splitlines()
        groups = re.findall(r"^attributes #(\d+) = \{(.*)\}", text, re.M)
        self._nounwind_groups = {number for number, content in groups if re.search(r"\bnounwind\b", content)}
        self._nounwind: set[str] = set()
        self.functions: dict[str, Function] = {}
        self._known: dict[str, bool] = {}
        self._read()

    def _is_nounwind(self, line: str) -> bool:
        return any(number in self._nounwind_groups for number in GROUP.findall(line))

    def _read(self) -> None:
        function, block, invoke = None, "", None
        for line in self._lines:
            if line[:1] == "d" and (match := DEFINITION.match(line)):
                if self._is_nounwind(line):
                    self._nounwind.add(match[2])
                function = self.functions.setdefault(match[2], Function()) if match[1] == "define" else None
                block = ""
            elif function is None:
                continue
            elif line == "}":
                function = None
            elif match := LABEL.match(line):
                block = match[1]
            else:
                function.blocks.setdefault(block, []).append(line)
                if match := CALL.search(line):
                    call = self._call(match, line)
                    function.calls.append(call)
                    invoke = call if match[1] == "invoke" else None
                if invoke is not None and (match := UNWIND.search(line)):
                    invoke.unwinds_to = match[1]
                    found = DEBUG.search(line)
                    invoke.debug = found[1] if found else invoke.debug
                    invoke = None

    def _call(self, match: re.Match, line: str) -> Call:
        thrown = THROWN.search(line) if match[2] == "__cxa_throw" else None
        debug = DEBUG.search(line)
        return Call(
            match[2], None, self._is_nounwind(line), thrown and thrown[1], debug[1] if debug else None
        )

    def _is_own(self, symbol: str) -> bool:
        """Whether a function is of this project, by its outermost namespace."""
        if match := NAMESPACE.match(symbol):
            return match[2][: int(match[1])] in self._own
        return False

    def may_throw(self, call: Call) -> bool:
        if call.callee == "__cxa_throw":
            return not any(name in (call.thrown or "") for name in IGNORED)
        if STANDARD.match(call.callee) and "__throw_" in call.callee:
            return not any(name in call.callee for name in IGNORED + IGNORED_THROWERS)
        if call.nounwind or call.callee in self._nounwind:
            return False
        return self._function_may_throw(call.callee)

    def _function_may_throw(self, symbol: str) -> bool:
        function = self.functions.get(symbol)
        if function is None:
            return self._is_own(symbol)
        if symbol not in self._known:
            self._known[symbol] = False  # for functions that call each other
            theirs = not self._is_own(symbol) and not STANDARD.match(symbol)
            self._known[symbol] = any(
                self.may_throw(call)
                for call in function.calls
                if not (theirs and "throw" in call.callee)  # what they throw by themselves
                and (
                    call.unwinds_to is None
                    or not (function.terminates(call.unwinds_to) or function.catches(call.unwinds_to))
                )
            )
        return self._known[symbol]

    def pairs(self) -> Iterator[tuple[str, Call]]:
        """The functions that would end the program, each with the call that may throw."""
        for name, function in self.functions.items():
            for call in function.calls:
                if call.unwinds_to and function.terminates(call.unwinds_to) and self.may_throw(call):
                    yield name, call

    @cached_property
    def _metadata(self) -> dict[str, tuple[str, dict[str, str]]]:
        found = {}
        for line in self._lines:
            if line[:1] == "!" and (match := METADATA.match(line)):
                fields = {name: "".join(values) for name, *values in FIELD.findall(match[3])}
                found[match[1]] = match[2], fields
        return found

    def places(self, debug: str | None) -> Iterator[tuple[str, int]]:
        """Where a call stands, and the calls of the functions in which the compiler has put it."""
        while debug in self._metadata:
            fields = self._metadata[debug][1]
            scope = fields.get("scope", "")
            while scope in self._metadata and "file" not in self._metadata[scope][1]:
                scope = self._metadata[scope][1].get("scope", "")
            file = self._metadata.get(self._metadata.get(scope, ("", {}))[1].get("file", ""), ("", {}))[1]
            path = Path(file.get("directory", ""), file.get("filename", ""))
            yield str(path), int(fields.get("line") or 0)
            debug = fields.get("inlinedAt")


def own_namespaces(files: list[Path]) -> set[str]:
    """The namespaces of headers and sources, without those of others that they add to."""
    opened = re.compile(r"^namespace (\w+)", re.M)
    names: set[str] = set()
    for path in files:
        names.update(opened.findall(path.read_text(encoding="utf-8")))
    return names - {"std", "ros", "boost", "Eigen", "pybind11", "testing"}


def compiled(entry: dict) -> str:
    """A source in the intermediate language. @param entry of compile_commands.json
    @throws RuntimeError with the compiler's messages"""
    words = entry.get("arguments") or shlex.split(entry["command"])
    while not re.search(r"(\+\+|cc|clang)[\d.-]*$", Path(words[0]).name) or "ccache" in words[0]:
        words = words[1:]
    kept = []
    for word in words[1:]:
        if kept and kept[-1] == "-o":
            kept.pop()
        elif word != "-c":
            kept.append(word)
    command = [COMPILER, *kept, "-w", "-O1", "-gline-tables-only", "-S", "-emit-llvm", "-o", "-"]
    result = subprocess.run(command, cwd=entry["directory"], capture_output=True, text=True)
    if result.returncode != 0:
        errors = [line for line in result.stderr.splitlines() if "error: " in line] or [result.stderr]
        raise RuntimeError(f"{entry['file']} cannot be compiled by {COMPILER}: {errors[0]}")
    return result.stdout


def demangled(names: list[str]) -> list[str]:
    result = subprocess.run(["c++filt"], input="\n".join(names), capture_output=True, text=True, check=True)
    return result.stdout.splitlines()


def short(name: str) -> str:
    """A demangled function without its arguments, those of its templates, and its result."""
    depth, kept = 0, ""
    for letter in name.replace("(anonymous namespace)::", ""):
        depth += (letter == "<") - (letter == ">")
        kept += letter if depth == 0 and letter != ">" else ""
    function = re.search(r"([A-Za-z_~][\w:~]*[^\w\s(]{0,3})\(", kept)
    return function[1] if function else name


def findings(entry: dict, own: set[str], top: Path) -> list[str]:
    """Lines `file:line: what` for a source."""
    try:
        module = Module(compiled(entry), own)
    except RuntimeError as error:
        return [str(error)]
    pairs = list(module.pairs())
    names = demangled([symbol for caller, call in pairs for symbol in (caller, call.callee)])
    found = []
    for index, (_, call) in enumerate(pairs):
        caller, callee = short(names[2 * index]), short(names[2 * index + 1])
        if call.thrown:
            callee = f"throw of {demangled([f'_ZTI{call.thrown}'])[0].removeprefix('typeinfo for ')}"
        places = [(Path(file).resolve(), line) for file, line in module.places(call.debug)]
        ours = [(file, line) for file, line in places if file.is_relative_to(top) and file.is_file()]
        # Without a place of ours, another project's code calls its own.
        if not ours or any(ACCEPTED in line_of(file, line) for file, line in ours):
            continue
        file, line = ours[0]
        found.append(f"{file.relative_to(top)}:{line}: {caller} is noexcept, but {callee} may throw")
    return list(dict.fromkeys(found))


def line_of(path: Path, number: int) -> str:
    lines = path.read_text(encoding="utf-8").splitlines()
    return lines[number - 1] if 0 < number <= len(lines) else ""
