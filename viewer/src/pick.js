// What is under the pointer: contacts first, then bodies, then ground.

const NEAR = 7; // [pixels]

function toSegment(x, y, ax, ay, bx, by) {
  const dx = bx - ax, dy = by - ay, size = dx * dx + dy * dy;
  const s = size > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / size)) : 0;
  return Math.hypot(x - ax - s * dx, y - ay - s * dy);
}

function toPolygon(x, y, points) {
  let inside = false, distance = Infinity;
  const count = points.length / 2;
  for (let i = 0, k = count - 1; i < count; k = i++) {
    const [ax, ay, bx, by] = [points[2 * i], points[2 * i + 1], points[2 * k], points[2 * k + 1]];
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
    distance = Math.min(distance, toSegment(x, y, ax, ay, bx, by));
  }
  return inside ? 0 : distance;
}

/** Pose of the body, or of the shape on ground, at a pixel; -1 if there is none. isFlat: planar outlines are looked at,
 * and not only particles, which have a size in pixels. */
export function poseAt(recording, poses, camera, px, py, isFlat) {
  let found = -1;
  const take = (pose) => { if (found < 0 || pose <= recording.bodies.length) found = pose; };
  for (const pose of recording.particles) {
    const [column, row] = camera.pixelAt(...poses.place(pose));
    if (Math.hypot(px - column, py - row) < NEAR) take(pose);
  }
  if (!isFlat) return found;
  const [x, y] = camera.sceneAt(px, py), pixel = 1 / camera.scale;
  for (const [pose, ax, ay, bx, by, radius] of recording.capsules) {
    const [u, v] = poses.local(pose, x, y);
    if (toSegment(u, v, ax, ay, bx, by) <= Math.max(radius, 2 * pixel)) take(pose);
  }
  for (const [pose, radius, points] of recording.polygons) {
    const [u, v] = poses.local(pose, x, y);
    if (toPolygon(u, v, points) <= Math.max(radius, pixel)) take(pose);
  }
  if (found >= 0) return found;
  for (const [pose, points] of recording.lines) {
    const [u, v] = poses.local(pose, x, y);
    for (let i = 0; i + 3 < points.length; i += 2) {
      if (toSegment(u, v, ...points.slice(i, i + 4)) < NEAR * pixel) return pose;
    }
  }
  return -1;
}

/** Number of the contact at a pixel among [first, end); -1 if there is none. */
export function contactAt(recording, [first, end], camera, px, py) {
  let nearest = NEAR, found = -1;
  const { dimension: d, contact_point: points } = recording;
  for (let i = first; i < end; ++i) {
    const [column, row] = camera.pixelAt(points[d * i], points[d * i + 1], d === 3 ? points[d * i + 2] : 0);
    const distance = Math.hypot(px - column, py - row);
    if (distance < nearest) [nearest, found] = [distance, i];
  }
  return found;
}
