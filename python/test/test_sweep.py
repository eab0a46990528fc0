# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.sweep: many cases on several processes, each exactly once, and what goes wrong with them."""

import csv
import fcntl
import functools
import json
import os
import pickle
import signal
import subprocess
import sys
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import cloudpickle
import distributed
import numpy
import page_output
import pyarrow.parquet
import pyfranka
import pyfranka.sim
import pytest
import waiting
from genuine_clients import client_python
from PIL import Image
from pyfranka import _sweep_run, sweeps
from waiting import wait_for

TOP = Path(__file__).resolve().parents[2]
DEADLINE = 120.0  # [s] of a busy machine
MODULE = [sys.executable, "-m", "pyfranka.sweeps"]
for module in (sys.modules[__name__], waiting):  # workers cannot import the tests
    cloudpickle.register_pickle_by_value(module)
ENVIRONMENT = {
    **os.environ,
    "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1",
    "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "10s",  # to a worker that was killed with a result
    "DASK_DISTRIBUTED__SCHEDULER__WORKER_SATURATION": "1.0",  # no case waits behind one that kills
}


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """The address of a scheduler with two workers, which are programs of their own, in another folder."""
    folder = tmp_path_factory.mktemp("cluster")
    file = folder / "scheduler.json"
    dask = [sys.executable, "-m", "dask"]
    where = ["--host", "127.0.0.1", "--no-dashboard", "--scheduler-file", str(file)]
    processes = []
    with (folder / "log").open("w") as log:
        options = {"env": ENVIRONMENT, "cwd": folder, "stdout": log, "stderr": log}
        try:
            processes.append(subprocess.Popen([*dask, "scheduler", "--port", "0", *where], **options))
            workers = [*dask, "worker", "--nworkers", "2", "--nthreads", "1", *where]
            processes.append(subprocess.Popen(workers, **options))
            wait_for(lambda: file.exists() and file.read_text().endswith("}"), "the scheduler", DEADLINE)
            address = json.loads(file.read_text())["address"]
            with distributed.Client(address, timeout=DEADLINE, set_as_default=False) as client:
                client.wait_for_workers(2, timeout=DEADLINE)
            yield address
        finally:
            for process in reversed(processes):  # workers first: without a scheduler they wait some seconds
                process.terminate()
                process.wait(DEADLINE)


class Log:
    """A file in which cases note that they run."""

    def __init__(self, path):
        self.path = path

    def note(self, text):
        with self.path.open("a") as file:
            file.write(f"{text}\n")

    def notes(self):
        return self.path.read_text().split() if self.path.exists() else []


@pytest.fixture
def log(tmp_path):
    return Log(tmp_path / "log")


# ---- order, seeds, failures ------------------------------------------------------------------------------


def test_results_come_in_order_and_each_case_runs_once(cluster, log):
    def unequal(case, seed):
        if case["number"] == 0:  # ends behind others
            wait_for(log.notes, "Another case")
        log.note(case["number"])
        return case["number"] ** 2, seed

    done = pyfranka.sweep(unequal, [{"number": n} for n in range(30)], cluster, seed=7)
    assert [outcome.index for outcome in done] == list(range(30))
    expected = [int(s.generate_state(1, "u8")[0]) >> 1 for s in numpy.random.SeedSequence(7).spawn(30)]
    assert done.results == [(n * n, seed) for n, seed in enumerate(expected)]
    assert sorted(map(int, log.notes())) == list(range(30))
    assert [outcome.case for outcome in done] == [{"number": n} for n in range(30)]
    assert all(outcome.ok and outcome.tries == 1 and outcome.duration >= 0 for outcome in done)
    assert len({outcome.worker for outcome in done}) == 2 and not done.failed


def test_failing_case_is_retried_then_reported_and_the_sweep_continues(cluster, log):
    def moody(case, seed):
        log.note(case)
        if case == 3 or (case == 5 and log.notes().count("5") == 1):
            raise ValueError(f"not\n{case}")
        if case == 7:
            sys.exit("no more")
        return case

    done = pyfranka.sweep(moody, 10, cluster)
    assert [outcome.index for outcome in done.failed] == [3, 7]
    assert done[3].error.startswith("ValueError: not 3 (test_sweep.py, line ") and done[3].result is None
    assert done[7].error.startswith("SystemExit: no more")
    assert [outcome.tries for outcome in done] == [1, 1, 1, 2, 1, 2, 1, 2, 1, 1]
    assert done[5].ok and done[3].duration >= 0 and done[3].worker.startswith("tcp://")
    assert Counter(log.notes()) == Counter({str(n): outcome.tries for n, outcome in enumerate(done)})
    alone = pyfranka.sweep(moody, [3], cluster, retries=0)
    assert alone[0].tries == 1


