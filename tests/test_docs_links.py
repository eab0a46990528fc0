# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Links of the written pages lead somewhere. The site's pages load nothing from outside, so that they work
without a network. Sphinx finds dead links in generated pages."""

import re
from pathlib import Path

import pytest
from docsite.paths import TOP

# What a browser loads with a page.
LOADED = re.compile(
    r'<(?:img|script|iframe|source)\b[^>]*\bsrc="([^"]+)"|<link\b[^>]*"stylesheet"[^>]*href="([^"]+)"'
)
OUTSIDE = re.compile(r"([a-z][a-z+.-]*:)?//")


@pytest.mark.long_form("builds the documentation site")
def test_nothing_is_loaded_from_outside(site):
    loaded = set()
    for page in (path for path in site.rglob("*.html") if "_static" not in path.parts):
        loaded |= {source or sheet for source, sheet in LOADED.findall(page.read_text(encoding="utf-8"))}
    assert any(".css" in target for target in loaded)
    assert not [target for target in loaded if OUTSIDE.match(target)]
    styles = [path.read_text(errors="replace") for path in site.glob("_static/**/*.css")]
    assert styles and not [
        found for text in styles for found in re.findall(r"url\(['\"]?(?:https?:)?//[^)]*\)", text)
    ]


def anchors(file: Path) -> set[str]:
    """The anchors of a page's headings, as MyST and GitHub make them."""
    headings = re.findall(r"^#+ (.+)$", file.read_text(encoding="utf-8"), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_links_of_the_written_pages_lead_somewhere():
    broken = []
    for file in sorted((TOP / "docs").rglob("*.md")):
        for target in re.findall(r"\]\(([^)\s]+)\)", file.read_text(encoding="utf-8")):
            if "://" in target or target.startswith("reference/"):  # the site's own pages
                continue
            name, _, anchor = target.partition("#")
            other = (file.parent / name).resolve() if name else file
            if not other.exists() or (anchor and anchor not in anchors(other)):
                broken.append(f"{file.name}: {target}")
    assert not broken
