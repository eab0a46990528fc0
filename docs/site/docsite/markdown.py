# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Pieces of Markdown."""

import re
from collections.abc import Iterable, Sequence


def cell(text: str) -> str:
    """Text for a cell of a table: one line, with escaped bars."""
    return " ".join(text.split()).replace("|", "\\|")


def plain(text: str) -> str:
    """Text from a comment in the sources, escaped for Markdown and HTML."""
    return re.sub(r"([\\`*_{}\[\]<>$#~^])", r"\\\1", text)


def with_links(text: str) -> str:
    """The same; names of pages such as docs/desk.md become links from a folder below reference/."""
    return re.sub(r"docs/([a-z\\_/]+)\.md", lambda found: page_link(found.group(0)), plain(text))


def page_link(name: str) -> str:
    path = name.replace("\\", "")
    return f"[{name}](../../{path.removeprefix('docs/')})"


def code(text: str) -> str:
    """A code span; nothing for an empty text."""
    if not text:
        return ""
    fence = "``" if "`" in text else "`"
    return f"{fence}{text}{fence}"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table whose cells are Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(cell(each) for each in line)} |" for line in lines) + "\n"


def block(language: str, text: str) -> str:
    """A fenced block of code."""
    longest = max((len(found) for found in re.findall(r"`+", text)), default=0)
    fence = "`" * max(3, longest + 1)
    return f"{fence}{language}\n{text.rstrip()}\n{fence}\n"


def page(title: str, *parts: str) -> str:
    """A page of parts; empty ones are left out."""
    return "\n\n".join([f"# {title}", *(part.strip() for part in parts if part.strip())]) + "\n"
