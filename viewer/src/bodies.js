// Outlines of bodies and of shapes on ground in the plane: discs and capsules, and convex polygons. A graphics card that is
// weak, and software still more, take their time for each triangle. So the line around a shape comes with its fill,
// as the distance from the edge, which is smooth at every size; and what is a few pixels wide is one point.

import { Points } from "three";
import { layer, QUAD, repeated, vertices } from "./layers.js";

const HALF_LINE = 0.7; // pixels of the line around a polygon on either side of its edge
const OUTSIDE = HALF_LINE + 0.5; // and what it covers in part
const WIDTH = 10; // numbers of a vertex of fan()
const LONGEST = 3; // of a corner that is sharp, in widths of what is outside

/** Discs and capsules: [{pose, ax, ay, bx, by, radius, fill}]. A radius shows how a disc turns. */
export function rounds(list, edge, uniforms, order) {
  const geometry = repeated(QUAD, list.length, numbersOf(list));
  return layer(geometry, { ...uniforms, edge: { value: edge } }, `
in vec2 corner; in vec4 ends; in float radius; in float pose; in vec3 fill;
out vec2 at; flat out float halfLength; flat out float size; flat out vec3 inside; flat out float isDisc;
void main() {
  vec2 along = ends.zw - ends.xy;
  halfLength = 0.5 * length(along);
  isDisc = halfLength < 1e-6 * radius ? 1.0 : 0.0;
  vec2 u = isDisc > 0.5 ? vec2(1.0, 0.0) : normalize(along);
  size = max(radius, 0.75 * pixel);
  at = corner * (vec2(halfLength, 0.0) + size + 0.5 * pixel);
  inside = picked == pose ? pickedColour : fill;
  vec2 local = 0.5 * (ends.xy + ends.zw) + at.x * u + at.y * vec2(-u.y, u.x);
  gl_Position = projectionMatrix * viewMatrix * vec4(inScene(pose, local), 1.0);
}`, `
in vec2 at; flat in float halfLength; flat in float size; flat in vec3 inside; flat in float isDisc;
uniform vec3 edge;
void main() {
  vec2 q = vec2(max(abs(at.x) - halfLength, 0.0), at.y);
  float d = length(q) - size;
  float cover = clamp(0.5 - d / pixel, 0.0, 1.0);
  float width = min(1.3 * pixel, 0.22 * size);
  float isEdge = clamp(0.5 + (d + width) / pixel, 0.0, 1.0);
  if (isDisc > 0.5 && at.x > 0.0) {
    float mark = clamp(0.5 + (0.5 * width - abs(at.y)) / pixel, 0.0, 1.0);
    isEdge = max(isEdge, 0.75 * mark * clamp(size / pixel / 3.0 - 1.0, 0.0, 1.0));
  }
  paint = vec4(mix(inside, edge, isEdge), cover);
}`, order);
}

function numbersOf(list) {
  const ends = new Float32Array(4 * list.length), radius = new Float32Array(list.length);
  const pose = new Float32Array(list.length), fill = new Float32Array(3 * list.length);
  list.forEach((item, i) => {
    ends.set([item.ax, item.ay, item.bx, item.by], 4 * i);
    radius[i] = item.radius;
    pose[i] = item.pose;
    fill.set(item.fill, 3 * i);
  });
  return { ends: [ends, 4], radius: [radius, 1], pose: [pose, 1], fill: [fill, 3] };
}

/** Those of a few pixels: one point each, which ends where its middle leaves the picture. areLong: capsules too. */
export function smallRounds(list, areLong, edge, uniforms, order) {
  const geometry = vertices(list.length, numbersOf(list));
  const axis = areLong ? `
  axis = 0.5 / pixel * (viewMatrix * vec4(turned(pose, vec3(ends.zw - ends.xy, 0.0)), 0.0)).xy;
  axis.y = -axis.y; // as coordinates of points go down
  halfLength = length(axis);` : "";
  return layer(geometry, { ...uniforms, edge: { value: edge } }, `
in vec4 ends; in float radius; in float pose; in vec3 fill;
flat out float size; flat out float reach; flat out vec3 inside; ${areLong ? "flat out vec2 axis;" : ""}
void main() {
  float halfLength = 0.0;
  size = max(radius / pixel, 0.75);
  inside = picked == pose ? pickedColour : fill;
  vec3 place = placeOf(pose);
  vec2 middle = 0.5 * (ends.xy + ends.zw);
  if (middle != vec2(0.0)) place += turned(pose, vec3(middle, 0.0));
  ${axis}
  reach = halfLength + size + 0.5;
  gl_Position = projectionMatrix * eye(place, vec2(0.0));
  gl_PointSize = density * 2.0 * reach;
}`, `
flat in float size; flat in float reach; flat in vec3 inside; ${areLong ? "flat in vec2 axis;" : ""}
uniform vec3 edge;
void main() {
  vec2 at = (2.0 * gl_PointCoord - 1.0) * reach;
  ${areLong ? "at -= clamp(dot(at, axis) / max(dot(axis, axis), 1e-9), -1.0, 1.0) * axis;" : ""}
  float d = length(at) - size;
  float isEdge = clamp(0.5 + d + min(1.3, 0.22 * size), 0.0, 1.0);
  paint = vec4(mix(inside, edge, isEdge), clamp(0.5 - d, 0.0, 1.0));
}`, order, false, false, Points);
}

