// Outlines of rounded convex polygons, and links as pieces of lines.

const ARC = 8; // straight pieces of a quarter of a circle, less where it is small beside the polygon

/** Corners of a convex polygon that is widened by a radius, counter-clockwise: [x, y, ...]. */
export function widened(points, radius) {
  const corners = counterClockwise(points);
  if (!(radius > 0)) return corners;
  const out = [], count = corners.length / 2;
  const size = Math.max(...corners.map(Math.abs));
  const arc = Math.max(1, Math.round(ARC * Math.min(1, Math.sqrt(radius / size))));
  for (let i = 0; i < count; ++i) {
    const [a, b, c] = [(i + count - 1) % count, i, (i + 1) % count].map((k) => [corners[2 * k], corners[2 * k + 1]]);
    const from = Math.atan2(b[1] - a[1], b[0] - a[0]) - Math.PI / 2;
    let turn = Math.atan2(c[1] - b[1], c[0] - b[0]) - Math.PI / 2 - from;
    if (turn < 0) turn += 2 * Math.PI;
    const pieces = Math.max(1, Math.ceil((turn / (Math.PI / 2)) * arc));
    for (let k = 0; k <= pieces; ++k) {
      const angle = from + (turn * k) / pieces;
      out.push(b[0] + radius * Math.cos(angle), b[1] + radius * Math.sin(angle));
    }
  }
  return out;
}

function counterClockwise(points) {
  let area = 0;
  const count = points.length / 2;
  for (let i = 0; i < count; ++i) {
    const k = (i + 1) % count;
    area += points[2 * i] * points[2 * k + 1] - points[2 * k] * points[2 * i + 1];
  }
  if (area >= 0) return points;
  const turned = [];
  for (let i = count - 1; i >= 0; --i) turned.push(points[2 * i], points[2 * i + 1]);
  return turned;
}

/** Lines along points of one pose. */
export function along(pose, points, isClosed, width, colour) {
  const list = [], count = points.length / 2;
  for (let i = 0; i + 1 < count || (isClosed && i < count); ++i) {
    const k = (i + 1) % count;
    const [a, b] = [points.slice(2 * i, 2 * i + 2), points.slice(2 * k, 2 * k + 2)];
    list.push({ poseA: pose, a, poseB: pose, b, width, colour });
  }
  return list;
}

// Corners of links between their ends: part of the way, pixels beside.
const FORMS = {
  spring: [[0, 0], [0.16, 0], ...Array.from({ length: 10 }, (_, i) => [0.16 + (0.68 * (i + 0.5)) / 10, i % 2 ? -6 : 6]),
    [0.84, 0], [1, 0]],
  actuator: [[0, 0], [0.35, 0], [0.35, 5], [0.65, 5], [0.65, -5], [0.35, -5], [0.35, 0], [1, 0]],
  cable: [[0, 0], [1, 0]],
  rod: [[0, 0], [1, 0]],
};

/** Lines of a link: {kind, poseA, a, poseB, b}. */
export function link({ kind, ...ends }, width, colour) {
  const form = FORMS[kind];
  return form.slice(1).map(([s1, t1], i) => {
    const [s0, t0] = form[i];
    return { ...ends, s0, t0, s1, t1, width, colour };
  });
}
