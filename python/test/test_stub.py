# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every public name is in the type stub with its arguments, and the stub names nothing else."""

import ast
import builtins
import inspect
import pickle
import re
import runpy
import subprocess
import sys
import typing
from functools import reduce
from pathlib import Path
from unittest.mock import patch

import _pyfranka
import pyfranka
import pyfranka.libfranka
import pyfranka.sim
import pytest
from signatures import signature

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


def members(owner):
    """Names with their values; pyfranka loads those in C++ when they are used."""
    names = set(dir(owner)) - {"sweep"} if owner is pyfranka else vars(owner)
    return {name: vars(owner).get(name, getattr(owner, name)) for name in names}


def classes(owner=pyfranka, path=()):
    for name, value in members(owner).items():
        # A class stands under its own name; others are aliases.
        if inspect.isclass(value) and not name.startswith("_") and name == value.__name__:
            yield (*path, name), value
            yield from classes(value, (*path, name))


def test_a_star_import_hides_no_builtin():
    names = {}
    exec("from pyfranka import *", names)
    assert names["FrankaException"] is pyfranka.Exception and "RobotState" in names
    assert not set(names) & set(vars(builtins)) - {"__builtins__"}
    names = {}
    exec("from pyfranka.libfranka import *", names)
    assert names["RobotState"] is pyfranka.libfranka.RobotState and "numpy" not in names
    assert not set(names) & set(vars(builtins)) - {"__builtins__"}


def test_classes_show_and_are_pickled_under_the_names_that_users_import():
    errors = {cls for _, cls in classes() if issubclass(cls, RuntimeError)}
    assert len(errors) == 9
    for path, cls in classes():
        assert (cls.__module__, cls.__qualname__) == ("pyfranka", ".".join(path))
    for cls in (*errors, pyfranka.RobotState, pyfranka.RobotMode, pyfranka.sim.RequestRefused):
        assert pickle.loads(pickle.dumps(cls)) is cls
    for name in ("ArmModel", "GripperOutcome", "LiveState", "RequestRefused", "Snapshot"):
        assert getattr(pyfranka.sim, name).__module__ == "pyfranka.sim"
    assert pickle.loads(pickle.dumps(pyfranka.RobotMode.Reflex)) == pyfranka.RobotMode.Reflex
    assert pyfranka.limit_rate.__module__ == "pyfranka"


def docstrings(owner):
    for value in vars(owner).values():
        if inspect.isclass(value) and value.__module__.startswith("pyfranka"):
            yield from docstrings(value)
        for each in (value, getattr(value, "fget", None), getattr(value, "fset", None)):
            yield getattr(each, "__doc__", None) or ""


def test_docstrings_show_the_names_that_users_import():
    shown = [doc for module in (_pyfranka, _pyfranka._sim) for doc in docstrings(module)]
    assert any("pyfranka.sim.LiveState" in doc for doc in shown)
    assert [doc for doc in shown if re.search(r"_pyfranka\b", doc.replace("import _pyfranka", ""))] == []
    assert "state: pyfranka.RobotState" in pyfranka.Model.mass.__doc__


def test_types_are_local_so_that_other_bindings_of_libfranka_can_be_loaded():
    bound = {cls for _, cls in classes(_pyfranka) if type(cls).__name__ == "pybind11_type"}
    assert pyfranka.RobotState in bound
    shared = {cls for cls in bound if not any("pybind11_module_local" in name for name in vars(cls))}
    assert not shared


@pytest.mark.parametrize("options", [[], ["-O"], ["-OO"]])
def test_all_modules_can_be_imported_with_optimization(options):
    code = (
        "import importlib, pkgutil, pyfranka\n"
        "for module in pkgutil.walk_packages(pyfranka.__path__, 'pyfranka.'):\n"
        "    if not module.name.endswith('__main__'):\n"
        "        importlib.import_module(module.name)\n"
        "pyfranka.sim.Simulation(robots=[pyfranka.sim.FR3()]).step()"
    )
    done = subprocess.run([sys.executable, *options, "-c", code], text=True, capture_output=True, timeout=120)
    assert done.returncode == 0, done.stderr


def names_of(cls):
    return public(vars(cls))


def test_the_module_and_its_stub_have_the_same_names():
    assert public(set(TREE) - HELPERS) == public(members(pyfranka))


@pytest.mark.parametrize("path, cls", list(classes()), ids=lambda value: str(value))
def test_classes_and_their_stubs_have_the_same_names(path, cls):
    body = TREE
    for name in path:
        node = body[name]
        body = stub_names(node.body)
    assert public(body) == names_of(cls) | RAISED.get(path[-1], set())


def overload(function, registered=typing.overload):
    registered(function)
    return function  # the result of typing's has no arguments


with patch("typing.overload", overload):
    DECLARED = runpy.run_path(str(STUB))


