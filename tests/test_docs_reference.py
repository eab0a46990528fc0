# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The site's reference is complete: every public name is described, and every described name exists.

test_docs_names.py does this for topics, services, actions and parameters. The long form builds the site.
"""

import html
import re
import subprocess
import sys
import textwrap
import tomllib

import pytest
from docsite import (
    command_lines,
    cpp_api,
    cpp_comments,
    descriptions,
    docstrings,
    dynamic_parameters,
    python_api,
    python_comments,
)
from docsite.interfaces import KINDS, read_interface
from docsite.launch_files import describe, read_launch_file
from docsite.packages import packages
from docsite.paths import TOP
from docsite.plugins import plugins_of

# A few words; less is not a description.
MIN_LENGTH = 8
PACKAGES = {package.name: package for package in packages()}
LAUNCH = [(package.name, path) for package in packages() for path in package.files("launch/**/*.launch")]
INTERFACES = [path for package in packages() for kind in KINDS for path in package.files(f"{kind}/*.{kind}")]

builds_the_site = pytest.mark.long_form("builds the documentation site")

# ---- launch files, interfaces, plugins -------------------------------------------------------------------


def without_doc(path):
    launch = read_launch_file(path)
    return [each.name for each in launch.arguments if len(each.doc) < MIN_LENGTH and each.doc != "[Hz]"]


@pytest.mark.parametrize(("package", "path"), LAUNCH, ids=lambda value: getattr(value, "name", value))
def test_launch_files_and_their_arguments_are_described(package, path):
    assert len(read_launch_file(path).comment) >= MIN_LENGTH
    assert not without_doc(path)


def test_an_argument_without_doc_is_found(tmp_path):
    path = tmp_path / "x.launch"
    path.write_text(
        """<launch>
          <!-- Starts nothing. -->
          <arg name="sim" default="false" doc="Start a simulated robot first?"/>
          <arg name="robot_ip" default="127.0.0.1" if="$(arg sim)"/>
          <arg name="robot_ip" unless="$(arg sim)" doc="Address of the robot"/>
          <arg name="bare" default=""/>
          <arg name="inner" value="3"/>
          <include file="y.launch"><arg name="passed" value="$(arg sim)"/></include>
        </launch>"""
    )
    assert without_doc(path) == ["bare"]
    text = describe(read_launch_file(path), "some_package")
    assert "Starts nothing." in text and "passed" not in text and "inner" not in text
    assert "| `robot_ip` | `127.0.0.1` if `sim:=true`; required unless `sim:=true` |" in text
    assert "| `bare` | empty |" in text


@pytest.mark.parametrize("path", INTERFACES, ids=lambda path: f"{path.parent.parent.name}/{path.name}")
def test_messages_services_and_actions_are_described(path):
    assert len(read_interface(path).description) >= MIN_LENGTH


def test_a_definition_without_a_comment_is_found(tmp_path):
    path = tmp_path / "X.srv"
    path.write_text(
        "# Copyright (c) 2026\n# SPDX-License-Identifier: Apache-2.0\nstring name  # of it\n---\nbool ok\n"
    )
    assert read_interface(path).description == ""


def test_plugin_classes_are_described():
    found = [(package.name, plugin) for package in packages() for plugin in plugins_of(package)]
    assert len(found) > 40
    assert not [(name, each.name) for name, each in found if len(each.description) < MIN_LENGTH]


def test_packages_are_described():
    assert len(PACKAGES) > 30
    assert not [each.name for each in packages() if len(each.description) < MIN_LENGTH]


# ---- C++ and Python --------------------------------------------------------------------------------------


def test_public_names_of_cpp_have_a_comment():
    cpp_api.run_doxygen()
    names = cpp_comments.public_names()
    some = {"franka_core::kFr3Limits", "franka_core::ArmLimits::dtau"}
    some |= {"franka::AsyncPositionControlHandler"}  # of an .hpp
    assert some <= {each.name for each in names}
    assert not [f"{each.file}:{each.line}: {each.name}" for each in names if not each.described]


@pytest.mark.parametrize("name", ["x.h", "x.hpp"])
def test_names_without_a_comment_are_found(name, tmp_path):
    header = tmp_path / name
    header.write_text(
        """
        /// A thing.
        class Thing {
         public:
          Thing();
          ~Thing();
          bool operator==(const Thing&) const;
          Thing(const Thing&) = delete;
          /// What it does.
          void described();
          void described(int);
          void bare();
          using Ptr = Thing*;
          using Number = double;
          double bare_field;
          double field, other_field;  ///< of this line
          static constexpr int kBare = 1;
          /// @name A group
          /// @{
          int first();
          int second();
          /// @}
         private:
          void hidden();
          struct Inside {
            double hidden_field;
          };
        };
        class Bare {};
        #define BARE_MACRO 1
        #define MACRO 2  ///< of something
        double bareFunction();
        namespace outer {
        /// Of a namespace.
        double function();
        constexpr double kBareConstant = 3.0;
        }
        """
    )
    settings = tmp_path / "Doxyfile"
    settings.write_text(cpp_api.SETTINGS.format(files=header, top=tmp_path, out=tmp_path))
    subprocess.run(["doxygen", str(settings)], check=True, timeout=60)
    found = cpp_comments.names_in(tmp_path / "xml", {name})
    described = {each.name for each in found if each.described}
    bare = {"Bare", "Thing::bare", "Thing::Number", "Thing::bare_field", "Thing::kBare"}
    bare |= {"BARE_MACRO", "bareFunction", "outer::kBareConstant"}
    assert {each.name for each in found} - described == bare
    assert {"Thing", "Thing::described", "Thing::first", "Thing::second", "Thing::field"} <= described
    assert {"Thing::other_field", "MACRO", "outer::function"} <= described


def test_every_module_of_python_has_a_page_or_a_reason():
    names = python_api.all_modules()
    assert {"pyfranka.plot", "pyfranka.meshes", "pyfranka.run", "pyfranka.sim.batch"} <= set(names)
    assert not python_api.without_page(names)
    listed = {each.name for each in python_api.MODULES}
    # What is listed exists, and is either shown or left out.
    assert not (listed | set(python_api.LEFT_OUT)) - set(names)
    assert not listed & set(python_api.LEFT_OUT)


def test_a_module_without_a_page_is_found():
    names = ["pyfranka", "pyfranka.plot", "pyfranka.plot.figure", "pyfranka.new", "pyfranka.plotting"]
    assert python_api.without_page(names) == ["pyfranka.new", "pyfranka.plotting"]


def test_public_names_of_python_have_a_docstring():
    assert not python_comments.undocumented()


def test_names_without_a_docstring_are_found(monkeypatch, tmp_path):
    (tmp_path / "some_module.py").write_text(
        textwrap.dedent(
            """
            '''A module.'''
            import dataclasses

            __all__ = ["ONE", "TWO", "Record", "Thing", "function"]

            # Of something
            # in two lines.
            ONE = 1
            TWO: int = 2

            @dataclasses.dataclass
            class Record:
                '''A record. of_docstring: a number.'''

                of_docstring: int
                of_comment: int  #: another one
                bare: int  # which Sphinx does not show

            class Thing:
                '''A thing.'''

                def described(self):
                    '''What it does.'''

                def bare(self):
                    pass

                @property
                def value(self):
                    return 0

            def function():
                pass
            """
        )
    )
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(python_comments, "MODULES", [python_api.Module("some_module", "")])
    bare = ["Record.bare", "TWO", "Thing.bare", "Thing.value", "function"]
    assert python_comments.undocumented() == [f"some_module.{name}" for name in bare]
    module = sys.modules.pop("some_module")
    assert python_api.comment_of_constant(module, "ONE") == "Of something in two lines."


@builds_the_site
def test_pages_of_cpp_show_functions_members_and_groups(site):
    page = (site / "reference" / "cpp" / "libfranka.html").read_text()
    for name in ("Robot7setLoad", "Robot8readOnce", "RobotState5tau_J", "Robot7control", "8Duration5toSec"):
        assert name in page
    assert "Callbacks get the newest state" in page  # of a group of members


@builds_the_site
def test_no_page_about_python_shows_marks_of_markup(site):
    for page in (site / "reference" / "python").glob("*.html"):
        body = re.search(r"<article.*</article>", page.read_text(encoding="utf-8"), re.DOTALL)[0]
        shown = html.unescape(re.sub(r"<[^>]+>", "", body))
        assert not re.findall(r".*(?:\\[_*|`]|@(?:raises|returns|param)\b).*", shown), page.name


# ---- command lines ---------------------------------------------------------------------------------------


def test_a_program_that_refuses_help_ends_the_build(tmp_path):
    program = tmp_path / "bad"
    program.write_text("#!/bin/sh\necho 'no help here' >&2\nexit 3\n")
    program.chmod(0o755)
    with pytest.raises(RuntimeError, match="bad --help failed: no help here"):
        command_lines.help_of(str(program))


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
    assert "python3 -m pyfranka.lerobot" in expected
    assert expected - {each.name for each in command_lines.programs()} == set()
    readme = (TOP / "python" / "wheel" / "README.md").read_text(encoding="utf-8")
    assert not [name for name in scripts if f"| `{name}" not in readme]


@pytest.mark.parametrize("program", command_lines.OTHERS, ids=lambda program: program.name)
def test_programs_without_a_file_of_their_name_answer_help(program):
    assert "usage:" in command_lines.help_of(*program.command)


@builds_the_site
def test_subcommands_are_those_of_the_programs(site):
    """Every word that a program's help offers is listed and has a section, and the reverse."""
    for each in command_lines.programs():
        offered = command_lines.subcommands_in(command_lines.help_of(*each.command))
        assert offered == command_lines.SUBCOMMANDS.get(each.name, ()), each.name
        page = (site / "reference" / "programs" / f"{each.package}.html").read_text()
        assert f"<h2>{each.name}<" in page
        assert not [word for word in offered if f"<h3>{each.name} {word}<" not in page]


