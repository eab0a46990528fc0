# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The programs in examples/python as Jupyter notebooks. The programs are the only source.

    python3 docs/site/docsite/notebooks.py FOLDER

Cells begin at the lines `# %%` and `# %% [markdown]`; the first cell is the program's docstring. Modules that
programs import are copied beside the notebooks.
"""

import ast
import shutil
import sys
import typing
from pathlib import Path

import jupytext
import nbformat

EXAMPLES = Path(__file__).resolve().parents[3] / "examples" / "python"
MODULES = ("common.py", "sweep_stiffness.py")
KERNEL = {"name": "python3", "display_name": "Python 3", "language": "python"}
CELL = "# %%"


def programs() -> list[Path]:
    """Those that have cells."""
    return [path for path in sorted(EXAMPLES.glob("*.py")) if CELL in path.read_text(encoding="utf-8")]


def notebook(program: Path) -> typing.Any:
    """A program as a notebook without outputs."""
    text = program.read_text(encoding="utf-8")
    title, _, rest = (ast.get_docstring(ast.parse(text)) or "").partition("\n")
    cells = text[text.index(f"\n{CELL}") + 1 :]
    made = jupytext.reads(cells, fmt="py:percent")
    heading = nbformat.v4.new_markdown_cell(f"# {title.rstrip('.')}\n{rest}".strip())
    made.cells.insert(0, heading)
    for number, cell in enumerate(made.cells):
        cell.id = f"cell-{number}"  # the same in each build
    made.metadata = nbformat.NotebookNode(kernelspec=KERNEL)
    nbformat.validate(made)
    return made


def write(folder: Path) -> list[Path]:
    """Writes all of them, and the modules; returns the notebooks."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for program in programs():
        written.append(folder / f"{program.stem}.ipynb")
        nbformat.write(notebook(program), written[-1])
    for module in MODULES:
        shutil.copy(EXAMPLES / module, folder)
    return written


if __name__ == "__main__":
    write(Path(sys.argv[1]))
