// Time that passes: which sample is shown, and how far it is to the next.

import { lastNotAfter } from "./data.js";

export class Player {
  constructor(times, changed) {
    this.times = times;
    this.changed = changed;
    this.time = times[0];
    this.speed = 1; // seconds of the run in a second
    this.isPlaying = false;
  }

  get start() { return this.times[0]; }
  get end() { return this.times[this.times.length - 1]; }

  play(on) {
    if (on && this.time >= this.end) this.time = this.start;
    this.isPlaying = on;
    this.changed();
  }

  seek(time) {
    this.time = Math.min(Math.max(time, this.start), this.end);
    this.changed();
  }

  /** To the sample before or after. */
  step(count) {
    this.isPlaying = false;
    const { sample, fraction } = this.place();
    const from = fraction > 0 && count < 0 ? sample + 1 : sample;
    this.seek(this.times[Math.min(Math.max(from + count, 0), this.times.length - 1)]);
  }

  advance(seconds) {
    if (!this.isPlaying) return;
    this.time += seconds * this.speed;
    if (this.time >= this.end) {
      this.time = this.end;
      this.isPlaying = false;
    }
    this.changed();
  }

  place() {
    const last = this.times.length - 1;
    const sample = Math.min(Math.max(lastNotAfter(this.times, this.time), 0), last);
    const length = sample < last ? this.times[sample + 1] - this.times[sample] : 0;
    return { sample, fraction: length > 0 ? (this.time - this.times[sample]) / length : 0 };
  }
}
