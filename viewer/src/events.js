// The list of events. Only the rows that are seen exist, so it may have a million.

import { KINDS } from "./colours.js";
import { lastNotAfter, shown } from "./data.js";

const ROW = 40; // [pixels]

/** The name of a contact by its bodies, without their shapes. */
function short(name) {
  return name.replace(/[a-z-]+ (?:#\d+|'[^']*') \(feature \d+\) of /g, "");
}

export class EventList {
  constructor(element, recording, seek) {
    this.element = element;
    this.recording = recording;
    this.seek = seek;
    this.count = recording.event_time.length;
    this.current = -1;
    this.top = 0; // scrolled so far, and the height that is seen [pixels]: to ask for them costs a layout of the page
    this.height = 0;
    this.space = document.createElement("div");
    this.space.className = "space";
    this.space.style.height = `${ROW * this.count}px`;
    element.replaceChildren(this.space);
    if (this.count === 0) {
      element.innerHTML = "<p class=\"none\">No events were recorded.</p>";
      return;
    }
    element.addEventListener("scroll", () => {
      this.top = element.scrollTop;
      this.fill();
    });
    element.addEventListener("click", (event) => {
      const row = event.target.closest("[data-event]");
      if (row) this.go(Number(row.dataset.event));
    });
    element.addEventListener("keydown", (event) => {
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      event.stopPropagation();
      this.go(Math.min(Math.max(this.current + step, 0), this.count - 1));
    });
  }

  go(number) {
    this.seek(this.recording.event_time[number]);
    this.mark(number);
    this.show(number);
  }

  /** Marks the last event that is not after a time. */
  follow(time, isPlaying) {
    if (this.count === 0) return;
    const times = this.recording.event_time;
    if (this.current >= 0 && times[this.current] === time) return;
    const last = lastNotAfter(times, time);
    if (last === this.current) return;
    this.mark(last);
    if (isPlaying) this.show(last);
  }

  mark(number) {
    this.current = number;
    for (const row of this.space.children) row.classList.toggle("current", Number(row.dataset.event) === number);
  }

  show(number) {
    const top = ROW * Math.max(number, 0);
    if (top < this.top || top + ROW > this.top + this.height) {
      this.top = Math.max(0, Math.min(top - 0.5 * this.height, ROW * this.count - this.height));
      this.element.scrollTop = this.top;
    }
  }

  resize() {
    this.height = this.element.clientHeight;
    this.top = this.element.scrollTop;
    if (this.count) this.fill();
  }

  fill() {
    const first = Math.max(0, Math.floor(this.top / ROW) - 4);
    const end = Math.min(this.count, Math.ceil((this.top + this.height) / ROW) + 4);
    this.space.replaceChildren(...Array.from({ length: end - first }, (_, i) => this.row(first + i)));
  }

  row(number) {
    const { recording } = this;
    const kind = recording.kinds[recording.event_kind[number]];
    const row = document.createElement("div");
    row.className = number === this.current ? "event current" : "event";
    row.dataset.event = number;
    row.style.top = `${ROW * number}px`;
    const line = (name, text) => {
      const part = document.createElement("span");
      part.className = name;
      part.textContent = text;
      return part;
    };
    const dot = line("dot", "");
    dot.style.background = KINDS[kind];
    const { dimension: d, event_impulse: impulses } = recording;
    const impulse = Math.hypot(...impulses.subarray(d * number, d * number + d));
    const details = impulse > 0 ? `${shown(impulse)} N s` : recording.modes[recording.event_mode[number]].replace("_", " ");
    row.append(dot, line("time", `${recording.event_time[number].toFixed(5)} s`), line("kind", kind.replaceAll("_", " ")),
      line("details", details), line("part", short(recording.names[recording.event_name[number]])));
    row.title = recording.names[recording.event_name[number]];
    return row;
  }
}
