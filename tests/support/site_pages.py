# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Pages of the documentation site as a reader meets them: headings and links."""

import re
from functools import cache
from html.parser import HTMLParser
from pathlib import Path

HEADINGS = ("h1", "h2", "h3", "h4", "h5")
# What stands on every page, around its own text.
AROUND = {"nav", "aside", "footer", "script", "style", "head"}
# Attributes that make a browser load something, and their elements.
LOADS = {"img": "src", "script": "src", "link": "href", "iframe": "src", "source": "src"}


class Page(HTMLParser):
    """A page. links: the targets of all; loaded: the files that a browser loads with it."""

    def __init__(self, path: Path):
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.headings: list[str] = []
        self._around = 0
        self._heading = ""
        self.feed(path.read_text())
        self.close()
        self.headings = [re.sub(r"\s+", " ", text).strip(" ¶") for text in self.headings]

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = dict(attributes)
        loaded = given.get(LOADS.get(tag, ""))
        if loaded and given.get("rel") not in ("index", "search", "next", "prev"):
            self.loaded.append(loaded)
        self._around += tag in AROUND
        if tag in HEADINGS and not self._around:
            self._heading = tag
            self.headings.append("")
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])

    def handle_endtag(self, tag: str) -> None:
        self._around = max(self._around - (tag in AROUND), 0)
        if tag == self._heading:
            self._heading = ""

    def handle_data(self, data: str) -> None:
        if self._heading:
            self.headings[-1] += data


read_page = cache(Page)


def pages_of(site: Path) -> list[Page]:
    """All pages, without the index of names and the search, which a browser makes."""
    return [read_page(path) for path in sorted(site.rglob("*.html")) if "_static" not in path.parts]
