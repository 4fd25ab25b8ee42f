// What is drawn, as few meshes: outlines of bodies, lines, ground, marks. Sizes of lines and
// marks are in pixels; `pixel` is the length of one in the scene [m].

import {
  BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, GLSL3, Mesh, Points, RawShaderMaterial,
} from "three";
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
out vec4 paint;
`;
// A form that is drawn for each item: corners, `size` numbers each, and its triangles.
export const QUAD = { corners: [-1, -1, 1, -1, 1, 1, -1, 1], size: 2, triangles: [0, 1, 2, 0, 2, 3] };

/** Numbers of each item, for all vertices of its form. */
function spread(from, width, copies, to, count) {
  for (let item = 0, at = 0; item < count; ++item) {
    for (let copy = 0; copy < copies; ++copy) {
      for (let i = 0; i < width; ++i) to[at++] = from[item * width + i];
    }
  }
}

/** A form drawn for each item, as one mesh with all vertices: drawing in software takes instances one by one, at a
 * hundred times the cost. Attributes by name: [numbers of all items, how many each has]. */
export class Repeated {
  constructor(form, most, attributes) {
    this.attributes = attributes;
    this.copies = form.corners.length / form.size;
    this.perItem = form.triangles.length;
    const corners = new Float32Array(most * form.corners.length), index = new Uint32Array(most * this.perItem);
    for (let item = 0; item < most; ++item) {
      corners.set(form.corners, item * form.corners.length);
      for (let i = 0; i < this.perItem; ++i) index[item * this.perItem + i] = item * this.copies + form.triangles[i];
    }
    this.geometry = new BufferGeometry();
    this.geometry.setIndex(new BufferAttribute(index, 1));
    this.geometry.setAttribute("corner", new BufferAttribute(corners, form.size));
    for (const [name, [, width]] of Object.entries(attributes)) {
      const attribute = new BufferAttribute(new Float32Array(most * this.copies * width), width);
      this.geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
    }
  }

  /** Takes the numbers of the first `count` items. */
  update(count) {
    for (const [name, [array, width]] of Object.entries(this.attributes)) {
      const attribute = this.geometry.attributes[name];
      spread(array, width, this.copies, attribute.array, count);
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, count * this.copies * width);
      attribute.needsUpdate = true;
    }
    this.geometry.setDrawRange(0, count * this.perItem);
  }
}

export function repeated(form, count, attributes) {
  const made = new Repeated(form, count, attributes);
  made.update(count);
  return made.geometry;
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

/** Discs and capsules: [{pose, ax, ay, bx, by, radius, fill, edge, isBody}]. The outline is a distance, which is
 * smooth at every size; a radius shows how a disc turns. */
export function capsules(list, uniforms, order) {
  const ends = new Float32Array(4 * list.length), radius = new Float32Array(list.length);
  const pose = new Float32Array(list.length), fill = new Float32Array(3 * list.length);
  const edge = new Float32Array(3 * list.length);
  list.forEach((item, i) => {
    ends.set([item.ax, item.ay, item.bx, item.by], 4 * i);
    radius[i] = item.radius;
    pose[i] = item.pose;
    fill.set(item.fill, 3 * i);
    edge.set(item.edge, 3 * i);
  });
  const geometry = repeated(QUAD, list.length, {
    ends: [ends, 4], radius: [radius, 1], pose: [pose, 1], fill: [fill, 3], edge: [edge, 3] });
  return layer(geometry, uniforms, `
in vec2 corner; in vec4 ends; in float radius; in float pose; in vec3 fill; in vec3 edge;
out vec2 at; out float halfLength; out float size; out vec3 inside; out vec3 border; out float isDisc; out float unit;
void main() {
  vec2 along = ends.zw - ends.xy;
  halfLength = 0.5 * length(along);
  isDisc = halfLength < 1e-6 * radius ? 1.0 : 0.0;
  vec2 u = isDisc > 0.5 ? vec2(1.0, 0.0) : normalize(along);
  size = max(radius, 0.75 * pixel);
  unit = pixel;
  at = corner * (vec2(halfLength, 0.0) + size + 0.5 * pixel);
  inside = picked == pose ? pickedColour : fill;
  border = edge;
  vec2 local = 0.5 * (ends.xy + ends.zw) + at.x * u + at.y * vec2(-u.y, u.x);
  gl_Position = projectionMatrix * viewMatrix * vec4(inScene(pose, local), 1.0);
}`, `
in vec2 at; in float halfLength; in float size; in vec3 inside; in vec3 border; in float isDisc; in float unit;
void main() {
  vec2 q = vec2(max(abs(at.x) - halfLength, 0.0), at.y);
  float d = length(q) - size;
  float cover = clamp(0.5 - d / unit, 0.0, 1.0);
  float width = min(1.3 * unit, 0.22 * size);
  float isEdge = clamp(0.5 + (d + width) / unit, 0.0, 1.0);
  if (isDisc > 0.5 && at.x > 0.0) {
    float mark = clamp(0.5 + (0.5 * width - abs(at.y)) / unit, 0.0, 1.0);
    isEdge = max(isEdge, 0.75 * mark * clamp(size / unit / 3.0 - 1.0, 0.0, 1.0));
  }
  paint = vec4(mix(inside, border, isEdge), cover);
}`, order);
}

/** Discs of a few pixels, as capsules() has them but as points, which end where their middle leaves the picture. */
export function smallDiscs(list, uniforms, order) {
  const at = new Float32Array(2 * list.length), radius = new Float32Array(list.length);
  const pose = new Float32Array(list.length), fill = new Float32Array(3 * list.length);
  const edge = new Float32Array(3 * list.length);
  list.forEach((item, i) => {
    at.set([item.ax, item.ay], 2 * i);
    radius[i] = item.radius;
    pose[i] = item.pose;
    fill.set(item.fill, 3 * i);
    edge.set(item.edge, 3 * i);
  });
  const geometry = new BufferGeometry();
  const attributes = { at: [at, 2], radius: [radius, 1], pose: [pose, 1], fill: [fill, 3], edge: [edge, 3] };
  for (const [name, [array, width]] of Object.entries(attributes)) {
    geometry.setAttribute(name, new BufferAttribute(array, width));
  }
  geometry.setDrawRange(0, list.length);
  return layer(geometry, uniforms, `
