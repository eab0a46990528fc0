# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The tutorials and the pages to get started do what they say: their commands are typed as they stand.

The short form follows a page and checks the files of all. The long form follows every page,
also as a reader with an FR3. With FRANKA_UPDATE_PICTURES=1 the pictures that a page makes replace those in
docs/pictures/tutorials.
"""

import json
import os
import re
import shutil
import subprocess
import time
from pathlib import Path

import pytest
from genuine_clients import skip_without
from screen import virtual_screen, with_rviz
from tutorial import (
    LIMIT,
    MORE_PAGES,
    PAGES,
    PICTURES,
    SCREEN,
    TOP,
    Page,
    PageError,
    Reader,
    check_picture,
    has_variant,
    read,
)

# A page that takes a few seconds.
SHORT = {"python"}
RUNS = [(page, False) for page in PAGES] + [(page, True) for page in PAGES if has_variant(page)]
OURS = [page for page, variant in RUNS if not variant]


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


# ---- what can be checked without following a page ------------------------------------------------------


@pytest.mark.parametrize("path", OURS, ids=named)
def test_files_of_a_page_are_named(path):
    page = read(path)
    written = {step.path: step for step in page.of("file")}
    for step in written.values():
        where = f"{path.name}:{step.line}"
        assert f"`{step.path}`" in page.prose, f"{where}: the text does not say where to save {step.path}"
    typed = "".join(step.text for step in page.of("bash"))
    for script in re.findall(r"python3? (~/\S+\.py)", typed):
        assert script in written, f"{path.name}: {script} is run, but the page does not have it"


@pytest.mark.parametrize("name", ["torque_controller_cpp", "libfranka_programs"])
def test_programs_in_cpp_compile(name, tmp_path):
    # The folders of headers that the workspace's own controllers are compiled with.
    compiled = json.loads((TOP / "catkin_ws" / "build" / "compile_commands.json").read_text())
    ours = next(entry for entry in compiled if "/franka_example_controllers.dir/" in entry["command"])
    options = [f"-I{tmp_path}", *re.findall(r"-(?:I|isystem )\S+", ours["command"])]
    options = [word for option in options for word in option.split()]
    sources = []
    for step in read(TOP / "docs" / "tutorials" / f"{name}.md").of("file"):
        file = tmp_path / step.path.rpartition("/include/")[2].removeprefix("~/")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(step.text)
        if (
            file.suffix == ".cfg"
        ):  # as CMake runs it: templates, then folders of its documentation and headers
            folders = ["/usr/share/dynamic_reconfigure", tmp_path, tmp_path / "spring_controller", tmp_path]
            subprocess.run(["/usr/bin/python3", file, *folders], check=True, capture_output=True, timeout=60)
        if file.suffix == ".cpp":
            sources.append(file)
    assert sources
    command = ["g++", "-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", *options, *sources]
    done = subprocess.run(command, capture_output=True, text=True, timeout=800)
    assert done.returncode == 0, done.stderr[-4000:]


def test_pictures_that_are_made_are_shown_and_show_something():
    shown = set()
    for path in [*PAGES, *MORE_PAGES]:
        on_page = set(re.findall(r"pictures/tutorials/(\S+)\)", path.read_text()))
        page = read(path)
        made = {step.text.split(" is ")[1] for kind in ("picture", "window") for step in page.of(kind)}
        assert made == on_page if path in PAGES else made <= on_page, path.name
        shown |= on_page
    assert {picture.name for picture in PICTURES.glob("*.png")} == shown
    for name in shown:
        check_picture(PICTURES / name)


# ---- the reader itself ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text, why",
    [
        ("```bash\nfalse\n```", "`false` ended with status 1"),
        ("<!-- fails -->\n```bash\ntrue\n```", "`true` ended with status 0"),
        ("<!-- status: 0 or 1 -->\n```bash\n(exit 3)\n```", "`(exit 3)` ended with status 3"),
        ("```bash\necho one\n```\n```text\ntwo\n```", "the line `two` was not printed"),
        ("```bash\necho two\necho one\n```\n```text\none\ntwo\n```", "the line `two` was not printed"),
        ("```bash\necho one\n```\n<!-- expect: two -->", "`two` was not printed"),
        ("<!-- keeps running -->\n```bash\nexit_at_once\n```\n```text\none\n```", "`one` was not printed"),
        ("<!-- keeps running -->\n```bash\nsleep 60\n```\n```bash\ntrue\n```", "is still running"),
        ("```bash\necho 'one\n```", "is not a complete command"),
        ("<!-- picture: ~/none.png is none.png -->", "there is no picture none.png"),
        ("<!-- nothing -->", "unknown comment"),
        ("```python\none\n```", "a block of python without"),
        ("```bash\ntrue", "this block does not end"),
    ],
)
def test_wrong_page_fails(text, why, tmp_path):
    page = tmp_path / "page.md"
    page.write_text(f"# A page\n\n{text}\n")
    with pytest.raises(PageError, match=re.escape(why)), Reader(tmp_path / "home") as reader:
        reader.follow(read(page))


@pytest.mark.parametrize("died", ["rviz-8", "gazebo-1"])
def test_a_page_is_followed_again_only_if_rviz_has_crashed(died, tmp_path):
    program, page = tmp_path / "program.sh", tmp_path / "page.md"
    crash = f"[{died}] process has died [pid 7, exit code -11, cmd /usr/bin/it]"
    program.write_text(f"mkdir {tmp_path}/seen && echo '{crash}' || echo works now\n")
    page.write_text(f"# A page\n\n```bash\nbash {program}\n```\n```text\nworks now\n```\n")
    if died == "rviz-8":
        follow(read(page), tmp_path)
    else:
        with pytest.raises(PageError):
            follow(read(page), tmp_path)


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


def test_ctrl_c_waits_until_the_program_runs(tmp_path):
    with Reader(tmp_path / "home") as reader:
        terminal = reader.terminal("1")
        for _ in range(20):  # pressed at the first output, before it had been started once in four times
            terminal.type("echo begins; sleep 100", {"keeps running"})
            assert terminal.prints(lambda printed: "begins" in printed, LIMIT)
            terminal.interrupt()
            terminal.type("echo $?", set())
            assert "130" in terminal.printed


def test_empty_picture_is_reported(tmp_path):
    from PIL import Image

    Image.new("RGB", (400, 400), "white").save(tmp_path / "white.png")
    with pytest.raises(PageError, match="nothing on it"):
        check_picture(tmp_path / "white.png")
    Image.effect_noise((100, 100), 50).save(tmp_path / "small.png")
    with pytest.raises(PageError, match="pixels only"):
        check_picture(tmp_path / "small.png")
