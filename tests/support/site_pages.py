# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Pages of the documentation site as a reader meets them: headings, text below them, and links."""

from __future__ import annotations

import re
import typing
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag

HEADINGS = ("h1", "h2", "h3", "h4", "h5")
VOID = {
    "img",
    "br",
    "hr",
    "meta",
    "link",
    "input",
    "col",
    "source",
    "wbr",
    "path",
    "svg",
    "use",
    "line",
    "rect",
}
# What stands on every page, around its own text.
AROUND = {"nav", "aside", "footer", "script", "style", "head"}
# Attributes that make a browser load something, and their elements.
LOADS = {"img": "src", "script": "src", "link": "href", "iframe": "src", "source": "src"}


class Section(typing.NamedTuple):
    """A heading, the anchors at it, and the text up to the next heading."""

    heading: str
    anchors: set[str]
    text: str


class Link(typing.NamedTuple):
    """A link: its target as written, and its words."""

    target: str
    words: str


class Page:
    """A page. links: all; own_links: those in its text and in its table of contents, not in menus."""

    def __init__(self, path: Path):
        self.path = path
        reader = _Reader()
        reader.feed(path.read_text())
        reader.close()
        self.anchors = reader.anchors
        self.links = reader.links
        self.own_links = reader.own_links
        self.loaded = reader.loaded
        self.sections = [
            Section(_line(heading), anchors, _line(text)) for heading, anchors, text in reader.sections
        ]

    def section_at(self, anchor: str) -> Section | None:
        """The section that a browser shows for an anchor; the first without one."""
        for section in self.sections:
            if not anchor or anchor in section.anchors:
                return section
        return None

    def text(self) -> str:
        return " ".join(f"{section.heading} {section.text}" for section in self.sections)


def _line(parts: list[str]) -> str:
    return re.sub(r"\s+", " ", "".join(parts)).strip().removesuffix("¶").strip()


@cache
def read_page(path: Path) -> Page:
    return Page(path)


def pages_of(site: Path) -> list[Page]:
    """All pages, without the index of names and the search, which a browser makes."""
    return [read_page(path) for path in sorted(site.rglob("*.html")) if "_static" not in path.parts]


def follow(page: Page, target: str) -> tuple[Path, str]:
    """The file and the anchor that a link of the page leads to."""
    name, anchor = urldefrag(target)
    path = (page.path.parent / unquote(name)).resolve() if name else page.path
    return path, unquote(anchor)


class _Reader(HTMLParser):
    def __init__(self):
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[Link] = []
        self.own_links: list[Link] = []
        self.loaded: list[str] = []
        self.sections: list[tuple[list[str], set[str], list[str]]] = []
        self._waiting: set[str] = set()  # anchors before their heading
        self._around: list[str] = []  # elements around the text, by their tags and classes
        self._heading = ""
        self._link: list | None = None

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = dict(attributes)
        if given.get("id"):
            self.anchors.add(given["id"])
            self._waiting.add(given["id"])
        if (
            tag in LOADS
            and given.get(LOADS[tag])
            and given.get("rel") not in ("index", "search", "next", "prev")
        ):
            self.loaded.append(given[LOADS[tag]])
        if tag in AROUND:
            self._around.append(f"{tag} {given.get('class') or ''}")
        if tag in HEADINGS and not self._around:
            self._heading = tag
            self.sections.append(([], self._waiting, []))
            self._waiting = set()
        if tag == "a" and given.get("href"):
            self._link = [given["href"], []]

    def handle_endtag(self, tag: str) -> None:
        if tag in AROUND and self._around:
            self._around.pop()
        if tag == self._heading:
            self._heading = ""
        if tag == "a" and self._link is not None:
            link = Link(self._link[0], _line(self._link[1]))
            self.links.append(link)
            if all("toc-drawer" in each for each in self._around):
                self.own_links.append(link)
            self._link = None

    def handle_data(self, data: str) -> None:
        if self._link is not None:
            self._link[1].append(data)
        if self._around or not self.sections:
            return
        heading, anchors, text = self.sections[-1]
        if self._heading:
            heading.append(data)
        else:
            text.append(data)
            if data.strip():
                # An anchor in the text belongs to the section around it.
                anchors |= self._waiting
                self._waiting = set()