def is_function(value):
    return inspect.isroutine(getattr(value, "__func__", value))


def typed_overloads(function):
    """The signature of each overload."""
    function = getattr(function, "__func__", function)
    # Of a property's function, which has no name, the arguments are the beginning.
    name = getattr(function, "__name__", "")
    text = getattr(function, "__doc__", "") or ""
    if inspect.isfunction(function):
        each = typing.get_overloads(function) or [function]
        text = "\n".join(
            re.sub(r"(: |> )'(.*?)'", r"\1\2", f"{name}{inspect.signature(one)}") for one in each
        )
    found = re.findall(rf"^(?:\d+\. )?(?:{name})?\((.*)\) -> (.*)$", text, re.MULTILINE)
    return [signature(arguments).replace(return_annotation=result) for arguments, result in found]


def overloads(function):
    """Arguments and defaults of each overload. A default without a literal is Ellipsis."""
    return [re.sub("'<.*?>'", "'Ellipsis'", str(without_types(each))) for each in typed_overloads(function)]


def without_self(signature):
    return [each for each in signature.parameters.values() if each.name not in ("self", "cls", "type")]


def without_types(signature):
    kept = without_self(signature)
    kept = [each.replace(annotation=each.empty) for each in kept]
    return signature.replace(parameters=kept, return_annotation=signature.empty)


def declared_as(native, wanted):
    """Whether a type of the stub is what pybind11 shows; of functions, tuples and
    `object` it shows no more."""
    native = re.sub(r"\b(_?pyfranka\.)+", "", native).replace("[3]", "")
    optional = re.fullmatch(r"Optional\[(.*)\]", native)
    if optional:
        return wanted.endswith(" | None") and declared_as(optional[1], wanted.removesuffix(" | None"))
    if native == "object":
        return True
    if native == "AsyncPositionControlHandler":  # a pointer
        return wanted.removesuffix(" | None") == native
    if native in ("function", "tuple", "dict"):
        return wanted.startswith({"function": "typing.Callable["}.get(native, native + "["))
    if native.startswith("numpy.ndarray[numpy.float64]"):
        return wanted in ("Array", "ArrayLike")
    return wanted in (native, native.replace("List", "list"), native.replace("List", "typing.Sequence"))


@pytest.mark.parametrize("path, owner", [((), pyfranka), *classes()], ids=lambda value: str(value))
def test_functions_and_properties_have_the_types_of_the_module(path, owner):
    stub, actual = reduce(lambda body, name: vars(body[name]), path, DECLARED), members(owner)
    for name in public({*actual, *stub}) - {"sweep"}:
        declared, value = stub.get(name), actual.get(name)
        if isinstance(value, property) and type(owner).__name__ == "pybind11_type":
            (native,) = typed_overloads(value.fget)
            own = stub.get("__annotations__", {}).get(name)
            own = own or inspect.signature(declared.fget).return_annotation
            assert declared_as(native.return_annotation, own), name
        elif is_function(declared) and is_function(value) and not inspect.isfunction(value):
            for own, native in zip(typed_overloads(declared), typed_overloads(value), strict=True):
                assert declared_as(native.return_annotation, own.return_annotation), name
                shown = {each.name: each.annotation for each in native.parameters.values()}
                for each in without_self(own):
                    assert declared_as(shown[each.name], each.annotation), (name, each)


@pytest.mark.parametrize("path, owner", [((), pyfranka), *classes()], ids=lambda value: str(value))
def test_functions_and_their_stubs_have_the_same_arguments(path, owner):
    stub, actual = reduce(lambda body, name: vars(body[name]), path, DECLARED), members(owner)
    for name in {*actual, *stub} - {"sweep"}:
        declared, value = stub.get(name), actual.get(name)
        if isinstance(value, property):
            variable = "ClassVar" not in stub.get("__annotations__", {}).get(name, "ClassVar")
            assert (variable or getattr(declared, "fset", None) is not None) == (value.fset is not None), name
        elif is_function(declared) or is_function(value) and (name == "__init__" or name[0] != "_"):
            assert overloads(declared) == overloads(value), name


def test_stubs_of_the_module_are_made_without_the_package(tmp_path):
    """As in the build of the wheel, where pyfranka cannot be imported yet."""
    code = (
        "import runpy, sys\n"
        "sys.modules['pyfranka'] = None\n"
        "runpy.run_module('pybind11_stubgen', run_name='__main__', alter_sys=True)"
    )
    options = ["_pyfranka", "--exit-code", "--output-dir", tmp_path, "--numpy-array-wrap-with-annotated"]
    options += ["--enum-class-locations", "[A-Z].*:_pyfranka"]
    made = subprocess.run([sys.executable, "-c", code, *options], text=True, capture_output=True, timeout=120)
    assert made.returncode == 0, made.stderr
    assert "-> None" in (tmp_path / "_pyfranka" / "__init__.pyi").read_text()
