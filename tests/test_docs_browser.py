# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The documentation site in Chromium, from files: without a server and without a network."""

from pathlib import Path

import page_browser
import pytest
from page_browser import browser

pytestmark = [
    pytest.mark.long_form("builds the site and opens every page"),
    pytest.mark.skipif(bool(page_browser.missing()), reason=page_browser.missing()),
]

DESKTOP, PHONE = (1280, 900), (390, 844)
SIZES = pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])


@pytest.fixture(scope="module")
def tab(site):
    with browser(width=DESKTOP[0], height=DESKTOP[1]) as opened:
        yield opened


def wide_elements(tab) -> list[str]:
    """Elements that make the page wider than the window."""
    return tab.run(
        "[...document.querySelectorAll('main *, article *')].filter((each) =>"
        " each.getBoundingClientRect().right > document.documentElement.clientWidth + 1 &&"
        " !each.closest('.table-wrapper, pre, .highlight, .sig'))"
        ".slice(0, 5).map((each) => each.outerHTML.slice(0, 120))"
    )


def faults(tab, path: Path, size: tuple[int, int]) -> list[str]:
    """What is wrong with a page in a window of this size: messages of the console, what is wider than the
    window, and pictures that are not there."""
    tab.resize(*size)
    tab.errors()
    tab.open(path.as_uri())
    assert tab.run("document.fonts.ready.then(() => document.readyState)") == "complete"
    lost = tab.run("[...document.images].filter((each) => !each.naturalWidth).map((each) => each.src)")
    found = tab.errors() + [f"no picture: {each}" for each in lost]
    if tab.run("document.documentElement.scrollWidth") > size[0]:
        found += [f"too wide: {each}" for each in wide_elements(tab) or ["the page"]]
    return [f"{path.name}, {size[0]} px: {each}" for each in found]


@SIZES
def test_every_page_fits_and_has_no_errors(tab, site, size):
    pages = [path for path in sorted(site.rglob("*.html")) if "_static" not in path.parts]
    assert len(pages) > 150
    assert not [fault for path in pages for fault in faults(tab, path, size)]


def test_a_page_with_faults_is_found(tab, tmp_path):
    page = tmp_path / "page.html"
    body = "<script>console.error('not good')</script><p style='width: 500px'>wide</p><img src='none.png'>"
    head = "<meta charset='utf-8'><meta name='viewport' content='width=device-width'><title>x</title>"
    page.write_text(f"<!doctype html>{head}<main>{body}</main>")
    found = "\n".join(faults(tab, page, PHONE))
    assert all(what in found for what in ("not good", "too wide: <p", "no picture"))