# ---- robot descriptions and parameters at run time -------------------------------------------------------

DESCRIPTIONS = [path for package in packages() for path in package.files("robots/**/*.urdf.xacro")]
CONFIGS = [path for package in packages() for path in package.files("cfg/*.cfg")]


def test_arguments_of_robot_descriptions_are_described():
    found = {path.name: descriptions.read_description(path) for path in DESCRIPTIONS}
    found = {name: each for name, each in found.items() if each.arguments}
    assert set(found) == {"panda.urdf.xacro", "fr3.urdf.xacro", "dual_panda_example.urdf.xacro"}
    for each in found.values():
        assert not [name for name, _, meaning in each.arguments if len(meaning) < MIN_LENGTH]
    assert [name for name, *_ in found["fr3.urdf.xacro"].arguments][-1] == "inertials"
    assert dict(each[:2] for each in found["panda.urdf.xacro"].arguments)["tcp_xyz"] == "0 0 0.1034"


def test_an_argument_without_a_meaning_is_found(tmp_path):
    path = tmp_path / "x.urdf.xacro"
    path.write_text(
        """<?xml version="1.0"?>
        <!-- Copyright (c) 2026 -->
        <!-- A robot.
             told, other  what it is
                          in two lines
             third        another -->
        <robot xmlns:xacro="http://www.ros.org/wiki/xacro">
          <xacro:arg name="told" default="1"/><xacro:arg name="other" default=""/><xacro:arg name="bare"/>
        </robot>"""
    )
    found = descriptions.read_description(path)
    assert found.comment == "A robot."
    assert found.arguments == [
        ("told", "1", "what it is in two lines"),
        ("other", "", "what it is in two lines"),
        ("bare", None, ""),
    ]


@pytest.mark.parametrize("path", CONFIGS, ids=lambda path: path.name)
def test_parameters_at_run_time_have_ranges_and_meanings(path):
    config = dynamic_parameters.read_config(path)
    assert config.description and config.parameters
    for each in config.parameters:
        assert len(each.meaning) >= MIN_LENGTH
        assert each.type == "bool" or each.lowest <= each.default <= each.highest


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


# ---- pieces ----------------------------------------------------------------------------------------------


def test_docstrings_become_restructured_text():
    text = [
        "A *plain* text of `q_d`, name_ and `a",
        "span`.",
        "",
        "    code(1)",
        "",
        "    code(2)",
        "",
        "* one",
        "  more",
        "* two",
        "",
        ">>> set_load(2 * mass)",
        "(1, *)",
    ]
    assert docstrings.to_rest(text) == [
        "A \\*plain\\* text of ``q_d``, name\\_ and ``a span``.",
        *("", "::", "", "    code(1)", "", "    code(2)", ""),
        *("", "* one", "  more", "", "* two", ""),
        *(">>> set_load(2 * mass)", "(1, *)", ""),
    ]
