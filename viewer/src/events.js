// The list of events: those of a kind, of a body, with a text. Only the rows that are seen exist, so it may have a
// million.

import { colourOf } from "./colours.js";
import { lastNotAfter, shown } from "./data.js";

const ROW = 40; // [pixels]

/** The name of a contact by its bodies, without their shapes. */
function short(name) {
  return name.replace(/[a-z-]+ (?:#\d+|'[^']*') \(feature \d+\) of /g, "");
}

/** True of names in which a full name stands, and not only the beginning of a longer one ("particle #1" in "#10"). */
function namesBody(name, body) {
  for (let at = name.indexOf(body); at >= 0; at = name.indexOf(body, at + 1)) {
    if (!/\d/.test(name[at + body.length] ?? "")) return true;
  }
  return false;
}

export class EventList {
  constructor(element, recording, seek) {
    this.element = element;
    this.recording = recording;
    this.seek = seek;
    this.current = -1; // an event
    this.top = 0; // scrolled so far, and the height that is seen [pixels]: to ask for them costs a layout of the page
    this.height = 0;
    this.space = document.createElement("div");
    this.space.className = "space";
    this.filter({});
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
      if (!step || this.count === 0) return;
      event.preventDefault();
      event.stopPropagation();
      this.go(this.shown[Math.min(Math.max(this.placeOf(this.current) + step, 0), this.count - 1)]);
    });
  }

  /** Kinds of events that there are. */
  get kinds() {
    const { event_kind: kinds, kinds: names } = this.recording;
    return [...new Set(kinds)].sort((a, b) => a - b).map((kind) => names[kind]);
  }

  get count() { return this.shown.length; }

  /** Lists the events of a kind, of a body (its full name), with a text; what is empty asks for nothing. */
  filter({ kind = "", body = "", text = "" }) {
    const { recording } = this, { event_kind: kinds, event_name: names } = recording;
    const wanted = text.trim().toLowerCase();
    const ofBody = recording.names.map((name) => body === "" || namesBody(name, body));
    const hasText = recording.names.map((name) => name.toLowerCase().includes(wanted));
    const kindHas = recording.kinds.map((name) => name.replaceAll("_", " ").includes(wanted));
    const isKind = recording.kinds.map((name) => kind === "" || name === kind);
    const shown = [];
    for (let i = 0; i < kinds.length; ++i) {
      if (isKind[kinds[i]] && ofBody[names[i]] && (hasText[names[i]] || kindHas[kinds[i]])) shown.push(i);
    }
    this.shown = Int32Array.from(shown);
    this.times = Float64Array.from(shown, (i) => recording.event_time[i]);
    this.space.style.height = `${ROW * this.count}px`;
    if (this.count > 0) {
      this.element.replaceChildren(this.space);
      this.fill();
      this.show(this.current);
    } else {
      const why = kinds.length ? "No event is of this kind, body and text." : "No events were recorded.";
      this.element.innerHTML = `<p class="none">${why}</p>`;
    }
  }

  /** Place in the list of an event, or of the last one before it; -1 if there is none. */
  placeOf(number) { return lastNotAfter(this.shown, number); }

  go(number) {
    this.seek(this.recording.event_time[number]);
    this.mark(number);
    this.show(number);
  }

  /** Marks the last event that is not after a time, and has it seen. */
  follow(time) {
    if (this.count === 0) return;
    if (this.current >= 0 && this.recording.event_time[this.current] === time) return;
    const last = this.shown[lastNotAfter(this.times, time)] ?? -1;
    if (last === this.current) return;
    this.mark(last);
    this.show(last);
  }

  mark(number) {
    this.current = number;
    for (const row of this.space.children) this.markRow(row);
  }

  markRow(row) {
    const isCurrent = Number(row.dataset.event) === this.current;
    row.classList.toggle("current", isCurrent);
    row.setAttribute("aria-selected", String(isCurrent));
  }

  show(number) {
    const top = ROW * Math.max(this.placeOf(number), 0);
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
    this.space.replaceChildren(...Array.from({ length: Math.max(0, end - first) }, (_, i) => this.row(first + i)));
  }

  row(place) {
    const { recording } = this, number = this.shown[place];
    const kind = recording.kinds[recording.event_kind[number]];
    const row = document.createElement("div");
    row.className = "event";
    row.setAttribute("role", "option");
    row.dataset.event = number;
    row.style.top = `${ROW * place}px`;
    this.markRow(row);
    const line = (name, text) => {
      const part = document.createElement("span");
      part.className = name;
      part.textContent = text;
      return part;
    };
    const dot = line("dot", "");
    dot.style.background = colourOf(kind);
    const { dimension: d, event_impulse: impulses } = recording;
    const impulse = Math.hypot(...impulses.subarray(d * number, d * number + d));
    const details = impulse > 0 ? `${shown(impulse)} N s` : recording.modes[recording.event_mode[number]].replace("_", " ");
    row.append(dot, line("time", `${recording.event_time[number].toFixed(5)} s`), line("kind", kind.replaceAll("_", " ")),
      line("details", details), line("part", short(recording.names[recording.event_name[number]])));
    row.title = recording.names[recording.event_name[number]];
    return row;
  }
}
