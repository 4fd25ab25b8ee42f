// Solid bodies as three meshes: round ones, for which the shader meets the ray of each pixel with the body; triangles;
// planes of ground. One light; what it meets first is a texture, drawn by the same shaders.

import { BufferAttribute, BufferGeometry } from "three";
import { layer, QUAD, repeated } from "./layers.js";
import { trianglesOf } from "./solids.js";
import { cross, minus } from "./vectors.js";

/** Layer of three.js of what casts shadows. */
export const CASTS = 1;

const LIGHT = `
precision highp sampler2DShadow;
uniform vec3 light;
uniform mat4 toShadow;
uniform sampler2DShadow shadows;
uniform float shadowBias; // [m]
// Colour of a surface with a unit normal at a place of the scene.
vec3 lit(vec3 colour, vec3 normal, vec3 at) {
  float facing = dot(normal, light);
  vec3 s = (toShadow * vec4(at + shadowBias * normal, 1.0)).xyz;
  bool isKnown = all(lessThan(abs(s - 0.5), vec3(0.5)));
  float sun = isKnown ? texture(shadows, s) : 1.0;
  return colour * (0.7 + 0.32 * sun * max(facing, 0.0) - 0.12 * max(-facing, 0.0));
}
`;

/** Spheres, capsules and cylinders: [{kind, pose, from, to, radius, fill}]. Eighths around the middle are darker by
 * turns, so that a turning sphere is seen to turn. */
export function rounds(list, uniforms) {
  const from = new Float32Array(3 * list.length), to = new Float32Array(3 * list.length);
  const size = new Float32Array(2 * list.length), pose = new Float32Array(list.length);
  const fill = new Float32Array(3 * list.length);
  list.forEach((item, i) => {
    from.set(item.from, 3 * i);
    to.set(item.to, 3 * i);
    size.set([item.radius, item.kind === "cylinder" ? 1 : 0], 2 * i);
    pose[i] = item.pose;
    fill.set(item.fill, 3 * i);
  });
  const geometry = repeated(QUAD, list.length, {
    from: [from, 3], to: [to, 3], size: [size, 2], pose: [pose, 1], fill: [fill, 3] });
  const mesh = layer(geometry, uniforms, `
in vec2 corner; in vec3 from; in vec3 to; in vec2 size; in float pose; in vec3 fill;
out vec3 ray; flat out vec3 a; flat out vec3 b; flat out vec2 form; flat out vec4 rotation; flat out vec3 inside;
void main() {
  a = eye(inScene(pose, from), vec2(0.0)).xyz;
  b = eye(inScene(pose, to), vec2(0.0)).xyz;
  vec2 ab = b.xy - a.xy;
  float span = length(ab);
  vec2 u = span > 1e-6 * size.x ? ab / span : vec2(1.0, 0.0);
  vec2 reach = corner * (vec2(0.5 * span, 0.0) + size.x);
  ray = 0.5 * (a + b) + vec3(reach.x * u + reach.y * vec2(-u.y, u.x), 0.0);
  form = size;
  rotation = rotationOf(pose);
  inside = picked == pose ? pickedColour : fill;
  gl_Position = projectionMatrix * vec4(ray, 1.0);
}`, `
in vec3 ray; flat in vec3 a; flat in vec3 b; flat in vec2 form; flat in vec4 rotation; flat in vec3 inside;
uniform mat4 projectionMatrix; uniform mat4 toScene;
${LIGHT}
// How far before the middle, towards the viewer, the ray meets the body, and the normal there; false: nowhere.
bool meets(out float way, out vec3 normal) {
  float r = form.x, most = -1e30;
  vec3 ab = b - a, o = ray - a, n;
  float length2 = dot(ab, ab), along = length2 > 0.0 ? dot(o, ab) / length2 : 0.0;
  float A = length2 > 0.0 ? 1.0 - ab.z * ab.z / length2 : 0.0; // squared sine of ray and axis
  if (A > 1e-9) {
    vec3 u = ab * inversesqrt(length2), off = o - dot(o, u) * u, side = vec3(0.0, 0.0, 1.0) - u.z * u;
    float B = dot(side, off), H = B * B - A * (dot(off, off) - r * r);
    if (H >= 0.0) {
      float w = (-B + sqrt(H)) / A, part = (dot(o, u) + w * u.z) * inversesqrt(length2);
      if (part >= 0.0 && part <= 1.0) { most = w; n = (off + w * side) / r; }
    }
  }
  for (int end = 0; end < 2; ++end) {
    vec3 off = end == 0 ? o : o - ab;
    if (form.y > 0.5) { // flat ends
      if (abs(ab.z) < 1e-6 * sqrt(length2)) continue;
      float w = -dot(off, ab) / ab.z;
      vec3 at = off + vec3(0.0, 0.0, w);
      if (dot(at, at) <= r * r && w > most) { most = w; n = normalize(ab) * (end == 0 ? -1.0 : 1.0); }
    } else {
      float H = r * r - dot(off.xy, off.xy), w = -off.z + sqrt(max(H, 0.0));
      if (H >= 0.0 && w > most) { most = w; n = (off + vec3(0.0, 0.0, w)) / r; }
    }
  }
  way = most;
  normal = n;
  return most > -1e29;
}
void main() {
  float way; vec3 normal;
  if (!meets(way, normal)) discard;
  vec3 at = ray + vec3(0.0, 0.0, way);
  gl_FragDepth = 0.5 + 0.5 * (projectionMatrix[2][2] * at.z + projectionMatrix[3][2]);
  mat3 turn = mat3(toScene);
  vec3 v = turn * (at - 0.5 * (a + b)), q = -rotation.xyz;
  v += 2.0 * cross(q, cross(q, v) + rotation.w * v);
  vec3 colour = inside * (v.x * v.y * (form.y > 0.5 ? 1.0 : v.z) > 0.0 ? 0.86 : 1.0);
  paint = vec4(lit(colour, turn * normal, (toScene * vec4(at, 1.0)).xyz), 1.0);
}`, 0, true);
  mesh.layers.enable(CASTS);
  return mesh;
}