/** Convex polygons: [{pose, points, fill}] with points counter-clockwise. Each is a fan of triangles around its middle,
 * in which distances from the edge and from its neighbours go on straight, from the outside of the line to the middle: of a
 * long polygon the triangle of an edge reaches far along the next one. */
export function polygons(list, edge, uniforms, order) {
  const fans = list.map(({ points }) => fan(points));
  const count = fans.reduce((sum, { length }) => sum + length / WIDTH, 0);
  const place = new Float32Array(WIDTH * count), pose = new Float32Array(count), fill = new Float32Array(3 * count);
  let next = 0;
  fans.forEach((numbers, item) => {
    place.set(numbers, WIDTH * next);
    for (let i = 0; i < numbers.length / WIDTH; ++i, ++next) {
      pose[next] = list[item].pose;
      fill.set(list[item].fill, 3 * next);
    }
  });
  const column = (from, width) => [
    Float32Array.from({ length: width * count }, (_, i) => place[WIDTH * Math.floor(i / width) + from + (i % width)]), width];
  const attributes = { at: column(0, 2), reach: column(2, 2), heights: column(4, 3), slopes: column(7, 3), pose: [pose, 1], fill: [fill, 3] };
  return layer(vertices(count, attributes), { ...uniforms, edge: { value: edge } }, `
in vec2 at; in vec2 reach; in vec3 heights; in vec3 slopes; in float pose; in vec3 fill;
out vec3 depths; flat out vec3 inside;
void main() {
  depths = heights / pixel - ${OUTSIDE.toFixed(2)} * slopes;
  inside = picked == pose ? pickedColour : fill;
  vec2 local = at + ${OUTSIDE.toFixed(2)} * pixel * reach;
  gl_Position = projectionMatrix * viewMatrix * vec4(inScene(pose, local), 1.0);
}`, `
in vec3 depths; flat in vec3 inside;
uniform vec3 edge;
void main() {
  float depth = min(depths.x, min(depths.y, depths.z));
  float isEdge = clamp(${OUTSIDE.toFixed(2)} - depth, 0.0, 1.0);
  paint = vec4(mix(inside, edge, isEdge), clamp(${OUTSIDE.toFixed(2)} + depth, 0.0, 1.0));
}`, order);
}

/** Triangles of a polygon, three vertices of each edge: place, direction to the outside of its line (which is as long
 * as the corner is sharp), distances from the edge before, from this one and from the next, by how much that direction leads
 * out of them. */
function fan(points) {
  const corners = [];
  for (let i = 0; i < points.length; i += 2) {
    const last = corners.at(-1) ?? points.slice(-2);
    if (points[i] !== last[0] || points[i + 1] !== last[1]) corners.push([points[i], points[i + 1]]);
  }
  const count = corners.length, middle = [0, 1].map((k) => corners.reduce((sum, corner) => sum + corner[k], 0) / count);
  const normals = corners.map(([x, y], i) => {
    const [u, v] = corners[(i + 1) % count], length = Math.hypot(u - x, v - y);
    return [(v - y) / length, (x - u) / length];
  });
  const outwards = normals.map(([x, y], i) => {
    const [u, v] = normals[(i + count - 1) % count], scale = 1 / Math.max(1 + x * u + y * v, 1e-9);
    const way = [scale * (x + u), scale * (y + v)], length = Math.hypot(...way);
    return way.map((value) => value * Math.min(1, LONGEST / length));
  });
  return normals.flatMap((_, i) => {
    const before = (i + count - 1) % count, next = (i + 1) % count, edges = [before, i, next];
    const height = (at, j) => normals[j][0] * (corners[j][0] - at[0]) + normals[j][1] * (corners[j][1] - at[1]);
    const vertex = (at, way) => [
      ...at, ...way, ...edges.map((j) => height(at, j)), ...edges.map((j) => normals[j][0] * way[0] + normals[j][1] * way[1])];
    return [vertex(middle, [0, 0]), vertex(corners[i], outwards[i]), vertex(corners[next], outwards[next])].flat();
  });
}
