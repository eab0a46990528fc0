# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""How pyfranka.sweeps uses Dask: the cluster, what runs on its workers, and the futures on their way."""

from __future__ import annotations

import functools
import inspect
import itertools
import logging
import os
import pickle
import sys
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import dask
from dask.system import CPU_COUNT
from distributed import CancelledError, Client, Future, KilledWorker, Scheduler, as_completed, get_worker
from distributed.deploy.spec import SpecCluster
from distributed.deploy.subprocess import SubprocessWorker
from distributed.utils import silence_logging_cmgr

from pyfranka._sweep_plan import Function, Plan

if TYPE_CHECKING:
    from pyfranka._sweep_output import Row

# Result (its columns if they are to be written), error, duration [s], worker.
CaseResult = tuple[dict[str, object], str | None, float, str]

IN_FLIGHT = 100  # futures at least: an adaptive cluster sees that there is work (chosen here)
PER_THREAD = 3  # futures a thread: a worker has its next case queued (chosen here)
LOOK = 1.0  # [s] between two looks at a silent cluster (chosen here)
OURS = ("pyfranka", "_pyfranka")
CONNECT = 30.0  # [s] to reach a scheduler, or to start one (chosen here)
ALONE = 60.0  # [s] until a worker ends that cannot reach its scheduler: its program was killed (chosen here)

# ---- the cluster -----------------------------------------------------------------------------------------


def check_cluster(cluster: object) -> None:
    """Raises TypeError, ValueError or FileNotFoundError if it can be none."""
    if isinstance(cluster, os.PathLike) or (isinstance(cluster, str) and cluster.endswith(".json")):
        if not Path(cluster).is_file():
            raise FileNotFoundError(f"There is no scheduler file '{cluster}'.")
    elif isinstance(cluster, str):
        if not cluster.rpartition(":")[2].isdigit() or cluster.startswith(":"):
            raise ValueError(f"The cluster's address is like tcp://host:8786, not '{cluster}'.")
    elif (
        cluster is not None and not isinstance(cluster, Client) and not hasattr(cluster, "scheduler_address")
    ):
        kind = type(cluster).__name__
        raise TypeError(f"cluster is an address, a scheduler file, a Dask cluster or a Client, not a {kind}.")
    elif getattr(cluster, "asynchronous", False):
        raise ValueError("The cluster is asynchronous; make it with asynchronous=False.")


@contextmanager
def client_of(cluster: object, workers: int | None, cases: int) -> Iterator[Client]:
    """A client of the cluster, or of a new one on this machine."""
    if isinstance(cluster, Client):
        yield cluster
        return
    with ExitStack() as stack:
        if cluster is None:
            # Until all is closed: Dask reports connections that end then.
            stack.enter_context(silence_logging_cmgr(logging.CRITICAL))
            cluster = local = local_cluster(min(workers or CPU_COUNT, cases))
            stack.callback(local.close, timeout=CONNECT)
        if isinstance(cluster, os.PathLike) or (isinstance(cluster, str) and cluster.endswith(".json")):
            where = {"scheduler_file": os.fspath(cluster)}
        else:
            where = {"address": cluster}
        try:
            client = Client(**where, timeout=CONNECT, set_as_default=False)
        except (OSError, ValueError) as error:  # TimeoutError is an OSError
            raise ConnectionError(f"The scheduler '{cluster}' cannot be reached: {error}.") from error
        stack.callback(client.close, timeout=CONNECT)
        yield client


def local_cluster(workers: int) -> SpecCluster:
    """As LocalCluster, but workers are programs of their own: multiprocessing would run the caller's script
    again in each of them, and fail in one without `if __name__ == "__main__"`. Their nannies set
    OMP_NUM_THREADS=1 and the like, so that libraries use one thread each."""
    local = {"host": "127.0.0.1", "dashboard": False, "dashboard_address": "127.0.0.1:0"}
    options = local | {
        "nthreads": 1,
        "memory_limit": 1 / workers,  # of the machine's
        "death_timeout": ALONE,
        "silence_logs": logging.CRITICAL,  # failures are reported by the sweep
    }
    worker = {"cls": SubprocessWorker, "options": {"worker_kwargs": options}}
    # A worker gets its next case when it has finished one. Cases that wait behind one that kills its worker
    # would count as involved.
    with dask.config.set({"distributed.scheduler.worker-saturation": 1.0}):
        return SpecCluster(
            scheduler={"cls": Scheduler, "options": {**local, "port": 0}},
            worker=worker,
            workers=dict.fromkeys(range(workers), worker),
        )


