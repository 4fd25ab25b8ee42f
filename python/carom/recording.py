"""Recordings: the course of a run as arrays, in memory or in one HDF5 file.

    with carom.Recorder(simulation, "run.h5", interval=0.01):
        simulation.run_until(10.0)
    recording = carom.load_recording("run.h5")

A recorder observes: the run has the same bits with it and without.
"""

from __future__ import annotations

import math
import weakref
from pathlib import Path
from types import TracebackType
from typing import Any, Optional, Protocol

import numpy

from . import _core
from .model_data import describe
from .recorded import Recording as Recording, StrPath, ledger_type

# A block is handed over when it has this many bytes of states, or this many samples [bytes, 1].
_BLOCK_BYTES = 4 << 20
_BLOCK_FRAMES = 4096


class Store(Protocol):
    """Where blocks of samples go."""

    def append(self, block: dict[str, Any]) -> None: ...

    def close(self) -> None: ...


class MemoryStore:
    """Blocks in memory; joined when they are asked for."""

    def __init__(self, types: dict[str, Any]) -> None:
        self._types = types
        self._blocks: list[dict[str, Any]] = []

    def append(self, block: dict[str, Any]) -> None:
        self._blocks.append(block)

    def close(self) -> None:
        """Nothing to do."""

    def arrays(self, empty: dict[str, Any]) -> dict[str, Any]:
        """All that was appended, by name. \"empty\": a block without rows."""
        blocks = self._blocks if self._blocks else [empty]
        joined: dict[str, Any] = {"names": [name for block in blocks for name in block["names"]]}
        for key in empty:
            if key not in ("names", "frames"):
                joined[key] = (
                    blocks[0][key] if len(blocks) == 1 else numpy.concatenate([b[key] for b in blocks])
                )
        self._blocks = [{**joined, "frames": len(joined["times"])}]
        return joined


