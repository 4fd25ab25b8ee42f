// Contacts of a sample: a mark at each, and an arrow that is its impulse. Two texels of a texture have all of one that
// the shaders need, and are filled where another sample is shown: pictures between two samples cost nothing for them.

import { BufferAttribute, BufferGeometry, DataTexture, FloatType, NearestFilter, Points, RGBAFormat } from "three";
import { layer } from "./layers.js";
import { cross, dot, plus, unit } from "./vectors.js";

const PER_ROW = 256;
const MANY = 3000; // contacts of a sample from which on mark and arrow are one triangle

/** Triangles of a form of `corners` corners for each of so many items: vertex i is corner i % corners of an item. */
function repeated(corners, triangles, most) {
  const index = new Uint32Array(most * triangles.length);
  for (let item = 0, at = 0; item < most; ++item) {
    for (const corner of triangles) index[at++] = item * corners + corner;
  }
  const geometry = new BufferGeometry();
  geometry.setIndex(new BufferAttribute(index, 1));
  return geometry;
}

/** A tangent of the contacts in space: along the axis that is least aligned with the normal; (it, second, normal) is
 * right-handed. */
function tangent(normal) {
  const [x, y, z] = normal.map(Math.abs);
  const axis = x <= y && x <= z ? [1, 0, 0] : y <= z ? [0, 1, 0] : [0, 0, 1];
  return unit(plus(axis, -dot(axis, normal), normal));
}

/** Impulse of a contact in the scene [N s], from parts along the normal and one or two tangents: in the plane the
 * tangent is the normal turned clockwise. */
function putImpulse({ dimension, contact_normal: normals, contact_impulse: impulses }, i, to, at) {
  if (dimension === 2) {
    const x = normals[2 * i], y = normals[2 * i + 1], along = impulses[2 * i], across = impulses[2 * i + 1];
    to[at] = along * x + across * y;
    to[at + 1] = along * y - across * x;
    return;
  }
  const n = [...normals.subarray(3 * i, 3 * i + 3)], t = tangent(n), second = cross(n, t);
  for (let k = 0; k < 3; ++k) {
    to[at + k] = impulses[3 * i] * n[k] + impulses[3 * i + 1] * t[k] + impulses[3 * i + 2] * second[k];
  }
}

const CONTACT = (corners, colours) => `
precision highp sampler2D;
uniform sampler2D contacts; // two texels of each: point and number of its colour, impulse
uniform vec3 contactColours[${colours}]; // of the modes, and of an impact
flat out vec3 inside;
vec4 contact(int texel) {
  int item = gl_VertexID / ${corners};
  return texelFetch(contacts, ivec2(2 * (item % ${PER_ROW}) + texel, item / ${PER_ROW}), 0);
}
vec3 colourOf(float number) { return contactColours[int(number + 0.5)]; }
`;

const ARROW = `
uniform float arrowScale;
// Direction and length [pixels] of an impulse in the picture.
vec2 arrow(vec3 impulse, out float span) {
  vec2 seen = (viewMatrix * vec4(impulse, 0.0)).xy * arrowScale;
  span = length(seen) / pixel;
  return span > 0.0 ? seen / (span * pixel) : vec2(0.0);
}
`;

export class Contacts {
  /** colours: of the modes in their order, and of an impact. */
  constructor(recording, colours, uniforms, order) {
    const ends = recording.contact_ends;
    let most = 0;
    for (let i = 0; i < ends.length; ++i) most = Math.max(most, ends[i] - (i ? ends[i - 1] : 0));
    const height = Math.max(1, Math.ceil(most / PER_ROW));
    this.recording = recording;
    this.impact = colours.length - 1;
    this.numbers = new Float32Array(8 * PER_ROW * height);
    this.texture = new DataTexture(this.numbers, 2 * PER_ROW, height, RGBAFormat, FloatType);
    this.texture.minFilter = this.texture.magFilter = NearestFilter;
    this.dotSize = { value: 1 };
    const own = {
      ...uniforms, dotSize: this.dotSize, contacts: { value: this.texture },
      contactColours: { value: Float32Array.from(colours.flat()) },
    };
    this.meshes = most > MANY ? [needles(most, colours.length, own, order)]
      : [dots(most, colours.length, own, order), arrows(most, colours.length, own, order + 1)];
    this.texture.needsUpdate = true;
    this.show(0, 0);
  }

