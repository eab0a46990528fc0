# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The documentation site in Chromium, from files: without a server and without a network."""

from pathlib import Path

import page_browser
import pytest
from page_browser import browser, wait_for

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


@pytest.mark.parametrize(
    ("body", "what"),
    [
        ("<script>console.error('not good')</script>", "not good"),
        ("<p style='width: 500px'>wide</p>", "too wide: <p"),
        ("<img src='none.png'>", "no picture"),
        ("<script src='none.js'></script>", "ERR_FILE_NOT_FOUND"),
    ],
)
def test_a_page_with_a_fault_is_found(tab, tmp_path, body, what):
    page = tmp_path / "page.html"
    head = "<meta charset='utf-8'><meta name='viewport' content='width=device-width'><title>x</title>"
    page.write_text(f"<!doctype html>{head}<main>{body}</main>")
    assert any(what in fault for fault in faults(tab, page, PHONE))


def test_the_search_finds_pages(tab, site):
    tab.resize(*PHONE)
    tab.errors()
    tab.open((site / "search.html").as_uri() + "?q=communication_constraints_violation")
    wait_for(lambda: "finished" in tab.text("#search-summary, .search-summary"), "the end of the search")
    results = tab.run("[...document.querySelectorAll('.search li a')].map((a) => a.getAttribute('href'))")
    assert any("protocol" in each or "motions" in each for each in results)
    assert tab.errors() == []
    assert tab.run("document.documentElement.scrollWidth") <= PHONE[0]


def test_the_search_is_typed_into_the_menu(tab, site):
    tab.resize(*DESKTOP)
    tab.open((site / "index.html").as_uri())
    field = tab.find(".sidebar-search")
    field.send_keys("set_load")
    field.submit()
    wait_for(lambda: "SetLoad" in tab.text(".search") or "set_load" in tab.text(".search"), "a result")
    assert tab.errors() == []


def test_a_phone_opens_the_menu(tab, site):
    tab.resize(*PHONE)
    tab.open((site / "index.html").as_uri())
    assert not tab.run("document.querySelector('.sidebar-drawer').getBoundingClientRect().right > 0")
    tab.find(".mobile-header label[for='__navigation']").click()
    wait_for(
        lambda: tab.run("document.querySelector('.sidebar-drawer').getBoundingClientRect().left >= 0"),
        "the menu",
    )
    assert "Tutorials".upper() in tab.text(".sidebar-drawer").upper()
