// How fast pictures come while a run plays. Where they come too slowly, pages are drawn sparingly until the run stops: one
// dot of the screen a pixel, and what is beside the scene seldom, for whatever changes there has the browser put the
// whole page together anew. A run that stands still is always drawn in full.

const SLOW = 36; // [ms] between two pictures, from which on it is too slow: less than 28 a second
const PICTURES = 15; // of whose times the median counts
const BETWEEN_CONTROLS = { full: 50, sparing: 250 }; // [ms] while the run plays

export class Pace {
  constructor() {
    this.isSparing = false;
    this.intervals = [];
    this.controlsAt = -Infinity;
  }

  /** A picture that comes `interval` [ms] after the one before. True: isSparing has changed. */
  note(interval, isPlaying) {
    const before = this.isSparing;
    if (!isPlaying) {
      this.isSparing = false;
      this.intervals.length = 0;
    } else if (!before && this.intervals.push(interval) === PICTURES) {
      this.isSparing = this.intervals.sort((a, b) => a - b)[PICTURES >> 1] > SLOW;
      this.intervals.length = 0;
    }
    return this.isSparing !== before;
  }

  /** Whether what is beside the scene is drawn in a picture at a time [ms]. */
  isTimeForControls(now, isPlaying) {
    const between = this.isSparing ? BETWEEN_CONTROLS.sparing : BETWEEN_CONTROLS.full;
    if (isPlaying && now - this.controlsAt < between) return false;
    this.controlsAt = now;
    return true;
  }
}
