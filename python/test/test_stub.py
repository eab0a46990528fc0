# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every public name is in the type stub and has a docstring, and the stub names nothing else."""

import ast
import inspect
import re
from pathlib import Path

import pyfranka
import pyfranka.sim
import pyfranka.sweeps
import pytest

STUB = Path(__file__).resolve().parent.parent / "src" / "pyfranka" / "__init__.pyi"
# Set on the instances that are raised.
RAISED = {"ControlException": {"log"}, "IncompatibleVersionException": {"server_version", "library_version"}}
HELPERS = {"Array", "Command"}  # used only within the stub


def public(names):
    """Public names, without submodules: those carry their types themselves."""
    return {name for name in names if not name.startswith("_") and not is_submodule(name)}


def is_submodule(name):
    return inspect.ismodule(getattr(pyfranka, name, None))


def stub_names(body):
    """Names that a stub's module or class declares, with the classes' bodies."""
    found = {}
    for node in body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            found[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            found[node.target.id] = node
        elif isinstance(node, ast.Assign):
            found[node.targets[0].id] = node
    return found


TREE = stub_names(ast.parse(STUB.read_text()).body)


def classes(owner=pyfranka, path=()):
    for name, value in vars(owner).items():
        # A class stands under its own name; others are aliases.
        if inspect.isclass(value) and not name.startswith("_") and name == value.__name__:
            yield (*path, name), value
            yield from classes(value, (*path, name))


def names_of(cls):
    return public(vars(cls))


def test_the_module_and_its_stub_have_the_same_names():
    assert public(set(TREE) - HELPERS) == public(vars(pyfranka))


@pytest.mark.parametrize("path, cls", list(classes()), ids=lambda value: str(value))
def test_classes_and_their_stubs_have_the_same_names(path, cls):
    body = TREE
    for name in path:
        node = body[name]
        body = stub_names(node.body)
    assert public(body) == names_of(cls) | RAISED.get(path[-1], set())


def texts(doc):
    """Texts of pybind11's docstrings without signatures, one per overload."""
    if "Overloaded function." in doc:
        return [part.partition("\n")[2].strip() for part in re.split(r"\n\d+\. ", doc)[1:]]
    return [doc.partition("\n")[2].strip()]


def test_everything_public_has_a_docstring():
    silent = []
    for path, cls in classes():
        where = ".".join(path)
        described = (cls.__doc__ or "").partition("Members:")[0].strip()
        if not described:
            silent.append(where)
        if issubclass(cls, BaseException) or hasattr(cls, "__members__"):
            continue
        for name in names_of(cls):
            member = vars(cls)[name]
            if inspect.isclass(member):
                continue
            doc = member.__doc__ or ""
            if isinstance(member, property):
                printed = [re.sub(r"^\(.*?\) -> .*\n*", "", doc).strip()]
            else:
                printed = texts(doc)
            if not all(printed):
                silent.append(f"{where}.{name}")
    for name in public(vars(pyfranka)):
        value = getattr(pyfranka, name)
        if inspect.isroutine(value) and not all(texts(value.__doc__ or "")):
            silent.append(name)
    assert silent == []


def test_types_are_installed_with_the_package():
    assert (STUB.parent / "py.typed").exists()
    setup = (STUB.parent.parent.parent / "setup.py").read_text()
    assert "py.typed" in setup and "*.pyi" in setup


def test_what_is_imported_when_used_is_in_the_stub():
    assert "from pyfranka.sweeps import sweep as sweep" in STUB.read_text()


@pytest.mark.parametrize("module", [pyfranka.sim, pyfranka.sweeps], ids=lambda module: module.__name__)
def test_modules_in_python_are_described_and_typed(module):
    for name in module.__all__:
        value = getattr(module, name)
        assert value.__doc__, name
        if inspect.isfunction(value):
            assert "return" in value.__annotations__, name
        if hasattr(value, "__members__") or not inspect.isclass(value):
            continue
        for member, function in vars(value).items():
            if not member.startswith("_") and inspect.isfunction(function):
                assert function.__doc__ and "return" in function.__annotations__, f"{name}.{member}"
            if not member.startswith("_") and isinstance(function, property):
                assert function.__doc__, f"{name}.{member}"
