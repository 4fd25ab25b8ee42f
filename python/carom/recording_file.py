"""Recordings as HDF5 files, written so that a program killed at any moment leaves one that can be read.

    /model                       JSON: every part with its fields (carom.model_data)
    /states/times, positions, velocities, ground            a row for each sample
    /states/orientations         likewise, of models in space; without rows if no body turns
    /states/contact_ends, event_ends                        rows of the tables up to and with each sample
    /ledger/rows, /contacts/rows, /events/rows              tables
    /names                       what `name` in the tables counts
    /bodies                      names of the bodies, in the order of positions
    /complete                    number of samples up to which all of this is written

Codes in the tables (`mode`, `kind`, `impact`) have their meaning as attributes of the tables: "legend of mode"
is a list of names, the first that of code 0. Units are attributes likewise.

The file is in the mode of HDF5 for one writer and several readers: its own structure is whole after every
flush. Rows are written first, the count of complete samples last, so a reader that believes the count finds
all rows.
"""

from __future__ import annotations

import json
import os
import struct
from pathlib import Path
from typing import Any

import numpy

from . import _core
from .recorded import Recording, ledger_type, units_of

try:
    import h5py  # type: ignore[import-untyped, unused-ignore]
except ImportError as missing:
    raise ImportError("carom: recordings in files need h5py: pip install h5py") from missing

FORMAT = "carom recording"
VERSION = 1
_STATES = ("positions", "velocities", "ground", "contact_ends", "event_ends", "times")
_TABLES = ("contacts", "events")
_LEGENDS = {
    "mode": [mode.name for mode in _core.ContactMode],
    "kind": [kind.name for kind in _core.EventKind],
    "impact": ["lasts, or closed slower than the capture speed", "struck"],
}
_FAULTS = (OSError, RuntimeError, ValueError)  # that h5py raises where a file cannot be written
_CHUNK_BYTES = 1 << 16
_SAME_TIME = 1e-6  # part of the interval by which samples and its multiples may differ, as in the sampler
_ROUNDING = 1e-13  # of sums of steps


