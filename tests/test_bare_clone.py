# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A new clone on a bare Debian, as a reader has it: the documentation is built there, and the pages
are typed. Long forms only: everything is fetched and compiled."""

import os
import re
import subprocess
from pathlib import Path

import pytest
from bare_debian import TOP, BareDebian, bare_debian, copy_project
from tutorial import check_picture, read

HOUR = 3600.0  # [s]
PROJECT = "/project"

pytestmark = [
    pytest.mark.long_form("fetches and builds everything on a bare Debian"),
    pytest.mark.timeout(8 * HOUR),
]


def share_compilers_results(root: Path) -> None:
    """The results of earlier builds, so that the test compiles only what changed."""
    folder = subprocess.check_output(["ccache", "--get-config=cache_dir"], text=True).strip()
    if os.path.isdir(folder):
        subprocess.run(["cp", "-a", "--reflink=auto", folder, root / "ccache"], check=True)


@pytest.fixture(scope="module")
def clone(tmp_path_factory):
    """The project in a bare Debian with git, which every clone needs."""
    with bare_debian(tmp_path_factory.mktemp("clone"), "git") as bare:
        copy_project(bare.root / PROJECT[1:])
        share_compilers_results(bare.root)
        commit = "git init -q && git add -A && git -c user.name=a -c user.email=a@b commit -qm clone"
        bare.must("sh", "-c", f"cd {PROJECT} && {commit}")
        yield bare


def in_project(bare: BareDebian, command: str, timeout: float) -> str:
    return bare.must("sh", "-ec", f"export CCACHE_DIR=/ccache; cd {PROJECT}\n{command}", timeout=timeout)


def test_the_documentation_is_built_in_a_new_clone(clone):
    said = in_project(clone, "./franka docs", 4 * HOUR)
    assert re.search(r"The site: /project/out/docs/html/index\.html", said)
    html = clone.root / PROJECT[1:] / "out/docs/html"
    names = {str(path.relative_to(html)) for path in html.rglob("*.html")}
    assert {
        "index.html",
        "search.html",
        "reference/cpp/libfranka.html",
        "reference/python/pyfranka.html",
    } <= names
    assert len(names) > 150
    # Only what the reference needs was compiled.
    assert not (clone.root / PROJECT[1:] / "catkin_ws/devel/lib/libfranka_example_controllers.so").exists()


def test_the_demo_is_built_and_shown_in_a_new_clone(clone):
    page = read(TOP / "docs/get_started/ros.md")
    in_project(clone, page.block_with("./franka build"), 4 * HOUR)
    for demo in (page, read(TOP / "README.md")):
        said = in_project(clone, demo.block_with("./franka demo"), HOUR)
        assert "rests in the red tray" in said
    for name in ("1-before", "2-grasped", "3-placed"):
        check_picture(clone.root / PROJECT[1:] / "out/demo" / f"{name}.png")


def test_the_wheel_of_a_new_clone_runs_the_first_program(clone):
    page = read(TOP / "docs/get_started/python.md")
    in_project(clone, page.block_with("./franka wheel"), HOUR)
    program = next(step for step in page.of("file") if step.path.endswith("/first.py"))
    output = next(step for step in page.of("text") if step.line > program.line)
    (clone.root / "root/first.py").write_text(program.text, encoding="utf-8")
    said = clone.must("sh", "-ec", "cd\n~/env/bin/python first.py")
    assert said == output.text
    check_picture(clone.root / "root/first.png")


def test_the_pages_are_typed_in_a_new_clone(clone):
    """Tutorials, pages to get started and how-to pages, by test_tutorials.py and test_typed_pages.py."""
    build = read(TOP / "docs/tutorials/porting_from_noetic.md").block_with("./franka build")
    in_project(clone, f"./franka install test\n{build}", 4 * HOUR)
    tests = "test_page_commands_have_the_documented_effect or test_page_does_what_it_says"
    pages = f"tests/test_tutorials.py tests/test_typed_pages.py -k '{tests}'"
    said = in_project(
        clone, f"./franka shell .venv/bin/python3 -m pytest -q -rs --long --timeout=1800 {pages}", 4 * HOUR
    )
    passed = re.search(r"(\d+) passed", said)
    assert passed and int(passed[1]) > 25, said[-3000:]
    assert "failed" not in said
