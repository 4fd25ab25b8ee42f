// The view of a planar scene: its middle and how many pixels a metre has. Dragging moves it, the wheel scales it.

import { OrthographicCamera } from "three";

const STEP = 1.0015;

export class PlanarCamera {
  constructor(canvas, bounds, changed) {
    this.canvas = canvas;
    this.bounds = bounds;
    this.changed = changed;
    this.three = new OrthographicCamera();
    this.x = this.y = 0;
    this.scale = 1; // [pixels/m]
    this.follows = () => null; // place of what is followed
    this.last = null;
    this.resize();
    this.fit();
    this.listen();
  }

  /** Takes the size of the canvas; to ask for it in every picture would have the browser lay out the page each time. */
  resize() {
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
  }

  fit() {
    const [left, low, right, high] = this.bounds;
    this.x = 0.5 * (left + right);
    this.y = 0.5 * (low + high);
    this.scale = 0.92 * Math.min(this.width / (right - left), this.height / (high - low));
    this.last = null;
    this.changed();
  }

  listen() {
    const { canvas } = this;
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const [x, y] = this.sceneAt(event.offsetX, event.offsetY);
      const factor = STEP ** -event.deltaY;
      this.scale *= factor;
      this.x = x - (x - this.x) / factor;
      this.y = y - (y - this.y) / factor;
      this.changed();
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      if (!(event.buttons & 1)) return;
      this.x -= event.movementX / this.scale;
      this.y += event.movementY / this.scale;
      this.changed();
    });
  }

  /** Moves along with what is followed. */
  follow() {
    const now = this.follows();
    if (now && this.last) {
      this.x += now[0] - this.last[0];
      this.y += now[1] - this.last[1];
    } else if (now) {
      [this.x, this.y] = now;
    }
    this.last = now;
  }

  /** Point of the scene [m] at a pixel of the canvas. */
  sceneAt(px, py) {
    return [this.x + (px - 0.5 * this.width) / this.scale, this.y - (py - 0.5 * this.height) / this.scale];
  }

  /** Pixel of the canvas at a point of the scene. */
  pixelAt(x, y) {
    return [0.5 * this.width + (x - this.x) * this.scale, 0.5 * this.height - (y - this.y) * this.scale];
  }

  update() {
    const wide = 0.5 * this.width / this.scale, high = 0.5 * this.height / this.scale;
    const three = this.three;
    Object.assign(three, { left: -wide, right: wide, top: high, bottom: -high, near: -1, far: 1 });
    three.position.set(this.x, this.y, 0);
    three.updateProjectionMatrix();
    three.updateMatrixWorld();
  }
}
