# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Prints the public names of a package of pybind11, one a line: kind, name, and arguments or value.

    python names_of_package.py panda_py.libfranka

A function has a line for each of its overloads. Also run by the interpreters of other packages: only Python's
own library here.
"""

import importlib
import inspect
import re
import sys


def split(text: str) -> list:
    """Splits at commas outside of brackets."""
    parts, depth, begin = [], 0, 0
    for index, letter in enumerate(text):
        depth += (letter in "[(<{") - (letter in "])>}" and text[index - 1] != "-")
        if letter == "," and depth == 0:
            parts.append(text[begin:index])
            begin = index + 1
    return [part.strip() for part in [*parts, text[begin:]] if part.strip()]


def argument(text: str) -> str:
    """`name` or `name=default` of an argument in a signature of pybind11."""
    name = text.partition(":")[0].strip()
    found = re.search(r" = (.*)$", text)
    if not found:
        return name
    value = re.sub(r"<(\w+\.\w+): \d+>", r"\1", found.group(1))
    return f"{name}={value}".replace(" ", "")


def signatures(name: str, doc: str) -> list:
    """The arguments of each overload, without self, from pybind11's docstring."""
    lines = re.findall(rf"^(?:\d+\. )?{name}\((.*)\) -> .*$", doc, re.MULTILINE)
    found = [split(line) for line in lines if line != "*args, **kwargs"]
    return [
        " ".join(argument(part) for part in parts if not re.match(r"self\b|type: ", part)) for parts in found
    ]


def is_value(member, owner) -> bool:
    return isinstance(member, owner) and hasattr(owner, "__members__")


def describe(owner, prefix: str):
    """Lines of a class or module."""
    for name, member in sorted(vars(owner).items()):
        path = prefix + name
        if inspect.isclass(member) and not name.startswith("_"):
            if issubclass(member, BaseException):
                yield f"exception {path}"
                continue
            yield f"class {path}"
            yield from describe(member, path + ".")
        elif name == "__init__" and inspect.isclass(owner):
            if hasattr(owner, "__members__"):
                continue
            for arguments in signatures(name, member.__doc__ or ""):
                yield f"constructor {prefix[:-1]} {arguments}".rstrip()
        elif name.startswith("_") or inspect.ismodule(member):
            continue
        elif inspect.isclass(owner) and is_value(member, owner):
            yield f"value {path} {int(member)}"
        elif isinstance(member, property):
            if hasattr(owner, "__members__"):
                continue  # name and value of an enumeration
            yield f"attribute {path}{' writable' if member.fset else ''}"
        elif callable(member) or isinstance(member, staticmethod):
            function = getattr(owner, name)
            for arguments in signatures(name, function.__doc__ or ""):
                yield f"function {path} {arguments}".rstrip()
        else:
            yield f"constant {path} {member}"


def names(package: str) -> list:
    """All lines of a package; also of its hidden module, from which pylibfranka's functions give objects."""
    modules = [importlib.import_module(package)]
    hidden = getattr(modules[0], "_" + package, None)
    if hidden is not None:
        modules.append(hidden)
    return sorted({line for module in modules for line in describe(module, "")})


if __name__ == "__main__":
    print("\n".join(names(sys.argv[1])))