/** Meshes of flat faces: [{pose, vertices, faces, fill}]. */
export function meshes(list, uniforms) {
  const parts = list.map(trianglesOf), count = parts.reduce((sum, part) => sum + part.length / 3, 0);
  const at = new Float32Array(3 * count), normal = new Float32Array(3 * count);
  const pose = new Float32Array(count), fill = new Float32Array(3 * count);
  let next = 0;
  parts.forEach((part, item) => {
    at.set(part, 3 * next);
    for (let i = 0; i < part.length; i += 9, next += 3) {
      const [a, b, c] = [0, 3, 6].map((k) => part.subarray(i + k, i + k + 3));
      const n = cross(minus(b, a), minus(c, a)), size = Math.hypot(...n) || 1;
      for (let k = 0; k < 3; ++k) {
        normal.set([n[0] / size, n[1] / size, n[2] / size], 3 * (next + k));
        pose[next + k] = list[item].pose;
        fill.set(list[item].fill, 3 * (next + k));
      }
    }
  });
  const geometry = new BufferGeometry();
  const attributes = { at: [at, 3], normal: [normal, 3], pose: [pose, 1], fill: [fill, 3] };
  for (const [name, [array, width]] of Object.entries(attributes)) {
    geometry.setAttribute(name, new BufferAttribute(array, width));
  }
  geometry.setDrawRange(0, count);
  const mesh = layer(geometry, uniforms, `
in vec3 at; in vec3 normal; in float pose; in vec3 fill;
out vec3 place; flat out vec3 across; flat out vec3 inside;
void main() {
  place = inScene(pose, at);
  across = turned(pose, normal);
  inside = picked == pose ? pickedColour : fill;
  gl_Position = projectionMatrix * eye(place, vec2(0.0));
}`, `
in vec3 place; flat in vec3 across; flat in vec3 inside;
${LIGHT}
void main() { paint = vec4(lit(inside, across, place), 1.0); }`, 0, true);
  mesh.layers.enable(CASTS);
  return mesh;
}

/** Planes of ground: [{pose, normal, fill}], seen within `reach` of `middle`, with a grid. */
export function planes(list, middle, reach, grid, uniforms) {
  const normal = new Float32Array(3 * list.length), pose = new Float32Array(list.length);
  const fill = new Float32Array(3 * list.length);
  list.forEach((item, i) => {
    normal.set(item.normal, 3 * i);
    pose[i] = item.pose;
    fill.set(item.fill, 3 * i);
  });
  const geometry = repeated(QUAD, list.length, { normal: [normal, 3], pose: [pose, 1], fill: [fill, 3] });
  const own = { ...uniforms, middle: { value: middle }, reach: { value: reach }, grid: { value: grid } };
  const mesh = layer(geometry, own, `
in vec2 corner; in vec3 normal; in float pose; in vec3 fill;
uniform vec3 middle; uniform float reach;
out vec3 place; out vec2 on; flat out vec3 across; flat out vec3 inside; flat out float isBehind;
void main() {
  across = turned(pose, normal);
  vec3 level = abs(across.x) < 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0);
  vec3 u = normalize(level - dot(level, across) * across), v = cross(across, u);
  vec3 start = placeOf(pose), foot = middle - dot(middle - start, across) * across;
  place = foot + reach * (corner.x * u + corner.y * v);
  on = vec2(dot(place, u), dot(place, v));
  isBehind = (viewMatrix * vec4(across, 0.0)).z < 0.0 ? 1.0 : 0.0;
  inside = picked == pose ? pickedColour : fill;
  gl_Position = projectionMatrix * eye(place, vec2(0.0));
}`, `
in vec3 place; in vec2 on; flat in vec3 across; flat in vec3 inside; flat in float isBehind;
uniform vec3 middle; uniform float reach; uniform float grid;
${LIGHT}
void main() {
  vec2 line = abs(fract(on / grid + 0.5) - 0.5) * grid / max(fwidth(on), 1e-30);
  float onLine = clamp(1.0 - min(line.x, line.y), 0.0, 1.0);
  vec3 foot = middle - dot(middle - place, across) * across;
  float far = smoothstep(0.55, 1.0, distance(place, foot) / reach);
  vec3 colour = inside * (1.0 - 0.13 * onLine);
  paint = vec4(lit(colour, across, place), (1.0 - far) * (isBehind > 0.5 ? 0.3 : 1.0));
}`, 1, true);
  mesh.material.transparent = true; // it fades, over what is drawn before it
  return mesh;
}