# ---- on the workers --------------------------------------------------------------------------------------


class CaseFailed(Exception):
    """A case raised: text, duration [s], worker. Unlike what it raised, this can always be pickled."""


@functools.lru_cache(maxsize=4)
def _loaded(payload: bytes, paths: tuple[str, ...]) -> Function:
    """The function; once a worker, so that its module's variables stay from case to case."""
    sys.path += [path for path in paths if path not in sys.path]
    function: Function = pickle.loads(payload)
    return function


def run_case(case: bytes, seed: int, payload: bytes, paths: tuple[str, ...], plain: bool) -> CaseResult:
    """Runs on a worker. Returns result (its columns if plain), error, duration [s], worker."""
    worker, begin = get_worker().address, time.perf_counter()
    try:
        function = _loaded(payload, paths)
        result = function(pickle.loads(case), seed)
    except (Exception, SystemExit) as error:
        raise CaseFailed(in_one_line(error), time.perf_counter() - begin, worker) from None
    duration = time.perf_counter() - begin
    if not plain:
        return {"result": result}, None, duration, worker
    from pyfranka._sweep_output import columns  # a worker without pyarrow returns other results

    try:
        return columns("result", result), None, duration, worker
    except TypeError as error:
        return {}, f"The result cannot be written: {error}.", duration, worker


def in_one_line(error: BaseException) -> str:
    """An exception in one line, with the place that raised it."""
    text = f"{type(error).__name__}: {' '.join(str(error).split())}"
    trace = inspect.getinnerframes(error.__traceback__) if error.__traceback__ else []
    if frames := [frame for frame in trace if frame.filename != __file__]:
        last = frames[-1]
        text += f" ({Path(last.filename).name}, line {last.lineno}, in {last.function})"
    return text


# ---- running ---------------------------------------------------------------------------------------------


