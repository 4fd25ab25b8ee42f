// Contacts of a sample: a mark at each, and an arrow that is its impulse. Their numbers are copied as they stand in the
// recording into textures, from which the shaders take those of an item: a frame costs no loop over contacts.

import {
  BufferAttribute, BufferGeometry, DataTexture, FloatType, NearestFilter, Points, RedFormat, RGBFormat, RGFormat,
  UnsignedByteType,
} from "three";
import { layer } from "./layers.js";

const PER_ROW = 256;
const MANY = 3000; // contacts of a sample from which on mark and arrow are one triangle
const FORMATS = { 1: RedFormat, 2: RGFormat, 3: RGBFormat };

/** Numbers of the contacts that are shown, `width` of each. */
class Column {
  constructor(all, width, most) {
    const height = Math.max(1, Math.ceil(most / PER_ROW));
    this.all = all;
    this.width = width;
    this.shown = new all.constructor(PER_ROW * height * width);
    this.texture = new DataTexture(this.shown, PER_ROW, height, FORMATS[width],
      all instanceof Uint8Array ? UnsignedByteType : FloatType);
    if (width === 3) this.texture.internalFormat = "RGB32F";
    this.texture.minFilter = this.texture.magFilter = NearestFilter;
    this.texture.needsUpdate = true;
  }

  show(first, end) {
    this.shown.set(this.all.subarray(this.width * first, this.width * end));
    this.texture.needsUpdate = true;
  }
}

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

// Impulses are along the normal and one or two tangents. In the plane the tangent is the normal turned clockwise; in
// space the first lies along the axis least aligned with the normal, and (t1, t2, n) is right-handed.
const IMPULSE = {
  2: "vec3 impulseInScene(vec3 n, vec3 p) { return p.x * n + p.y * vec3(n.y, -n.x, 0.0); }",
  3: `vec3 impulseInScene(vec3 n, vec3 p) {
  vec3 size = abs(n);
  vec3 axis = size.x <= size.y && size.x <= size.z ? vec3(1, 0, 0) : size.y <= size.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
  vec3 t = normalize(axis - dot(axis, n) * n);
  return p.x * n + p.y * t + p.z * cross(n, t);
}`,
};

const ARROWS = (dimension) => `
uniform float arrowScale;
${IMPULSE[dimension]}
// Direction and length [pixels] of the impulse of a contact in the picture.
vec2 arrow(ivec2 at, out float span) {
  vec3 n = texelFetch(contactNormals, at, 0).xyz, impulse = texelFetch(contactImpulses, at, 0).xyz;
  vec2 seen = (viewMatrix * vec4(impulseInScene(n, impulse), 0.0)).xy * arrowScale;
  span = length(seen) / pixel;
  return span > 0.0 ? seen / (span * pixel) : vec2(0.0);
}
`;

const COLUMNS = (corners, colours) => `
precision highp sampler2D;
uniform sampler2D contactPoints, contactNormals, contactImpulses, contactModes, contactImpacts;
uniform vec3 contactColours[${colours}]; // of the modes, and of an impact
flat out vec3 inside;
ivec2 contact() { int item = gl_VertexID / ${corners}; return ivec2(item % ${PER_ROW}, item / ${PER_ROW}); }
vec3 colourOf(ivec2 at) {
  bool isImpact = texelFetch(contactImpacts, at, 0).r > 0.0;
  return contactColours[isImpact ? ${colours - 1} : int(255.0 * texelFetch(contactModes, at, 0).r + 0.5)];
}
`;

export class Contacts {
  /** colours: of the modes in their order, and of an impact. */
  constructor(recording, colours, uniforms, order) {
    const ends = recording.contact_ends;
    let most = 0;
    for (let i = 0; i < ends.length; ++i) most = Math.max(most, ends[i] - (i ? ends[i - 1] : 0));
    const column = (name, width) => new Column(recording[name], width, most), { dimension } = recording;
    this.columns = {
      contactPoints: column("contact_point", dimension), contactNormals: column("contact_normal", dimension),
      contactImpulses: column("contact_impulse", dimension), contactModes: column("contact_mode", 1),
      contactImpacts: column("contact_impact", 1),
    };
    this.dotSize = { value: 1 };
    const own = { ...uniforms, dotSize: this.dotSize, contactColours: { value: Float32Array.from(colours.flat()) } };
    for (const [name, { texture }] of Object.entries(this.columns)) own[name] = { value: texture };
    this.meshes = most > MANY ? [needles(most, colours.length, own, order, dimension)]
      : [dots(most, colours.length, own, order), arrows(most, colours.length, own, order + 1, dimension)];
    this.show(0, 0);
  }

  /** Shows the contacts [first, end) of the recording. */
  show(first, end) {
    if (end > first) for (const column of Object.values(this.columns)) column.show(first, end);
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
${COLUMNS(1, colours)}
flat out float size;
void main() {
  ivec2 at = contact();
  inside = colourOf(at);
  size = dotSize;
  gl_Position = projectionMatrix * eye(texelFetch(contactPoints, at, 0).xyz, vec2(0.0));
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
function arrows(most, colours, uniforms, order, dimension) {
  // A corner: along the arrow (0: foot, 1: head), along the head (0: its base, 1: its tip), across [pixels].
  const triangles = [0, 1, 2, 0, 2, 3, 4, 5, 6];
  const mesh = layer(repeated(7, triangles, most), uniforms, `
${COLUMNS(7, colours)}
${ARROWS(dimension)}
const vec3 corners[7] = vec3[7](vec3(0, 0, -0.9), vec3(1, 0, -0.9), vec3(1, 0, 0.9), vec3(0, 0, 0.9),
                                vec3(1, 0, -4), vec3(1, 1, 0), vec3(1, 0, 4));
void main() {
  ivec2 at = contact();
  vec3 corner = corners[gl_VertexID % 7];
  float span;
  vec2 u = arrow(at, span);
  float head = min(9.0, 0.6 * span);
  float along = corner.x * (span - head) + corner.y * head;
  float across = corner.z * (corner.x > 0.5 && abs(corner.z) > 1.0 ? head / 9.0 : 1.0);
  inside = colourOf(at);
  gl_Position = projectionMatrix * eye(texelFetch(contactPoints, at, 0).xyz, along * u + across * vec2(-u.y, u.x));
}`, `
flat in vec3 inside;
void main() { paint = vec4(inside, 1.0); }`, order);
  mesh.userData.perItem = triangles.length;
  return mesh;
}

/** Mark and impulse of a contact as one triangle, as wide as the mark at its foot: of very many contacts, as software
 * takes its time for each triangle. */
function needles(most, colours, uniforms, order, dimension) {
  const mesh = layer(repeated(3, [0, 1, 2], most), uniforms, `
uniform float dotSize;
${COLUMNS(3, colours)}
${ARROWS(dimension)}
const vec2 corners[3] = vec2[3](vec2(-0.5, -0.87), vec2(1, 0), vec2(-0.5, 0.87));
void main() {
  ivec2 at = contact();
  float span;
  vec2 u = arrow(at, span), corner = 1.6 * dotSize * corners[gl_VertexID % 3];
  if (u == vec2(0.0)) u = vec2(0.0, 1.0);
  if (corner.x > 0.0) corner.x = max(corner.x, span);
  inside = colourOf(at);
  gl_Position = projectionMatrix * eye(texelFetch(contactPoints, at, 0).xyz, corner.x * u + corner.y * vec2(-u.y, u.x));
}`, `
flat in vec3 inside;
void main() { paint = vec4(inside, 1.0); }`, order);
  mesh.userData.perItem = 3;
  return mesh;
}
