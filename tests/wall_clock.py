# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Finds tests whose verdict depends on how fast the machine is, and those that wait in a loop of their own.

A test outside of `./franka test --realtime` may wait with a deadline of at least 30 s. It neither asserts
that something took less, nor sleeps until something has probably happened. Two files have the loops that
wait for a condition.
"""

import ast
import re
from collections.abc import Iterator

DEADLINE = 30  # [s] the shortest upper bound on a wall time (chosen here)
CLOCKS = {"monotonic", "monotonic_ns", "perf_counter", "perf_counter_ns", "time", "time_ns"}
WAITING = ("tests/support/waiting.py", "tests/include/ros_test/eventually.h")
# What a line says that may sleep: the fault that the test is about, or the period of a loop, on which no
# verdict depends.
ALLOWED = ("the fault itself", "the loop's period")
ADVICE = f"wait for a state with a deadline ({', '.join(WAITING)}), or count ticks"
PYTHON_SLEEP = re.compile(r"\bsleep\(")
CPP_SLEEP = re.compile(r"\b(sleep_for|sleep_until|u?sleep|nanosleep)\(")
CPP_NOW = r"\w*(?:_clock|Clock|WallTime)::now\(\)"
CPP_SPAN = re.compile(rf"(\w+)\s*=[^;=]*?(?:{CPP_NOW}\s*-|-\s*{CPP_NOW})")
CPP_UPPER = re.compile(r"\b(?:EXPECT|ASSERT)_(?:LT|LE)\(([^;]*)\);")
CPP_POLL = re.compile(rf"{CPP_NOW}\s*[+<>]|[<>]=?\s*(?:\w+::)*{CPP_NOW}")
# Real-time cases end their names so, or carry the mark (CONTRIBUTING.md, "Tests").
CPP_REALTIME = re.compile(r"\bTEST(?:_F|_P)?\((\w*OnWallClock,\s*\w+|\w+,\s*\w*OnWallClock)\)")


def is_test(name: str) -> bool:
    """Whether a file, by its path in the repository, is part of the tests."""
    return bool(re.search(r"(^|/)tests?/", name)) and "/bench/" not in name


def findings(name: str, text: str) -> Iterator[str]:
    """Lines `file:line: what` about a test's text."""
    if not is_test(name) or name in WAITING:
        return
    python = name.endswith(".py")
    realtime = realtime_lines(text, python)
    sleep = PYTHON_SLEEP if python else CPP_SLEEP
    for number, line in enumerate(text.splitlines(), 1):
        code = line.split("#" if python else "//")[0]
        if sleep.search(code) and number not in realtime and not line.rstrip().endswith(ALLOWED):
            yield f"{name}:{number}: a test sleeps: {ADVICE}"
    for number in python_bounds(text) if python else cpp_bounds(text):
        if number not in realtime:
            yield f"{name}:{number}: an upper bound below {DEADLINE} s on a wall time: {ADVICE}"
    for number in python_polls(text) if python else cpp_polls(text):
        if number not in realtime:
            yield f"{name}:{number}: a loop of its own waits until a time: {ADVICE}"


# ---- Python ----------------------------------------------------------------------------------------------


def realtime_lines(text: str, python: bool) -> set[int]:
    """The lines of cases that only `--realtime` runs."""
    if not python:
        return cpp_realtime_lines(text)
    tree = ast.parse(text)
    if any(isinstance(node, ast.Assign) and "mark.realtime" in ast.unparse(node) for node in tree.body):
        return set(range(1, text.count("\n") + 2))
    lines = set()
    for node in ast.walk(tree):
        decorators = " ".join(ast.unparse(each) for each in getattr(node, "decorator_list", []))
        if "mark.realtime" in decorators or "FRANKA_TEST_REALTIME" in decorators:
            lines.update(range(node.lineno, node.end_lineno + 1))
    return lines


def reads_clock(node: ast.AST) -> bool:
    function = node.func if isinstance(node, ast.Call) else None
    return (
        isinstance(function, ast.Attribute)
        and function.attr in CLOCKS
        and isinstance(function.value, ast.Name)
        and function.value.id == "time"
    )


