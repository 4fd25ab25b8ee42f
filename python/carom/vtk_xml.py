"""A writer of VTK's XML files: points with cells on them, and series of files over time.

Form: https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html. Arrays are base64, each after
the number of its bytes, so that the files are XML for any reader.
"""

from __future__ import annotations

import base64
import dataclasses
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy
from numpy.typing import NDArray

Array = NDArray[Any]

_TYPES = {"f8": "Float64", "i8": "Int64", "i4": "Int32", "u1": "UInt8"}
_HEAD = '<?xml version="1.0"?>\n<VTKFile type="{}" version="{}" byte_order="LittleEndian"{}>\n'
_KINDS = ("verts", "lines", "polys")  # in the order that data of cells have


def _array(name: str, values: Array, more: str = "") -> str:
    """An element DataArray. A second dimension holds the components; more: further attributes."""
    code = values.dtype.str[1:]
    data = numpy.ascontiguousarray(values, dtype="|u1" if code == "u1" else f"<{code}").tobytes()
    text = base64.b64encode(numpy.array([len(data)], "<u8").tobytes() + data).decode("ascii")
    components = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    head = f'type="{_TYPES[code]}" Name={quoteattr(name)}{components} {more} format="binary"'
    return f"<DataArray {head}>{text}</DataArray>\n"


def _arrays(tag: str, arrays: Mapping[str, Array]) -> str:
    return f"<{tag}>\n{''.join(_array(name, values) for name, values in arrays.items())}</{tag}>\n"


class Cells:
    """Cells by the numbers of their points: of one (verts), along them (lines), around them (polys)."""

    def __init__(self) -> None:
        self._connected: dict[str, list[int]] = {kind: [] for kind in _KINDS}
        self._ends: dict[str, list[int]] = {kind: [] for kind in _KINDS}
        self._text = ""  # made once, as many files share it

    def add(self, kind: str, points: Iterable[int]) -> None:
        """Adds a cell of a kind."""
        self._text = ""
        self._connected[kind] += points
        self._ends[kind].append(len(self._connected[kind]))

    def count(self, kind: str) -> int:
        """Number of cells of a kind."""
        return len(self._ends[kind])

    def text(self) -> str:
        """Their elements."""
        if not self._text:
            for kind in _KINDS:
                connected, ends = (numpy.array(table[kind], "i8") for table in (self._connected, self._ends))
                self._text += _arrays(kind.capitalize(), {"connectivity": connected, "offsets": ends})
        return self._text


@dataclasses.dataclass
class PolyData:
    """Points (n, 3) [m] with cells, numbers of each point and of each cell: verts, lines, then polys."""

    points: Array
    cells: Cells
    of_points: dict[str, Array]
    of_cells: dict[str, Array]

    def write(self, path: Path, time: float) -> None:
        """Writes a file .vtp. time: of its state [s]. Raises OSError."""
        counts = {kind.capitalize(): self.cells.count(kind) for kind in _KINDS}
        numbers = " ".join(f'NumberOf{kind}="{count}"' for kind, count in counts.items())
        of_time = _array("TimeValue", numpy.array([time]), ' NumberOfTuples="1"')
        text = (
            _HEAD.format("PolyData", "1.0", ' header_type="UInt64"')
            + "<PolyData>\n"
            + f"<FieldData>\n{of_time}</FieldData>\n"
            + f'<Piece NumberOfPoints="{len(self.points)}" NumberOfStrips="0" {numbers}>\n'
            + _arrays("PointData", self.of_points)
            + _arrays("CellData", self.of_cells)
            + _arrays("Points", {"points": self.points})
            + self.cells.text()
            + "</Piece>\n</PolyData>\n</VTKFile>\n"
        )
        path.write_text(text, encoding="ascii")


def write_series(path: Path, files: Iterable[tuple[float, str, str]]) -> None:
    """Writes a file .pvd, which ParaView opens as one run: (time [s], name of a part, its file from there).
    Raises OSError.
    """
    rows, parts = [], list[str]()
    for time, part, file in files:
        if part not in parts:
            parts.append(part)
        rows.append(
            f'<DataSet timestep="{time!r}" group="" part="{parts.index(part)}" name={quoteattr(part)} '
            f"file={quoteattr(file)}/>\n"
        )
    path.write_text(
        _HEAD.format("Collection", "0.1", "")
        + "<Collection>\n"
        + "".join(rows)
        + "</Collection>\n</VTKFile>\n",
        encoding="utf-8",
    )
