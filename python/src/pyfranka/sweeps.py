# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a function on many cases, on this machine's cores or on a Dask cluster.

    import pyfranka

    def reach(case, seed):
        ...
        return {"error": 0.001, "q": q}

    done = pyfranka.sweep(reach, 1000, output="reach.parquet")
    print(len(done.failed), [outcome.result["error"] for outcome in done if outcome.ok])

The module has another name than the function, so that `pyfranka.sweep` is always the function. Dask, tqdm
and pyarrow are imported when a sweep starts: the wheel's extra `cluster`; in the workspace `./franka install
extras` installs them.

dask.distributed schedules the cases. Objects of this process's `__main__` and of scripts are sent by value
(cloudpickle), so workers do not need the file.
"""

from __future__ import annotations

import argparse
import importlib.machinery
import importlib.util
import numbers
import os
import sys
import time
import typing
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from types import ModuleType

from pyfranka._sweep_plan import Function, Plan, check_number, seed_of
from pyfranka.command_line import Parser, install_command

if typing.TYPE_CHECKING:
    from pyfranka._sweep_output import Output, Row

__all__ = ["Outcome", "Sweep", "main", "seed_of", "sweep"]

FAILURES_SHOWN = 10  # by the program (chosen here)
SCRIPT = "pyfranka_sweep_script"  # the name of a script as a module


class Outcome(typing.NamedTuple):
    """The outcome of a case.

    index: its number. case, seed: the function's arguments. result: what the function returned; None if it
    failed. error: why it failed, in a sentence, or None. tries: how often it was started. duration: of the
    last try [s]; None if the worker died. worker: address of the last worker.

    >>> [(outcome.case, outcome.ok) for outcome in sweep_of_squares]
    [(0, True), (1, True), (2, True)]
    """

    index: int  # type: ignore[assignment]  # hides the method of tuples
    case: typing.Any
    seed: int
    result: typing.Any
    error: str | None
    tries: int
    duration: float | None
    worker: str

    @property
    def ok(self) -> bool:
        """Whether there is a result."""
        return self.error is None


class Sweep(Sequence[Outcome]):
    """The outcomes of all cases, in their order.

    >>> sweep_of_squares
    <Sweep of 3 cases, 0 failed>
    >>> sweep_of_squares.results
    [0, 1, 4]
    """

    def __init__(self, outcomes: Sequence[Outcome]):
        self._outcomes = list(outcomes)

    @typing.overload
    def __getitem__(self, index: int) -> Outcome: ...
    @typing.overload
    def __getitem__(self, index: slice) -> list[Outcome]: ...
    def __getitem__(self, index: int | slice) -> Outcome | list[Outcome]:
        return self._outcomes[index]

    def __len__(self) -> int:
        return len(self._outcomes)

    def __repr__(self) -> str:
        return f"<Sweep of {len(self)} cases, {len(self.failed)} failed>"

    @property
    def results(self) -> list[typing.Any]:
        """The results in order; None for failed cases."""
        return [outcome.result for outcome in self]

    @property
    def failed(self) -> list[Outcome]:
        """The outcomes of failed cases."""
        return [outcome for outcome in self if not outcome.ok]


def sweep(
    function: Function,
    cases: int | Iterable[object],
    cluster: object = None,
    *,
    output: str | os.PathLike[str] | None = None,
    seed: int = 1,
    retries: int = 1,
    workers: int | None = None,
    progress: bool | None = None,
    retry_failed: bool = False,
    patience: float = 600.0,
) -> Sweep:
    """Calls `function(case, seed)` for each case and returns the outcomes, in order.

    cases: any values that can be pickled, or a number n for the cases 0 ... n-1. cluster: None for processes
    on this machine, one core each; the address of a Dask scheduler ("tcp://host:8786"); the path of a
    scheduler file; a cluster of Dask, such as dask_jobqueue.SLURMCluster or dask.distributed.SSHCluster; or a
    dask.distributed.Client. A cluster object and a Client stay open.

    output: a .parquet or .csv file. Results are written as they arrive; the same call continues an
    interrupted sweep. With an output, results must be numbers, texts, lists, numpy arrays, or dicts of them,
    and arrays are returned as lists. seed: of the sweep; each case has its own (seed_of). retries: how often
    a case that raises is run again. If its worker died, Dask runs the case again, up to its setting
    distributed.scheduler.allowed-failures (3). After that the case is reported as failed, and the sweep
    continues. workers: number of processes on this machine. progress: shows a bar; None: if standard error is
    a terminal. retry_failed: runs cases again that failed according to the output. patience: time that the
    cluster may be without workers [s].

    Blocks. Raises TypeError or ValueError for invalid arguments, before any case starts; ImportError if a
    package is missing; ConnectionError if the scheduler cannot be reached or is lost; TimeoutError without
    workers; OSError if the output cannot be written. Finished cases are then in the output.
    Thread-safe. Exception: of two sweeps with the same output, one raises RuntimeError.

    >>> pyfranka.sweep(lambda case, seed: case * case, 3, workers=1, progress=False).results
    [0, 1, 4]
    """
    _require()
    from pyfranka import _sweep_run

    plan = Plan(function, cases, seed)
    check_number("retries", retries, 0)
    if workers is not None:
        check_number("workers", workers, 1)
        if cluster is not None:
            raise ValueError("workers is the number of processes on this machine; a cluster has its own.")
    if not isinstance(patience, numbers.Real) or not patience > 0:
        raise ValueError(f"patience must be a time above 0 s, not {patience!r}.")
    _sweep_run.check_cluster(cluster)
    with ExitStack() as stack:
        record: _Memory | Output = _Memory()
        done: dict[int, bool] = {}
        if output is not None:
            record = file = stack.enter_context(_open_output(Path(output), plan))
            done = file.done()
        left = [i for i in range(len(plan)) if i not in done or (retry_failed and not done[i])]
        if left:
            bar = stack.enter_context(_bar(progress, len(plan), len(plan) - len(left)))
            client = stack.enter_context(_sweep_run.client_of(cluster, workers, len(left)))
            run = _sweep_run.Run(
                client, plan, retries, patience, plain=output is not None, local=cluster is None
            )
            for outcome in run.outcomes(left):
                if outcome is None:
                    record.flush()
                    continue
                record.add(*outcome)
                bar(outcome[0]["error"] is not None)
        return Sweep([_outcome(row, plan) for row in record.rows()])


# ---- arguments -------------------------------------------------------------------------------------------


def _require() -> None:
    # The Debian package of a sweep's dependencies has its own folder, for this process and its workers.
    folder = str(Path(__file__).resolve().parents[3] / "pyfranka-sweep")
    if os.path.isdir(folder) and folder not in sys.path:
        sys.path.insert(0, folder)
        os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [folder, os.environ.get("PYTHONPATH")]))
    for name in ("distributed", "pyarrow", "tqdm"):
        if importlib.util.find_spec(name) is None:
            raise ImportError(
                f"A sweep needs the Python package {name}, which this Python ({sys.executable}) does not "
                f"have: {install_command('cluster')}.",
                name=name,
            )


# ---- the record of a sweep -------------------------------------------------------------------------------


class _Memory:
    """Rows of a sweep without an output; the interface is that of _sweep_output.Output."""

    def __init__(self) -> None:
        self._rows: dict[int, Row] = {}

    def add(self, row: Row, result: Row) -> None:
        self._rows[row["index"]] = {**row, **result}

    def flush(self) -> None:
        pass

    def rows(self) -> list[Row]:
        return [self._rows[index] for index in sorted(self._rows)]


def _open_output(path: Path, plan: Plan) -> Output:
    from pyfranka import _sweep_output

    _sweep_output.check_path(path)
    cases = None if plan.counted else _sweep_output.table_of(plan.cases, "case")
    return _sweep_output.Output(path, plan.identity, cases)


def _outcome(row: Row, plan: Plan) -> Outcome:
    if "sweep" in row:
        from pyfranka._sweep_output import result_of

        result = result_of(row)
    else:
        result = row.get("result")
    values = {name: row[name] for name in ("index", "seed", "error", "tries", "duration", "worker")}
    return Outcome(case=plan.cases[row["index"]], result=result, **values)


@contextmanager
def _bar(progress: bool | None, cases: int, done: int) -> Iterator[Callable[[bool], None]]:
    """A progress bar on standard error with rate and time left. Yields the function to call after each
    case."""
    from tqdm import tqdm

    disable = None if progress is None else not progress  # None: unless it is a terminal
    failures = 0
    with tqdm(total=cases, initial=done, unit="case", disable=disable, dynamic_ncols=True) as bar:

        def advance(failed: bool) -> None:
            nonlocal failures
            failures += failed
            if failed:
                bar.set_postfix_str(f"{failures} failed", refresh=False)
            bar.update()

        yield advance


# ---- the program -----------------------------------------------------------------------------------------


def main(arguments: Sequence[str] | None = None) -> int:
    """The program pyfranka-sweep. Returns 0, 1 if cases failed, 2 for a wrong call, 130 if interrupted."""
    parser = Parser(
        prog="pyfranka-sweep",
        description="Calls the function case(index, seed) of a Python file for many cases, on all cores or "
        "on a Dask cluster, and writes the results into a file. A second call continues an interrupted "
        "sweep. The file may also define the cases: a list `cases`, or a function that returns one.",
    )
    parser.add_argument("script", type=Path, help="a Python file with a function case(index, seed)")
    parser.add_argument("--cases", type=int, metavar="N", help="cases 0 ... N-1 (the file's `cases`)")
    parser.add_argument("--seed", type=int, default=1, help="of the whole sweep (%(default)s)")
    parser.add_argument("--output", type=Path, help=".parquet or .csv (the script's name, .parquet, here)")
    parser.add_argument("--cluster", help="address or file of a Dask scheduler (processes on this machine)")
    parser.add_argument("--workers", type=int, metavar="N", help="processes on this machine (its cores)")
    parser.add_argument("--retries", type=int, default=1, help="of a case that raises (%(default)s)")
    parser.add_argument("--retry-failed", action="store_true", help="run failed cases of the output again")
    parser.add_argument("--patience", type=float, default=600.0, help="[s] without any worker (%(default)g)")
    parser.add_argument("--function", default="case", metavar="NAME", help="its name (%(default)s)")
    parser.add_argument(
        "--progress", action=argparse.BooleanOptionalAction, help="a bar (if standard error is a terminal)"
    )
    options = parser.parse_args(arguments)
    output = options.output or Path(f"{options.script.stem}.parquet")
    begin = time.monotonic()
    try:
        function, cases = _from_script(options.script, options.function, options.cases)
        done = sweep(
            function,
            cases,
            options.cluster,
            output=output,
            seed=options.seed,
            retries=options.retries,
            workers=options.workers,
            progress=options.progress,
            retry_failed=options.retry_failed,
            patience=options.patience,
        )
    except KeyboardInterrupt:
        print(f"\npyfranka-sweep: interrupted; the same command continues from {output}.", file=sys.stderr)
        return 130
    except (TypeError, ValueError, OSError, ImportError, RuntimeError) as error:
        print(f"pyfranka-sweep: {error}", file=sys.stderr)
        return 2
    for outcome in done.failed[:FAILURES_SHOWN]:
        print(f"case {outcome.index} (seed {outcome.seed}) failed in {outcome.tries} tries: {outcome.error}")
    if len(done.failed) > FAILURES_SHOWN:
        print(f"... and {len(done.failed) - FAILURES_SHOWN} more, in the column `error`")
    print(f"{len(done)} cases, {len(done.failed)} failed: {output} ({time.monotonic() - begin:.1f} s)")
    return 1 if done.failed else 0


def _from_script(path: Path, name: str, number: int | None) -> tuple[Function, int | Iterable[object]]:
    """The function and the cases of a file; its objects are pickled by value from now on."""
    _require()
    import cloudpickle

    if not path.is_file():
        raise FileNotFoundError(f"There is no file '{path}'.")
    module = _imported(path)
    cloudpickle.register_pickle_by_value(module)
    function = getattr(module, name, None)
    if not callable(function):
        raise ValueError(f"'{path}' has no function {name}(index, seed).")
    if number is not None:
        return function, number
    cases = getattr(module, "cases", None)
    if cases is None:
        raise ValueError(f"Give the number of cases (--cases), or define `cases` in '{path}'.")
    return function, cases() if callable(cases) else cases


def _imported(path: Path) -> ModuleType:
    """The file as a module; files beside it can be imported, as in a script."""
    from pyfranka._sweep_run import in_one_line

    spec = importlib.util.spec_from_loader(
        SCRIPT, importlib.machinery.SourceFileLoader(SCRIPT, str(path)), origin=str(path)
    )
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[SCRIPT] = module
    sys.path.insert(0, str(path.absolute().parent))
    try:
        spec.loader.exec_module(module)
    except Exception as error:  # whatever the script raises
        raise RuntimeError(f"'{path}' cannot be imported: {in_one_line(error)}.") from error
    return module


if __name__ == "__main__":
    from pyfranka import sweeps  # workers know the functions by that name

    sys.exit(sweeps.main())
