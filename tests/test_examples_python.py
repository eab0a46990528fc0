# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The examples in examples/python run as they stand, say what is true and draw their pictures.

The short form runs each with one of the robots. sweep_stiffness.py: python/test/test_sweep.py;
lerobot_dataset.py: python/test/test_lerobot.py.
"""

import re
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient
from PIL import Image, ImageStat

TOP = Path(__file__).resolve().parents[1]
EXAMPLES = TOP / "examples" / "python"
QUICK = {"first_steps"}
LONG = {"random_episodes", "record_and_plot", "task_rewards", "train_reach"}
sys.path.append(str(TOP / "docs" / "site"))
from docsite import notebooks  # noqa: E402

AGAIN = pytest.mark.long_form("the same with the other robot")
with_panda = pytest.mark.parametrize("kind", ["panda", pytest.param("fr3", marks=AGAIN)])
with_fr3 = pytest.mark.parametrize("kind", ["fr3", pytest.param("panda", marks=AGAIN)])


@pytest.fixture
def run(kind, tmp_path):
    """Runs an example with a robot; returns what it printed. Its picture has something on it, and a long one
    shows how far it is."""

    def example(name, *options):
        command = [sys.executable, EXAMPLES / f"{name}.py", "--robot", kind, "--output", tmp_path]
        done = subprocess.run([*command, *options], capture_output=True, text=True, timeout=500)
        assert done.returncode == 0, done.stdout + done.stderr
        assert name not in LONG or re.search(r"(\d+) of \1\n", done.stderr), done.stderr
        with Image.open(tmp_path / f"{name}.png") as picture:
            assert min(picture.size) >= 300
            assert max(ImageStat.Stat(picture.convert("L")).stddev) > 10.0
        return done.stdout

    return example


def numbers(text):
    return [float(number) for number in re.findall(r"-?\d+\.?\d*", text)]


@with_panda
def test_first_steps(run):
    *_, last = run("first_steps").splitlines()
    assert last.endswith("RobotMode.Idle GripperOutcome.Succeeded")


@with_fr3
def test_impedance_in_python(run):
    yielded, spring = numbers(run("impedance_in_python"))
    assert spring == 10.0
    assert yielded == pytest.approx(spring, rel=0.05)


@with_panda
def test_pick_and_place(run):
    assert run("pick_and_place").startswith("placed ")


@with_fr3
def test_random_episodes(run):
    chance, written = run("random_episodes", "--episodes", "4").splitlines()
    assert written.endswith("100% reached")
    assert numbers(chance)[0] > numbers(written)[0]


@with_panda
def test_task_rewards(run):
    lines = run("task_rewards", "--episodes", "1").splitlines()
    assert [line.partition(":")[0] for line in lines] == ["Reach", "Push", "PickAndPlace", "HandOver"]
    for line in lines:
        assert re.search(r"written policy 100%, of random actions 0%$", line), line


@with_panda
def test_train_reach(run, long_run):
    reached, goals, _ = numbers(run("train_reach", *(() if long_run else ("--episodes", "40"))))
    assert goals == 20
    assert not long_run or reached >= 18


@with_panda
def test_record_and_plot(run, tmp_path):
    samples, force = numbers(run("record_and_plot"))
    assert samples == 1200
    assert force == pytest.approx(-400 * (0.42 - 0.37), rel=0.1), "of the spring, on the table"
    assert (tmp_path / "recording.npz").stat().st_size > 10000


@pytest.mark.parametrize("name", ["random_episodes", "task_rewards", "train_reach"])
def test_without_gymnasium_an_example_has_help_and_a_sentence(name):
    program = str(EXAMPLES / f"{name}.py")
    code = (
        "import runpy, sys; sys.modules['gymnasium'] = None; sys.argv = sys.argv[1:];"
        f"sys.path.insert(0, {str(EXAMPLES)!r}); runpy.run_path({program!r}, run_name='__main__')"
    )
    for option, status, text in (
        ("--help", 0, "usage: "),
        ("--robot=fr3", 1, f"{name}.py needs the Python package gymnasium: run ./franka install extras"),
    ):
        command = [sys.executable, "-c", code, program, option]
        ran = subprocess.run(command, capture_output=True, text=True, timeout=120)
        assert ran.returncode == status, ran.stderr
        assert (ran.stdout + ran.stderr).startswith(text) and "Traceback" not in ran.stderr


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Of the notebooks."""
    folder = tmp_path_factory.mktemp("notebooks")
    notebooks.write(folder)
    return folder


def test_each_program_is_a_notebook_with_the_same_code(folder):
    assert {path.stem for path in folder.glob("*.ipynb")} == {path.stem for path in EXAMPLES.glob("*.py")} - {
        "common",
        "lerobot_dataset",  # a command
    }
    for path in folder.glob("*.ipynb"):
        notebook = nbformat.read(path, as_version=4)
        assert notebook.cells[0].cell_type == "markdown" and notebook.cells[0].source.startswith("# ")
        code = [cell.source for cell in notebook.cells if cell.cell_type == "code"]
        text = [f"# {cell.source}" for cell in notebook.cells[1:] if cell.cell_type == "markdown"]
        _, _, program = (EXAMPLES / f"{path.stem}.py").read_text().partition("# %%\n")
        rest = [
            line for line in program.splitlines() if line and line not in ("# %%", "# %% [markdown]", *text)
        ]
        assert rest == [line for cell in code for line in cell.splitlines() if line]


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=() if name in QUICK else pytest.mark.long_form("all notebooks"))
        for name in sorted(path.stem for path in notebooks.programs())
    ],
)
def test_a_notebook_runs_in_jupyter_and_shows_its_picture(folder, name):
    notebook = nbformat.read(folder / f"{name}.ipynb", as_version=4)
    NotebookClient(notebook, timeout=900, resources={"metadata": {"path": str(folder)}}).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert any("image/png" in output.get("data", {}) for output in outputs), "a picture"
    assert not any(output.output_type == "error" for output in outputs)
    picture = "stiffness" if name == "sweep_stiffness" else name
    assert (folder / f"{picture}.png").exists()