class Recorder:
    """Records a run at the first end of a step at or after every multiple of an interval, and its last state.

    simulation   what is observed, from now to close()
    path         an HDF5 file, which needs h5py; None: in memory, see recording()
    interval     between samples, 0: every step [s]. In the event-driven mode steps end at multiples of its
                 own interval.
    contacts     False: contacts of samples are left out, which are most of a file of many bodies
    overwrite    replaces a file of that name, which is refused otherwise
    resume       continues the file of an earlier run of the same model, from the time at which the simulation
                 is (load its checkpoint first); later samples in the file are dropped
    flush_every  a killed program loses what is younger than this, of the clock on the wall [s]

    A context manager: leaving it closes. Raises ModelError for an interval that is no number >= 0, or a
    resumed file of another model; FileError for a file that exists, or cannot be read or written; ImportError
    without h5py. A recorder that finds the model edited ends the run with ModelError, one that cannot write
    with FileError: the file has what was written before.
    """

    def __init__(
        self,
        simulation: _core.Simulation,
        path: Optional[StrPath] = None,
        interval: float = 0.01,
        *,
        contacts: bool = True,
        overwrite: bool = False,
        resume: bool = False,
        flush_every: float = 1.0,
    ) -> None:
        self._simulation = simulation
        self._closed = True  # until all is open
        if overwrite and resume:
            raise _core.ModelError("Recorder: overwrite and resume are both True; allowed: one of them")
        self.path = None if path is None else Path(path)
        self._model = describe(simulation.system())
        self._dimension = 3 if self._model["dimension"] == 3 else 2
        self._types = {key: numpy.dtype(value) for key, value in _core._row_types(self._dimension).items()}
        self._base = {"contact_ends": 0, "event_ends": 0}
        self._bodies = len(self._model["bodies"])
        names: list[str] = []
        last, instant = math.nan, 0
        resumed = None
        if resume:
            resumed = self._open_resumed(simulation)
            names, last, self._base, instant = resumed.names, resumed.last, resumed.counts, resumed.instant
        row_bytes = 48 * max(1, self._bodies)
        frames = max(1, min(_BLOCK_FRAMES, _BLOCK_BYTES // row_bytes))
        weak = weakref.ref(self)

        def full() -> None:
            recorder = weak()
            if recorder is not None:
                recorder.flush()

        seconds = flush_every if self.path is not None else 0.0
        self._sampler = _core._Sampler(
            simulation, interval, contacts, frames, seconds, full, names, last, instant
        )
        try:
            self._store = resumed or self._new_store(interval, overwrite)
            self._closed = False
            if math.isnan(last):
                self._sampler.sample(simulation)
            self.flush()
        except BaseException:
            self._sampler.detach(simulation)
            raise

    def _open_resumed(self, simulation: _core.Simulation) -> Any:
        if self.path is None:
            raise _core.ModelError(
                "Recorder: resume is True without a path; allowed: the path of a recording"
            )
        from .recording_file import FileStore

        return FileStore.resume(self.path, self._model, self._types, simulation.time())

    def _new_store(self, interval: float, overwrite: bool) -> Any:
        if self.path is None:
            return MemoryStore(self._types)
        from .recording_file import FileStore

        moved = self._sampler.moved()
        return FileStore.create(self.path, self._model, self._types, moved, interval, overwrite)

    def __enter__(self) -> Recorder:
        return self

    def __exit__(
        self,
        kind: Optional[type[BaseException]],
        error: Optional[BaseException],
        trace: Optional[TracebackType],
    ) -> None:
        if kind is None:
            self.close()
            return
        try:
            self.close()
        except Exception as second:  # the first error is the one to be seen
            error.__context__ = error.__context__ or second  # type: ignore[union-attr]

    def flush(self) -> None:
        """Hands over what was sampled so far; a file then has it. Raises FileError."""
        if not self._closed:
            self._store.append(self._shaped(self._sampler.take()))

    def close(self) -> None:
        """Records the last state, and ends the recording. Raises FileError."""
        if self._closed:
            return
        try:
            try:
                if not self._sampler.last() == self._simulation.time():
                    self._sampler.sample(self._simulation)
            finally:
                self.flush()
        finally:
            self._closed = True
            self._sampler.detach(self._simulation)
            self._store.close()

    def recording(self) -> Recording:
        """What was recorded so far."""
        if self.path is not None:
            self.flush()
            return load_recording(self.path)
        self.flush()
        arrays = self._store.arrays(self._empty())
        return Recording(self._dimension, self._model, self._sampler.moved(), dict(arrays))

    def _empty(self) -> dict[str, Any]:
        moved = len(self._sampler.moved())
        return {
            "times": numpy.empty(0),
            "positions": numpy.empty((0, self._bodies, 3)),
            "velocities": numpy.empty((0, self._bodies, 3)),
            "ground": numpy.empty((0, moved, 3)),
            "ledger": numpy.empty(0, ledger_type()),
            "contacts": numpy.empty(0, self._types["contacts"]),
            "events": numpy.empty(0, self._types["events"]),
            "contact_ends": numpy.empty(0, "i8"),
            "event_ends": numpy.empty(0, "i8"),
            "names": [],
            "frames": 0,
        }

    def _shaped(self, block: dict[str, Any]) -> dict[str, Any]:
        """The arrays of a block in their shapes; views, no copies."""
        frames = block["frames"]
        for key, width in (("positions", self._bodies), ("velocities", self._bodies), ("ground", None)):
            count = len(self._sampler.moved()) if width is None else width
            block[key] = block[key][: frames * count * 3].reshape(frames, count, 3)
        block["times"] = block["times"][:frames]
        kind = ledger_type()
        block["ledger"] = block["ledger"][: frames * len(kind.names or ())].view(kind)
        for table, ends in (("contacts", "contact_ends"), ("events", "event_ends")):
            block[table] = block[table].view(self._types[table])
            block[ends] += self._base[ends]
            self._base[ends] += len(block[table])
        return block


def load_recording(path: StrPath) -> Recording:
    """A recording from its file, which may be one whose program was killed, or still runs.

    Raises FileError naming the path where there is none, it is no recording, or it is cut off; ImportError
    without h5py.
    """
    from .recording_file import load

    return load(Path(path))
