// Poses of everything that is drawn, as a texture: all shaders read places and rotations from it, so a frame
// changes one texture and nothing else. Two texels a pose: place, and rotation as a quaternion. In the plane z is 0 and
// the rotation is about z.

import { DataTexture, FloatType, NearestFilter, RGBAFormat } from "three";

const PER_ROW = 512;

export class Poses {
  constructor(recording) {
    this.recording = recording;
    this.isSpatial = recording.dimension === 3;
    this.bodies = recording.bodies.length;
    this.count = 1 + this.bodies + recording.obstacles.length;
    this.numbers = new Float32Array(PER_ROW * 8 * Math.ceil(this.count / PER_ROW)); // x, y, z, 0, quaternion x, y, z, w
    this.texture = new DataTexture(
      this.numbers, 2 * PER_ROW, Math.ceil(this.count / PER_ROW), RGBAFormat, FloatType);
    this.texture.minFilter = this.texture.magFilter = NearestFilter;
    this.angles = new Float64Array(this.count); // of the plane
    this.bodyPoses = Int32Array.from({ length: this.bodies }, (_, i) => i + 1);
    this.movedPoses = Int32Array.from(
      recording.moved, (serial) => recording.obstacles.find((obstacle) => obstacle.serial === serial).pose);
    for (let i = 0; i < this.count; ++i) this.set(i, 0, 0, 0);
    recording.obstacles.forEach(({ pose }, i) => {
      const [x, y, third] = recording.places.slice(3 * i, 3 * i + 3);
      this.set(pose, x, y, this.isSpatial ? 0 : third);
      if (this.isSpatial) this.numbers[8 * pose + 2] = third;
    });
  }

  /** A pose in the plane. */
  set(pose, x, y, angle) {
    const at = 8 * pose;
    const numbers = this.numbers;
    numbers[at] = x;
    numbers[at + 1] = y;
    numbers[at + 6] = Math.sin(0.5 * angle);
    numbers[at + 7] = Math.cos(0.5 * angle);
    this.angles[pose] = angle;
  }

  /** Poses between two samples: at `fraction` of the way from one to the next. */
  fill(sample, fraction) {
    const { positions, orientations, ground, times } = this.recording;
    const next = Math.min(sample + 1, times.length - 1);
    if (this.isSpatial) {
      this.mixSpatial(positions, orientations, sample, next, fraction);
    } else {
      this.mix(positions, this.bodyPoses, sample, next, fraction);
    }
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

  /** Bodies in space: places on the straight way, orientations (w, x, y, z) on the shorter of the two great circles. */
  mixSpatial(positions, orientations, sample, next, fraction) {
    const { numbers, bodies } = this, turned = [0, 0, 0, 0];
    for (let i = 0, p = bodies * sample, q = bodies * next, at = 8; i < bodies; ++i, ++p, ++q, at += 8) {
      let cosine = 0, size = 0;
      for (let k = 0; k < 3; ++k) {
        numbers[at + k] = positions[3 * p + k] + fraction * (positions[3 * q + k] - positions[3 * p + k]);
      }
      for (let k = 0; k < 4; ++k) cosine += orientations[4 * p + k] * orientations[4 * q + k];
      const sign = cosine < 0 ? -1 : 1;
      for (let k = 0; k < 4; ++k) {
        turned[k] = (1 - fraction) * orientations[4 * p + k] + sign * fraction * orientations[4 * q + k];
        size += turned[k] * turned[k];
      }
      const scale = 1 / Math.sqrt(size);
      for (let k = 0; k < 4; ++k) numbers[at + 4 + k] = scale * turned[(k + 1) % 4];
    }
  }

  x(pose) { return this.numbers[8 * pose]; }
  y(pose) { return this.numbers[8 * pose + 1]; }
  angle(pose) { return this.angles[pose]; }
  place(pose) { return [...this.numbers.subarray(8 * pose, 8 * pose + 3)]; }

  /** A point of the scene in the frame of a pose in the plane. */
  local(pose, x, y) {
    const c = Math.cos(this.angle(pose)), s = Math.sin(this.angle(pose));
    const dx = x - this.x(pose), dy = y - this.y(pose);
    return [c * dx + s * dy, c * dy - s * dx];
  }

  /** A point, or a direction if `free`, of the scene in the frame of a pose. */
  inFrame(pose, [x, y, z], free = false) {
    const at = 8 * pose, n = this.numbers;
    if (!free) [x, y, z] = [x - n[at], y - n[at + 1], z - n[at + 2]];
    const [i, j, k, w] = [-n[at + 4], -n[at + 5], -n[at + 6], n[at + 7]];
    const [a, b, c] = [j * z - k * y + w * x, k * x - i * z + w * y, i * y - j * x + w * z];
    return [x + 2 * (j * c - k * b), y + 2 * (k * a - i * c), z + 2 * (i * b - j * a)];
  }
}

export const POSE_SHADER = `
uniform highp sampler2D poses;
vec3 placeOf(float pose) {
  int i = int(pose + 0.5);
  return texelFetch(poses, ivec2(2 * (i % ${PER_ROW}), i / ${PER_ROW}), 0).xyz;
}
vec4 rotationOf(float pose) {
  int i = int(pose + 0.5);
  return texelFetch(poses, ivec2(2 * (i % ${PER_ROW}) + 1, i / ${PER_ROW}), 0);
}
vec3 rotated(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
vec3 turned(float pose, vec3 v) { return rotated(rotationOf(pose), v); }
vec3 inScene(float pose, vec3 local) { return placeOf(pose) + turned(pose, local); }
vec3 inScene(float pose, vec2 local) { return inScene(pose, vec3(local, 0.0)); }
`;
