"""A recording for ParaView: a series of files in VTK's form; in the plane with z = 0.

    recording.to_vtk("run.pvd")

writes run.pvd, which ParaView opens, and into the folder run one file .vtp a sample of each of

    bodies     outlines of shapes; particles and bodies without shape as points. Of each cell `body` (place in
               body_names()), `velocity` of the centre of mass [m/s]; in the plane `spin` [rad/s] too, and of
               each point `point_velocity` [m/s]
    links      springs, rods and their like as lines, if there are any
    contacts   points, with the vectors `impulse`, on the body that the name of the contact has first, and
               `normal`; `normal_impulse`, `tangential_impulse` [N s], which in space is a size, `gap` [m],
               `mode` (carom.ContactMode), `impact` (0, 1), `name` (place in Recording.names)
    ground     outlines of shapes on ground, of a half-space a square; one file for all samples where none
               moves
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Union

import numpy

from . import _core
from .drawing import Drawing
from .drawing_space import SpatialDrawing
from .recorded import Recording
from .vtk_xml import Array, Cells, PolyData, write_series

_ARC = 32  # straight pieces of a full circle


def widened(points: Array, radius: float) -> Array:
    """The outline, counter-clockwise, of a convex polygon, a segment or a point, widened by a radius."""
    if len(points) > 2:
        x, y = points[:, 0], points[:, 1]
        if x @ numpy.roll(y, -1) < y @ numpy.roll(x, -1):
            points = points[::-1]
    if radius <= 0.0 and len(points) > 1:
        return points
    if len(points) == 1 or not numpy.ptp(points, axis=0).any():
        turns = 2.0 * numpy.pi * numpy.arange(_ARC) / _ARC
        circle = numpy.stack([numpy.cos(turns), numpy.sin(turns)], axis=1)
        return numpy.asarray(points[0] + radius * circle)
    edges = numpy.roll(points, -1, axis=0) - points
    normals = numpy.arctan2(edges[:, 1], edges[:, 0]) - 0.5 * numpy.pi  # of the edge after each corner
    outline = []
    for corner, start, end in zip(points, numpy.roll(normals, 1), normals):
        turn = (end - start) % (2.0 * numpy.pi)
        pieces = max(1, int(numpy.ceil(turn / (2.0 * numpy.pi) * _ARC)))
        angles = start + turn * numpy.arange(pieces + 1) / pieces
        outline.append(corner + radius * numpy.stack([numpy.cos(angles), numpy.sin(angles)], axis=1))
    return numpy.concatenate(outline)


class _Layer:
    """Points, each in the frame of a pose, with cells on them: what moves with the poses."""

    def __init__(self, dimension: int) -> None:
        self._dimension = dimension  # of points that are added
        self._cells = Cells()
        self._poses: list[int] = []
        self._local: list[Array] = []
        self._of_cells: dict[str, list[int]] = {"verts": [], "lines": [], "polys": []}

    def add(self, kind: str, poses: Union[int, list[int]], points: Any) -> None:
        """A cell of points in the frame of one pose, or each in its own."""
        flat = numpy.asarray(points, dtype=float).reshape(-1, self._dimension)
        local = numpy.concatenate([flat, numpy.zeros((len(flat), 3 - self._dimension))], axis=1)
        own = [poses] * len(local) if isinstance(poses, int) else poses
        self._cells.add(kind, range(len(self._poses), len(self._poses) + len(local)))
        self._poses += own
        self._local.append(local)
        self._of_cells[kind].append(own[0])

    def freeze(self) -> None:
        """Ends the adding."""
        self.poses = numpy.array(self._poses, dtype=int)
        self.of_cells = numpy.array(sum(self._of_cells.values(), []), dtype=int)
        self.local = numpy.concatenate([numpy.empty((0, 3)), *self._local])

    def at(self, places: Array, turns: Array) -> PolyData:
        """The layer where poses are at places (n, 3) with axes (n, 3, 3) in columns; without numbers."""
        arms = numpy.einsum("nij,nj->ni", turns[self.poses], self.local)
        return PolyData(places[self.poses] + arms, self._cells, {}, {})


def axes_of(angles: Array) -> Array:
    """Axes (n, 3, 3), in columns, of frames that are turned in the plane by angles."""
    c, s, axes = numpy.cos(angles), numpy.sin(angles), numpy.zeros((len(angles), 3, 3))
    axes[:, 0, 0], axes[:, 0, 1], axes[:, 1, 0], axes[:, 1, 1], axes[:, 2, 2] = c, -s, s, c, 1.0
    return axes


def tangents(normals: Array) -> Array:
    """The two tangents (n, 2, 3) of contacts in space: the first along the axis least aligned with the
    normal, (t1, t2, n) right-handed.
    """
    axes = numpy.eye(3)[numpy.abs(normals).argmin(axis=1)]
    first = axes - (axes * normals).sum(axis=1, keepdims=True) * normals
    first /= numpy.linalg.norm(first, axis=1, keepdims=True)
    return numpy.stack([first, numpy.cross(normals, first)], axis=1)


class _Series:
    """What there is to write of a recording."""

    def __init__(self, recording: Recording) -> None:
        self._recording = recording
        self._count = recording.positions.shape[1]
        self._dimension = recording.dimension
        places = recording.positions[:, :, : self._dimension]
        reach = 40.0 * float(numpy.nanmax(numpy.ptp(places, axis=(0, 1)), initial=1.0))
        kind = SpatialDrawing if self._dimension == 3 else Drawing
        self._drawing = drawing = kind(recording.model, reach)
        self._reach = reach
        self._moved = [
            next(item["pose"] for item in drawing.obstacles if item["serial"] == serial)
            for serial in recording.moved
        ]
        self._bodies, self._ground, self._links = (_Layer(self._dimension) for _ in range(3))
        self._add_shapes()
        self._add_links()
        for layer in (self._bodies, self._ground, self._links):
            layer.freeze()

    def _layer(self, pose: int) -> _Layer:
        return self._bodies if 0 < pose <= self._count else self._ground

    def _add_shapes(self) -> None:
        drawing = self._drawing
        shaped = set()
        for pose, *numbers, radius in drawing.capsules:
            outline = widened(numpy.reshape(numbers, (2, 2)), radius)
            self._layer(int(pose)).add("polys", int(pose), outline)
            shaped.add(int(pose))
        for pose, radius, flat in drawing.polygons:
            self._layer(pose).add("polys", pose, widened(numpy.reshape(flat, (-1, 2)), radius))
            shaped.add(pose)
        for pose in sorted(set(range(1, self._count + 1)) - shaped):
            self._bodies.add("verts", pose, [0.0] * self._dimension)
        for pose, flat in drawing.fills:
            for triangle in numpy.reshape(flat, (-1, 6)):
                self._ground.add("polys", pose, triangle)
        for pose, flat in drawing.lines:
            self._ground.add("lines", pose, flat)
        for item in drawing.solids:
            if item["kind"] == "plane":
                (a, b), half = tangents(numpy.array([item["normal"]]))[0], 0.5 * self._reach
                corners = [half * (i * a + j * b) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                self._ground.add("polys", item["pose"], corners)

    def _add_links(self) -> None:
        d = self._dimension
        for _, *ends in self._drawing.links:
            self._links.add("lines", [int(ends[0]), int(ends[d + 1])], ends[1 : d + 1] + ends[d + 2 :])
        for pose, *point in self._drawing.struts:
            self._links.add("lines", int(pose), [0.0] * d + point)

    def _poses(self, sample: int) -> tuple[Array, Array]:
        """Places and axes of all poses."""
        fixed = numpy.reshape(self._drawing.places, (-1, 3))
        poses = numpy.concatenate([numpy.zeros((1, 3)), self._recording.positions[sample], fixed])
        poses[self._moved] = self._recording.ground[sample]
        if self._dimension == 3:  # of points: there are no others in space
            return poses, numpy.broadcast_to(numpy.eye(3), (len(poses), 3, 3))
        return _in_space(poses[:, :2]), axes_of(poses[:, 2])

    def _bodies_at(self, sample: int, poses: tuple[Array, Array]) -> PolyData:
        layer, velocities = self._bodies, self._recording.velocities[sample]
        data, bodies = layer.at(*poses), layer.of_cells - 1
        data.of_cells = {
            "body": bodies.astype("i4"),
            "velocity": _in_space(velocities[bodies, : self._dimension]),
        }
        if self._dimension == 2:
            owners = layer.poses - 1
            arm = data.points - poses[0][layer.poses]
            turned = numpy.stack([-arm[:, 1], arm[:, 0]], axis=1)
            own, spin = velocities[owners, :2], velocities[owners, 2]
            data.of_points = {"point_velocity": _in_space(own + spin[:, None] * turned)}
            data.of_cells["spin"] = velocities[bodies, 2]
        return data

    def _contacts_at(self, sample: int) -> PolyData:
        rows, cells = self._recording.contacts_at(sample), Cells()
        for i in range(len(rows)):
            cells.add("verts", [i])
        normal, impulse = rows["normal"], rows["impulse"]
        if self._dimension == 3:
            along = numpy.einsum("nk,nkj->nj", impulse[:, 1:], tangents(normal))
            tangential = numpy.linalg.norm(impulse[:, 1:], axis=1)
        else:
            along = impulse[:, 1:] * numpy.stack([normal[:, 1], -normal[:, 0]], axis=1)
            tangential = impulse[:, 1]
        numbers = {
            "impulse": _in_space(impulse[:, :1] * normal + along),
            "normal": _in_space(normal),
            "normal_impulse": impulse[:, 0],
            "tangential_impulse": tangential,
            **{name: rows[name] for name in ("gap", "mode", "impact", "name")},
        }
        return PolyData(_in_space(rows["point"]), cells, numbers, {})

    def write(self, sample: int, folder: Path) -> Iterator[tuple[str, str]]:
        """Writes the files of a sample: name of each part, and its file in the folder. Raises OSError."""
        poses, time = self._poses(sample), float(self._recording.times[sample])
        parts = {"bodies": self._bodies_at(sample, poses), "contacts": self._contacts_at(sample)}
        if len(self._links.poses):
            parts["links"] = self._links.at(*poses)
        if len(self._ground.poses):
            parts["ground"] = self._ground.at(*poses)
        for part, data in parts.items():
            stays = part == "ground" and not self._moved
            file = f"{part}.vtp" if stays else f"{part}_{sample:06}.vtp"
            if not stays or sample == 0:
                data.write(folder / file, time)
            yield part, file


def _in_space(vectors: Array) -> Array:
    """Vectors; those of the plane with z = 0."""
    return numpy.concatenate([vectors, numpy.zeros((len(vectors), 3 - vectors.shape[1]))], axis=1)


def write_vtk(recording: Recording, path: Union[str, os.PathLike[str]], every: int = 1) -> None:
    """Writes a recording for ParaView: path, a file .pvd, and a folder of that name beside it. Makes folders.

    every: only each so many samples are taken, and the last. Raises ModelError for a path that does not end
    in .pvd; FileError for one that cannot be written.
    """
    target = Path(path)
    if target.suffix != ".pvd":
        raise _core.ModelError(f"write_vtk: path is '{target}'; allowed: a name that ends in .pvd")
    if every < 1:
        raise _core.ModelError(f"write_vtk: every is {every}; allowed: at least 1")
    if len(recording) == 0:
        raise _core.ModelError("write_vtk: the recording has no samples; allowed: at least one")
    folder, series = target.with_suffix(""), _Series(recording)
    files = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for sample in sorted({*range(0, len(recording), every), len(recording) - 1}):
            time = float(recording.times[sample])
            files += [(time, part, f"{folder.name}/{file}") for part, file in series.write(sample, folder)]
        write_series(target, files)
    except OSError as error:
        raise _core.FileError(f"write_vtk: '{target}' cannot be written: {error}") from error
