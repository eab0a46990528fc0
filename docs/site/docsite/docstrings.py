# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Docstrings as reStructuredText.

Ours are plain text: paragraphs, lists with * or -, indented code, and examples with >>>. pybind11 adds a
signature for each overload.
"""

import re

ITEM = re.compile(r"\s*[*-] ")
OVERLOAD = re.compile(r"(\d+)\. (\w+\(.*\) -> .*)")


def escaped(line: str) -> str:
    """The line without marks of reStructuredText, except code spans."""
    parts = re.split(r"`+([^`]+)`+", line)
    return "".join(
        f"``{part}``" if i % 2 else re.sub(r"([*_|\\`]|(?<!https):(?=//))", r"\\\1", part)
        for i, part in enumerate(parts)
    )


def blocks(lines: list[str]) -> list[list[str]]:
    """Groups of lines between empty lines."""
    found: list[list[str]] = [[]]
    for line in lines:
        if line.strip():
            found[-1].append(line)
        elif found[-1]:
            found.append([])
    return [each for each in found if each]


def is_code(block: list[str]) -> bool:
    return all(line.startswith("    ") for line in block)


def paragraph(block: list[str]) -> list[str]:
    """A block of text: an example, the signature of an overload, items of a list, or one paragraph."""
    if not block:
        return []
    if block[0].startswith(">>> "):
        return block
    overload = OVERLOAD.fullmatch(block[0])
    if overload:
        return [
            f"{overload.group(1)}) ``{overload.group(2)}``",
            *([""] if block[1:] else []),
            *paragraph(block[1:]),
        ]
    if not ITEM.match(block[0]):
        return [escaped(" ".join(line.strip() for line in block))]
    lines = []
    for line in block:
        text = line.strip()
        if ITEM.match(line):
            lines += ["", f"* {escaped(text[2:])}"]
        else:
            lines.append(f"  {escaped(text)}")
    return lines


def to_rest(lines: list[str]) -> list[str]:
    """The docstring's lines with the same text in reStructuredText."""
    found: list[str] = []
    before_is_code = False
    for block in blocks(lines):
        if is_code(block):
            found += ([] if before_is_code else ["::", ""]) + block + [""]
            before_is_code = True
        else:
            found += [*paragraph(block), ""]
            before_is_code = False
    return found