def _rows(group: Any, name: str, shape: tuple[int, ...], kind: Any, unit: str = "") -> Any:
    """An empty data set that grows along its first axis."""
    row = numpy.dtype(kind).itemsize * max(1, int(numpy.prod(shape, dtype=int)))
    chunk = (max(1, min(4096, _CHUNK_BYTES // row)), *(max(1, size) for size in shape))
    most = tuple(size or None for size in shape)  # HDF5 has no parts of data sets without columns
    made = group.create_dataset(name, (0, *shape), kind, maxshape=(None, *most), chunks=chunk)
    if unit:
        made.attrs["unit"] = unit
    return made


def _name_length(model: dict[str, Any]) -> int:
    """Bytes that the longest name of two parts and what joins them needs."""
    given = [part["name"] for part in model["parts"]] + [body["name"] for body in model["bodies"]]
    return 96 + 3 * max((len(name.encode()) for name in given), default=0)


def _checksum(data: bytes) -> int:
    """Checksum of the metadata of HDF5: lookup3 (B. Jenkins, burtleburtle.net/bob/c/lookup3.c), of bytes of a
    length that is a multiple of 4 and none of 12.
    """
    words: tuple[int, ...] = struct.unpack(f"<{len(data) // 4}I", data)
    a = b = c = (0xDEADBEEF + len(data)) & 0xFFFFFFFF

    def turned(x: int, bits: int) -> int:
        return (x << bits | x >> 32 - bits) & 0xFFFFFFFF

    whole = len(words) // 3 * 3
    for i in range(0, whole, 3):
        a, b, c = a + words[i], b + words[i + 1], c + words[i + 2]
        for bits in (4, 6, 8, 16, 19, 4):
            a, c = (a - c & 0xFFFFFFFF) ^ turned(c & 0xFFFFFFFF, bits), c + b & 0xFFFFFFFF
            a, b, c = b, c, a
    rest = (*words[whole:], 0, 0)
    a, b = a + rest[0] & 0xFFFFFFFF, b + rest[1] & 0xFFFFFFFF
    for bits in (14, 11, 25, 16, 4, 14, 24):
        c = (c ^ b) - turned(b, bits) & 0xFFFFFFFF
        a, b, c = b, c, a
    return b


def _end_where_it_ends(path: Path) -> None:
    """Corrects the end of a file that could not be written as far as it says: what is behind was not counted as
    complete. Raises OSError.
    """
    with open(path, "r+b") as file:
        start = file.read(48)
        size = file.seek(0, os.SEEK_END)
        # The superblock, as in _is_open(), ends with the checksum of what is before.
        known = len(start) == 48 and start[8] == 3 and _checksum(start[:44]) == struct.unpack("<I", start[44:])[0]
        if known and struct.unpack_from("<Q", start, 28)[0] > size:
            start = start[:28] + struct.pack("<Q", size) + start[36:44]
            file.seek(0)
            file.write(start + struct.pack("<I", _checksum(start)))


def _abandon(file: Any, sets: dict[str, Any]) -> None:
    """Closes a file that could not be written, and its data sets. HDF5 would write what is left when it closes
    them, and once more when the program ends, which then crashes: it writes to nowhere instead, and the file
    stays as it is. Whoever writes keeps all data sets open until here, for the same reason.
    """
    try:
        nowhere = os.open(os.devnull, os.O_RDWR)
        try:
            os.dup2(nowhere, file.id.get_vfd_handle(), inheritable=False)
        finally:
            os.close(nowhere)
        path = Path(file.filename)
        sets.clear()
        file.close()
        _end_where_it_ends(path)
    except _FAULTS:
        pass  # the fault that is to be told is the first


def _write_legends(file: Any, sets: dict[str, Any], model: dict[str, Any]) -> None:
    """Names of bodies, and what codes in the tables mean; files of earlier versions have none."""
    text = h5py.string_dtype()
    for table in _TABLES:
        rows = sets[f"{table}/rows"]
        for field in rows.dtype.names:
            if field in _LEGENDS:
                rows.attrs.create(f"legend of {field}", _LEGENDS[field], dtype=text)
    if "bodies" not in file:
        names = [body["name"] for body in model["bodies"]]
        sets["bodies"] = file.create_dataset("bodies", data=names, shape=(len(names),), dtype=text)


class FileStore:
    """Writes blocks of samples to a file."""

    def __init__(
        self,
        file: Any,
        sets: dict[str, Any],
        path: Path,
        names: list[str],
        last: float,
        counts: dict[str, int],
    ) -> None:
        events = sets["events/rows"]
        self.instant = int(events[-1]["instant"]) + 1 if len(events) else 0
        self._file = file
        self._sets = sets
        self._path = path
        self._frames = len(sets["states/times"])
        self.names = names
        self.last = last
        self.counts = counts
        self._failed = False
        file.swmr_mode = True

    @classmethod
    def create(
        cls,
        path: Path,
        model: dict[str, Any],
        types: dict[str, Any],
        moved: list[int],
        interval: float,
        overwrite: bool = False,
    ) -> FileStore:
        """A new file, which replaces one of that name if `overwrite`. Raises FileError."""
        existed = os.path.lexists(path)
        if existed and not overwrite:
            raise _core.FileError(
                f"recording '{path}' exists; allowed: overwrite=True, which replaces it, "
                "resume=True, which continues it, or another path"
            )
        # Made in memory and written as a whole: HDF5 does not survive a disk that is full at the start.
        with h5py.File(path.name, "w", driver="core", backing_store=False, libver="latest") as made:
            cls._lay_out(made, model, types, moved, interval)
            made.flush()
            image = made.id.get_file_image()
        try:
            with open(path, "wb" if overwrite else "xb") as plain:
                plain.write(image)
        except OSError as error:
            if not existed:
                path.unlink(missing_ok=True)
            raise _core.FileError(f"recording '{path}' cannot be written: {error}") from error
        file = _reopen(path)
        sets: dict[str, Any] = {}
        try:
            sets.update({name: file[name] for name in cls._names(file)})
            return cls(file, sets, path, [], numpy.nan, {"contact_ends": 0, "event_ends": 0})
        except _FAULTS as error:
            _abandon(file, sets)
            raise _core.FileError(f"recording '{path}' cannot be written: {error}") from error

    @staticmethod
    def _names(file: Any) -> list[str]:
        """Names of all data sets that rows are written to."""
        states = [f"states/{name}" for name in file["states"]]
        return [*states, "ledger/rows", *(f"{table}/rows" for table in _TABLES), "names", "complete"]

    @staticmethod
    def _lay_out(
        file: Any,
        model: dict[str, Any],
        types: dict[str, Any],
        moved: list[int],
        interval: float,
    ) -> None:
        """Makes empty data sets."""
        file.attrs.update(
            format=FORMAT,
            version=VERSION,
            dimension=model["dimension"],
            fingerprint=model["fingerprint"],
            interval=interval,
            moved=numpy.array(moved, dtype="i8"),
        )
        file.create_dataset("model", data=json.dumps(model))
        bodies = len(model["bodies"])
        units = units_of(model["dimension"])
        states = file.create_group("states")
        shapes: dict[str, tuple[int, ...]] = {
            "positions": (bodies, 3),
            "velocities": (bodies, 3),
            "orientations": (bodies, 4),
            "ground": (len(moved), 3),
        }
        for name in (*_STATES, *(("orientations",) if model["dimension"] == 3 else ())):
            kind = "i8" if name.endswith("_ends") else "f8"
            _rows(states, name, shapes.get(name, ()), kind, units.get(name, ""))
        _rows(file.create_group("ledger"), "rows", (), ledger_type(), "J")
        for table in _TABLES:
            rows = _rows(file.create_group(table), "rows", (), types[table])
            for field in types[table].names:
                if field in units:
                    rows.attrs[f"unit of {field}"] = units[field]
        _rows(file, "names", (), f"S{_name_length(model)}")
        file.create_dataset("complete", data=0, dtype="i8")
        _write_legends(file, {name: file[name] for name in FileStore._names(file)}, model)

    @classmethod
    def resume(cls, path: Path, model: dict[str, Any], types: dict[str, Any], time: float) -> FileStore:
        """A file that is continued from a time [s]. Raises FileError; ModelError for one of another model."""
        with _open(path) as before:
            if before.attrs["fingerprint"] != model["fingerprint"]:
                raise _core.ModelError(
                    f"recording '{path}' is of another model: its fingerprint is "
                    f"{before.attrs['fingerprint']}, "
                    f"that of the simulation {model['fingerprint']}"
                )
            frames = _complete(before)
            times = before["states/times"][:frames]
            # The run of the checkpoint may have come to this time by other steps: to another last digit.
            reached = time + _SAME_TIME * float(before.attrs["interval"]) + _ROUNDING * abs(time)
            kept = int(numpy.searchsorted(times, reached, side="right"))
            counts = {name: _count(before, name, kept) for name in ("contact_ends", "event_ends")}
            later = before["events/rows"]["time"][counts["event_ends"] : _count(before, "event_ends", frames)]
            counts["event_ends"] += int(numpy.count_nonzero(later <= reached))
            names = [name.decode() for name in before["names"][()]]
            last = min(float(times[kept - 1]), time) if kept else numpy.nan
        file = _reopen(path)
        lengths = {f"states/{name}": kept for name in _STATES}
        lengths.update({"ledger/rows": kept, "contacts/rows": counts["contact_ends"]})
        lengths.update({"events/rows": counts["event_ends"], "names": len(names)})
        sets = {name: file[name] for name in cls._names(file)}
        try:
            sets["complete"][()] = kept
            if "states/orientations" in sets:
                lengths["states/orientations"] = min(kept, len(sets["states/orientations"]))
            for name, length in lengths.items():
                sets[name].resize(length, axis=0)
            _write_legends(file, sets, model)
            return cls(file, sets, path, names, last, counts)
        except _FAULTS as error:
            _abandon(file, sets)
            raise _core.FileError(f"recording '{path}' cannot be continued: {error}") from error

    def append(self, block: dict[str, Any]) -> None:
        """Writes the rows of a block, then the count. Raises FileError; then the file is closed, and has what it
        had before.
        """
        if self._failed:
            raise _core.FileError(f"recording '{self._path}' could not be written before, and is closed")
        try:
            self._append("names", numpy.array([self._encoded(name) for name in block["names"]]))
            for table in (*_TABLES, "ledger"):
                self._append(f"{table}/rows", block[table])
            for name in (*_STATES, *(("orientations",) if "orientations" in block else ())):
                self._append(f"states/{name}", block[name])
            self._file.flush()
            self._frames += block["frames"]
            self._sets["complete"][()] = self._frames
            self._sets["complete"].flush()
        except _FAULTS as error:
            self._failed = True
            _abandon(self._file, self._sets)
            raise _core.FileError(f"recording '{self._path}' cannot be written: {error}") from error

    def _encoded(self, name: str) -> bytes:
        data = name.encode()
        longest = self._sets["names"].dtype.itemsize
        if len(data) > longest:
            raise _core.FileError(
                f"recording '{self._path}': the name {name!r} is longer than {longest} bytes"
            )
        return data

    def _append(self, name: str, rows: Any) -> None:
        if len(rows) == 0:
            return
        target = self._sets[name]
        start = len(target)
        target.resize(start + len(rows), axis=0)
        target[start:] = rows

    def close(self) -> None:
        """Ends the file. Raises FileError."""
        if self._failed:
            return
        try:
            self._file.flush()
            self._sets.clear()
            self._file.close()
        except _FAULTS as error:
            self._failed = True
            _abandon(self._file, self._sets)
            raise _core.FileError(f"recording '{self._path}' cannot be written: {error}") from error


def _is_open(path: Path) -> bool:
    """True of a file that its writer did not close: it runs, or was killed.

    Read from the superblock, as HDF5 itself tries for minutes to read a file for several readers that is cut
    off.
    Raises FileError for a file that is cut off, or no HDF5 file.
    """
    try:
        size = path.stat().st_size
        with open(path, "rb") as file:
            start = file.read(48)
    except OSError as error:
        raise _core.FileError(f"recording '{path}' cannot be read: {error}") from error
    # HDF5 file format 3.0, section II.A, version 3: flags, then base, extension, end of file and root.
    if not start.startswith(b"\x89HDF\r\n\x1a\n"):
        raise _core.FileError(f"'{path}' is not a recording: it is no HDF5 file")
    end = struct.unpack_from("<Q", start, 28)[0] if len(start) == 48 and start[8] in (2, 3) else 0
    if len(start) < 48 or size < end:
        raise _core.FileError(f"recording '{path}' is cut off: it has {size} bytes of {max(end, 48)}")
    return start[8] == 3 and start[11] & 5 != 0


def _open(path: Path) -> Any:
    """A recording to be read, whether its writer closed it, runs, or was killed. Raises FileError."""
    if not path.exists():
        raise _core.FileError(f"recording '{path}' does not exist")
    try:
        file = h5py.File(path, "r", libver="latest", swmr=_is_open(path))
        found, version = file.attrs.get("format"), file.attrs.get("version", 0)
    except _core.FileError:
        raise
    except (OSError, RuntimeError, KeyError) as error:
        raise _core.FileError(
            f"recording '{path}' cannot be read: it is cut off or damaged ({error})"
        ) from error
    if found == FORMAT and version <= VERSION:
        return file
    file.close()
    if found != FORMAT:
        raise _core.FileError(f"'{path}' is not a recording: it is an HDF5 file of something else")
    raise _core.FileError(f"recording '{path}' is of version {version}; this carom reads up to {VERSION}")


def _reopen(path: Path) -> Any:
    """A recording to be written on. One that was not closed is copied, as HDF5 refuses to write on it."""
    try:
        return h5py.File(path, "r+", libver="latest")
    except OSError:
        pass
    copy = path.with_name(path.name + ".copy")
    try:
        with _open(path) as source:
            _copy(source, copy)
        os.replace(copy, path)
        return h5py.File(path, "r+", libver="latest")
    except _FAULTS as error:
        raise _core.FileError(f"recording '{path}' cannot be continued: {error}") from error


def _copy(source: Any, path: Path) -> None:
    """Copies an open file. Raises what h5py raises; there is no copy then."""
    target = h5py.File(path, "w", libver="latest")
    try:
        target.attrs.update(source.attrs)
        for name in source:
            source.copy(name, target)
        target.flush()
    except _FAULTS:
        _abandon(target, {})
        path.unlink()
        raise
    target.close()


def _complete(file: Any) -> int:
    """Number of samples whose rows are all there."""
    shortest = min([len(file[f"states/{name}"]) for name in _STATES] + [len(file["ledger/rows"])])
    return min(shortest, int(file["complete"][()]))


def _count(file: Any, ends: str, frames: int) -> int:
    return int(file[f"states/{ends}"][frames - 1]) if frames else 0


def _demand_shape(name: str, array: Any, allowed: tuple[int, ...]) -> None:
    if array.shape != allowed:
        raise ValueError(f"{name} has the shape {array.shape}; allowed: {allowed}")


def _read(file: Any) -> Recording:
    frames = _complete(file)
    arrays: dict[str, Any] = {name: file[f"states/{name}"][:frames] for name in _STATES}
    turned = file["states"].get("orientations")
    if turned is not None and len(turned) >= frames > 0:
        arrays["orientations"] = turned[:frames]
    arrays["ledger"] = file["ledger/rows"][:frames]
    for table, ends in (("contacts", "contact_ends"), ("events", "event_ends")):
        arrays[table] = file[f"{table}/rows"][: _count(file, ends, frames)]
    count = max([int(arrays[table]["name"].max()) + 1 for table in _TABLES if len(arrays[table])], default=0)
    arrays["names"] = [name.decode() for name in file["names"][:count]]
    model = json.loads(file["model"][()])
    moved = [int(serial) for serial in file.attrs["moved"]]
    bodies = len(model["bodies"])
    columns = {"positions": (bodies, 3), "velocities": (bodies, 3), "ground": (len(moved), 3)}
    for name in _STATES:
        _demand_shape(f"states/{name}", arrays[name], (frames, *columns.get(name, ())))
    return Recording(model["dimension"], model, moved, arrays)


def load(path: Path) -> Recording:
    """The recording in a file. Raises FileError."""
    with _open(path) as file:
        try:
            return _read(file)
        except (OSError, KeyError, ValueError, TypeError, AttributeError, IndexError) as error:
            raise _core.FileError(
                f"recording '{path}' cannot be read: it is cut off or damaged ({error})"
            ) from error
