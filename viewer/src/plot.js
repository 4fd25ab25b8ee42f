// The energy ledger over time: stored energies, their total, and what was lost; as they are, or their changes since the
// start, which a large energy of rest would hide. A click on a name hides or shows a line, a click on the plot goes to
// that time.

import { GRID, INK, QUIET, SERIES } from "./colours.js";
import { shown } from "./data.js";

const STORED = ["kinetic", "gravity", "elastic", "potential"];
const GAINS = ["external", "intervention"];
const ROUNDING = 1e-7; // of the largest energy; the page has 24 bits of each
const MARGIN = { left: 62, right: 14, top: 8, bottom: 20 };

/** Lines of a ledger: those that are more than rounding. */
function seriesOf(recording) {
  const { ledger_terms: terms, ledger, times } = recording;
  const width = terms.length;
  const column = (term) => {
    const at = terms.indexOf(term);
    return Float64Array.from(times, (_, i) => ledger[width * i + at]);
  };
  const flows = terms.filter((term) => ![...STORED, "total", "initial", "residual"].includes(term));
  const losses = flows.filter((term) => !GAINS.includes(term)).map(column);
  const lost = Float64Array.from(times, (_, i) => losses.reduce((sum, values) => sum + values[i], 0));
  const list = [
    { name: "total", values: column("total"), colour: INK, width: 2, isShown: true },
    ...STORED.map((term) => ({ name: term, values: column(term), isShown: true })),
    { name: "lost", values: lost, colour: "#8a1c1c", dash: [5, 3], isShown: true },
    ...flows.map((term) => ({ name: term, values: column(term), dash: [2, 2], isShown: false })),
  ];
  const largest = (values) => values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
  const scale = Math.max(...list.map(({ values }) => largest(values)));
  const seen = list.filter(({ name, values }) => name === "total" || largest(values) > ROUNDING * scale);
  let next = 0;
  for (const series of seen) series.colour ??= SERIES[next++ % SERIES.length];
  return seen;
}

/** Round distances between marks of an axis. */
function marks(low, high, most) {
  const rough = (high - low) / most, power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough);
  const list = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; ++k) list.push(k * step);
  return list;
}

const BETWEEN_VALUES = 120; // [ms]

export class LedgerPlot {
  /** cursor: the element that is a line at the present time, beside which nothing is drawn anew. */
  constructor(canvas, cursor, legend, recording, seek) {
    this.canvas = canvas;
    this.cursor = cursor;
    this.legend = legend;
    this.times = recording.times;
    this.series = seriesOf(recording);
    this.isChange = false;
    this.makeLegend();
    const go = (event) => {
      const inside = (event.offsetX - MARGIN.left) / (canvas.clientWidth - MARGIN.left - MARGIN.right);
      seek(this.times[0] + inside * (this.times[this.times.length - 1] - this.times[0]));
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      go(event);
    });
    canvas.addEventListener("pointermove", (event) => { if (event.buttons & 1) go(event); });
    this.resize();
  }

  makeLegend() {
    this.legend.replaceChildren(...this.series.map((series) => {
      const item = document.createElement("button");
      item.type = "button";
      item.innerHTML = "<i></i><span></span><b></b>";
      item.querySelector("i").style.borderTop = `3px ${series.dash ? "dotted" : "solid"} ${series.colour}`;
      item.querySelector("span").textContent = series.name.replaceAll("_", " ");
      series.value = item.querySelector("b");
      const mark = () => item.setAttribute("aria-pressed", String(series.isShown));
      mark();
      item.addEventListener("click", () => {
        series.isShown = !series.isShown;
        mark();
        this.resize();
      });
      return item;
    }));
  }

  /** What a line is counted from. */
  zero(values) { return this.isChange ? values[0] : 0; }

  /** Shows changes since the start, or the energies themselves. */
  showChange(on) {
    this.isChange = on;
    this.shownSample = undefined;
    this.resize();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    [this.width, this.height] = [clientWidth, clientHeight]; // asked for here alone: it costs a layout of the page
    this.ratio = Math.min(window.devicePixelRatio, 2);
    this.canvas.width = clientWidth * this.ratio;
    this.canvas.height = clientHeight * this.ratio;
    let low = 0, high = 0;
    for (const { values, isShown } of this.series) {
      if (!isShown) continue;
      const zero = this.zero(values);
      for (const value of values) {
        if (value - zero < low) low = value - zero;
        if (value - zero > high) high = value - zero;
      }
    }
    if (high === low) high = low + 1;
    this.range = [low - 0.04 * (high - low), high + 0.06 * (high - low)];
    this.drawLines();
    if (this.sample !== undefined) this.draw(this.time, this.sample);
  }

  x(time) {
    const [first, last] = [this.times[0], this.times[this.times.length - 1]];
    const width = this.width - MARGIN.left - MARGIN.right;
    return MARGIN.left + (last > first ? ((time - first) / (last - first)) * width : 0);
  }

  y(value) {
    const height = this.height - MARGIN.top - MARGIN.bottom;
    return MARGIN.top + ((this.range[1] - value) / (this.range[1] - this.range[0])) * height;
  }

  drawLines() {
    const pen = this.canvas.getContext("2d");
    const { clientWidth, clientHeight } = this.canvas;
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.clearRect(0, 0, clientWidth, clientHeight);
    this.drawAxes(pen, clientWidth, clientHeight);
    for (const { values, colour, width, dash, isShown } of this.series) {
      if (!isShown) continue;
      pen.strokeStyle = colour;
      pen.lineWidth = width ?? 1.4;
      pen.setLineDash(dash ?? []);
      pen.beginPath();
      const stride = Math.max(1, Math.floor(values.length / 20000));
      for (let i = 0; i < values.length; i += stride) {
        pen.lineTo(this.x(this.times[i]), this.y(values[i] - this.zero(values)));
      }
      pen.stroke();
    }
    pen.setLineDash([]);
  }

  drawAxes(pen, width, height) {
    pen.font = "11px system-ui, sans-serif";
    pen.lineWidth = 1;
    pen.strokeStyle = GRID;
    pen.fillStyle = QUIET;
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    for (const value of marks(...this.range, Math.max(2, height / 32))) {
      const y = Math.round(this.y(value)) + 0.5;
      pen.beginPath();
      pen.moveTo(MARGIN.left, y);
      pen.lineTo(width - MARGIN.right, y);
      pen.stroke();
      pen.fillText(`${shown(value)} J`, MARGIN.left - 6, y);
    }
    pen.textBaseline = "top";
    pen.textAlign = "center";
    const last = this.times[this.times.length - 1];
    for (const time of last > this.times[0] ? marks(this.times[0], last, width / 90) : []) {
      pen.fillText(`${shown(time)} s`, Math.min(this.x(time), width - 18), height - MARGIN.bottom + 5);
    }
  }

  /** Values change some times a second while the run plays: nobody reads more, and each has the page drawn again. */
  draw(time, sample, isPlaying = false) {
    this.cursor.style.transform = `translateX(${Math.round(this.x(time))}px)`;
    const now = performance.now();
    if (sample !== this.shownSample && !(isPlaying && now - this.shownAt < BETWEEN_VALUES)) {
      [this.shownSample, this.shownAt] = [sample, now];
      for (const { value, values } of this.series) value.textContent = `${shown(values[sample] - this.zero(values))} J`;
    }
    [this.time, this.sample] = [time, sample];
  }
}
