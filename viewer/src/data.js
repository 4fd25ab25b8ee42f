// The recording in the page: a description in JSON, and all arrays in one base64 text.

const TYPES = { f8: Float64Array, f4: Float32Array, i4: Int32Array, u1: Uint8Array };

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** Reads the recording. Arrays are views into one buffer, by the names that `description.arrays` gives. */
export function readRecording(document) {
  const description = JSON.parse(document.getElementById("description").textContent);
  const bytes = bytesOf(document.getElementById("arrays").textContent.trim());
  const arrays = {};
  for (const [name, { type, offset, length }] of Object.entries(description.arrays)) {
    arrays[name] = new TYPES[type](bytes.buffer, offset, length);
  }
  return { ...description, ...arrays, ...withPoints(description) };
}

/** Links, joints and struts with their points, which have as many numbers as the model has dimensions. */
function withPoints({ dimension: d, links, joints, struts }) {
  return {
    links: links.map(([kind, poseA, ...rest]) => (
      { kind, poseA, a: rest.slice(0, d), poseB: rest[d], b: rest.slice(d + 1) })),
    joints: joints.map(([kind, pose, ...rest]) => ({ kind, pose, at: rest.slice(0, d), axis: rest[d] })),
    struts: struts.map(([pose, ...at]) => ({ pose, at })),
  };
}

/** Place of the last entry of an ascending array that is not after `value`; -1 if there is none. */
export function lastNotAfter(ascending, value) {
  let low = 0, high = ascending.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (ascending[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** A number for people: four digits. */
export function shown(value) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(2) : String(Number(value.toPrecision(4)));
}
