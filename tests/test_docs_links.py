# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Links of the documentation: internal ones lead somewhere, external ones are addresses.

Pages load nothing from outside, so that the site works without a network. Sphinx finds dead links in
generated pages.
"""

import re
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from docsite import pages as site_sources
from docsite.paths import TOP
from docsite.tree import Tree
from site_pages import pages_of

builds_the_site = pytest.mark.long_form("builds the documentation site")


def is_external(target: str) -> bool:
    return bool(re.match(r"[a-z][a-z+.-]*:", target))


@builds_the_site
def test_external_links_are_addresses(site):
    external = {link for page in pages_of(site) for link in page.links if is_external(link)}
    wrong = []
    for target in sorted(external):
        parts = urlsplit(target)
        if parts.scheme not in ("https", "http") or "." not in parts.netloc or re.search(r"\s", target):
            wrong.append(target)
    assert not wrong


@builds_the_site
def test_nothing_is_loaded_from_outside(site):
    loaded = {target for page in pages_of(site) for target in page.loaded}
    assert any(target.endswith(".css") or ".css?" in target for target in loaded)
    assert not [target for target in loaded if is_external(target) or target.startswith("//")]
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


def in_site(text: str, page: str, folder: Path) -> str:
    """A line of a page of docs/ as the site's sources have it."""
    pages = site_sources.Pages(Tree(folder))
    return site_sources.LINK.sub(lambda found: pages._link(found, site_sources.DOCS / page, page), text)


@pytest.mark.parametrize(
    ("link", "expected"),
    [
        ("../examples/cpp", "files/examples/cpp.md"),
        ("../CHANGELOG.md", "changelog.md"),
        ("../README.md", "index.md"),
        ("limits.md#cartesian-limits", "limits.md#cartesian-limits"),
        ("https://example.org/a", "https://example.org/a"),
        ("#options", "#options"),
    ],
)
def test_links_to_other_files_become_links_of_the_site(tmp_path, link, expected):
    assert in_site(f"[a]({link})", "gym.md", tmp_path) == f"[a]({expected})"
    if not link.startswith(("#", "http")):
        deeper = f"../{link}"
        assert in_site(f"[a]({deeper})", "design/faults.md", tmp_path) == f"[a](../{expected})"


def test_a_link_to_a_missing_file_is_refused(tmp_path):
    with pytest.raises(site_sources.DeadLink, match="docs/gym.md links to ../gone.txt"):
        in_site("[x](../gone.txt)", "gym.md", tmp_path)
