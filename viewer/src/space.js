// What is seen in space: solids, the light on them, and what it does not reach.

import {
  DepthTexture, LessEqualCompare, LinearFilter, Matrix4, OrthographicCamera, UnsignedIntType, Vector3, WebGLRenderTarget,
} from "three";
import { Rays } from "./rays.js";
import { CASTS, meshes, planes, rounds } from "./solid_layers.js";
import { plain } from "./solids.js";
import { plus, unit } from "./vectors.js";

const SHADOWS = 1024; // texels across
const TO_TEXTURE = new Matrix4().set(0.5, 0, 0, 0.5, 0, 0.5, 0, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0, 1);

/** A round length: 1, 2 or 5 times a power of ten, at most `rough`. */
export function roundLength(rough) {
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * [5, 2, 1].find((factor) => factor * power <= rough);
}

export class Space {
  /** bounds and frame: as of the camera. fill: colour of a pose. */
  constructor(three, solids, uniforms, fill, bounds, [right, up, back]) {
    const middle = [0, 1, 2].map((k) => 0.5 * (bounds[k] + bounds[k + 3]));
    const reach = 0.5 * Math.hypot(...[0, 1, 2].map((k) => bounds[k + 3] - bounds[k]));
    const all = plain(solids).map((solid) => ({ ...solid, fill: fill(solid.pose) }));
    this.depth = 40 * reach;
    this.rays = new Rays(all);
    const towards = unit(plus(plus(up, 0.45, back), -0.4, right));
    this.camera = new OrthographicCamera(-reach, reach, reach, -reach, 0, 4 * reach);
    this.camera.layers.set(CASTS);
    this.camera.up.set(...right);
    this.camera.position.set(...plus(middle, 2 * reach, towards));
    this.camera.lookAt(new Vector3(...middle));
    this.camera.updateMatrixWorld();
    this.target = new WebGLRenderTarget(SHADOWS, SHADOWS);
    const depth = new DepthTexture(SHADOWS, SHADOWS, UnsignedIntType);
    depth.compareFunction = LessEqualCompare;
    depth.minFilter = depth.magFilter = LinearFilter;
    this.target.depthTexture = depth;
    Object.assign(uniforms, {
      light: { value: new Vector3(...towards) }, shadows: { value: depth }, shadowBias: { value: (3 * reach) / SHADOWS },
      toShadow: { value: TO_TEXTURE.clone().multiply(this.camera.projectionMatrix).multiply(this.camera.matrixWorldInverse) },
      toScene: { value: new Matrix4() },
    });
    this.uniforms = uniforms;
    const of = (...kinds) => all.filter(({ kind }) => kinds.includes(kind));
    this.meshes = [
      rounds(of("capsule", "cylinder"), uniforms), meshes(of("mesh"), uniforms),
      planes(of("plane"), middle, 4 * reach, roundLength(0.5 * reach), uniforms)];
    three.add(...this.meshes);
  }

  /** Pose of what is met first by the ray to the viewer, in a direction, that goes through a point; -1: nothing. */
  poseAlong(poses, point, back) {
    return this.rays.poseAt(poses, plus(point, this.depth, back), back.map((value) => -value));
  }

  get visible() { return this.meshes[0].visible; }

  set visible(on) { for (const mesh of this.meshes) mesh.visible = on; }

  /** Draws what the light meets first. */
  drawShadows(renderer, three) {
    const { shadows } = this.uniforms, depth = shadows.value;
    shadows.value = null; // nothing may be read while it is drawn
    renderer.setRenderTarget(this.target);
    renderer.render(three, this.camera);
    renderer.setRenderTarget(null);
    shadows.value = depth;
  }
}