def test_killed_worker_loses_and_duplicates_no_case(cluster, log, tmp_path):
    def deadly(case, seed):
        log.note(case)
        if case == 4 or (case == 9 and log.notes().count("9") == 1):
            os.kill(os.getpid(), signal.SIGKILL)
        return {"seed": seed}

    done = pyfranka.sweep(deadly, 20, cluster, output=tmp_path / "done.parquet")
    assert [outcome.index for outcome in done.failed] == [4]
    assert "workers died" in done[4].error and done[4].tries == 2 and done[4].duration is None
    assert done[9].ok and done[9].tries == 2
    assert all(outcome.result == {"seed": outcome.seed} for outcome in done if outcome.index != 4)
    table = pyarrow.parquet.read_table(tmp_path / "done.parquet")
    assert table["index"].to_pylist() == list(range(20))


def test_the_number_of_cases_in_flight_is_bounded(cluster, monkeypatch):
    monkeypatch.setattr(_sweep_run, "IN_FLIGHT", 3)
    with distributed.Client(cluster, set_as_default=False) as client:
        most, submit = [], client.map

        def counted(function, *arguments, **options):
            futures = submit(function, *arguments, **options)
            most.append([state.status for state in client.futures.values()].count("pending"))
            return futures

        monkeypatch.setattr(client, "map", counted)
        assert pyfranka.sweep(lambda case, seed: case, 100, client).results == list(range(100))
        assert client.status == "running", "a client of the caller stays open"
    assert max(most) <= 2 * _sweep_run.PER_THREAD, "of two workers"


def test_workers_without_pyfranka_are_reported(monkeypatch):
    """A worker of this process has pyfranka, so the name of what it needs is changed on its way."""

    def other(value):
        return pickle.dumps(value).replace(b"\x8c\x13pyfranka._sweep_run", b"\x8c\x13pyfranka.none_such_")

    monkeypatch.setattr(_sweep_run, "pickle", SimpleNamespace(dumps=other))
    with (
        distributed.LocalCluster(n_workers=1, processes=False, dashboard_address="127.0.0.1:0") as local,
        pytest.raises(ImportError, match="workers cannot import pyfranka .*; install it there"),
    ):
        pyfranka.sweep(lambda case, seed: 0, 3, local)


def test_a_cluster_without_workers_is_reported():
    with distributed.LocalCluster(n_workers=0, dashboard_address="127.0.0.1:0", host="127.0.0.1") as empty:
        with pytest.raises(TimeoutError, match="no workers for 0.1 s"):
            pyfranka.sweep(lambda case, seed: 0, 3, empty, patience=0.1)


# ---- output ----------------------------------------------------------------------------------------------

RESULT = {
    "number": 1.5,
    "whole": numpy.int64(3),
    "flag": True,
    "none": None,
    "text": "1.5",
    "words": 'a "b",\nc',
    "q": numpy.arange(3) / 2,
    "matrix": numpy.eye(2),
    "names": ["x", "y"],
    "empty": [],
}
PLAIN = {**RESULT, "whole": 3, "q": [0.0, 0.5, 1.0], "matrix": [[1.0, 0.0], [0.0, 1.0]]}


@pytest.mark.parametrize("suffix", ["parquet", "csv"])
def test_an_output_is_read_by_others_and_by_the_next_sweep(cluster, log, tmp_path, suffix):
    path, cases = tmp_path / f"out.{suffix}", [{"stiffness": 100.0 * n, "kind": "soft"} for n in range(3)]

    def full(case, seed):
        log.note(case["stiffness"])
        if case["stiffness"] == 100.0:
            raise RuntimeError("too, soft")
        return {**RESULT, "number": 1 if case["stiffness"] else 1.5}

    done = pyfranka.sweep(full, cases, cluster, output=path, retries=0)
    assert done.results == [PLAIN, None, {**PLAIN, "number": 1}]
    if suffix == "parquet":
        rows = pyarrow.parquet.read_table(path).to_pylist()
        assert rows[0]["result.q"] == [0.0, 0.5, 1.0] and rows[0]["result.words"] == RESULT["words"]
    else:
        with path.open(newline="") as file:
            rows = list(csv.DictReader(file))
        assert rows[0]["result.q"] == "[0.0, 0.5, 1.0]" and rows[0]["result.words"] == RESULT["words"]
    assert [int(row["index"]) for row in rows] == [0, 1, 2]
    assert [float(row["case.stiffness"]) for row in rows] == [0.0, 100.0, 200.0]
    assert [int(row["seed"]) for row in rows] == [sweeps.seed_of(1, n) for n in range(3)]
    assert rows[1]["error"].startswith("RuntimeError: too, soft") and not rows[0]["error"]
    assert [entry.name for entry in tmp_path.iterdir() if entry.name.startswith("out")] == [path.name]

    again = pyfranka.sweep(full, cases, cluster, output=path, retries=0)
    assert list(again) == list(done), "all of it from the file"
    assert len(log.notes()) == 3
    pyfranka.sweep(full, cases, cluster, output=path, retries=0, retry_failed=True)
    assert Counter(log.notes()) == {"0.0": 1, "100.0": 2, "200.0": 1}