in vec2 at; in float radius; in float pose; in vec3 fill; in vec3 edge;
out float size; out vec3 inside; out vec3 border;
void main() {
  size = max(radius / pixel, 0.75);
  inside = picked == pose ? pickedColour : fill;
  border = edge;
  vec3 place = placeOf(pose);
  if (at != vec2(0.0)) place += turned(pose, vec3(at, 0.0));
  gl_Position = projectionMatrix * eye(place, vec2(0.0));
  gl_PointSize = density * (2.0 * size + 1.0);
}`, `
in float size; in vec3 inside; in vec3 border;
void main() {
  float d = length((2.0 * gl_PointCoord - 1.0) * (size + 0.5)) - size;
  float isEdge = clamp(0.5 + d + min(1.3, 0.22 * size), 0.0, 1.0);
  paint = vec4(mix(inside, border, isEdge), clamp(0.5 - d, 0.0, 1.0));
}`, order, false, false, Points);
}

/** Filled triangles: [{pose, points, colour, triangles}]; without `triangles` three points each. */
export function fills(list, uniforms, order) {
  const count = list.reduce((sum, item) => sum + item.points.length / 2, 0);
  const at = new Float32Array(2 * count), pose = new Float32Array(count), colour = new Float32Array(3 * count);
  const index = [];
  let next = 0;
  for (const item of list) {
    at.set(item.points, 2 * next);
    for (let i = 0; i < (item.triangles ?? item.points).length / (item.triangles ? 1 : 2); ++i) {
      index.push(next + (item.triangles ? item.triangles[i] : i));
    }
    for (let i = 0; i < item.points.length / 2; ++i, ++next) {
      pose[next] = item.pose;
      colour.set(item.colour, 3 * next);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("at", new BufferAttribute(at, 2));
  geometry.setAttribute("pose", new BufferAttribute(pose, 1));
  geometry.setAttribute("colour", new BufferAttribute(colour, 3));
  geometry.setIndex(new BufferAttribute(Uint32Array.from(index), 1));
  return layer(geometry, uniforms, `
in vec2 at; in float pose; in vec3 colour;
out vec3 inside;
void main() {
  inside = picked == pose ? pickedColour : colour;
  gl_Position = projectionMatrix * viewMatrix * vec4(inScene(pose, at), 1.0);
}`, `
in vec3 inside;
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
out float beside; out float half_; out vec3 inside;
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
in float beside; in float half_; in vec3 inside;
void main() { paint = vec4(inside, clamp(half_ + 0.5 - abs(beside), 0.0, 1.0)); }`, order, false, isHidden);
}

/** Marks of a size in pixels, whose number may change: discs (0), rings (1), squares (2), circles (3). */
export class Marks {
  constructor(most, uniforms, order, isHidden = false) {
    this.at = new Float32Array(3 * most);
    this.pose = new Float32Array(most);
    this.look = new Float32Array(2 * most); // size, form
    this.colour = new Float32Array(4 * most);
    this.count = 0;
    this.all = new Repeated(QUAD, most, {
      at: [this.at, 3], pose: [this.pose, 1], look: [this.look, 2], colour: [this.colour, 4] });
    this.mesh = layer(this.all.geometry, uniforms, `
in vec2 corner; in vec3 at; in float pose; in vec2 look; in vec4 colour;
out vec2 place; out float size; out float form; out vec4 inside;
void main() {
  size = look.x; form = look.y;
  inside = picked == pose && pose > 0.5 ? vec4(pickedColour, 1.0) : colour;
  place = corner * (size + 1.0);
  gl_Position = projectionMatrix * eye(inScene(pose, at), place);
}`, `
in vec2 place; in float size; in float form; in vec4 inside;
void main() {
  float d = (form == 2.0 ? max(abs(place.x), abs(place.y)) : length(place)) - size;
  float cover = clamp(0.5 - d, 0.0, 1.0);
  float isEdge = clamp(2.0 + d, 0.0, 1.0);
  if (form == 3.0) { paint = vec4(inside.rgb, inside.a * cover * isEdge); return; }
  vec3 colour = form == 1.0 ? mix(vec3(1.0), inside.rgb, isEdge) : mix(inside.rgb, inside.rgb * 0.55, isEdge);
  paint = vec4(colour, inside.a * cover);
}`, order, false, isHidden);
  }

  clear() { this.count = 0; }

  /** at: of two numbers, or three. */
  add(pose, at, size, form, colour, opacity = 1) {
    const i = this.count++;
    this.at[3 * i] = at[0];
    this.at[3 * i + 1] = at[1];
    this.at[3 * i + 2] = at[2] ?? 0;
    this.pose[i] = pose;
    this.look[2 * i] = size;
    this.look[2 * i + 1] = form;
    this.colour.set(colour, 4 * i);
    this.colour[4 * i + 3] = opacity;
  }

  update() {
    this.all.update(this.count);
    this.mesh.visible = this.count > 0;
  }
}
