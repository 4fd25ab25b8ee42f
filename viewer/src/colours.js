// Colours. Bodies and ground are pale, so that contacts are seen; those are told apart by people with colour
// blindness too (Okabe and Ito).

export const BODIES = ["#b9c8da", "#c7d3c3", "#d9ccba", "#cbc2d6", "#bcd2d2", "#d8c6c6"];
export const BODY_EDGE = "#3c4d61";
export const GROUND = "#e4e0d7";
export const GROUND_EDGE = "#6d675c";
export const LINK = "#4a5a6a";
export const ROD = "#2b3947";
export const PICKED = "#f2c14e";

export const MODES = { open: "#9aa0a6", stick: "#0072b2", slip_positive: "#d55e00", slip_negative: "#d55e00", slip: "#d55e00" };
export const IMPACT = "#b5237a";
export const KINDS = {
  impact: IMPACT, accumulation: "#7a3e9d", closing: "#0072b2", lift_off: "#56b4e9", stick: "#009e73", slip: "#d55e00",
  impact_without_collision: "#b5237a", several_accelerations: "#8a6d00", switching_point: "#6b7280",
  discontinuity: "#6b7280", mode_switch: "#6b7280", roll: "#d55e00", hold: "#009e73",
};
export const SERIES = ["#0072b2", "#009e73", "#e69f00", "#cc79a7", "#56b4e9", "#d55e00", "#7a6a00", "#7a3e9d"];

/** Red, green and blue of "#rrggbb", 0 to 1. */
export function rgb(colour) {
  const number = parseInt(colour.slice(1), 16);
  return [(number >> 16) / 255, ((number >> 8) & 255) / 255, (number & 255) / 255];
}
