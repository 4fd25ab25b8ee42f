// The scene: what the recording has, as layers, and what changes with time in them.

import { Color, OrthographicCamera, Scene, Vector3, WebGLRenderer } from "three";
import { polygons, rounds, smallRounds } from "./bodies.js";
import * as colours from "./colours.js";
import { Contacts } from "./contacts.js";
import { lastNotAfter } from "./data.js";
import { fills, lines } from "./layers.js";
import { Marks } from "./marks.js";
import { along, link, widened } from "./outlines.js";
import { Poses } from "./poses.js";
import { around, plain, thickened } from "./solids.js";
import { Space } from "./space.js";

const FLASH = 0.35; // seconds on the screen that the mark of an event is seen
const MOST_FLASHES = 400;
const CLEAR_FLASHES = 20; // the marks of older events are fainter, so that many do not hide the bodies
const ARROW = [10, 60]; // least and most pixels of the arrow of a large impulse, three bodies long between
const SMALL = 4; // pixels from the middle to the end up to which discs and capsules are points
const DOT = [0.8, 2.2]; // least and most pixels of the radius of a contact's mark

const within = ([least, most], value) => Math.min(Math.max(value, least), most);

const PLANE = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const SPACE = [[1, 0, 0], [0, 0, 1], [0, -1, 0]];

export class RunScene {
  constructor(canvas, recording) {
    this.recording = recording;
    this.poses = new Poses(recording);
    // Nothing shines through an opaque picture, which the browser need not mix with the page behind it.
    const context = canvas.getContext("webgl2", { alpha: false, antialias: false, powerPreference: "high-performance" });
    this.renderer = new WebGLRenderer({ canvas, context });
    this.renderer.setClearColor(new Color(colours.AIR), 1);
    this.three = new Scene();
    this.uniforms = {
      poses: { value: this.poses.texture }, pixel: { value: 1 }, density: { value: 1 }, picked: { value: -1 },
      arrowScale: { value: 1 },
      pickedColour: { value: new Vector3(...colours.rgb(colours.PICKED)) },
    };
    this.showsContacts = this.showsArrows = true;
    this.arrowFactor = 1; // of the length of arrows, by the user
    this.kindColours = recording.kinds.map((kind) => colours.rgb(colours.colourOf(kind)));
    this.bodySize = bodySize(recording);
    this.planar = []; // what is seen of the plane only
    this.space = null; // made when it is seen
    this.addGround();
    this.addBodies();
    this.addLinks();
    this.addContacts();
    this.showSpace(this.isSpatial);
    this.renderer.compile(this.three, new OrthographicCamera()); // or the first impact would wait for it
    this.largeImpulse = largeImpulse(recording.contact_impulse, recording.dimension);
  }

  get isSpatial() { return this.recording.dimension === 3; }

  /** Least and most x, y and z of what is seen at first; a planar scene is as thick as a body is wide. */
  get bounds() {
    const { bounds } = this.recording, half = 0.5 * this.bodySize;
    return this.isSpatial ? bounds : [...bounds.slice(0, 2), -half, ...bounds.slice(2), half];
  }

  get inSpace() { return this.space?.visible ?? false; }

  /** Directions right, up and to the viewer, seen from in front. */
  get frame() { return this.isSpatial ? SPACE : PLANE; }

  /** Bodies as solids in space, or a planar run as the plane has it. */
  showSpace(on) {
    if (on && !this.space) {
      const solids = this.isSpatial ? this.recording.solids : thickened(this.recording, this.bodySize);
      this.space = new Space(this.three, solids, this.uniforms, (pose) => this.fill(pose), this.bounds, this.frame);
    }
    if (this.space) this.space.visible = on;
    for (const mesh of this.planar) mesh.visible = !on;
    this.drawn = {}; // what is drawn anew where it changes
  }

  /** How far from the middle of the view anything is that is drawn [m]. */
  get depth() { return 40 * Math.hypot(...[0, 1, 2].map((k) => this.bounds[k + 3] - this.bounds[k])); }

  addPlanar(...meshes) {
    this.planar.push(...meshes);
    this.three.add(...meshes);
  }

  isGround(pose) { return pose === 0 || pose > this.recording.bodies.length; }

  fill(pose) {
    return colours.rgb(this.isGround(pose) ? colours.GROUND : colours.BODIES[(pose - 1) % colours.BODIES.length]);
  }

