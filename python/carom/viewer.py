"""A recording as one page for a browser, which needs no network: written to a file, or shown in a notebook.

carom.write_view(recording, "run.html")
recording.view()                                    # in a notebook
"""

from __future__ import annotations

import base64
import html
import json
import os
from importlib import resources
from pathlib import Path
from typing import Any, Optional, Union

import numpy

from . import _core
from .drawing import Drawing
from .drawing_space import SpatialDrawing
from .recorded import Recording

PAGE = "viewer.html"
_CODES = {"f8": "<f8", "f4": "<f4", "i4": "<i4", "u1": "u1"}


def _template() -> str:
    """The page without a recording. Raises FileError where it was not built."""
    page = resources.files(__package__) / PAGE
    if not page.is_file():
        raise _core.FileError(
            f"write_view: the page of the viewer is not in this installation ({page}); build it with "
            "scripts/viewer.sh --build, which needs npm, and install the package again"
        )
    return page.read_text(encoding="utf-8")


def _bounds(recording: Recording, drawing: Drawing, size: float) -> list[float]:
    """The rectangle that is shown at first: places and ends of the bodies, pins, and ground of finite size [m]."""
    points = recording.positions[:, :, :2].reshape(-1, 2)
    sets = [points[numpy.isfinite(points).all(axis=1)]]
    poses = {item["pose"]: drawing.places[3 * i : 3 * i + 2] for i, item in enumerate(drawing.obstacles)}
    for pose, flat in (*drawing.lines, *((item[0], item[2]) for item in drawing.polygons)):
        local = numpy.asarray(flat).reshape(-1, 2)
        if pose in poses and numpy.ptp(local, axis=0).max() < size:
            sets.append(local + poses[pose])
    for pose, *ends, _ in drawing.capsules:
        if pose in poses:
            sets.append(numpy.reshape(ends, (2, 2)) + poses[pose])
    pinned = [end for link in drawing.links for end in (link[1:4], link[4:7])]
    pinned += [joint[1:4] for joint in drawing.joints] + drawing.struts
    for pose, x, y in pinned:
        if pose == 0:
            sets.append(numpy.array([[x, y]]))
        elif pose <= recording.positions.shape[1] and (x or y):
            at = recording.positions[:, pose - 1]
            cos, sin = numpy.cos(at[:, 2]), numpy.sin(at[:, 2])
            places = numpy.stack([at[:, 0] + cos * x - sin * y, at[:, 1] + sin * x + cos * y], axis=1)
            sets.append(places[numpy.isfinite(places).all(axis=1)])
    every = numpy.concatenate(sets)
    if len(every) == 0:
        return [-1.0, -1.0, 1.0, 1.0]
    low, high = every.min(axis=0), every.max(axis=0)
    for pose, flat in drawing.lines:
        local = numpy.asarray(flat).reshape(-1, 2)
        if (
            pose in poses and numpy.ptp(local, axis=0).max() >= size
        ):  # a half-plane: its point below what is seen
            along = (local[-1] - local[0]) / numpy.linalg.norm(local[-1] - local[0])
            start = local[0] + poses[pose]
            foot = start + along * float(along @ (0.5 * (low + high) - start))
            if numpy.abs(foot - 0.5 * (low + high)).max() < 2.0 * (high - low).max():
                low, high = numpy.minimum(low, foot), numpy.maximum(high, foot)
    margin = (
        max([0.06 * float((high - low).max()), *(capsule[5] for capsule in drawing.capsules)] or [0.0]) or 0.5
    )
    return [*(low - margin).tolist(), *(high + margin).tolist()]


class _Arrays:
    """Arrays one after another, each at a multiple of eight bytes."""

    def __init__(self) -> None:
        self.places: dict[str, dict[str, Any]] = {}
        self._parts: list[bytes] = []
        self._size = 0

    def add(self, name: str, code: str, values: numpy.ndarray) -> None:
        data = numpy.ascontiguousarray(values, dtype=_CODES[code]).tobytes()
        self.places[name] = {"type": code, "offset": self._size, "length": int(numpy.size(values))}
        padding = -len(data) % 8
        self._parts += [data, bytes(padding)]
        self._size += len(data) + padding

    def base64(self) -> str:
        return base64.b64encode(b"".join(self._parts)).decode("ascii")


def _add_table(arrays: _Arrays, prefix: str, rows: numpy.ndarray, codes: dict[str, str]) -> None:
    for field, code in codes.items():
        arrays.add(f"{prefix}_{field}", code, rows[field])


