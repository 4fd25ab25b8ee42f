// What is drawn, as few meshes, each one call: how they are made, and fills and lines. Sizes of lines are in pixels;
// `pixel` is the length of one in the scene [m]. What an item has everywhere goes to its pixels `flat`: a number that is
// not is worked out anew in each.

import { BufferAttribute, BufferGeometry, DoubleSide, GLSL3, Mesh, RawShaderMaterial } from "three";
import { POSE_SHADER } from "./poses.js";

const HEAD = `
precision highp float;
precision highp int;
uniform mat4 projectionMatrix;
uniform mat4 viewMatrix;
uniform float pixel;
uniform float density; // of the screen: dots a pixel
uniform float picked;
uniform vec3 pickedColour;
// Where a point of the scene is seen from the camera, moved by pixels of the picture.
vec4 eye(vec3 at, vec2 beside) { vec4 seen = viewMatrix * vec4(at, 1.0); seen.xy += pixel * beside; return seen; }
`;
const PAINT = `
precision highp float;
uniform float pixel;
out vec4 paint;
`;
// A form that is drawn for each item: corners, `size` numbers each, and its triangles.
export const QUAD = { corners: [-1, -1, 1, -1, 1, 1, -1, 1], size: 2, triangles: [0, 1, 2, 0, 2, 3] };

/** A form drawn for each item, as one mesh with all vertices: drawing in software takes instances one by one, at a
 * hundred times the cost. Attributes by name: [numbers of all items, how many each has]. */
export function repeated(form, count, attributes) {
  const copies = form.corners.length / form.size, { triangles } = form;
  const corners = new Float32Array(count * form.corners.length), index = new Uint32Array(count * triangles.length);
  for (let item = 0; item < count; ++item) {
    corners.set(form.corners, item * form.corners.length);
    for (let i = 0; i < triangles.length; ++i) index[item * triangles.length + i] = item * copies + triangles[i];
  }
  const geometry = new BufferGeometry();
  geometry.setIndex(new BufferAttribute(index, 1));
  geometry.setAttribute("corner", new BufferAttribute(corners, form.size));
  for (const [name, [numbers, width]] of Object.entries(attributes)) {
    const all = new Float32Array(count * copies * width);
    for (let item = 0, at = 0; item < count; ++item) {
      const own = numbers.subarray(item * width, (item + 1) * width);
      for (let copy = 0; copy < copies; ++copy, at += width) all.set(own, at);
    }
    geometry.setAttribute(name, new BufferAttribute(all, width));
  }
  return geometry;
}

/** Vertices one by one. Attributes by name: [numbers of all vertices, how many each has]. */
export function vertices(count, attributes) {
  const geometry = new BufferGeometry();
  for (const [name, [numbers, width]] of Object.entries(attributes)) {
    geometry.setAttribute(name, new BufferAttribute(numbers, width));
  }
  geometry.setDrawRange(0, count);
  return geometry;
}

/** One call of drawing, over what has a lower order. solid: hides what is behind it. isHidden: by solids. Kind:
 * Mesh, or Points, which have one vertex each where a square has four: software spends its time on those. */
export function layer(geometry, uniforms, vertex, fragment, order, solid = false, isHidden = solid, Kind = Mesh) {
  const material = new RawShaderMaterial({
    glslVersion: GLSL3, uniforms, vertexShader: HEAD + POSE_SHADER + vertex, fragmentShader: PAINT + fragment,
    transparent: !solid, depthTest: isHidden, depthWrite: solid, side: DoubleSide, // triangles turn either way
  });
  const mesh = new Kind(geometry, material);
  mesh.frustumCulled = false;
  mesh.renderOrder = order;
  return mesh;
}

/** Filled triangles: [{pose, points, colour}], three points each. */
export function fills(list, uniforms, order) {
  const count = list.reduce((sum, item) => sum + item.points.length / 2, 0);
  const at = new Float32Array(2 * count), pose = new Float32Array(count), colour = new Float32Array(3 * count);
  let next = 0;
  for (const item of list) {
    at.set(item.points, 2 * next);
    for (let i = 0; i < item.points.length / 2; ++i, ++next) {
      pose[next] = item.pose;
      colour.set(item.colour, 3 * next);
    }
  }
  return layer(vertices(count, { at: [at, 2], pose: [pose, 1], colour: [colour, 3] }), uniforms, `
in vec2 at; in float pose; in vec3 colour;
flat out vec3 inside;
void main() {
  inside = picked == pose ? pickedColour : colour;
  gl_Position = projectionMatrix * viewMatrix * vec4(inScene(pose, at), 1.0);
}`, `
flat in vec3 inside;
void main() { paint = vec4(inside, 1.0); }`, order);
}

/** Straight lines between two ends, each in the frame of its own pose: [{poseA, a, poseB, b, s0, t0, s1, t1, width,
 * colour}] with a and b of two numbers or three. A line goes from s0 to s1 of the way between the ends, t0 and t1 pixels
 * beside it: pieces of a spring's zigzag. isHidden: behind solids. */
export function lines(list, uniforms, order, isHidden = false) {
  const poses = new Float32Array(2 * list.length);
  const from = new Float32Array(3 * list.length), to = new Float32Array(3 * list.length);
  const piece = new Float32Array(4 * list.length), width = new Float32Array(list.length);
  const colour = new Float32Array(3 * list.length);
  list.forEach((item, i) => {
    poses.set([item.poseA, item.poseB], 2 * i);
    from.set(item.a, 3 * i);
    to.set(item.b, 3 * i);
    piece.set([item.s0 ?? 0, item.t0 ?? 0, item.s1 ?? 1, item.t1 ?? 0], 4 * i);
    width[i] = item.width;
    colour.set(item.colour, 3 * i);
  });
  const geometry = repeated(QUAD, list.length, {
    bases: [poses, 2], from: [from, 3], to: [to, 3], piece: [piece, 4], width: [width, 1], colour: [colour, 3] });
  return layer(geometry, uniforms, `
in vec2 corner; in vec2 bases; in vec3 from; in vec3 to; in vec4 piece; in float width; in vec3 colour;
out float beside; flat out float half_; flat out vec3 inside;
void main() {
  vec4 a = eye(inScene(bases.x, from), vec2(0.0)), b = eye(inScene(bases.y, to), vec2(0.0)), ab = b - a;
  float span = length(ab.xy);
  vec4 across = vec4(span > 0.0 ? vec2(-ab.y, ab.x) / span : vec2(0.0, 1.0), 0.0, 0.0);
  vec4 p = a + piece.x * ab + piece.y * pixel * across, q = a + piece.z * ab + piece.w * pixel * across;
  vec2 pq = q.xy - p.xy;
  vec2 u = dot(pq, pq) > 0.0 ? normalize(pq) : vec2(1.0, 0.0);
  half_ = 0.5 * width;
  beside = corner.y * (half_ + 0.7);
  vec4 at = corner.x < 0.0 ? p : q;
  at.xy += 0.5 * half_ * pixel * corner.x * u + beside * pixel * vec2(-u.y, u.x);
  inside = colour;
  gl_Position = projectionMatrix * at;
}`, `
in float beside; flat in float half_; flat in vec3 inside;
void main() { paint = vec4(inside, clamp(half_ + 0.5 - abs(beside), 0.0, 1.0)); }`, order, false, isHidden);
}