  addGround() {
    const { recording, uniforms } = this;
    const fill = colours.rgb(colours.GROUND), edge = colours.rgb(colours.GROUND_EDGE);
    this.addPlanar(
      fills(recording.fills.map(([pose, points]) => ({ pose, points, colour: fill })), uniforms, 0),
      lines(recording.lines.flatMap(([pose, points]) => along(pose, points, false, 1.6, edge)), uniforms, 1));
  }

  addBodies() {
    const { recording, uniforms } = this;
    const round = recording.capsules.map(([pose, ax, ay, bx, by, radius]) => (
      { pose, ax, ay, bx, by, radius, fill: this.fill(pose) }));
    const outlines = recording.polygons.map(([pose, radius, points]) => (
      { pose, points: widened(points, radius), fill: this.fill(pose) }));
    const onGround = (item) => this.isGround(item.pose), ofBody = (item) => !this.isGround(item.pose);
    const isDisc = ({ ax, ay, bx, by }) => ax === bx && ay === by, ground = colours.rgb(colours.GROUND_EDGE);
    const edge = colours.rgb(colours.BODY_EDGE), bodies = round.filter(ofBody);
    const bySize = (list, areLong) => ({
      reach: list.reduce((most, { ax, ay, bx, by, radius }) => Math.max(most, radius + 0.5 * Math.hypot(bx - ax, by - ay)), 0),
      small: smallRounds(list, areLong, edge, uniforms, 5), large: rounds(list, edge, uniforms, 5),
    });
    this.rounds = [bySize(bodies.filter((item) => !isDisc(item)), true), bySize(bodies.filter(isDisc), false)];
    this.addPlanar(
      rounds(round.filter(onGround), ground, uniforms, 2), polygons(outlines.filter(onGround), ground, uniforms, 3),
      polygons(outlines.filter(ofBody), edge, uniforms, 4), ...this.rounds.flatMap(({ small, large }) => [small, large]));
  }

  addLinks() {
    const { recording, uniforms, three, bounds, isSpatial } = this;
    const dark = colours.rgb(colours.LINK), rod = colours.rgb(colours.ROD);
    const list = recording.links.flatMap((item) => (
      link(item, item.kind === "rod" ? 3.2 : 1.5, item.kind === "rod" ? rod : dark)));
    const reach = 0.12 * Math.hypot(bounds[3] - bounds[0], bounds[4] - bounds[1]);
    for (const { kind, pose, at, axis } of recording.joints) {
      if (kind !== "axis") continue;
      const [a, b] = [-reach, reach].map((way) => at.map((value, k) => value + way * axis[k]));
      list.push({ poseA: pose, a, poseB: pose, b, width: 0.8, colour: dark });
    }
    for (const { pose, at } of recording.struts) {
      list.push({ poseA: pose, a: at.map(() => 0), poseB: pose, b: at, width: 3.2, colour: rod });
    }
    three.add(lines(list, uniforms, 6, isSpatial));
    const ends = recording.links.flatMap(({ poseA, a, poseB, b }) => [[poseA, a], [poseB, b]]);
    const rest = recording.joints.filter(({ kind }) => kind !== "axis");
    const marks = new Marks(recording.particles.length + ends.length + rest.length, uniforms, 7, isSpatial);
    for (const [pose, at] of ends) marks.add(pose, at, 2.5, this.isGround(pose) ? 2 : 0, dark);
    for (const pose of recording.particles) marks.add(pose, [0, 0], 6, 0, colours.rgb("#7d93ad"));
    const forms = { pin: [4, 1], weld: [4, 2], slide: [5, 2], slot: [4, 1], point: [1.8, 0], centre: [3, 0] };
    for (const { kind, pose, at } of rest) marks.add(pose, at, ...forms[kind], dark);
    marks.update();
    three.add(marks.mesh);
  }

  addContacts() {
    const modes = this.recording.modes.map((mode) => colours.rgb(colours.colourOf(mode)));
    this.contacts = new Contacts(this.recording, [...modes, colours.rgb(colours.IMPACT)], this.uniforms, 8);
    this.flashes = new Marks(MOST_FLASHES, this.uniforms, 10);
    this.three.add(...this.contacts.meshes, this.flashes.mesh);
  }

  contactRange(sample) {
    const ends = this.recording.contact_ends;
    return [sample > 0 ? ends[sample - 1] : 0, ends[sample]];
  }