  /** Shows the contacts [first, end) of the recording. */
  show(first, end) {
    const { numbers, recording, impact } = this;
    const { dimension, contact_point: points, contact_mode: modes, contact_impact: impacts } = recording;
    for (let i = first, at = 0; i < end; ++i, at += 8) {
      for (let k = 0; k < dimension; ++k) numbers[at + k] = points[dimension * i + k];
      numbers[at + 3] = impacts[i] ? impact : modes[i];
      putImpulse(recording, i, numbers, at + 4);
    }
    if (end > first) this.texture.needsUpdate = true;
    for (const mesh of this.meshes) {
      mesh.geometry.setDrawRange(0, (end - first) * mesh.userData.perItem);
      mesh.visible = end > first;
    }
  }
}

/** Discs whose radius is `dotSize` pixels. */
function dots(most, colours, uniforms, order) {
  const mesh = layer(repeated(1, [0], most), uniforms, `
uniform float dotSize;
${CONTACT(1, colours)}
flat out float size;
void main() {
  vec4 point = contact(0);
  inside = colourOf(point.w);
  size = dotSize;
  gl_Position = projectionMatrix * eye(point.xyz, vec2(0.0));
  gl_PointSize = density * 2.0 * (size + 1.0);
}`, `
flat in vec3 inside; flat in float size;
void main() {
  float d = length((2.0 * gl_PointCoord - 1.0) * (size + 1.0)) - size;
  paint = vec4(mix(inside, inside * 0.55, clamp(2.0 + d, 0.0, 1.0)), clamp(0.5 - d, 0.0, 1.0));
}`, order, false, false, Points);
  mesh.userData.perItem = 1;
  return mesh;
}

/** Impulses on the body that the name of the contact has first, in the scene; none where it is zero. */
function arrows(most, colours, uniforms, order) {
  // A corner: along the arrow (0: foot, 1: head), along the head (0: its base, 1: its tip), across [pixels].
  const triangles = [0, 1, 2, 0, 2, 3, 4, 5, 6];
  const mesh = layer(repeated(7, triangles, most), uniforms, `
${CONTACT(7, colours)}
${ARROW}
const vec3 corners[7] = vec3[7](vec3(0, 0, -0.9), vec3(1, 0, -0.9), vec3(1, 0, 0.9), vec3(0, 0, 0.9),
                                vec3(1, 0, -4), vec3(1, 1, 0), vec3(1, 0, 4));
void main() {
  vec4 point = contact(0);
  vec3 corner = corners[gl_VertexID % 7];
  float span;
  vec2 u = arrow(contact(1).xyz, span);
  float head = min(9.0, 0.6 * span);
  float along = corner.x * (span - head) + corner.y * head;
  float across = corner.z * (corner.x > 0.5 && abs(corner.z) > 1.0 ? head / 9.0 : 1.0);
  inside = colourOf(point.w);
  gl_Position = projectionMatrix * eye(point.xyz, along * u + across * vec2(-u.y, u.x));
}`, `
flat in vec3 inside;
void main() { paint = vec4(inside, 1.0); }`, order);
  mesh.userData.perItem = triangles.length;
  return mesh;
}

/** Mark and impulse of a contact as one triangle, as wide as the mark at its foot: of very many contacts, as software
 * takes its time for each triangle. */
function needles(most, colours, uniforms, order) {
  const mesh = layer(repeated(3, [0, 1, 2], most), uniforms, `
uniform float dotSize;
${CONTACT(3, colours)}
${ARROW}
const vec2 corners[3] = vec2[3](vec2(-0.5, -0.87), vec2(1, 0), vec2(-0.5, 0.87));
void main() {
  vec4 point = contact(0);
  float span;
  vec2 u = arrow(contact(1).xyz, span), corner = 1.6 * dotSize * corners[gl_VertexID % 3];
  if (u == vec2(0.0)) u = vec2(0.0, 1.0);
  if (corner.x > 0.0) corner.x = max(corner.x, span);
  inside = colourOf(point.w);
  gl_Position = projectionMatrix * eye(point.xyz, corner.x * u + corner.y * vec2(-u.y, u.x));
}`, `
flat in vec3 inside;
void main() { paint = vec4(inside, 1.0); }`, order);
  mesh.userData.perItem = 3;
  return mesh;
}
