# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Pages of the documentation site as a reader meets them: headings, sections, anchors and links."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag

HEADINGS = ("h1", "h2", "h3", "h4", "h5")
# What stands on every page, around its own text.
AROUND = {"nav", "aside", "footer", "script", "style", "head"}
# Attributes that make a browser load something, and their elements.
LOADS = {"img": "src", "script": "src", "link": "href", "iframe": "src", "source": "src"}


def plain(text: str) -> str:
    """A text on one line, without the sign at the end of a heading."""
    return re.sub(r"\s+", " ", text).strip().removesuffix("¶").strip()


@dataclass
class Section:
    """What follows a heading, up to the next one."""

    heading: str
    anchor: str
    text: str = ""


class Page(HTMLParser):
    """A page. links: the targets of all; own_links: of those in its text and in its table of contents, not in
    menus; labels: the texts of these; loaded: the files that a browser loads with it."""

    def __init__(self, path: Path):
        super().__init__()
        self.path = path
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.own_links: list[str] = []
        self.labels: list[str] = []
        self.sections: list[Section] = []
        self.loaded: list[str] = []
        self.headings: list[str] = []
        self._around: list[str] = []  # elements around the text, by their tags and classes
        self._heading = ""
        self._anchor = ""  # of the section that begins
        self._in_link = False
        self.feed(path.read_text())
        self.close()
        self.headings = [plain(text) for text in self.headings]
        self.labels = [plain(text) for text in self.labels]
        for section, heading in zip(self.sections, self.headings, strict=True):
            section.heading, section.text = heading, plain(section.text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = dict(attributes)
        if given.get("id"):
            self.anchors.add(given["id"])
        if (
            tag in LOADS
            and given.get(LOADS[tag])
            and given.get("rel") not in ("index", "search", "next", "prev")
        ):
            self.loaded.append(given[LOADS[tag]])
        if tag in AROUND:
            self._around.append(f"{tag} {given.get('class') or ''}")
        if tag == "section":
            self._anchor = given.get("id") or ""
        if tag in HEADINGS and not self._around:
            self._heading = tag
            self.headings.append("")
            self.sections.append(Section("", self._anchor))
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
            if all("toc-drawer" in each for each in self._around):
                self.own_links.append(given["href"])
                self.labels.append("")
                self._in_link = True

    def handle_endtag(self, tag: str) -> None:
        if tag in AROUND and self._around:
            self._around.pop()
        if tag == self._heading:
            self._heading = ""
        if tag == "a":
            self._in_link = False

    def handle_data(self, data: str) -> None:
        if self._in_link:
            self.labels[-1] += data
        if self._heading:
            self.headings[-1] += data
        elif self.sections and not self._around:
            self.sections[-1].text += data


read_page = cache(Page)


def pages_of(site: Path) -> list[Page]:
    """All pages, without the index of names and the search, which a browser makes."""
    return [read_page(path) for path in sorted(site.rglob("*.html")) if "_static" not in path.parts]


def follow(page: Page, target: str) -> tuple[Path, str]:
    """The file and the anchor that a link of the page leads to."""
    name, anchor = urldefrag(target)
    path = (page.path.parent / unquote(name)).resolve() if name else page.path
    return path, unquote(anchor)