  fillFlashes(time, speed) {
    const { event_time: times, event_point: point, event_kind: kind, event_normal: normal, dimension: d } = this.recording;
    this.flashes.clear();
    const last = lastNotAfter(times, time), length = FLASH * speed;
    for (let i = last; i >= 0 && times[i] > time - length && this.flashes.count < MOST_FLASHES; --i) {
      if (normal[d * i] === 0 && normal[d * i + 1] === 0 && (d === 2 || normal[d * i + 2] === 0)) continue; // at no place
      const age = (time - times[i]) / length;
      const clear = last - i < CLEAR_FLASHES ? 1 : CLEAR_FLASHES / (last - i);
      const at = point.subarray(d * i, d * i + d);
      this.flashes.add(0, at, 4 + 7 * age, 3, this.kindColours[kind[i]], clear * (1 - age));
    }
    this.flashes.update();
  }

  /** Impulse of the arrow of the legend [N s]. */
  impulseOfArrow() { return this.largeImpulse; }

  /** Length of that arrow [pixels]. */
  arrowLength(camera) { return this.arrowFactor * within(ARROW, 3 * this.bodySize * camera.scale); }

  draw(camera, { sample, fraction, time, speed }) {
    const { drawn, showsContacts } = this, isMoved = sample !== drawn.sample || fraction !== drawn.fraction;
    if (isMoved) this.poses.fill(sample, fraction);
    if (sample !== drawn.sample || showsContacts !== drawn.showsContacts) {
      const [first, end] = showsContacts ? this.contactRange(sample) : [0, 0];
      this.contacts.show(first, end);
    }
    this.contacts.dotSize.value = within(DOT, 0.25 * this.bodySize * camera.scale);
    this.drawn = { sample, fraction, showsContacts };
    this.fillFlashes(time, speed);
    if (isMoved && this.inSpace) this.space.drawShadows(this.renderer, this.three);
    camera.follow();
    camera.update();
    if (this.inSpace) this.uniforms.toScene.value = camera.three.matrixWorld;
    this.uniforms.pixel.value = 1 / camera.scale;
    for (const { reach, small, large } of this.rounds) {
      const isSmall = reach * camera.scale <= SMALL;
      small.visible = !this.inSpace && isSmall;
      large.visible = !this.inSpace && !isSmall;
    }
    this.uniforms.arrowScale.value =
      this.largeImpulse > 0 && this.showsArrows ? this.arrowLength(camera) / (camera.scale * this.largeImpulse) : 0;
    this.renderer.render(this.three, camera.three);
  }

  /** Takes the size of the canvas. most: dots of the screen that a pixel has on a side, at most. */
  resize(most = 2) {
    const { clientWidth, clientHeight } = this.renderer.domElement;
    this.uniforms.density.value = Math.min(window.devicePixelRatio, most);
    this.renderer.setPixelRatio(this.uniforms.density.value);
    this.renderer.setSize(clientWidth, clientHeight, false);
  }
}

/** Width of a body in the middle of all [m]. */
function bodySize({ capsules: round, polygons, solids, bounds }) {
  const sizes = [
    ...round.map(([, ax, ay, bx, by, radius]) => 2 * radius + Math.hypot(bx - ax, by - ay)),
    ...polygons.map(([, radius, points]) => 2 * radius + Math.max(...points) - Math.min(...points)),
    ...plain(solids).filter(({ kind }) => kind !== "plane").map((solid) => 2 * around(solid)[1]),
  ].sort((a, b) => a - b);
  const half = bounds.length / 2, spans = bounds.slice(half).map((value, k) => value - bounds[k]);
  return sizes.length ? sizes[sizes.length >> 1] : 0.05 * Math.max(...spans);
}

/** An impulse that few exceed: of a sorted sample of all. */
function largeImpulse(impulse, dimension) {
  const sizes = [], count = impulse.length / dimension, stride = Math.max(1, Math.floor(count / 20000));
  for (let i = 0; i < count; i += stride) {
    const size = Math.hypot(...impulse.subarray(dimension * i, dimension * (i + 1)));
    if (size > 0) sizes.push(size);
  }
  sizes.sort((a, b) => a - b);
  return sizes.length ? sizes[Math.floor(0.95 * (sizes.length - 1))] : 0;
}
