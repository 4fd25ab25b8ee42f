// Marks of a size in pixels, whose number may change: ends of links, joints, particles, events. Each is one point.

import { DynamicDrawUsage, Points } from "three";
import { layer, vertices } from "./layers.js";

/** Forms: discs (0), rings (1), squares (2), circles (3). */
export class Marks {
  constructor(most, uniforms, order, isHidden = false) {
    this.at = new Float32Array(3 * most);
    this.pose = new Float32Array(most);
    this.look = new Float32Array(2 * most); // size, form
    this.colour = new Float32Array(4 * most);
    this.count = 0;
    this.geometry = vertices(0, { at: [this.at, 3], pose: [this.pose, 1], look: [this.look, 2], colour: [this.colour, 4] });
    for (const attribute of Object.values(this.geometry.attributes)) attribute.setUsage(DynamicDrawUsage);
    this.mesh = layer(this.geometry, uniforms, `
in vec3 at; in float pose; in vec2 look; in vec4 colour;
flat out float size; flat out float form; flat out vec4 inside;
void main() {
  size = look.x; form = look.y;
  inside = picked == pose && pose > 0.5 ? vec4(pickedColour, 1.0) : colour;
  gl_Position = projectionMatrix * eye(inScene(pose, at), vec2(0.0));
  gl_PointSize = density * 2.0 * (size + 1.0);
}`, `
flat in float size; flat in float form; flat in vec4 inside;
void main() {
  vec2 place = (2.0 * gl_PointCoord - 1.0) * (size + 1.0);
  float d = (form == 2.0 ? max(abs(place.x), abs(place.y)) : length(place)) - size;
  float cover = clamp(0.5 - d, 0.0, 1.0);
  float isEdge = clamp(2.0 + d, 0.0, 1.0);
  if (form == 3.0) { paint = vec4(inside.rgb, inside.a * cover * isEdge); return; }
  vec3 colour = form == 1.0 ? mix(vec3(1.0), inside.rgb, isEdge) : mix(inside.rgb, inside.rgb * 0.55, isEdge);
  paint = vec4(colour, inside.a * cover);
}`, order, false, isHidden, Points);
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
    for (const attribute of Object.values(this.geometry.attributes)) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, this.count * attribute.itemSize);
      attribute.needsUpdate = true;
    }
    this.geometry.setDrawRange(0, this.count);
    this.mesh.visible = this.count > 0;
  }
}
