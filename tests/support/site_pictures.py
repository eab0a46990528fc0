#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Makes contact sheets of the documentation site: small pictures of every page, to look at.

./franka shell .venv/bin/python3 tests/support/site_pictures.py [WORD...]

writes out/docs/sheets/desktop_01.png and so on, and the same for a phone. With words, only pages whose
names have one of them. The site must be built (./franka docs).
"""

import sys
from pathlib import Path

from page_browser import Browser, browser
from PIL import Image, ImageDraw

TOP = Path(__file__).resolve().parents[2]
SITE, SHEETS = TOP / "out" / "docs" / "html", TOP / "out" / "docs" / "sheets"
SIZES = {"desktop": (1280, 900), "phone": (390, 844)}
# Of a small picture: its width, and the part of a long page that is shown (in widths of the page) [pixels].
WIDTHS, LONGEST = {"desktop": 640, "phone": 300}, {"desktop": 1.4, "phone": 3.0}
COLUMNS, ROWS = {"desktop": 3, "phone": 6}, {"desktop": 2, "phone": 2}
LABEL = 18  # height of the name below a picture


def pages(site: Path, words: list[str]) -> list[Path]:
    found = [path for path in sorted(site.rglob("*.html")) if "_static" not in path.parts]
    names = {path: str(path.relative_to(site)) for path in found}
    return [path for path in found if not words or any(word in names[path] for word in words)]


def small_picture(page: Browser, path: Path, kind: str) -> Image.Image:
    """The beginning of a page, as a person sees it when scrolling down."""
    width, height = SIZES[kind]
    page.resize(width, height)
    page.open(path.as_uri())
    page.run("document.fonts.ready.then(() => true)")
    whole = page.run("document.documentElement.scrollHeight")
    page.resize(width, min(whole, round(LONGEST[kind] * width)))
    picture = page.picture()
    scale = WIDTHS[kind] / picture.width
    return picture.resize((WIDTHS[kind], round(picture.height * scale)), Image.Resampling.LANCZOS)


def sheets(pictures: list[tuple[str, Image.Image]], kind: str) -> list[Image.Image]:
    """Pictures in rows and columns, with the names of their pages."""
    width, height = WIDTHS[kind] + 8, max(picture.height for _, picture in pictures) + LABEL + 8
    each = COLUMNS[kind] * ROWS[kind]
    made = []
    for begin in range(0, len(pictures), each):
        sheet = Image.new("RGB", (COLUMNS[kind] * width, ROWS[kind] * height), "#808080")
        draw = ImageDraw.Draw(sheet)
        for index, (name, picture) in enumerate(pictures[begin : begin + each]):
            x, y = index % COLUMNS[kind] * width, index // COLUMNS[kind] * height
            sheet.paste(picture, (x, y + LABEL))
            draw.text((x + 4, y + 3), name, fill="white")
        made.append(sheet)
    return made


def main() -> None:
    SHEETS.mkdir(parents=True, exist_ok=True)
    found = pages(SITE, sys.argv[1:])
    with browser() as page:
        for kind in SIZES:
            pictures = [(str(path.relative_to(SITE)), small_picture(page, path, kind)) for path in found]
            for number, sheet in enumerate(sheets(pictures, kind), 1):
                file = SHEETS / f"{kind}_{number:02}.png"
                sheet.save(file)
                print(file)


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    main()
