# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the types of the module in C++ into FOLDER/_pyfranka: pybind11-stubgen reads them from docstrings,
and this program adds what docstrings do not have.

    PYTHONPATH=where _pyfranka is python3 write_types.py FOLDER

Each build runs it (CMakeLists.txt), before pyfranka can be imported.
"""

import importlib
import re
import sys
from pathlib import Path
from types import ModuleType

OPTIONS = ["--exit-code", "--numpy-array-wrap-with-annotated", "--enum-class-locations=[A-Z].*:_pyfranka"]
REPLACED = (
    (r"^import pybind11_stubgen.*\n", ""),
    # Users have no pybind11_stubgen: the length of a list becomes a text.
    (r"pybind11_stubgen[.]typing_ext[.]FixedSize\(([0-9, ]+)\)", r'"length \1"'),
    # What compares by value and can change has no hash.
    (r"^( +__hash__: typing[.]ClassVar\[None\].*)$", r"\1  # type: ignore[assignment]"),
    (r"typing[.]Annotated\[numpy[.]ndarray, (numpy[.]float64)\]", r"numpy.typing.NDArray[\1]"),
    (r"\blist\[(\w+)\[[0-9]+\]\]", r"list[\1]"),
    (r"^(\w+): list = \[[-0-9., ]+\]$", r"\1: list[float]"),
)


def with_aliases(text: str, module: ModuleType) -> str:
    """A function with another name of its own is one more name of the first."""
    for cls in vars(module).values():
        for name, value in vars(cls).items() if isinstance(cls, type) else ():
            own = getattr(value, "__name__", name)
            if own == name or own not in vars(cls) or not callable(value):
                continue
            head = rf"(?:    @.*\n)*    def {name}\(\*args, \*\*kwargs\):\n"
            text = re.sub(rf"^(?:{head}(?:        .*\n|\n)+?(?=    \S|\S))+", "", text, flags=re.MULTILINE)
            whole = rf"^class {cls.__name__}\b.*\n(?:    .*\n|\n)+"
            text = re.sub(whole, rf"\g<0>    {name} = {own}\n", text, flags=re.MULTILINE)
    return text


def with_annotations(text: str, module: ModuleType) -> str:
    """Classes of Python have attributes that their instances get."""
    for name, cls in vars(module).items():
        if isinstance(cls, type) and cls.__name__ == name:
            lines = [f"    {each}: {kind}\n" for each, kind in vars(cls).get("__annotations__", {}).items()]
            text = re.sub(rf"^class {name}\(.*\):\n", rf"\g<0>{''.join(lines)}", text, flags=re.MULTILINE)
    return text


def main() -> None:
    folder = Path(sys.argv[1])
    stubgen = importlib.import_module("pybind11_stubgen")
    stubgen.main(["_pyfranka", "--output-dir", str(folder), *OPTIONS])
    for name in ("_pyfranka", "_pyfranka._sim"):
        module = importlib.import_module(name)
        file = folder / "_pyfranka" / ("__init__.pyi" if name == "_pyfranka" else "_sim.pyi")
        text = with_annotations(with_aliases(file.read_text(encoding="utf-8"), module), module)
        for pattern, replacement in REPLACED:
            text = re.sub(pattern, replacement, text, flags=re.MULTILINE)
        if "numpy.typing" in text and "\nimport numpy.typing" not in text:
            text = text.replace("\nimport numpy\n", "\nimport numpy\nimport numpy.typing\n", 1)
        file.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