def test_a_result_that_cannot_be_written_fails_its_case_only(cluster, tmp_path):
    wrong = [object(), {"a": {"b": 1}}, {3: 4}, {"a": [1, "x"]}, 2**63, "text", {"a": "no number"}]

    def odd(case, seed):
        return {"a": 1.0} if case < 0 else wrong[case]

    done = pyfranka.sweep(odd, [-1, -2], cluster, output=tmp_path / "even.csv")
    assert not done.failed
    with pytest.raises(ValueError, match="another sweep: its cases is"):
        pyfranka.sweep(odd, [-1, -2, -3], cluster, output=tmp_path / "even.csv")
    done = pyfranka.sweep(odd, [-1, *range(7)], cluster, output=tmp_path / "odd.parquet")
    # One of the texts and numbers comes first and decides what its column is.
    assert {o.case for o in done.failed} in ({0, 1, 2, 3, 4, 6}, {-1, 0, 1, 2, 3, 4})
    assert all(o.error.startswith("The result cannot be written: ") and o.tries == 1 for o in done.failed)
    for case, text in {
        0: "type object",
        1: "type dict",
        2: "key 3 is not",
        3: "'a' cannot",
        4: "64 bits",
    }.items():
        assert text in done[case + 1].error


def test_the_output_of_another_sweep_is_refused_and_not_touched(cluster, tmp_path):
    path, other = tmp_path / "out.csv", tmp_path / "other.parquet"

    def one(case, seed):
        return 1

    def two(case, seed):
        return 2

    pyfranka.sweep(one, 2, cluster, output=path)
    before = path.read_bytes()
    for sentence, call in {
        "its function is": lambda: pyfranka.sweep(two, 2, cluster, output=path),
        "its cases is 2, here it is 3": lambda: pyfranka.sweep(one, 3, cluster, output=path),
        "its seed is 1, here it is 2": lambda: pyfranka.sweep(one, 2, cluster, output=path, seed=2),
    }.items():
        with pytest.raises(ValueError, match=sentence):
            call()
    other.write_text("no parquet\n")
    with pytest.raises(ValueError, match="cannot be read as a parquet file"):
        pyfranka.sweep(one, 2, cluster, output=other)
    (tmp_path / "table.csv").write_text("a,b\n1,2\n")
    with pytest.raises(ValueError, match="is not the output of a sweep"):
        pyfranka.sweep(one, 2, cluster, output=tmp_path / "table.csv")
    assert path.read_bytes() == before and other.read_text() == "no parquet\n"
    assert not list(tmp_path.glob("*.parts"))


# ---- interruption ----------------------------------------------------------------------------------------

# Without `if __name__ == "__main__"`: workers must not run the script again.
SCRIPT = """
import os, time
from pathlib import Path
import pyfranka
from beside import note

def slow(case, seed):
    note(f"{case} {os.getpid()}")
    time.sleep(0.1)  # rows are written each second; a longer sleep changes nothing: the fault itself
    while case >= 40 and not Path("again").exists():
        time.sleep(0.01)  # the fault itself
    return {"double": 2 * case}

done = pyfranka.sweep(slow, CASES, workers=2, output="out.NAME")
print(len(done), [outcome.result["double"] for outcome in done] == [2 * n for n in range(CASES)])
"""
CASES = 45  # the last of which wait, if the machine is so slow that they begin before the interruption
BESIDE = "def note(text):\n    with open('log', 'a') as file:\n        file.write(text + '\\n')\n"


def alive(pid):
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False


