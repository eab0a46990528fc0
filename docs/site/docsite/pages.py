# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The hand-written pages: copied from docs/.

Links to other files of the repository become links of the site, which shows these files.
"""

import os
import re
from pathlib import Path

from docsite.markdown import block, page
from docsite.paths import DOCS, NO_PAGES, TOP, files_of_repository
from docsite.tree import Tree

# Pages outside docs/, and their paths in the site.
OTHER_PAGES = {"CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md"}
START = {"README.md": "index.md"}
LINK = re.compile(r"(?<!`)(\]\()([^()\s]+)(\))")
FENCE = re.compile(r"^\s*(`{3,}|~{3,})")
LANGUAGES = {".py": "python", ".cpp": "cpp", ".h": "cpp", ".yaml": "yaml", ".launch": "xml", ".xml": "xml"}


class DeadLink(Exception):
    """A page links to a file that does not exist; the message names both."""


def pages_of_docs() -> list[Path]:
    """The pages in docs/ and the files that they show."""
    found = []
    for path in files_of_repository():
        if DOCS in path.parents and path.relative_to(DOCS).parts[0] not in NO_PAGES:
            found.append(path)
    return found


class Pages:
    """Copies pages into the site's sources."""

    def __init__(self, tree: Tree):
        self._tree = tree
        self._shown: set[Path] = set()  # files of the repository that pages link

    def copy_all(self) -> None:
        for path in pages_of_docs():
            self._copy(path, str(path.relative_to(DOCS)))
        for name, place in OTHER_PAGES.items():
            self._copy(TOP / name, place)
        for path in sorted(self._shown):
            self._show(path)

    def _copy(self, path: Path, place: str) -> None:
        if path.suffix == ".md":
            self._tree.write(place, self._with_links(path, place))
        else:
            self._tree.write(place, path.read_bytes())

    def _with_links(self, path: Path, place: str) -> str:
        """The text of a page with links that work in the site."""
        lines, fence = [], ""
        for line in path.read_text().splitlines():
            mark = FENCE.match(line)
            if mark and not fence:
                fence = mark.group(1)
            elif mark and mark.group(1).startswith(fence):
                fence = ""
            elif not fence:
                line = LINK.sub(lambda found: self._link(found, path, place), line)
            lines.append(line)
        return "\n".join(lines) + "\n"

    def _link(self, found: re.Match[str], path: Path, place: str) -> str:
        opening, target, closing = found.groups()
        if re.match(r"[a-z]+:|#", target):
            return str(found[0])
        name, _, anchor = target.partition("#")
        file = Path(os.path.normpath(path.parent / name))
        if file == DOCS or DOCS in file.parents:
            new = str(file.relative_to(DOCS))
        else:
            if not file.exists() or TOP not in file.parents:
                raise DeadLink(f"{path.relative_to(TOP)} links to {target}, which does not exist.")
            new = self._place_of(file)
        back = os.path.relpath(new, os.path.dirname(place) or ".")
        return f"{opening}{back}{'#' + anchor if anchor else ''}{closing}"

    def _place_of(self, file: Path) -> str:
        """The site's path for a file that is not a page of docs/."""
        name = str(file.relative_to(TOP))
        known = {**OTHER_PAGES, **START}
        if name in known:
            return known[name]
        self._shown.add(file)
        if file.is_dir():
            self._shown.update(each for each in files_of_repository() if each.parent == file)
        return f"files/{name}.md"

    def _show(self, file: Path) -> None:
        """A page with a file's text, or with the list of a folder's files."""
        name = str(file.relative_to(TOP))
        if file.is_dir():
            inside = [each for each in files_of_repository() if each.parent == file]
            names = "\n".join(f"* [{each.name}]({file.name}/{each.name}.md)" for each in inside)
            body = f"The folder `{name}` of the repository:\n\n{names}"
        else:
            text = file.read_text(errors="replace")
            language = (
                "bash" if text.startswith("#!/usr/bin/env bash") else LANGUAGES.get(file.suffix, "text")
            )
            body = block(language, text)
        self._tree.write(f"files/{name}.md", "---\norphan: true\n---\n\n" + page(name, body))
