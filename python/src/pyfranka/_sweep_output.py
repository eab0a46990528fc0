# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The file of a sweep: one row per case, as Parquet or CSV. An interrupted sweep continues from it.

New rows are written to small Parquet files in the folder `NAME.parts`. Periodically and at the end they are
merged into NAME. Each file is written under another name and then renamed, so a reader never gets a partial
file, and the files of a killed process are complete. Only NAME is sorted and has each case once; a row in
both (the process ended between the two steps) counts once.
"""

from __future__ import annotations

import csv
import fcntl
import json
import math
import os
import time
import typing
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy
import pyarrow
import pyarrow.csv
import pyarrow.parquet

SUFFIXES = (".parquet", ".csv")
FLUSH = 1.0  # [s] between two part files (chosen here: a killed process loses these rows and one case)
PARTS = 64  # part files before they are merged into the output (chosen here: few files, few rewrites)
ROWS = 100  # rows of the output per further part file: a long output is rewritten rarely
MEANINGS = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}  # as Arrow writes them into CSV

FIXED = {  # the columns of every sweep
    "sweep": pyarrow.string(),
    "index": pyarrow.int64(),
    "seed": pyarrow.int64(),
    "error": pyarrow.string(),
    "tries": pyarrow.int64(),
    "duration": pyarrow.float64(),
    "worker": pyarrow.string(),
}
ADVICE = "Choose another output, or remove it."
Row = dict[str, typing.Any]


def check_path(path: Path) -> None:
    """Raises ValueError or OSError if an output cannot have this name."""
    if path.suffix not in SUFFIXES:
        raise ValueError(f"The output '{path}' needs the suffix {' or '.join(SUFFIXES)}.")
    if path.is_dir():
        raise IsADirectoryError(f"The output '{path}' is a folder; give the name of a file.")
    if not path.absolute().parent.is_dir():
        raise FileNotFoundError(
            f"The output's folder '{path.absolute().parent}' does not exist; make it first."
        )
    if not os.access(path.absolute().parent, os.W_OK):
        raise PermissionError(f"The output's folder '{path.absolute().parent}' cannot be written.")


def columns(prefix: str, value: object) -> Row:
    """The columns of a value: `prefix.KEY` of a dict, else `prefix`. Raises TypeError with a sentence."""
    if isinstance(value, Mapping):
        if wrong := [key for key in value if not isinstance(key, str) or not key]:
            raise TypeError(f"its key {wrong[0]!r} is not a text")
        return {f"{prefix}.{key}": _cell(key, entry) for key, entry in value.items()}
    return {prefix: _cell(prefix, value)}


def _cell(name: str, value: object) -> object:
    """The value in types that both formats have; lists of one type."""
    if isinstance(value, (numpy.ndarray, numpy.generic)):
        value = value.tolist()
    plain = _plain(name, value)
    try:
        pyarrow.array([plain])
    except (pyarrow.ArrowException, ValueError, OverflowError) as error:
        raise TypeError(f"'{name}' cannot be a column: {error}") from None
    return plain


def _plain(name: str, value: object) -> object:
    if value is None or isinstance(value, (bool, float, str)):
        return value
    if isinstance(value, int):
        if not -(2**63) <= value < 2**63:
            raise TypeError(f"'{name}' is beyond the integers of 64 bits with sign; write it as text")
        return int(value)
    if isinstance(value, (list, tuple)):
        return [_cell(name, entry) for entry in value]
    if isinstance(value, (numpy.ndarray, numpy.generic)):
        return _cell(name, value)
    kind = type(value).__name__
    raise TypeError(f"'{name}' is of type {kind}; numbers, text, lists and arrays of them can be written")


class Output:
    """The rows of one sweep in a file; use it as a context manager, which writes all rows at its end.

    identity: function, cases and seed, as in each row. cases: the columns of all cases, or None. Called by
    one thread of one process at a time. Raises ValueError if the file is of another sweep, RuntimeError if
    another process writes it, OSError.
    """

    def __init__(self, path: Path, identity: str, cases: pyarrow.Table | None):
        self._path, self._identity, self._cases = path, identity, cases
        self._parts = path.with_name(f"{path.name}.parts")
        self._rows: list[Row] = []
        while (lock := self._locked_folder()) is None:
            pass
        self._lock = lock
        try:
            self._load()
        except BaseException:
            self._unlock()
            raise
        self._flushed = time.monotonic()

    def _locked_folder(self) -> int | None:
        """The folder of part files, open and locked; None if another process has removed it meanwhile, at the
        end of its sweep."""
        self._parts.mkdir(exist_ok=True)
        try:
            lock = os.open(self._parts, os.O_RDONLY)
        except FileNotFoundError:
            return None
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(lock)
            raise RuntimeError(f"Another process writes '{self._path}' now; wait for its end.") from None
        try:
            if os.path.samestat(os.fstat(lock), self._parts.stat()):
                return lock
        except FileNotFoundError:
            pass
        os.close(lock)
        return None

    def _load(self) -> None:
        """Reads the rows of earlier calls."""
        parts = self._part_files()
        files = [self._path, *parts] if self._path.exists() else parts
        self._tables = [_checked(path, _read(path), self._identity) for path in files]
        self._number = max((int(path.stem.partition("-")[2]) for path in parts), default=0)
        self._waiting = len(parts)
        whole = self._whole()
        self._types = {} if whole is None else {field.name: field.type for field in whole.schema}

    def _unlock(self) -> None:
        """Unlocks the folder, and removes it if it is empty."""
        for draft in self._parts.glob("*.tmp"):  # of an interrupted write
            draft.unlink()
        if not any(self._parts.iterdir()):
            self._parts.rmdir()
        os.close(self._lock)

    def _part_files(self) -> list[Path]:
        return sorted(self._parts.glob("part-*.parquet"))

    def __enter__(self) -> Output:
        return self

    def __exit__(self, *error: object) -> None:
        try:
            self.flush()
            if self._part_files() or not self._path.exists():
                self._merge_parts()
        finally:
            self._unlock()

    def done(self) -> dict[int, bool]:
        """The numbers of the cases in the file, and whether each has a result."""
        whole = self._whole()
        if whole is None:
            return {}
        return dict(zip(whole["index"].to_pylist(), whole["error"].is_null().to_pylist()))

    def add(self, row: Row, result: Row) -> None:
        """Adds a row and the columns of its result; a result that cannot be written becomes the row's
        error."""
        try:
            self._types = self._types_with(result)
        except TypeError as error:
            row, result = {**row, "error": f"The result cannot be written: {error}."}, {}
        self._rows.append({"sweep": self._identity, **row, **result})
        if time.monotonic() - self._flushed > FLUSH:
            self.flush()

    def _types_with(self, result: Row) -> dict[str, pyarrow.DataType]:
        """The types of all columns so far, with those of this result."""
        types = dict(self._types)
        for name, value in result.items():
            kind = pyarrow.array([value]).type
            before = types.get(name, kind)
            if kind == before:
                types[name] = kind
                continue
            try:
                types[name] = _common(before, kind)
            except pyarrow.ArrowException:
                text = f"{name} is {kind} here and {before} in other cases"
                raise TypeError(text) from None
        return types

    def flush(self) -> None:
        """Writes the rows since the last call. Raises OSError."""
        self._flushed = time.monotonic()
        if not self._rows:
            return
        table = self._table(self._rows)
        self._number += 1
        self._write(self._parts / f"part-{self._number:08d}.parquet", table)
        self._rows = []
        self._tables.append(table)
        self._waiting += 1
        written = sum(len(table) for table in self._tables)
        if self._waiting >= max(PARTS, written / ROWS / PARTS):
            self._merge_parts()

    def _table(self, rows: list[Row]) -> pyarrow.Table:
        """Rows as a table: identity, case, outcome, result."""
        indices = [row["index"] for row in rows]
        cases = self._cases.take(indices) if self._cases is not None else pyarrow.table({})
        results = {n: kind for n, kind in self._types.items() if n == "result" or n.startswith("result.")}
        data: dict[str, typing.Any] = {}
        for name, kind in (FIXED | results).items():
            if name == "error":  # the case stands before its outcome
                data |= {case: cases[case] for case in cases.column_names}
            data[name] = pyarrow.array([row.get(name) for row in rows], kind)
        return pyarrow.table(data)

    def _whole(self) -> pyarrow.Table | None:
        """All rows, in order, each case once, the last one of several."""
        if not self._tables:
            return None
        types: dict[str, pyarrow.DataType] = {}
        for table in self._tables:
            for field in table.schema:
                before = types.get(field.name, field.type)
                types[field.name] = before if before == field.type else _common(before, field.type)
        schema = pyarrow.schema(list(types.items()))
        table = pyarrow.concat_tables([_cast(table, schema) for table in self._tables])
        last = {index: row for row, index in enumerate(table["index"].to_pylist())}
        whole = table.take([last[index] for index in sorted(last)])
        self._tables = [whole]
        return whole

    def _merge_parts(self) -> None:
        """Merges the part files into the output."""
        whole = self._whole()
        if whole is not None:
            self._write(self._path, whole)
        for path in self._part_files():
            path.unlink()
        self._waiting = 0

    def _write(self, path: Path, table: pyarrow.Table) -> None:
        """Writes all of it or nothing."""
        draft = self._parts / f"{path.name}.tmp"
        try:
            with draft.open("wb") as file:
                if path.suffix == ".csv":
                    pyarrow.csv.write_csv(_texts(table), file)
                else:
                    pyarrow.parquet.write_table(table, file)
                file.flush()
                os.fsync(file.fileno())
            draft.replace(path)
        except OSError as error:
            raise OSError(f"'{path}' cannot be written ({error}). Rows written before are kept.") from error

    def rows(self) -> Iterator[Row]:
        """All rows, in order, with the columns of the file."""
        self.flush()
        whole = self._whole()
        for batch in whole.to_batches() if whole is not None else ():
            yield from batch.to_pylist()


def result_of(row: Row) -> object:
    """The result in a row: a dict if the function gave one; keys of other cases are None."""
    if row["error"] is not None:
        return None
    if row.get("result") is not None:
        return row["result"]
    return {n.partition(".")[2]: value for n, value in row.items() if n.startswith("result.")} or None


def table_of(values: Sequence[object], name: str) -> pyarrow.Table:
    """Columns of all cases. Cases that have no common columns become texts."""
    try:
        rows = [columns(name, value) for value in values]
        names = dict.fromkeys(key for row in rows for key in row)
        return pyarrow.table({key: pyarrow.array([row.get(key) for row in rows]) for key in names})
    except (TypeError, ValueError, OverflowError, pyarrow.ArrowException):
        return pyarrow.table({name: [repr(value) for value in values]})


def _common(one: pyarrow.DataType, other: pyarrow.DataType) -> pyarrow.DataType:
    """The common type of both, such as double for int64 and double. Raises ArrowException."""
    fields = [pyarrow.schema([("x", kind)]) for kind in (one, other)]
    return pyarrow.unify_schemas(fields, promote_options="permissive").field("x").type


def _cast(table: pyarrow.Table, schema: pyarrow.Schema) -> pyarrow.Table:
    """The table with all columns of the schema, in its types; missing ones are null."""
    data = {}
    for field in schema:
        if field.name in table.column_names:
            # Integers above 2**53 in a column of floats are rounded, as everywhere.
            data[field.name] = table[field.name].cast(field.type, safe=False)
        else:
            data[field.name] = pyarrow.nulls(len(table), field.type)
    return pyarrow.table(data)


# ---- reading ---------------------------------------------------------------------------------------------


def _read(path: Path) -> pyarrow.Table:
    """A file of either format. Raises ValueError if it is not."""
    try:
        return _read_csv(path) if path.suffix == ".csv" else pyarrow.parquet.read_table(path)
    except (pyarrow.ArrowException, UnicodeDecodeError, StopIteration) as error:
        raise ValueError(
            f"'{path}' cannot be read as a {path.suffix[1:]} file ({error}). {ADVICE}"
        ) from error


def _checked(path: Path, table: pyarrow.Table, identity: str) -> pyarrow.Table:
    """The table, if it is of this sweep. Raises ValueError."""
    if not set(FIXED) <= set(table.column_names):
        raise ValueError(f"'{path}' is not the output of a sweep. {ADVICE}")
    for found in table["sweep"].unique().to_pylist():
        parts = list(zip(("function", "cases", "seed"), str(found).split("/"), identity.split("/")))
        if different := [(what, theirs, ours) for what, theirs, ours in parts if theirs != ours]:
            texts = [f"its {what} is {theirs}, here it is {ours}" for what, theirs, ours in different]
            raise ValueError(f"'{path}' is of another sweep: {', and '.join(texts)}. {ADVICE}")
    return table


# CSV has no types: a text that could be read as another type is written as JSON, in quotes, and lists as
# JSON.


def _texts(table: pyarrow.Table) -> pyarrow.Table:
    """The same table in columns that CSV can hold."""
    return pyarrow.table({name: _text_column(name, table[name]) for name in table.column_names})


def _text_column(name: str, column: pyarrow.ChunkedArray) -> pyarrow.ChunkedArray | pyarrow.Array:
    if pyarrow.types.is_list(column.type):
        return pyarrow.array(
            [None if v is None else json.dumps(v) for v in column.to_pylist()], pyarrow.string()
        )
    if pyarrow.types.is_string(column.type):
        return pyarrow.array([None if v is None else _text(v) for v in column.to_pylist()], pyarrow.string())
    return column


def _text(value: str) -> str:
    return value if _value(value) == value else json.dumps(value)


def _value(text: str) -> object:
    """The value of a cell."""
    if text == "" or text in MEANINGS:
        return MEANINGS.get(text)
    try:
        return json.loads(text)
    except ValueError:
        return text


def _read_csv(path: Path) -> pyarrow.Table:
    with path.open(newline="", encoding="utf-8") as file:
        names = next(csv.reader(file))
    one_block = max(1 << 20, min(path.stat().st_size + 1, 2**31 - 1))  # rows may be long
    texts = pyarrow.csv.read_csv(
        path,
        pyarrow.csv.ReadOptions(block_size=one_block),
        pyarrow.csv.ParseOptions(newlines_in_values=True),
        pyarrow.csv.ConvertOptions(
            column_types={name: pyarrow.string() for name in names}, strings_can_be_null=False
        ),
    )
    return pyarrow.table(
        {
            name: pyarrow.array([_value(text) for text in texts[name].to_pylist()], FIXED.get(name))
            for name in texts.column_names
        }
    )
