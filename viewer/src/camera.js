// The view: a parallel projection, so that lengths and arrows have one scale everywhere. It has a middle, a scale and a
// direction. The plane is seen from in front, x to the right and y up; in space the direction may turn.

import { Matrix4, OrthographicCamera } from "three";
import { dot } from "./vectors.js";

const STEP = 1.0015;
const TURN = 0.008; // radians a pixel
const AT_FIRST = [-0.6, 0.42]; // azimuth and elevation of the view in space [rad]

export class Camera {
  /** scene: has bounds, [x, y, z, x, y, z] of what is seen at first; frame, directions right, up and to the viewer,
   * seen from in front; depth, how far before and behind its middle anything is [m]; inSpace. */
  constructor(canvas, scene, changed) {
    Object.assign(this, { canvas, scene, changed });
    this.three = new OrthographicCamera();
    this.middle = [0, 0, 0];
    this.scale = 1; // [pixels/m]
    this.azimuth = this.elevation = 0;
    this.follows = () => null; // place of what is followed
    this.last = null;
    this.aim();
    this.resize();
    this.fit();
    this.listen();
  }

  /** Takes the size of the canvas; to ask for it in every picture would have the browser lay out the page each time. */
  resize() {
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
  }

  /** Seen from in front, or in space, where dragging turns the view. */
  show() {
    [this.azimuth, this.elevation] = this.scene.inSpace ? AT_FIRST : [0, 0];
    this.aim();
    this.fit();
  }

  /** Directions of the picture from the angles. */
  aim() {
    const [right, up, back] = this.scene.frame;
    const [c, s] = [Math.cos(this.azimuth), Math.sin(this.azimuth)];
    const [d, e] = [Math.cos(this.elevation), Math.sin(this.elevation)];
    const level = right.map((_, i) => c * back[i] + s * right[i]); // to the viewer, without elevation
    this.right = right.map((_, i) => c * right[i] - s * back[i]);
    this.up = up.map((_, i) => d * up[i] - e * level[i]);
    this.back = up.map((_, i) => d * level[i] + e * up[i]);
  }

  fit() {
    const { bounds } = this.scene;
    const corners = Array.from({ length: 8 }, (_, i) => [0, 1, 2].map((k) => bounds[(i >> k) & 1 ? k + 3 : k]));
    const span = (axis) => {
      const along = corners.map((corner) => dot(corner, axis));
      return Math.max(...along) - Math.min(...along);
    };
    this.middle = [0, 1, 2].map((k) => 0.5 * (bounds[k] + bounds[k + 3]));
    this.scale = 0.92 * Math.min(this.width / span(this.right), this.height / span(this.up));
    this.last = null;
    this.changed();
  }

  listen() {
    const { canvas } = this;
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(event.offsetX, event.offsetY, STEP ** -event.deltaY);
    }, { passive: false });
    const fingers = new Map(); // pixels of those that touch
    const lift = (event) => fingers.delete(event.pointerId);
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      if (event.pointerType === "touch") fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    });
    canvas.addEventListener("pointerup", lift);
    canvas.addEventListener("pointercancel", lift);
    canvas.addEventListener("contextmenu", (event) => { if (this.scene.inSpace) event.preventDefault(); });
    canvas.addEventListener("pointermove", (event) => {
      const { inSpace } = this.scene;
      if (fingers.size > 1) return this.pinch(fingers, event);
      if (fingers.size) fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
      if (inSpace && !event.shiftKey && event.buttons & 1) this.orbit(-TURN * event.movementX, TURN * event.movementY);
      else if (event.buttons & (inSpace ? 3 : 1)) this.move(-event.movementX, event.movementY);
    });
  }

  /** Scales about a pixel. */
  zoom(px, py, factor) {
    const under = this.sceneAt(px, py);
    this.scale *= factor;
    this.middle = this.middle.map((value, k) => under[k] - (under[k] - value) / factor);
    this.changed();
  }

  /** Moves and scales with two fingers, of which one has moved: what was between them stays there. */
  pinch(fingers, event) {
    if (!fingers.has(event.pointerId)) return;
    const span = ([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]);
    const between = ([a, b]) => [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    const before = [...fingers.values()].slice(0, 2);
    fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    const now = [...fingers.values()].slice(0, 2), [from, to] = [between(before), between(now)];
    this.move(from[0] - to[0], to[1] - from[1]);
    if (span(before) > 0 && span(now) > 0) this.zoom(...to, span(now) / span(before));
  }

  orbit(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.min(Math.max(this.elevation + elevation, -0.5 * Math.PI), 0.5 * Math.PI);
    this.aim();
    this.changed();
  }

  /** Moves the middle by pixels, to the right and up. */
  move(right, up) {
    this.middle = this.middle.map((value, k) => value + (right * this.right[k] + up * this.up[k]) / this.scale);
    this.changed();
  }

  /** Moves along with what is followed. */
  follow() {
    const now = this.follows();
    if (now && this.last) this.middle = this.middle.map((value, k) => value + now[k] - this.last[k]);
    else if (now) this.middle = [...now];
    this.last = now;
  }

  /** Point of the scene [m] at a pixel of the canvas, as deep as the middle. */
  sceneAt(px, py) {
    const right = (px - 0.5 * this.width) / this.scale, up = (0.5 * this.height - py) / this.scale;
    return this.middle.map((value, k) => value + right * this.right[k] + up * this.up[k]);
  }

  /** Pixel of the canvas at a point of the scene. */
  pixelAt(x, y, z = 0) {
    const from = [x - this.middle[0], y - this.middle[1], z - this.middle[2]];
    return [0.5 * this.width + dot(from, this.right) * this.scale, 0.5 * this.height - dot(from, this.up) * this.scale];
  }

  update() {
    const wide = 0.5 * this.width / this.scale, high = 0.5 * this.height / this.scale;
    const { three, right, up, back } = this, { depth } = this.scene;
    // What is near is never cut off, however close the middle was moved to it.
    Object.assign(three, { left: -wide, right: wide, top: high, bottom: -high, near: -depth, far: depth });
    three.quaternion.setFromRotationMatrix(new Matrix4().set(
      right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0, 0, 0, 0, 1));
    three.position.set(...this.middle);
    three.updateProjectionMatrix();
    three.updateMatrixWorld();
  }
}
