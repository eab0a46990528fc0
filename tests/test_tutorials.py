# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The tutorials and the pages to get started do what they say: their commands are typed as they stand.

The short form follows one page. The long form follows every page, also as a reader with an FR3. With
FRANKA_UPDATE_PICTURES=1 the pictures that a page makes replace those in docs/pictures/tutorials.
"""

import os
import re
import shutil
import time
from pathlib import Path

import pytest
from genuine_clients import skip_without
from screen import virtual_screen, with_rviz
from tutorial import (
    PAGES,
    PICTURES,
    SCREEN,
    TOP,
    Page,
    PageError,
    Reader,
    has_variant,
    read,
)

# A page that takes a few seconds.
SHORT = {"python"}
RUNS = [(page, False) for page in PAGES] + [(page, True) for page in PAGES if has_variant(page)]


def named(page: Path) -> str:
    """The page below docs/: two folders may have pages of one name."""
    return str(page.relative_to(TOP / "docs").with_suffix(""))


def parameters(page: Path, variant: bool):
    """Those of the test that follows the page."""
    is_short = page.stem in SHORT and not variant
    marks = () if is_short else pytest.mark.long_form("follows a page that takes longer")
    return pytest.param(page, variant, id=f"{named(page)}{'-fr3' if variant else ''}", marks=marks)


def follow(page: Page, folder: Path, **variables: str) -> dict[str, Path]:
    """Follows a page in a new home, and in another one if Debian's rviz has crashed; returns its pictures."""
    home = folder / "home"

    def once() -> dict[str, Path]:
        if home.exists():
            home.rename(folder / "home_with_crash")
        with Reader(home, **variables) as reader:
            begin = time.monotonic()
            reader.follow(page)
            print(f"{page.path.stem}: {time.monotonic() - begin:.0f} s")
            return reader.pictures

    return with_rviz(once, home.with_suffix(".log"))


@pytest.mark.parametrize("path, variant", [parameters(*each) for each in RUNS])
def test_page_commands_have_the_documented_effect(path, variant, tmp_path):
    of_page = {"genuine_clients": ("panda", "pylibfranka"), "python": ("wheel",)}.get(path.stem, ())
    folders = " ".join(str(skip_without(name, "files")) for name in of_page)
    variables = {"PIP_NO_INDEX": "1", "PIP_FIND_LINKS": folders}
    with virtual_screen(SCREEN):
        pictures = follow(read(path, variant), tmp_path, **variables)
    if os.environ.get("FRANKA_UPDATE_PICTURES") and not variant:
        for name, picture in pictures.items():
            shutil.copy(picture, PICTURES / name)


# ---- the reader itself ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text, why",
    [
        ("```bash\nfalse\n```", "`false` ended with status 1"),
        ("```bash\necho one\n```\n```text\ntwo\n```", "the line `two` was not printed"),
        ("<!-- keeps running -->\n```bash\nexit_at_once\n```\n```text\none\n```", "`one` was not printed"),
        ("<!-- picture: ~/none.png is none.png -->", "there is no picture none.png"),
        ("<!-- run by: tests/test_none.py::test_it -->\n```bash\ntrue\n```", "there is no test"),
        ("<!-- nothing -->", "unknown comment"),
    ],
)
def test_wrong_page_fails(text, why, tmp_path):
    page = tmp_path / "page.md"
    page.write_text(f"# A page\n\n{text}\n")
    with pytest.raises(PageError, match=re.escape(why)), Reader(tmp_path / "home") as reader:
        reader.follow(read(page))


def test_page_commands_are_typed_unchanged(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        """# A page
<!-- with an FR3: panda is fr3 -->
<!-- with a simulated robot: 172.16.0.2 is 127.0.0.1 -->
<!-- file: ~/folder/file.txt -->
```python
"the panda"
```
<!-- status: 0 or 1 -->
```bash
grep 172.16.0.2 ~/folder/file.txt
```
<!-- only parsed: changes the system -->
```bash
sudo false
```
```bash
cat ~/folder/file.txt
for i in 1 2; do
  echo $i \\
    more
done
```
```text
"the panda"
1 more
...
2 ...re
```
<!-- terminal 2 -->
<!-- keeps running -->
```bash
cd ~/folder
echo begins; sleep 100
```
```text
begins
```
<!-- press Ctrl-C in terminal 2 -->
```bash
ls
```
```text
file.txt
```
"""
    )
    with Reader(tmp_path / "home") as reader:
        reader.follow(read(page))
    assert read(page, variant=True).of("file")[0].text == '"the fr3"\n'
