// Poses of everything that is drawn, as a texture: all shaders read places and rotations from it, so a frame
// changes one texture and nothing else. Two texels a pose: place, and rotation as a quaternion; a model in space
// needs another filling, no other shaders.

import { DataTexture, FloatType, NearestFilter, RGBAFormat } from "three";

const PER_ROW = 512;

export class Poses {
  constructor(recording) {
    this.recording = recording;
    this.bodies = recording.bodies.length;
    this.count = 1 + this.bodies + recording.obstacles.length;
    this.numbers = new Float32Array(PER_ROW * 8 * Math.ceil(this.count / PER_ROW));
    this.texture = new DataTexture(
      this.numbers, 2 * PER_ROW, Math.ceil(this.count / PER_ROW), RGBAFormat, FloatType);
    this.texture.minFilter = this.texture.magFilter = NearestFilter;
    this.flat = new Float64Array(3 * this.count); // x, y, angle
    this.bodyPoses = Int32Array.from({ length: this.bodies }, (_, i) => i + 1);
    this.movedPoses = Int32Array.from(
      recording.moved, (serial) => recording.obstacles.find((obstacle) => obstacle.serial === serial).pose);
    for (let i = 0; i < this.count; ++i) this.set(i, 0, 0, 0);
    recording.obstacles.forEach(({ pose }, i) => this.set(pose, ...recording.places.slice(3 * i, 3 * i + 3)));
  }

  set(pose, x, y, angle) {
    const at = 8 * pose;
    const numbers = this.numbers;
    numbers[at] = x;
    numbers[at + 1] = y;
    numbers[at + 6] = Math.sin(0.5 * angle);
    numbers[at + 7] = Math.cos(0.5 * angle);
    this.flat[3 * pose] = x;
    this.flat[3 * pose + 1] = y;
    this.flat[3 * pose + 2] = angle;
  }

  /** Poses between two samples: at `fraction` of the way from one to the next. */
  fill(sample, fraction) {
    const { positions, ground, times } = this.recording;
    const next = Math.min(sample + 1, times.length - 1);
    this.mix(positions, this.bodyPoses, sample, next, fraction);
    this.mix(ground, this.movedPoses, sample, next, fraction);
    this.texture.needsUpdate = true;
  }

  mix(array, poses, sample, next, fraction) {
    const count = poses.length;
    for (let i = 0, p = 3 * count * sample, q = 3 * count * next; i < count; ++i, p += 3, q += 3) {
      this.set(
        poses[i],
        array[p] + fraction * (array[q] - array[p]),
        array[p + 1] + fraction * (array[q + 1] - array[p + 1]),
        array[p + 2] + fraction * (array[q + 2] - array[p + 2]));
    }
  }

  x(pose) { return this.flat[3 * pose]; }
  y(pose) { return this.flat[3 * pose + 1]; }
  angle(pose) { return this.flat[3 * pose + 2]; }

  /** A point of the scene in the frame of a pose. */
  local(pose, x, y) {
    const c = Math.cos(this.angle(pose)), s = Math.sin(this.angle(pose));
    const dx = x - this.x(pose), dy = y - this.y(pose);
    return [c * dx + s * dy, c * dy - s * dx];
  }
}

export const POSE_SHADER = `
uniform highp sampler2D poses;
vec3 placeOf(float pose) {
  int i = int(pose + 0.5);
  return texelFetch(poses, ivec2(2 * (i % ${PER_ROW}), i / ${PER_ROW}), 0).xyz;
}
vec3 turned(float pose, vec3 v) {
  int i = int(pose + 0.5);
  vec4 q = texelFetch(poses, ivec2(2 * (i % ${PER_ROW}) + 1, i / ${PER_ROW}), 0);
  return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}
vec3 inScene(float pose, vec2 local) { return placeOf(pose) + turned(pose, vec3(local, 0.0)); }
`;
