# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Blocks of code in the written pages, and the commands in their shell blocks."""

from __future__ import annotations

import re
import shlex
import typing
from pathlib import Path

from docsite.pages import OTHER_PAGES, pages_of_docs
from docsite.paths import TOP
from markdown_it import MarkdownIt

SHELL = {"bash", "sh", "shell", "console"}
# How lines begin that readers type; blocks without a language, such as indented ones, may hold them.
TYPED = re.compile(
    r"\s*(\$ |\./franka|ros(launch|run|topic|service|bag|param|pack)\b|"
    r"(franka_(sim|info|desk)|python3|pip3?|cmake|catkin_make|apt-get|apt-cache|sudo|echo|cd|ping|ip) )"
)
# Words of the shell after which a command follows.
BEFORE_A_COMMAND = {
    "if",
    "then",
    "else",
    "elif",
    "do",
    "while",
    "until",
    "!",
    "{",
    "(",
    "time",
    "exec",
    "sudo",
    "env",
}
# Operators between commands.
OPERATORS = {"&&", "||", "|", ";", "&", ";;", "|&"}


class Block(typing.NamedTuple):
    """A block: the page, the line of its fence, its language, and its text."""

    page: str
    line: int
    language: str
    text: str

    def __str__(self) -> str:
        return f"{self.page}:{self.line}"


def blocks_in(text: str, page: str) -> list[Block]:
    """Blocks of Markdown. Of MyST's directives only {code-block} is one."""
    found = []
    for token in MarkdownIt().enable("table").parse(text):
        if token.type not in ("fence", "code_block"):
            continue
        words = token.info.split()
        language, content = (words[0] if words else ""), token.content
        if language == "{code-block}":
            language = words[1] if len(words) > 1 else ""
            content = re.sub(r"\A(:[\w-]+:.*\n)+\n?", "", content)
        elif language.startswith("{"):
            continue
        elif not language and TYPED.match(content):
            language = "console" if content.lstrip().startswith("$ ") else "bash"
        found.append(Block(page, token.map[0] + 1, language, content))
    return found


def all_blocks() -> list[Block]:
    """The blocks of the site's pages and of README.md."""
    pages = [path for path in pages_of_docs() if path.suffix == ".md"]
    pages += [TOP / name for name in (*OTHER_PAGES, "README.md")]
    return [block for path in pages for block in blocks_in(path.read_text(), str(path.relative_to(TOP)))]


def script_of(block: Block) -> str:
    """The lines to type: of a console block those with a prompt."""
    if block.language != "console":
        return block.text
    typed, goes_on = [], False
    for line in block.text.splitlines():
        if line.startswith("$ ") or goes_on:
            typed.append(line.removeprefix("$ "))
            goes_on = line.endswith("\\")
    return "\n".join(typed) + "\n"


def commands_in(script: str) -> list[list[str]]:
    """A script's commands with their words, without assignments, redirections and here-documents."""
    script = re.sub(r"<<-?\s*['\"]?(\w+)['\"]?(.*)\n(?:.*\n)*?\s*\1\n", r"\2\n", script)
    inner = re.findall(r"\$\(([^()]*)\)", script)
    script = re.sub(r"\$\([^()]*\)", "VALUE", script).replace("\\\n", " ")
    found: list[list[str]] = [each for text in inner for each in commands_in(text)]
    for line in logical_lines(script):
        lexer = shlex.shlex(line, posix=True, punctuation_chars="();<>|&")
        lexer.whitespace_split = True
        lexer.commenters = "#"
        words: list[str] = []
        for word in [*lexer, ";"]:
            if word in OPERATORS or word in ("(", ")"):
                found += [words] if words else []
                words = []
            else:
                words.append(word)
    return [each for each in map(without_prefix, found) if each]


def logical_lines(script: str) -> list[str]:
    """Lines of the script; those within quotes are one."""
    lines: list[str] = []
    for line in script.splitlines():
        if lines and not is_complete(lines[-1]):
            lines[-1] += "\n" + line
        else:
            lines.append(line)
    return lines


def is_complete(line: str) -> bool:
    try:
        shlex.split(line, comments=True)
    except ValueError:
        return False
    return True


def without_prefix(words: list[str]) -> list[str]:
    """A command without assignments, words before it, and redirections."""
    while words and (words[0] in BEFORE_A_COMMAND or re.match(r"\w+=", words[0])):
        words = words[1:]
    kept: list[str] = []
    skip = False
    for word in words:
        if skip or re.fullmatch(r"\d?[<>]+&?\d?", word):
            if word == ">&" and kept[-1:] == ["2"]:  # of 2>&1
                kept.pop()
            skip = not skip
            continue
        kept.append(word)
    return kept


def launch_arguments(path: Path, find) -> set[str] | None:
    """Arguments that a launch file takes, with those of files it passes all arguments to; None: any."""
    import xml.etree.ElementTree as ET

    root = ET.parse(path).getroot()
    names = {each.get("name") for each in root.findall("arg") if each.get("value") is None}
    for include in root.iter("include"):
        if include.get("pass_all_args") == "true":
            inner = re.fullmatch(r"\$\(find (\w+)\)/(.*)", include.get("file"))
            names |= launch_arguments(find(inner.group(1)) / inner.group(2), find)
    return names