def _orientations(recording: Recording, chosen: numpy.ndarray) -> numpy.ndarray:
    """Orientations of samples. Raises ModelError naming a body whose orientation is no unit quaternion."""
    turned: numpy.ndarray = recording.orientations[chosen]
    sizes = numpy.linalg.norm(turned, axis=2)
    wrong = numpy.argwhere(~(numpy.abs(sizes - 1.0) < 1e-6))  # rounding of some steps, but no other quantity
    if len(wrong):
        sample, body = wrong[0]
        raise _core.ModelError(
            f"write_view: the orientation of {recording.body_names()[body]} at "
            f"{recording.times[chosen[sample]]:g} s is {turned[sample, body].tolist()}; "
            "allowed: a unit quaternion"
        )
    return turned


def _page(recording: Recording, title: str, every: int) -> str:
    if len(recording) == 0:
        raise _core.ModelError("write_view: the recording has no samples; allowed: at least one")
    if every < 1:
        raise _core.ModelError(f"write_view: every is {every}; allowed: at least 1")
    chosen = numpy.arange(0, len(recording), every)
    if chosen[-1] != len(recording) - 1:
        chosen = numpy.append(chosen, len(recording) - 1)
    positions = recording.positions[chosen]
    arrays = _Arrays()
    arrays.add("times", "f8", recording.times[chosen])
    arrays.add("positions", "f4", positions)
    drawing: Drawing
    if recording.dimension == 3:
        turned = _orientations(recording, chosen)
        arrays.add("orientations", "f4", turned)
        drawing = spatial = SpatialDrawing(recording.model, 0.0)
        bounds = spatial.bounds(positions, turned)
    else:
        size = 10.0 * float(numpy.nanmax(numpy.ptp(positions[:, :, :2], axis=(0, 1)), initial=1.0))
        drawing = Drawing(recording.model, 4.0 * size)
        bounds = _bounds(recording, drawing, size)
    arrays.add("ground", "f4", recording.ground[chosen])
    terms = list(recording.ledger.dtype.names or ())
    arrays.add("ledger", "f4", numpy.stack([recording.ledger[term][chosen] for term in terms], axis=1))
    contacts = [recording.contacts_at(int(i)) for i in chosen]
    arrays.add("contact_ends", "i4", numpy.cumsum([len(rows) for rows in contacts]))
    vectors = {"point": "f4", "normal": "f4", "impulse": "f4", "name": "i4", "mode": "u1"}
    _add_table(arrays, "contact", numpy.concatenate(contacts), {**vectors, "impact": "u1"})
    events = recording.events[numpy.argsort(recording.events["time"], kind="stable")]
    _add_table(arrays, "event", events, {"time": "f8", **vectors, "kind": "u1"})

    description = {
        "title": title,
        "dimension": recording.dimension,
        "bodies": recording.body_names(),
        "moved": recording.moved,
        "names": recording.names,
        "ledger_terms": terms,
        "modes": [mode.name for mode in _core.ContactMode],
        "kinds": [kind.name for kind in _core.EventKind],
        "bounds": bounds,
        "arrays": arrays.places,
        **drawing.data(),
    }
    # "<" would end the element of the page, wherever a name has it.
    text = json.dumps(description, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    # Both marks are found before anything is put in, since texts may look like marks.
    head, _, rest = _template().partition("/*DESCRIPTION*/")
    middle, _, tail = rest.partition("/*ARRAYS*/")
    return "".join((head, text, middle, arrays.base64(), tail))


def write_view(
    recording: Recording, path: Union[str, os.PathLike[str]], title: Optional[str] = None, every: int = 1
) -> None:
    """Writes a page that shows a recording; everything is in this one file.

    title: the heading; unless given, the name of the file. every: only each so many samples are taken, and
    the last. Places, contacts and energies are rounded to 24 bits (float32), times are not. Raises FileError
    where the page cannot be written or was not built; ModelError for a recording that is empty, or whose
    orientations are no unit quaternions.
    """
    target = Path(path)
    page = _page(recording, target.stem if title is None else title, every)
    try:
        target.write_text(page, encoding="utf-8")
    except OSError as error:
        raise _core.FileError(f"write_view: '{target}' cannot be written: {error}") from error


class View:
    """A recording as a page: shown inline in notebooks."""

    def __init__(
        self, recording: Recording, every: int = 1, height: int = 640, title: str = "Recording"
    ) -> None:
        self._page = _page(recording, title, every)
        self.height = height

    def _repr_html_(self) -> str:
        source = html.escape(self._page, quote=True)
        return f'<iframe srcdoc="{source}" width="100%" height="{self.height}" style="border:0"></iframe>'

    def __repr__(self) -> str:
        return f"View({len(self._page)} characters)"
