#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Builds the documentation site: writes its sources into out/docs/source, then runs Sphinx.

`./franka docs` calls it in the environment of the workspace. A warning of Sphinx is an error.
"""

import argparse
import sys
import time
from pathlib import Path

SITE = Path(__file__).resolve().parent
sys.path.insert(0, str(SITE))

from docsite import command_lines, cpp_api, notebooks, python_api, reference  # noqa: E402
from docsite.pages import Pages  # noqa: E402
from docsite.paths import OUT  # noqa: E402
from docsite.tree import Tree  # noqa: E402

# Pages without a source: the index of names, of modules, and the search.
MADE_BY_SPHINX = {"genindex.html", "py-modindex.html", "search.html"}


def write_sources() -> None:
    """The pages of docs/ and the generated reference."""
    tree = Tree(OUT / "source")
    Pages(tree).copy_all()
    cpp_api.run_doxygen()
    for part in (reference, cpp_api, python_api, command_lines):
        part.write_pages(tree)
    tree.close()


def run_sphinx(jobs: int) -> int:
    from sphinx.cmd.build import main as sphinx

    # All pages are read again (-E): when Sphinx reads a page again, its symbols of C++ remain beside the new
    # ones. 3,737 were 8,685 after the second build and 102,015 after the third, which took 281 s, not 73.
    options = ["-b", "html", "-E", "-c", str(SITE), "-d", str(OUT / "doctrees"), "-j", str(jobs)]
    strict = ["--fail-on-warning", "--nitpicky", "--quiet"]
    return sphinx([*options, *strict, str(OUT / "source"), str(OUT / "html")])


def remove_old_pages() -> None:
    """Removes pages without a source: Sphinx keeps them."""
    html = OUT / "html"
    for path in html.rglob("*.html"):
        source = OUT / "source" / path.relative_to(html).with_suffix(".md")
        if "_static" not in path.parts and path.name not in MADE_BY_SPHINX and not source.is_file():
            path.unlink()


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--jobs", type=int, default=2, help="processes of Sphinx at a time")
    arguments = parser.parse_args()
    begin = time.monotonic()
    write_sources()
    print(f"   sources after {time.monotonic() - begin:.0f} s", flush=True)
    status = run_sphinx(arguments.jobs)
    remove_old_pages()
    notebooks.write(OUT / "html" / "notebooks")
    print(f"   pages after {time.monotonic() - begin:.0f} s", flush=True)
    return status


if __name__ == "__main__":
    sys.exit(main())
