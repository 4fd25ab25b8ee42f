"""Rows of an ensemble in a file: parts as they come, one file at the end.

While it is written, `sweep.parquet` is a folder `sweep.parquet.parts` of complete files, so that what a killed
program leaves can be read; at the end they become one file.
"""

from __future__ import annotations

import importlib
import json
import math
import os
import shutil
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Optional, Protocol

import numpy

from .._core import FileError, ModelError

Columns = dict[str, Any]

_FIRST_WAIT = 1.0  # from one part to the next at least [s]
_SHARE = 0.02  # of the time since the beginning, where that is longer
_MOST_WAITING = 8e6  # then a part is written at once [bytes]


class Format(Protocol):
    """A kind of file."""

    def write(self, path: Path, parts: Iterator[Columns], about: dict[str, Any]) -> None:
        """Writes columns, one table behind the other."""

    def read(self, path: Path) -> Iterator[Columns]:
        """The tables of a file."""

    def about(self, path: Path) -> dict[str, Any]:
        """What write() was told about the file."""


class Parquet:
    """By pyarrow."""

    def __init__(self) -> None:
        self._arrow: Any = importlib.import_module("pyarrow")
        self._parquet: Any = importlib.import_module("pyarrow.parquet")

    def write(self, path: Path, parts: Iterator[Columns], about: dict[str, Any]) -> None:
        writer = None
        try:
            for columns in parts:
                arrays = {name: self._array(column) for name, column in columns.items()}
                table = self._arrow.table(arrays).replace_schema_metadata({"carom": json.dumps(about)})
                if writer is None:
                    writer = self._parquet.ParquetWriter(path, table.schema)
                writer.write_table(table)
        finally:
            if writer is not None:
                writer.close()

    def read(self, path: Path) -> Iterator[Columns]:
        file = self._parquet.ParquetFile(path)
        for group in range(file.num_row_groups):
            table = file.read_row_group(group)
            yield {name: self._values(table.column(name).combine_chunks()) for name in table.column_names}

    def _array(self, column: Any) -> Any:
        """A column of arrow: of arrays, lists around one buffer of numbers."""
        if getattr(column, "ndim", 1) < 2:
            return column
        made = self._arrow.array(numpy.ascontiguousarray(column).ravel())
        for axis in range(column.ndim - 1, 0, -1):
            offsets = numpy.arange(math.prod(column.shape[:axis]) + 1, dtype=numpy.int32) * column.shape[axis]
            made = self._arrow.ListArray.from_arrays(offsets.astype(numpy.int32), made)
        return made

    def _values(self, array: Any) -> Any:
        """What _array() was given."""
        shape = [len(array)]
        while self._arrow.types.is_list(array.type):
            inner = array.flatten()
            shape.append(len(inner) // max(1, len(array)))
            array = inner
        values = array.to_numpy(zero_copy_only=False)
        return values if len(shape) == 1 else values.reshape(shape)

    def about(self, path: Path) -> dict[str, Any]:
        metadata = self._parquet.ParquetFile(path).schema_arrow.metadata or {}
        found: dict[str, Any] = json.loads(metadata.get(b"carom", b"{}"))
        return found


class Hdf5:
    """By h5py: a data set of each column."""

    def __init__(self) -> None:
        self._h5py: Any = importlib.import_module("h5py")

    def write(self, path: Path, parts: Iterator[Columns], about: dict[str, Any]) -> None:
        with self._h5py.File(path, "w") as file:
            file.attrs["carom"] = json.dumps(about)
            for columns in parts:
                for name, column in columns.items():
                    self._append(file, name, column)

    def _append(self, file: Any, name: str, column: Any) -> None:
        values = numpy.asarray(column)
        if values.dtype.kind in "OU":
            values = values.astype(object)
        kind = self._h5py.string_dtype() if values.dtype == object else values.dtype
        if name not in file:
            limits = (None, *values.shape[1:])
            file.create_dataset(name, (0, *values.shape[1:]), kind, maxshape=limits, chunks=True)
        data = file[name]
        data.resize(len(data) + len(values), 0)
        data[-len(values) :] = values

    def read(self, path: Path) -> Iterator[Columns]:
        with self._h5py.File(path, "r") as file:
            yield {
                name: data.asstr()[:] if self._h5py.check_string_dtype(data.dtype) else data[:]
                for name, data in file.items()
            }

    def about(self, path: Path) -> dict[str, Any]:
        with self._h5py.File(path, "r") as file:
            found: dict[str, Any] = json.loads(file.attrs.get("carom", "{}"))
            return found


_FORMATS: dict[str, tuple[Any, str]] = {
    ".parquet": (Parquet, "pyarrow"),
    ".h5": (Hdf5, "h5py"),
    ".hdf5": (Hdf5, "h5py"),
}


class Store:
    """The file of an ensemble."""

    def __init__(self, path: "str | os.PathLike[str]", about: dict[str, str]) -> None:
        """about: fingerprints, by what they are of. Raises ModelError for another sweep's file, FileError."""
        self.path = Path(path)
        if self.path.suffix not in _FORMATS:
            raise ModelError(f"file: is '{self.path}'; allowed: a name that ends in {', '.join(_FORMATS)}")
        kind, package = _FORMATS[self.path.suffix]
        try:
            self._format: Format = kind()
        except ImportError as error:
            raise FileError(f"'{self.path}': {self.path.suffix} needs {package}; install it, or choose another") from error
        self._parts = self.path.with_name(self.path.name + ".parts")
        self._about = about
        self._waiting: list[Columns] = []
        self._bytes_waiting = 0
        self._shapes: dict[str, tuple[int, ...]] = {}
        self._begun = self._written = time.monotonic()
        if not self.path.parent.is_dir():
            raise FileError(f"'{self.path}' cannot be written: there is no folder '{self.path.parent}'")
        for file in self._files():
            self._demand_same(file)
        self._next = 1 + max((int(file.stem) for file in self._part_files()), default=-1)

    def _part_files(self) -> list[Path]:
        return sorted(self._parts.glob(f"[0-9]*{self.path.suffix}")) if self._parts.is_dir() else []

    def _files(self) -> list[Path]:
        return [*([self.path] if self.path.exists() else []), *self._part_files()]

    def _demand_same(self, file: Path) -> None:
        try:
            found = self._format.about(file)
        except Exception as error:
            raise FileError(f"'{file}' cannot be read: {error}") from error
        if found == self._about:
            return
        other = [what for what, print_ in self._about.items() if found.get(what) != print_]
        if not found:
            other = ["it is no file of carom.ensemble()"]
        raise ModelError(
            f"file: '{self.path}' is of another ensemble ({', '.join(other)}); allowed: a new name, or the same call as "
            "before"
        )

    @property
    def complete(self) -> bool:
        """True if all rows are in one file."""
        return self.path.exists()

    def tables(self) -> Iterator[Columns]:
        """What is in it."""
        for file in self._files():
            for table in self._format.read(file):
                self._learn(table)
                yield table

    def _learn(self, table: Columns) -> None:
        """Keeps the shapes of arrays: rows that have all failed have none."""
        for name, column in table.items():
            if getattr(column, "ndim", 1) > 1:
                self._shapes[name] = column.shape[1:]

    def _filled(self, table: Columns) -> Columns:
        """The same table, with arrays of NaN where rows that have all failed have one NaN each."""
        short = [name for name in self._shapes if getattr(table[name], "ndim", 1) == 1]
        return {**table, **{name: numpy.full((len(table[name]), *self._shapes[name]), numpy.nan) for name in short}}

    def add(self, columns: Columns) -> None:
        """Rows; they are in a file within a second, or a fiftieth of the time since the beginning. Memory holds 8 MB of them
        at most.
        """
        self._learn(columns)
        self._waiting.append(columns)
        self._bytes_waiting += sum(numpy.asarray(column).nbytes for column in columns.values())
        now = time.monotonic()
        if self._bytes_waiting > _MOST_WAITING or now - self._written >= max(_FIRST_WAIT, _SHARE * (now - self._begun)):
            self.flush()

    def flush(self) -> None:
        """Writes what waits. Raises FileError; it waits then still."""
        if not self._waiting:
            return
        self._write(self._parts / f"{self._next:06d}{self.path.suffix}", iter([_joined([self._filled(table) for table in self._waiting])]))
        self._waiting, self._bytes_waiting = [], 0
        self._next += 1
        self._written = time.monotonic()

    def finish(self) -> None:
        """Makes one file of the parts, in their order."""
        self.flush()
        if self.complete:
            return
        parts = (self._filled(table) for file in self._part_files() for table in self._format.read(file))
        self._write(self.path, parts)
        shutil.rmtree(self._parts, ignore_errors=True)

    def _write(self, path: Path, parts: Iterator[Columns]) -> None:
        """A file that is there whole, or not at all."""
        unfinished = path.with_name(path.name + ".unfinished")
        try:
            path.parent.mkdir(exist_ok=True)
            self._format.write(unfinished, parts, self._about)
            os.replace(unfinished, path)
        except OSError as error:
            unfinished.unlink(missing_ok=True)
            raise FileError(f"'{path}' cannot be written: {error.strerror or error}") from error


def _joined(tables: list[Columns]) -> Columns:
    names = tables[0].keys()
    return {name: numpy.concatenate([numpy.asarray(table[name]) for table in tables]) for name in names}


def find_rows(tables: Iterator[Columns], count: int) -> Optional[numpy.ndarray]:
    """Which of so many runs are in the tables; None: none."""
    done = None
    for table in tables:
        if done is None:
            done = numpy.zeros(count, dtype=bool)
        done[numpy.asarray(table["run"], dtype=int)] = True
    return done
