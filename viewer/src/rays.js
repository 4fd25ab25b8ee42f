// What a ray meets first among solids.

import { around, trianglesOf } from "./solids.js";
import { cross, dot, minus, plus, unit } from "./vectors.js";

/** Way along a ray of unit direction d from o to a capsule, or a cylinder; Infinity where it passes. */
function toRound({ kind, from, to, radius }, o, d) {
  const axis = minus(to, from), length = Math.hypot(...axis);
  const ways = [Infinity];
  const keep = (way, isIn) => { if (Number.isFinite(way) && isIn(plus(o, way, d))) ways.push(way); };
  if (length > 0) {
    const u = unit(axis), along = (point) => dot(minus(point, from), u);
    const side = plus(d, -dot(d, u), u), start = minus(o, from), off = plus(start, -dot(start, u), u);
    const a = dot(side, side), b = dot(side, off), c = dot(off, off) - radius * radius;
    const root = Math.sqrt(b * b - a * c);
    keep((-b - root) / a, (point) => along(point) >= 0 && along(point) <= length);
    if (kind === "cylinder") {
      for (const end of [from, to]) {
        keep(dot(minus(end, o), u) / dot(d, u), (point) => Math.hypot(...minus(point, end)) <= radius);
      }
      return Math.min(...ways);
    }
  }
  for (const end of [from, to]) {
    const off = minus(o, end), b = dot(off, d);
    keep(-b - Math.sqrt(b * b - dot(off, off) + radius * radius), () => true);
  }
  return Math.min(...ways);
}

function toTriangles(triangles, o, d) {
  let nearest = Infinity;
  for (let i = 0; i < triangles.length; i += 9) {
    const [a, b, c] = [0, 3, 6].map((k) => triangles.subarray(i + k, i + k + 3));
    const e = minus(b, a), f = minus(c, a), p = cross(d, f), size = dot(e, p);
    if (size === 0) continue;
    const from = minus(o, a), u = dot(from, p) / size, q = cross(from, e), v = dot(d, q) / size;
    if (u >= 0 && v >= 0 && u + v <= 1) nearest = Math.min(nearest, dot(f, q) / size);
  }
  return nearest;
}

/** Solids to be met, with the sphere around each, so that most are not looked at. */
export class Rays {
  constructor(solids) {
    this.items = solids.filter(({ kind }) => kind !== "plane").map((solid) => {
      const [centre, reach] = around(solid);
      return { solid, centre, reach, triangles: solid.kind === "mesh" ? trianglesOf(solid) : null };
    });
    this.planes = solids.filter(({ kind }) => kind === "plane");
  }

  /** Pose of what the ray from `origin` in a unit `direction` meets first; -1: nothing. */
  poseAt(poses, origin, direction) {
    let nearest = Infinity, found = -1;
    for (const { solid, centre, reach, triangles } of this.items) {
      const o = poses.inFrame(solid.pose, origin), d = poses.inFrame(solid.pose, direction, true);
      const off = minus(centre, o), along = dot(off, d);
      if (dot(off, off) - along * along > reach * reach) continue;
      const way = triangles ? toTriangles(triangles, o, d) : toRound(solid, o, d);
      if (way < nearest) [nearest, found] = [way, solid.pose];
    }
    for (const { pose, normal } of this.planes) {
      const way = -dot(poses.inFrame(pose, origin), normal) / dot(poses.inFrame(pose, direction, true), normal);
      if (way > 0 && way < nearest) [nearest, found] = [way, pose];
    }
    return found;
  }
}
