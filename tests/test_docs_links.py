# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Links of the documentation site: internal ones resolve, external ones are addresses.

Pages load nothing from outside, so that the site works without a network.
"""

import re
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from docsite import pages as site_sources
from docsite.paths import TOP
from docsite.tree import Tree
from site_pages import Page, follow, pages_of, read_page

builds_the_site = pytest.mark.long_form("builds the documentation site")


def is_external(target: str) -> bool:
    return bool(re.match(r"[a-z][a-z+.-]*:", target))


def dead_links(page: Page, site: Path) -> list[str]:
    dead = []
    for link in page.links:
        if is_external(link):
            continue
        path, anchor = follow(page, link)
        if not path.is_file() or site not in path.parents:
            dead.append(f"{page.path.relative_to(site)}: {link}")
        elif path.suffix == ".html" and anchor and anchor not in read_page(path).anchors:
            dead.append(f"{page.path.relative_to(site)}: {link}: no such anchor")
    return dead


@builds_the_site
def test_every_internal_link_leads_to_a_page_and_its_anchor(site):
    pages = pages_of(site)
    assert len(pages) > 60
    assert sum(len(page.links) for page in pages) > 5000
    assert not [each for page in pages for each in dead_links(page, site)]


def test_dead_links_are_found(tmp_path):
    (tmp_path / "there.html").write_text("<h1 id='a'>A</h1>")
    page = tmp_path / "page.html"
    links = [
        "there.html#a",
        "there.html",
        "gone.html",
        "there.html#b",
        "#c",
        "https://example.org",
        "../x.html",
    ]
    page.write_text("".join(f"<a href='{link}'>x</a>" for link in links))
    found = [line.split(": ")[1] for line in dead_links(Page(page), tmp_path)]
    assert found == ["gone.html", "there.html#b", "#c", "../x.html"]


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


@builds_the_site
def test_every_page_can_be_reached_from_the_start_page(site):
    seen, new = set(), {site / "index.html"}
    while new:
        seen |= new
        found = {
            follow(read_page(path), link)[0]
            for path in new
            for link in read_page(path).own_links
            if not is_external(link)
        }
        new = {path for path in found if path.suffix == ".html" and path.is_file()} - seen
    made = {"genindex.html", "search.html", "py-modindex.html", "cpp-modindex.html"}
    assert not {str(page.path.relative_to(site)) for page in pages_of(site) if page.path not in seen} - made


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
