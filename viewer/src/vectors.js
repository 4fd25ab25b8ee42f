// Vectors of three numbers, and quaternions w, x, y, z.

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
/** a + s b. */
export const plus = (a, s, b) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
export const unit = (a) => plus([0, 0, 0], 1 / Math.hypot(...a), a);

export function rotate([w, ...q], v) {
  const t = plus(cross(q, v), w, v);
  return plus(v, 2, cross(q, t));
}
