// Colours. Bodies and ground are pale, so that contacts are seen; those are told apart by people with colour
// blindness too (Okabe and Ito).

export const BODIES = ["#b9c8da", "#c7d3c3", "#d9ccba", "#cbc2d6", "#bcd2d2", "#d8c6c6"];
export const BODY_EDGE = "#3c4d61";
export const GROUND = "#e4e0d7";
export let GROUND_EDGE = "#6d675c";
export let LINK = "#4a5a6a";
export let ROD = "#2b3947";
export let AIR = "#fbfbf9";
export let INK = "#1f2933"; // of the plot
export let QUIET = "#5b6570";
export let GRID = "#e3e5e8";
export const PICKED = "#f2c14e";
export const IMPACT = "#b5237a";

// One colour for each word, wherever it stands: at contacts, in the list of events, in the legend.
const WORDS = {
  open: "#9aa0a6", stick: "#0072b2", slip: "#d55e00", impact: IMPACT, closing: "#56b4e9", lift_off: "#009e73",
  accumulation: "#7a3e9d", impact_without_collision: "#cc79a7", several_accelerations: "#8a6d00", roll: "#e69f00",
  hold: "#4c9b2f", switching_point: "#6b7280", discontinuity: "#a0522d", mode_switch: "#44546a",
};

/** Colour of a mode of contacts or a kind of events. */
export function colourOf(word) { return WORDS[word.replace(/_(positive|negative)$/, "")] ?? WORDS.open; }

export const SERIES = ["#0072b2", "#009e73", "#e69f00", "#cc79a7", "#56b4e9", "#d55e00", "#7a6a00", "#7a3e9d"];

/** Red, green and blue of "#rrggbb", 0 to 1. */
export function rgb(colour) {
  const number = parseInt(colour.slice(1), 16);
  return [(number >> 16) / 255, ((number >> 8) & 255) / 255, (number & 255) / 255];
}

/** Takes colours that are seen before a dark air, from here on. */
export function goDark() {
  [GROUND_EDGE, LINK, ROD, AIR] = ["#a49c8c", "#93a5b8", "#c3d0dd", "#1a1e23"];
  [INK, QUIET, GRID] = ["#e4e8ec", "#a3adb8", "#343b43"];
}
