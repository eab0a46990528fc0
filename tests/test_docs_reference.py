# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The site's reference is complete: every public name is described, and every described name exists.

test_docs_names.py does this for topics, services, actions and parameters. The long form builds the site.
"""

import html
import re
import subprocess
import tomllib
from collections.abc import Iterator

import pytest
from docsite import (
    command_lines,
    cpp_api,
    cpp_comments,
    descriptions,
    dynamic_parameters,
    python_api,
    python_comments,
)
from docsite.interfaces import KINDS, read_interface
from docsite.launch_files import read_launch_file
from docsite.packages import packages
from docsite.paths import TOP
from docsite.plugins import plugins_of

# A few words; less is not a description.
MIN_LENGTH = 8

builds_the_site = pytest.mark.long_form("builds the documentation site")

# ---- launch files, interfaces, packages, plugins, robot descriptions -------------------------------------


def undescribed() -> Iterator[str]:
    """What users start, send or load, and is there without a description."""
    for package in packages():
        texts = {f"package {package.name}": package.description}
        texts |= {f"plugin {each.name}": each.description for each in plugins_of(package)}
        for path in package.files("launch/**/*.launch"):
            launch = read_launch_file(path)
            texts[path.name] = launch.comment
            texts |= {f"{path.name} {each.name}": each.doc for each in launch.arguments if each.doc != "[Hz]"}
        for path in (path for kind in KINDS for path in package.files(f"{kind}/*.{kind}")):
            texts[path.name] = read_interface(path).description
        for path in package.files("robots/**/*.urdf.xacro"):
            arguments = descriptions.read_description(path).arguments
            texts |= {f"{path.name} {name}": meaning for name, _, meaning in arguments}
        for path in package.files("cfg/*.cfg"):
            parameters = dynamic_parameters.read_config(path).parameters
            texts |= {f"{path.name} {each.name}": each.meaning for each in parameters}
        yield from (f"{package.name}: {name}" for name, text in texts.items() if len(text) < MIN_LENGTH)


def test_what_users_start_and_send_is_described():
    assert not list(undescribed())


# ---- C++ and Python --------------------------------------------------------------------------------------


def test_public_names_of_cpp_have_a_comment():
    """Doxygen's own check reports 900 constructors, operators and names of groups, which need none."""
    cpp_api.run_doxygen()
    names = cpp_comments.public_names()
    assert {"franka_core::kFr3Limits", "franka_core::ArmLimits::dtau"} <= {each.name for each in names}
    assert not [f"{each.file}:{each.line}: {each.name}" for each in names if not each.described]


def test_a_name_of_cpp_without_a_comment_is_found(tmp_path):
    header = tmp_path / "x.h"
    header.write_text(
        """
        /// A thing.
        class Thing {
         public:
          Thing();
          /// What it does.
          void described();
          void described(int);
          void bare();
          double field, other_field;  ///< of this line
          double bare_field;
         private:
          void hidden();
        };
        double bareFunction();
        """
    )
    settings = tmp_path / "Doxyfile"
    settings.write_text(cpp_api.SETTINGS.format(files=header, top=tmp_path, out=tmp_path))
    subprocess.run(["doxygen", str(settings)], check=True, timeout=60)
    found = cpp_comments.names_in(tmp_path / "xml", {"x.h"})
    bare = {"Thing::bare", "Thing::bare_field", "bareFunction"}
    assert {each.name for each in found if not each.described} == bare


def test_every_module_of_python_has_a_page_or_a_reason():
    names = python_api.all_modules()
    assert not python_api.without_page(names)
    listed = {each.name for each in python_api.MODULES}
    # What is listed exists, and is either shown or left out.
    assert not (listed | set(python_api.LEFT_OUT)) - set(names)
    assert not listed & set(python_api.LEFT_OUT)


def test_public_names_of_python_have_a_docstring():
    assert not python_comments.undocumented()


@builds_the_site
def test_no_page_about_python_shows_marks_of_markup(site):
    for page in (site / "reference" / "python").glob("*.html"):
        body = re.search(r"<article.*</article>", page.read_text(encoding="utf-8"), re.DOTALL)[0]
        shown = html.unescape(re.sub(r"<[^>]+>", "", body))
        assert not re.findall(r".*(?:\\[_*|`]|@(?:raises|returns|param)\b).*", shown), page.name


# ---- command lines ---------------------------------------------------------------------------------------


def test_commands_of_the_wheel_have_a_section():
    """Those of [project.scripts], and modules that are programs without a command."""
    scripts = tomllib.loads((TOP / "pyproject.toml").read_text())["project"]["scripts"]
    commands = {value.partition(":")[0] for value in scripts.values()}
    folder = TOP / "python" / "src"
    modules = {
        ".".join(path.relative_to(folder).with_suffix("").parts)
        for path in folder.rglob("*.py")
        if '\nif __name__ == "__main__"' in path.read_text(encoding="utf-8")
    }
    expected = {*scripts, *(f"python3 -m {module}" for module in modules - commands)}
    assert expected - {each.name for each in command_lines.programs()} == set()
    readme = (TOP / "python" / "wheel" / "README.md").read_text(encoding="utf-8")
    assert not [name for name in scripts if f"| `{name}" not in readme]


@builds_the_site
def test_subcommands_are_those_of_the_programs(site):
    """Every word that a program's help offers is listed and has a section, and the reverse."""
    for each in command_lines.programs():
        offered = command_lines.subcommands_in(command_lines.help_of(*each.command))
        assert offered == command_lines.SUBCOMMANDS.get(each.name, ()), each.name
        page = (site / "reference" / "programs" / f"{each.package}.html").read_text()
        assert f"<h2>{each.name}<" in page
        assert not [word for word in offered if f"<h3>{each.name} {word}<" not in page]


# ---- parameters at run time ------------------------------------------------------------------------------

CONFIGS = [path for package in packages() for path in package.files("cfg/*.cfg")]


def test_ranges_are_those_of_the_generated_configuration():
    """dynamic_reconfigure's own generator made the module that the controllers use."""
    from franka_example_controllers.cfg import compliance_paramConfig, teleop_paramConfig

    for module in (compliance_paramConfig, teleop_paramConfig):
        name = module.__name__.rsplit(".", 1)[1].removesuffix("Config")
        (path,) = [path for path in CONFIGS if path.stem == name]
        read = {each.name: each for each in dynamic_parameters.read_config(path).parameters}
        assert {name: each.lowest for name, each in read.items()} == module.min
        assert {name: each.highest for name, each in read.items()} == module.max
        assert {name: each.default for name, each in read.items()} == module.defaults