def _portable() -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Functions that Dask sends by value, because they are local: a scheduler needs no pyfranka, and a worker
    that has none reports it. A task that a worker cannot read at all would end the worker."""

    def call(work: bytes, case: bytes, seed: int) -> CaseResult:
        import pickle

        result: CaseResult = pickle.loads(work)(case, seed)
        return result

    def facts(keys: list[Any], dask_scheduler: Any) -> dict[Any, tuple[int, int, str]]:
        """By key: the retries left, the deaths of workers, the worker of the failure."""
        found = {key: dask_scheduler.tasks[key] for key in keys if key in dask_scheduler.tasks}
        return {key: (t.retries, t.suspicious, next(iter(t.erred_on or ()), "")) for key, t in found.items()}

    return call, facts


_CALL, _FACTS = _portable()


class NoWorkers(TimeoutError):
    """The cluster has no workers."""


class Run:
    """Cases on their way: a bounded number of futures."""

    def __init__(self, client: Client, plan: Plan, retries: int, patience: float, plain: bool, local: bool):
        self._client, self._plan, self._retries, self._patience = client, plan, retries, patience
        paths = tuple(sys.path) if local else ()  # workers on this machine find modules beside the script
        work = functools.partial(run_case, payload=plan.payload, paths=paths, plain=plain)
        self._call = functools.partial(_CALL, pickle.dumps(work))
        self._name = f"case-{uuid.uuid4().hex[:8]}"
        self._pending: dict[Future, int] = {}  # future -> number of the case

    def outcomes(self, left: list[int]) -> Iterator[tuple[Row, Row] | None]:
        """Row and result of each case of `left`, as they finish; None when LOOK has passed without any."""
        waiting, with_workers = iter(left), time.monotonic()
        self._finished = as_completed(loop=self._client.loop)
        try:
            self._submit(waiting, self._threads())
            while self._pending:
                batch = self._next_batch()
                rows: list[tuple[Row, Row] | None] = [*self._rows(batch)] if batch else []
                threads = self._threads()
                self._submit(waiting, threads)
                yield from rows or [None]
                if threads:
                    with_workers = time.monotonic()
                elif time.monotonic() - with_workers > self._patience:
                    raise NoWorkers(
                        f"The cluster has had no workers for {self._patience:g} s. Start workers, or have "
                        "more patience."
                    )
        except NoWorkers:
            raise
        except (OSError, CancelledError) as error:
            raise ConnectionError(
                f"The connection to the scheduler was lost ({error or type(error).__name__}). Finished cases "
                "are in the output, if there is one; the same call goes on."
            ) from error
        finally:
            self._give_up()

    def _threads(self) -> int:
        """Of all workers."""
        return sum(self._client.nthreads().values())

    def _submit(self, waiting: Iterator[int], threads: int) -> None:
        room = max(IN_FLIGHT, PER_THREAD * threads) - len(self._pending)
        indices = list(itertools.islice(waiting, max(room, 0)))
        if not indices:
            return
        futures = self._client.map(
            self._call,
            [self._plan.pickled_case(index) for index in indices],
            [self._plan.seed_of(index) for index in indices],
            key=[(self._name, index) for index in indices],
            retries=self._retries,
            pure=False,
        )
        self._pending.update(zip(futures, indices))
        self._finished.update(futures)

    def _next_batch(self) -> list[Future]:
        """Futures that have finished; none after LOOK."""
        woken = self._finished.thread_condition
        with woken:
            if not self._finished.has_ready():
                woken.wait(LOOK)
        batch = self._finished.next_batch(block=False)
        if any(future.cancelled() for future in batch):
            raise CancelledError("its futures are cancelled")
        # Dask runs a case again whose result was lost with its worker.
        lost = [future for future in batch if future.status in ("lost", "pending")]
        self._finished.update(lost)
        return [future for future in batch if future not in lost]

    def _rows(self, batch: list[Future]) -> list[tuple[Row, Row]]:
        """Rows and results of finished futures, which are then forgotten."""
        facts = self._client.run_on_scheduler(_FACTS, [future.key for future in batch])
        finished = {future: None for future in batch if future.status != "error"}
        values, rows = iter(self._client.gather(list(finished))), []
        for future in batch:
            index = self._pending.pop(future)
            left, deaths, worker = facts.get(future.key, (self._retries, 0, ""))
            row = {"index": index, "seed": self._plan.seed_of(index)}
            tries = self._retries - left + deaths
            if future in finished:
                result, error, duration, worker = next(values)
                tries += 1
            else:
                result, error, duration, known, begun = self._failure(future)
                worker, tries = known or worker, tries + begun
            row |= {"error": error, "tries": tries, "duration": duration, "worker": worker}
            rows.append((row, result))
        return rows

    def _failure(self, future: Future) -> tuple[Row, str, float | None, str, int]:
        """Result, error, duration, worker of a failed future, and whether its last try is to be counted."""
        error = future.exception()
        if isinstance(error, CaseFailed):
            text, duration, worker = error.args
            return {}, text, duration, worker, 1
        if isinstance(error, KilledWorker):
            worker = error.last_worker.address
            return {}, f"Its workers died, the last one at {worker}; their logs may say why.", None, worker, 0
        if isinstance(error, ImportError) and (error.name or "").partition(".")[0] in OURS:
            raise ImportError(f"The cluster's workers cannot import pyfranka ({error}); install it there.")
        return {}, in_one_line(error), None, "", 1

    def _give_up(self) -> None:
        """Cancels what has not finished."""
        if self._pending and self._client.status == "running":
            with suppress(OSError, CancelledError):
                self._client.cancel(list(self._pending))
        self._pending.clear()
        self._finished.clear()
