"""A recording for ParaView: a series of files in VTK's form, with z = 0.

    recording.to_vtk("run.pvd")

writes run.pvd, which ParaView opens, and into the folder run one file .vtp a sample of each of

    bodies     outlines of shapes; particles and bodies without shape as points. Of each cell `body` (place in
               body_names()), `velocity` of the centre of mass [m/s], `spin` [rad/s]; of each point
               `point_velocity` [m/s]
    links      springs, rods and their like as lines, if there are any
    contacts   points, with the vectors `impulse`, on the body that the name of the contact has first, and
               `normal`; `normal_impulse`, `tangential_impulse` [N s], `gap` [m], `mode` (carom.ContactMode),
               `impact` (0, 1), `name` (place in Recording.names)
    ground     outlines of shapes on ground; one file for all samples where none moves
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Union

import numpy

from . import _core
from .drawing import Drawing
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

    def __init__(self) -> None:
        self._cells = Cells()
        self._poses: list[int] = []
        self._local: list[Array] = []
        self._of_cells: dict[str, list[int]] = {"verts": [], "lines": [], "polys": []}

    def add(self, kind: str, poses: Union[int, list[int]], points: Any) -> None:
        """A cell of points in the frame of one pose, or each in its own."""
        local = numpy.asarray(points, dtype=float).reshape(-1, 2)
        own = [poses] * len(local) if isinstance(poses, int) else poses
        self._cells.add(kind, range(len(self._poses), len(self._poses) + len(local)))
        self._poses += own
        self._local.append(local)
        self._of_cells[kind].append(own[0])

    def freeze(self) -> None:
        """Ends the adding."""
        self.poses = numpy.array(self._poses, dtype=int)
        self.of_cells = numpy.array(sum(self._of_cells.values(), []), dtype=int)
        self.local = numpy.concatenate([numpy.empty((0, 2)), *self._local])

    def at(self, poses: Array) -> PolyData:
        """The layer where poses are (n, 3): x, y, angle; without numbers."""
        x, y, angle = poses[self.poses].T
        c, s = numpy.cos(angle), numpy.sin(angle)
        u, v = self.local.T
        points = numpy.stack([x + c * u - s * v, y + s * u + c * v, numpy.zeros(len(x))], axis=1)
        return PolyData(points, self._cells, {}, {})


class _Series:
    """What there is to write of a recording."""

    def __init__(self, recording: Recording) -> None:
        self._recording = recording
        self._count = recording.positions.shape[1]
        places = recording.positions[:, :, :2]
        size = 10.0 * float(numpy.nanmax(numpy.ptp(places, axis=(0, 1)), initial=1.0))
        self._drawing = drawing = Drawing(recording.model, 4.0 * size)
        self._moved = [
            next(item["pose"] for item in drawing.obstacles if item["serial"] == serial)
            for serial in recording.moved
        ]
        self._bodies, self._ground, self._links = _Layer(), _Layer(), _Layer()
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
            self._bodies.add("verts", pose, (0.0, 0.0))
        for pose, flat in drawing.fills:
            for triangle in numpy.reshape(flat, (-1, 6)):
                self._ground.add("polys", pose, triangle)
        for pose, flat in drawing.lines:
            self._ground.add("lines", pose, flat)

    def _add_links(self) -> None:
        for _, a, ax, ay, b, bx, by in self._drawing.links:
            self._links.add("lines", [int(a), int(b)], (ax, ay, bx, by))
        for pose, x, y in self._drawing.struts:
            self._links.add("lines", int(pose), (0.0, 0.0, x, y))

    def _poses(self, sample: int) -> Array:
        fixed = numpy.reshape(self._drawing.places, (-1, 3))
        poses = numpy.concatenate([numpy.zeros((1, 3)), self._recording.positions[sample], fixed])
        poses[self._moved] = self._recording.ground[sample]
        return poses

    def _bodies_at(self, sample: int, poses: Array) -> PolyData:
        layer, velocities = self._bodies, self._recording.velocities[sample]
        data = layer.at(poses)
        owners = layer.poses - 1
        arm = data.points[:, :2] - poses[layer.poses, :2]
        own, spin = velocities[owners, :2], velocities[owners, 2]
        turned = numpy.stack([-arm[:, 1], arm[:, 0]], axis=1)
        data.of_points = {"point_velocity": _in_space(own + spin[:, None] * turned)}
        bodies = layer.of_cells - 1
        data.of_cells = {
            "body": bodies.astype("i4"),
            "velocity": _in_space(velocities[bodies, :2]),
            "spin": velocities[bodies, 2],
        }
        return data

    def _contacts_at(self, sample: int) -> PolyData:
        rows, cells = self._recording.contacts_at(sample), Cells()
        for i in range(len(rows)):
            cells.add("verts", [i])
        normal, impulse = rows["normal"], rows["impulse"]
        tangent = numpy.stack([normal[:, 1], -normal[:, 0]], axis=1)
        numbers = {
            "impulse": _in_space(impulse[:, :1] * normal + impulse[:, 1:] * tangent),
            "normal": _in_space(normal),
            "normal_impulse": impulse[:, 0],
            "tangential_impulse": impulse[:, 1],
            **{name: rows[name] for name in ("gap", "mode", "impact", "name")},
        }
        return PolyData(_in_space(rows["point"]), cells, numbers, {})

    def write(self, sample: int, folder: Path) -> Iterator[tuple[str, str]]:
        """Writes the files of a sample: name of each part, and its file in the folder. Raises OSError."""
        poses, time = self._poses(sample), float(self._recording.times[sample])
        parts = {"bodies": self._bodies_at(sample, poses), "contacts": self._contacts_at(sample)}
        if len(self._links.poses):
            parts["links"] = self._links.at(poses)
        if len(self._ground.poses):
            parts["ground"] = self._ground.at(poses)
        for part, data in parts.items():
            stays = part == "ground" and not self._moved
            file = f"{part}.vtp" if stays else f"{part}_{sample:06}.vtp"
            if not stays or sample == 0:
                data.write(folder / file, time)
            yield part, file


def _in_space(vectors: Array) -> Array:
    """Vectors of the plane with z = 0."""
    return numpy.concatenate([vectors, numpy.zeros((len(vectors), 1))], axis=1)


def write_vtk(recording: Recording, path: Union[str, os.PathLike[str]], every: int = 1) -> None:
    """Writes a recording for ParaView: path, a file .pvd, and a folder of that name beside it.

    every: only each so many samples are taken, and the last. Raises ModelError for a recording in space, or a
    path that does not end in .pvd; FileError for one that cannot be written.
    """
    target = Path(path)
    if recording.dimension != 2:
        raise _core.ModelError("write_vtk: the model is in space; allowed: models in the plane")
    if target.suffix != ".pvd":
        raise _core.ModelError(f"write_vtk: path is '{target}'; allowed: a name that ends in .pvd")
    if every < 1:
        raise _core.ModelError(f"write_vtk: every is {every}; allowed: at least 1")
    if len(recording) == 0:
        raise _core.ModelError("write_vtk: the recording has no samples; allowed: at least one")
    folder, series = target.with_suffix(""), _Series(recording)
    files = []
    try:
        folder.mkdir(exist_ok=True)
        for sample in sorted({*range(0, len(recording), every), len(recording) - 1}):
            time = float(recording.times[sample])
            files += [(time, part, f"{folder.name}/{file}") for part, file in series.write(sample, folder)]
        write_series(target, files)
    except OSError as error:
        raise _core.FileError(f"write_vtk: '{target}' cannot be written: {error}") from error