@pytest.mark.parametrize("how, name", [(signal.SIGKILL, "parquet"), (signal.SIGINT, "csv")])
def test_interrupted_sweep_continues_where_it_stopped(tmp_path, how, name):
    (tmp_path / "script.py").write_text(SCRIPT.replace("NAME", name).replace("CASES", str(CASES)))
    (tmp_path / "beside.py").write_text(BESIDE)
    log, parts = tmp_path / "log", tmp_path / f"out.{name}.parts"
    options = {"cwd": tmp_path, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    first = subprocess.Popen([sys.executable, "script.py"], **options)
    wait_for(
        lambda: any(parts.glob("part-*.parquet")) or first.poll() is not None,
        "a part of the output",
        DEADLINE,
    )
    first.send_signal(how)
    _, error = first.communicate(timeout=DEADLINE)
    begun = [line.split() for line in log.read_text().splitlines()]
    assert first.returncode != 0 and len(begun) < CASES, error
    wait_for(lambda: not any(alive(pid) for _, pid in begun), "the end of the workers", DEADLINE)
    if how == signal.SIGKILL:
        written = {
            i
            for part in parts.glob("part-*.parquet")
            for i in pyarrow.parquet.read_table(part)["index"].to_pylist()
        }
    else:
        assert "KeyboardInterrupt" in error and not parts.exists()
        with (tmp_path / "out.csv").open(newline="") as file:
            written = {int(row["index"]) for row in csv.DictReader(file)}
    assert written
    (tmp_path / "again").touch()
    second = subprocess.run([sys.executable, "script.py"], timeout=DEADLINE, **options)
    assert second.stdout == f"{CASES} True\n", second.stderr
    runs = Counter(int(line.split()[0]) for line in log.read_text().splitlines())
    assert set(runs) == set(range(CASES)) and all(runs[index] == 1 for index in written)
    assert sum(runs.values()) - CASES <= len(begun) - len(written)
    if name == "csv":
        with (tmp_path / "out.csv").open(newline="") as file:
            rows = [int(row["index"]) for row in csv.DictReader(file)]
    else:
        rows = pyarrow.parquet.read_table(tmp_path / "out.parquet")["index"].to_pylist()
    assert rows == list(range(CASES)) and not parts.exists()


KILLED = """
import os, signal
from distributed.deploy.subprocess import SubprocessWorker
from pyfranka import _sweep_run

class KilledAtStart(SubprocessWorker):
    async def start(self):
        await super().start()
        os.kill(os.getpid(), signal.SIGKILL)

_sweep_run.SubprocessWorker = KilledAtStart
_sweep_run.ALONE = 2.0
_sweep_run.local_cluster(1)
"""


def test_worker_ends_if_its_program_was_killed_during_start():
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    killed = subprocess.Popen([sys.executable, "-c", KILLED], **options)
    killed.communicate(timeout=DEADLINE)  # until the worker has closed its ends
    assert killed.returncode == -signal.SIGKILL


def test_two_processes_cannot_write_one_output(cluster, tmp_path):
    path = tmp_path / "out.csv"

    def nothing(case, seed):
        return None

    with pytest.raises(RuntimeError, match="Another process writes"):
        plan = sweeps.Plan(nothing, 1, 1)
        with sweeps._open_output(path, plan):
            pyfranka.sweep(nothing, 1, cluster, output=path)


IDENTITY = """
from pyfranka import sweeps
names = {"shoulder", "elbow", "wrist"}
def use(case, seed):
    return len(names)
print(sweeps.Plan(use, [{"parts": {"left", "right", "tool"}}, frozenset({("a", 1), ("b", 2)})], 1).identity)
"""


def test_sets_do_not_make_another_sweep():
    def identity(hash_seed):
        environment = {**os.environ, "PYTHONHASHSEED": hash_seed}
        ran = subprocess.run(
            [sys.executable, "-c", IDENTITY], env=environment, capture_output=True, text=True, check=True
        )
        return ran.stdout

    assert len({identity(hash_seed) for hash_seed in "1234"}) == 1


def test_a_variable_without_a_value_fails_its_cases_only(cluster):
    def use(case, seed):
        return case if case == 0 else later

    if not use:
        later = 1
    first, second = pyfranka.sweep(use, 2, cluster, progress=False, retries=0)
    assert first.ok and "later" in second.error
    assert sweeps.Plan(use, 2, 1).identity


def test_an_output_whose_folder_was_removed_meanwhile_is_locked_again(tmp_path, monkeypatch):
    """Another process ends its sweep, and removes the folder, while this one waits for the lock."""
    path, lock = tmp_path / "out.csv", fcntl.flock
    folder = path.with_name("out.csv.parts")

    def remove_and_lock(file, how):
        monkeypatch.setattr(fcntl, "flock", lock)
        folder.rmdir()
        lock(file, how)

    monkeypatch.setattr(fcntl, "flock", remove_and_lock)
    plan = sweeps.Plan(lambda case, seed: case, 1, 1)
    with sweeps._open_output(path, plan) as output:
        assert os.path.samestat(os.fstat(output._lock), folder.stat())
        with pytest.raises(RuntimeError, match="Another process writes"):
            sweeps._open_output(path, plan)


# ---- the program -----------------------------------------------------------------------------------------

OWN = """
from dataclasses import dataclass

@dataclass
class Point:
    x: float

cases = [Point(1.0), Point(2.0)]

def helper(point):
    return point.x ** 2

def case(index, seed):
    return {"index": index, "parity": seed % 2}

def square(point, seed):
    if point.x == 2.0:
        raise ValueError("no twos")
    return helper(point)
"""


def test_the_program_sends_the_functions_of_a_file(cluster, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    script = tmp_path / "own.py"
    script.write_text(OWN)
    assert sweeps.main([str(script), "--cases", "5", "--seed", "3", "--cluster", cluster]) == 0
    printed = capsys.readouterr()
    assert "5 cases, 0 failed: own.parquet" in printed.out
    assert "case/s" not in printed.err, "no bar without a terminal"
    table = pyarrow.parquet.read_table("own.parquet")
    assert table["result.parity"].to_pylist() == [sweeps.seed_of(3, n) % 2 for n in range(5)]
    arguments = [str(script), "--function", "square", "--output", "squares.csv", "--cluster", cluster]
    for first in (True, False):  # the second time from the file
        assert sweeps.main([*arguments, "--retries", "0", "--progress"]) == 1
        printed = capsys.readouterr()
        assert ("2/2" in printed.err) == ("case/s" in printed.err) == first, "nothing to do, no bar"
        assert (
            "case 1 (seed " in printed.out
            and "ValueError: no twos (own.py, line 18, in square)" in printed.out
        )
    for sentence, words in {
        "There is no file 'nowhere.py'": ["nowhere.py"],
        "has no function act(index, seed)": [str(script), "--function", "act"],
        "is of another sweep": [str(script), "--cases", "6", "--seed", "3"],
        "suffix .parquet or .csv": [str(script), "--cases", "6", "--output", "out.txt"],
        "cases must be a whole number": [str(script), "--cases", "0"],
    }.items():
        assert sweeps.main(words) == 2 and sentence in capsys.readouterr().err
    script.write_text("1 / 0\n")
    assert sweeps.main([str(script)]) == 2
    assert (
        "cannot be imported: ZeroDivisionError: division by zero (own.py, line 1" in capsys.readouterr().err
    )


# Locks of earlier versions: the oldest one that dask allows, and the last one that sends the names of files.
OLDER = ("cloudpickle-3.0.0", "cloudpickle-3.1.2")


DEADLY = """
import os, signal
from pathlib import Path

def deadly(case, seed):
    with open(f"ran-{case}", "a") as file:
        file.write("x")
    if case == 2:
        raise ValueError("no twos")
    if case == 3 or (case == 5 and Path("ran-5").read_text() == "x"):
        os.kill(os.getpid(), signal.SIGKILL)
    return seed
"""


@pytest.mark.parametrize("lock", OLDER)
def test_failed_and_killed_cases_with_an_older_cloudpickle(lock, tmp_path):
    """The program pyfranka-sweep with another version of cloudpickle, also in its workers."""
    (tmp_path / "own.py").write_text(DEADLY)
    words = ["own.py", "--function", "deadly", "--cases", "6", "--workers", "2"]
    (older,) = client_python(lock).parents[1].glob("lib/*/site-packages")
    code = "import cloudpickle, sys; from pyfranka import sweeps; print(cloudpickle.__version__);"
    run = subprocess.run(
        [sys.executable, "-c", code + f"sys.exit(sweeps.main({words}))"],
        env={**ENVIRONMENT, "PYTHONPATH": f"{older}:{os.environ.get('PYTHONPATH', '')}"},
        capture_output=True,
        text=True,
        timeout=DEADLINE,
        cwd=tmp_path,
    )
    assert run.stdout.startswith(lock.removeprefix("cloudpickle-") + "\n"), run.stderr
    assert run.returncode == 1 and "6 cases, 2 failed" in run.stdout, run.stdout + run.stderr
    assert "ValueError: no twos (own.py, line 9, in deadly)" in run.stdout, run.stderr
    rows = pyarrow.parquet.read_table(tmp_path / "own.parquet").to_pylist()
    assert [row["index"] for row in rows] == list(range(6))
    assert "workers died" in rows[3]["error"] and rows[5]["tries"] == 2
    good = [row for row in rows if row["index"] not in (2, 3)]
    assert all(row["result"] == row["seed"] and row["error"] is None for row in good)


# ---- bad input -------------------------------------------------------------------------------------------


def test_what_cannot_be_carried_out_is_refused_before_anything_is_begun(tmp_path):
    def good(case, seed):
        return 0

    def one_argument(case):
        return 0

    class Asynchronous:
        scheduler_address, asynchronous = "tcp://127.0.0.1:1", True

    def fail(self):
        raise RuntimeError("glued")

    stuck = type("Stuck", (), {"__reduce__": fail})()
    there = tmp_path / "is_there.csv"
    there.mkdir()
    call = pyfranka.sweep
    for sentence, refused in {
        "'one_argument' cannot be": lambda: call(one_argument, 1),
        "case 1 cannot be sent to a worker": lambda: call(good, [1, stuck], output=tmp_path / "out.csv"),
        "function cannot be sent to a worker": lambda: call(lambda case, seed: stuck, 1),
        "is asynchronous": lambda: call(good, 1, Asynchronous()),
        "suffix .parquet or .csv": lambda: call(good, 1, output=tmp_path / "out.txt"),
        "is a folder": lambda: call(good, 1, output=there),
        "does not exist; make it first": lambda: call(good, 1, output=tmp_path / "no" / "out.csv"),
        "a cluster has its own": lambda: call(good, 1, "tcp://127.0.0.1:1", workers=1),
    }.items():
        with pytest.raises((TypeError, ValueError, OSError)) as caught:
            refused()
        assert sentence in str(caught.value)
        assert [entry.name for entry in tmp_path.iterdir()] == ["is_there.csv"], sentence


def test_a_scheduler_that_is_not_there_is_reported(monkeypatch):
    monkeypatch.setattr(_sweep_run, "CONNECT", 0.2)
    with pytest.raises(ConnectionError, match="'tcp://127.0.0.1:9' cannot be reached"):
        pyfranka.sweep(lambda case, seed: 0, 1, "tcp://127.0.0.1:9")


def test_a_missing_package_is_named(monkeypatch):
    monkeypatch.setattr(sweeps.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(ImportError, match="needs the Python package distributed.*./franka install extras"):
        pyfranka.sweep(lambda case, seed: 0, 1)


def test_dask_is_imported_by_sweeps_only():
    code = "import sys, pyfranka.sim; print('dask' in sys.modules, 'sweep' in dir(pyfranka)); pyfranka.sweep"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=DEADLINE)
    assert run.stdout == "False True\n", run.stderr
    assert pyfranka.sweep is sweeps.sweep
    with pytest.raises(AttributeError, match="no attribute 'sweeep'"):
        _ = pyfranka.sweeep


# ---- robots ----------------------------------------------------------------------------------------------


def test_the_example_of_the_documentation_runs(cluster, tmp_path, monkeypatch, capsys):
    (example,) = page_output.examples("python.md", "## Sweeps")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(pyfranka, "sweep", functools.partial(sweeps.sweep, cluster=cluster), raising=False)
    example.run()
    example.check(capsys.readouterr().out, tolerance=2e-3)
    assert len(pyarrow.parquet.read_table("swing.parquet")["result.q"][0]) == 7


def test_the_example_draws_a_heat_map(cluster, tmp_path):
    example = [sys.executable, str(TOP / "examples" / "python" / "sweep_stiffness.py"), "--cluster", cluster]
    options = ["--output", str(tmp_path), "--scenes", "1", "--stiffnesses", "50", "800"]
    run = subprocess.run([*example, *options], capture_output=True, text=True, timeout=DEADLINE)
    assert run.stdout == "   50 N/m: 0 of 1 placed\n  800 N/m: 1 of 1 placed\n", run.stderr
    assert Image.open(tmp_path / "stiffness.png").size[0] > 100
    table = pyarrow.parquet.read_table(tmp_path / "stiffness.parquet")
    assert table["result.distance"].to_pylist()[1] < 0.01
