// Solid bodies: what a recording in space has, and bodies of the plane made as thick as one of them is wide. They are
// of two sorts: round ones (spheres, capsules, cylinders), and triangles (boxes, convex meshes, prisms).
//
//     {kind: "sphere", pose, centre, radius}            {kind: "box", pose, centre, half, turn: [w, x, y, z]}
//     {kind: "capsule", pose, from, to, radius}         {kind: "mesh", pose, vertices, faces}
//     {kind: "cylinder", pose, from, to, radius}        {kind: "plane", pose, normal}: solid on its other side
//
// Places are in the frame of the pose [m]; faces are convex, each a list of numbers of vertices.

import { widened } from "./outlines.js";
import { rotate } from "./vectors.js";

const BOX = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

function boxMesh({ pose, centre, half, turn }) {
  const vertices = Array.from({ length: 8 }, (_, i) => {
    const corner = [0, 1, 2].map((k) => ((i >> k) & 1 ? half[k] : -half[k]));
    return (turn ? rotate(turn, corner) : corner).map((value, k) => value + centre[k]);
  });
  return { kind: "mesh", pose, vertices, faces: BOX };
}

/** Solids whose kinds are round or meshes, and planes. */
export function plain(solids) {
  return solids.map((solid) => {
    if (solid.kind === "sphere") return { ...solid, kind: "capsule", from: solid.centre, to: solid.centre };
    return solid.kind === "box" ? boxMesh(solid) : solid;
  });
}

/** A planar outline from -half to half in z: [x, y, ...] counter-clockwise and convex. */
function prism(pose, outline, half) {
  const count = outline.length / 2, all = Array.from({ length: count }, (_, i) => i);
  const corner = (i, z) => [outline[2 * i], outline[2 * i + 1], z];
  const vertices = [...all.map((i) => corner(i, half)), ...all.map((i) => corner(i, -half))];
  const walls = all.map((i) => [i, i + count, ((i + 1) % count) + count, (i + 1) % count]);
  return { kind: "mesh", pose, vertices, faces: [all, all.map((i) => 2 * count - 1 - i), ...walls] };
}

/** Triangles of the plane as one solid, whose walls are where only one triangle has an edge. */
function slab(pose, points, half) {
  const vertices = [], faces = [], edges = new Map();
  const key = (x, y) => `${x.toPrecision(9)} ${y.toPrecision(9)}`;
  for (let i = 0; i < points.length; i += 6) {
    let corners = [0, 2, 4].map((k) => [points[i + k], points[i + k + 1]]);
    const [[ax, ay], [bx, by], [cx, cy]] = corners;
    if ((bx - ax) * (cy - ay) < (cx - ax) * (by - ay)) corners = corners.reverse();
    const at = vertices.length;
    for (const z of [half, -half]) vertices.push(...corners.map(([x, y]) => [x, y, z]));
    faces.push([at, at + 1, at + 2], [at + 5, at + 4, at + 3]);
    corners.forEach((corner, k) => {
      const [one, two] = [key(...corner), key(...corners[(k + 1) % 3])];
      const [m, n] = [at + k, at + ((k + 1) % 3)];
      if (!edges.delete(`${two}|${one}`)) edges.set(`${one}|${two}`, [m, m + 3, n + 3, n]);
    });
  }
  return { kind: "mesh", pose, vertices, faces: [...faces, ...edges.values()] };
}

/** What a recording of the plane has, as solids of a thickness [m]. */
export function thickened({ capsules, polygons, fills }, thickness) {
  const half = 0.5 * thickness;
  const round = capsules.map(([pose, ax, ay, bx, by, radius]) => (
    ax === bx && ay === by
      ? { kind: "cylinder", pose, from: [ax, ay, -half], to: [ax, ay, half], radius }
      : prism(pose, widened([ax, ay, bx, by], radius || 0.02 * thickness), half)));
  return [
    ...round, ...polygons.map(([pose, radius, points]) => prism(pose, widened(points, radius), half)),
    ...fills.map(([pose, points]) => slab(pose, points, half)),
  ];
}

/** Corners of the triangles of a mesh, nine numbers each. */
export function trianglesOf({ vertices, faces }) {
  const out = [];
  for (const face of faces) {
    for (let i = 2; i < face.length; ++i) for (const k of [0, i - 1, i]) out.push(...vertices[face[k]]);
  }
  return Float32Array.from(out);
}

/** The sphere around a solid: [centre, radius], in the frame of its pose. */
export function around(solid) {
  const points = solid.kind === "mesh" ? solid.vertices : [solid.from, solid.to];
  const [low, high] = [Math.min, Math.max].map((least) => [0, 1, 2].map((k) => (
    points.reduce((found, point) => least(found, point[k]), points[0][k]))));
  const centre = low.map((value, k) => 0.5 * (value + high[k]));
  const reach = points.reduce((most, point) => Math.max(most, Math.hypot(...point.map((v, k) => v - centre[k]))), 0);
  return [centre, reach + (solid.radius ?? 0)];
}