def python_bounds(text: str) -> Iterator[int]:
    """Lines of assertions that a wall time is below a small number."""
    tree = ast.parse(text)
    constants = {
        target.id: node.value.value
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    scopes = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)]
    found = set()
    for scope in scopes:
        spans = wall_times(scope)
        for node in ast.walk(scope):
            for large, small in upper_bounds(node):
                names = {each.id for each in ast.walk(small) if isinstance(each, ast.Name)}
                if (is_span(small) or names & spans) and below_deadline(large, constants):
                    found.add(node.lineno)
    yield from sorted(found)


def is_span(node: ast.AST) -> bool:
    """Whether an expression subtracts a clock's reading."""
    return any(
        isinstance(each, ast.BinOp)
        and isinstance(each.op, ast.Sub)
        and any(reads_clock(inner) for inner in ast.walk(each))
        for each in ast.walk(node)
    )


def wall_times(scope: ast.AST) -> set[str]:
    """The names that hold wall times, or lists of them, in a function."""
    holders = []
    for node in ast.walk(scope):
        if isinstance(node, ast.Assign) and is_span(node.value):
            holders += node.targets
        called = node.func if isinstance(node, ast.Call) else None
        if isinstance(called, ast.Attribute) and called.attr == "append" and is_span(node):
            holders.append(called.value)
    return {each.id for holder in holders for each in ast.walk(holder) if isinstance(each, ast.Name)}


def python_polls(text: str) -> Iterator[int]:
    """Lines of loops that compare a clock's reading."""
    for loop in ast.walk(ast.parse(text)):
        compared = [node for node in ast.walk(loop) if isinstance(node, ast.Compare)]
        if isinstance(loop, ast.While) and any(reads_clock(n) for node in compared for n in ast.walk(node)):
            yield loop.lineno


def upper_bounds(node: ast.AST) -> Iterator[tuple[ast.AST, ast.AST]]:
    """Pairs (larger, smaller) of what an assertion compares."""
    if isinstance(node, ast.Assert):
        for compared in ast.walk(node.test):
            if isinstance(compared, ast.Compare):
                sides = [compared.left, *compared.comparators]
                for left, operator, right in zip(sides, compared.ops, sides[1:]):
                    if isinstance(operator, ast.Lt | ast.LtE):
                        yield right, left
                    elif isinstance(operator, ast.Gt | ast.GtE):
                        yield left, right
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and len(node.args) >= 2:
        if node.func.attr in ("assertLess", "assertLessEqual"):
            yield node.args[1], node.args[0]


def below_deadline(node: ast.AST, constants: dict) -> bool:
    """Whether a bound is not known to be at least the deadline."""
    value = constants.get(node.id) if isinstance(node, ast.Name) else getattr(node, "value", None)
    return not isinstance(value, int | float) or value < DEADLINE


# ---- C++ -------------------------------------------------------------------------------------------------


def cpp_realtime_lines(text: str) -> set[int]:
    lines = set()
    for match in CPP_REALTIME.finditer(text):
        end = text.find("\n}\n", match.start())
        first = text.count("\n", 0, match.start()) + 1
        last = text.count("\n", 0, end if end >= 0 else len(text)) + 2
        lines.update(range(first, last))
    return lines


def cpp_bounds(text: str) -> Iterator[int]:
    spans = {match[1] for match in CPP_SPAN.finditer(text)}
    for match in CPP_UPPER.finditer(text):
        names = set(re.findall(r"\w+", match[1]))
        if names & spans or re.search(rf"{CPP_NOW}\s*-", match[1]):
            seconds = re.search(r"(?:seconds\(|\b)(\d+)(?:\)|s\b)", match[1].rsplit(",", 1)[-1])
            if not seconds or int(seconds[1]) < DEADLINE:
                yield text.count("\n", 0, match.start()) + 1


def cpp_polls(text: str) -> Iterator[int]:
    for match in CPP_POLL.finditer(text):
        yield text.count("\n", 0, match.start()) + 1
