// The page: one state (time, what is followed), drawn whenever it changed.

import { PlanarCamera } from "./camera.js";
import { IMPACT, MODES } from "./colours.js";
import { readRecording, shown } from "./data.js";
import { EventList } from "./events.js";
import { contactAt, poseAt } from "./pick.js";
import { Player } from "./player.js";
import { LedgerPlot } from "./plot.js";
import { RunScene } from "./scene.js";

const element = (id) => document.getElementById(id);
const SPEEDS = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];

class Page {
  constructor() {
    this.recording = readRecording(document);
    this.dirty = true;
    const changed = () => { this.dirty = true; };
    this.player = new Player(this.recording.times, changed);
    this.scene = new RunScene(element("scene"), this.recording);
    this.camera = new PlanarCamera(element("scene"), this.recording.bounds, changed);
    const seek = (time) => {
      this.player.play(false);
      this.player.seek(time);
    };
    this.events = new EventList(element("events"), this.recording, seek);
    this.plot = new LedgerPlot(
      element("ledger"), element("cursor"), element("legend"), this.recording, (time) => this.player.seek(time));
    this.frames = 0;
    this.addTexts();
    this.addControls();
    this.addHover();
    new ResizeObserver(() => this.resize()).observe(document.body);
    this.resize();
    this.camera.fit();
    let before = performance.now();
    const frame = (now) => {
      this.player.advance(Math.min(0.25, (now - before) / 1000));
      before = now;
      if (this.dirty) this.draw();
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  resize() {
    this.scene.resize();
    this.camera.resize();
    this.plot.resize();
    this.events.resize();
    this.dirty = true;
  }

  addTexts() {
    const { recording } = this;
    document.title = recording.title;
    element("title").textContent = recording.title;
    const count = (number, one, many) => `${number.toLocaleString("en")} ${number === 1 ? one : many}`;
    element("facts").textContent = [
      count(recording.bodies.length, "body", "bodies"), count(recording.times.length, "sample", "samples"),
      count(recording.event_time.length, "event", "events")].join(" · ");
    const names = [["stick", MODES.stick], ["slip", MODES.slip], ["impact", IMPACT]];
    element("modes").replaceChildren(...names.map(([name, colour]) => {
      const item = document.createElement("span");
      item.innerHTML = "<i></i>";
      item.firstChild.style.background = colour;
      item.append(name);
      return item;
    }));
    const impulse = this.scene.impulseOfArrow();
    element("arrow").hidden = !(impulse > 0);
    element("arrow").lastElementChild.textContent = `${shown(impulse)} N s`;
  }

  addControls() {
    const { player, camera, recording } = this;
    element("play").addEventListener("click", () => player.play(!player.isPlaying));
    element("back").addEventListener("click", () => player.step(-1));
    element("next").addEventListener("click", () => player.step(1));
    element("time").addEventListener("input", (event) => {
      player.isPlaying = false;
      player.seek(player.start + Number(event.target.value) * (player.end - player.start));
    });
    const whole = (player.end - player.start) / 8; // of the run in a second, so that it takes 8 s
    player.speed = SPEEDS.reduce((best, each) => (Math.abs(Math.log(each / whole)) < Math.abs(Math.log(best / whole)) ? each : best));
    element("speed").replaceChildren(...SPEEDS.map((each) => new Option(`${each}×`, each, false, each === player.speed)));
    element("speed").addEventListener("change", (event) => { player.speed = Number(event.target.value); });
    element("fit").addEventListener("click", () => {
      this.follow(0);
      camera.fit();
    });
    element("contacts").addEventListener("change", (event) => {
      this.scene.showsContacts = event.target.checked;
      this.dirty = true;
    });
    element("names").replaceChildren(...recording.bodies.slice(0, 2000).map((name) => new Option(name)));
    element("followed").addEventListener("change", (event) => (
      this.follow(recording.bodies.indexOf(event.target.value.trim()) + 1)));
    document.addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    if (event.target.matches("input[list], select")) return;
    const actions = {
      " ": () => this.player.play(!this.player.isPlaying), ArrowLeft: () => this.player.step(-1),
      ArrowRight: () => this.player.step(1), Home: () => this.player.seek(this.player.start),
      End: () => this.player.seek(this.player.end), f: () => element("fit").click(),
    };
    if (!actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  }

  /** Follows the body of a pose; 0: none. */
  follow(pose) {
    const { camera, scene, recording } = this;
    const isBody = pose > 0 && pose <= recording.bodies.length;
    camera.last = null;
    camera.follows = isBody ? () => [scene.poses.x(pose), scene.poses.y(pose)] : () => null;
    element("followed").value = isBody ? recording.bodies[pose - 1] : "";
    this.dirty = true;
  }

  addHover() {
    const canvas = element("scene"), label = element("label");
    const at = (event) => this.camera.sceneAt(event.offsetX, event.offsetY);
    canvas.addEventListener("pointermove", (event) => {
      const text = event.buttons ? "" : this.textAt(...at(event));
      label.hidden = text === "";
      label.innerText = text;
      const isRight = event.offsetX > 0.7 * canvas.clientWidth;
      label.style.left = isRight ? "" : `${event.offsetX + 14}px`;
      label.style.right = isRight ? `${canvas.clientWidth - event.offsetX + 14}px` : "";
      label.style.top = `${event.offsetY + 12}px`;
    });
    canvas.addEventListener("pointerleave", () => {
      label.hidden = true;
      this.pick(-1);
    });
    canvas.addEventListener("dblclick", (event) => (
      this.follow(poseAt(this.recording, this.scene.poses, ...at(event), 1 / this.camera.scale))));
  }

  pick(pose) {
    if (this.scene.uniforms.picked.value === pose) return;
    this.scene.uniforms.picked.value = pose;
    this.dirty = true;
  }

  /** Text about what is at a point of the scene. */
  textAt(x, y) {
    const { recording, scene } = this;
    const pixel = 1 / this.camera.scale, { sample } = this.player.place();
    const contact = scene.showsContacts ? contactAt(recording, scene.contactRange(sample), x, y, pixel) : -1;
    if (contact >= 0) {
      this.pick(-1);
      const mode = recording.contact_impact[contact] ? "impact" : recording.modes[recording.contact_mode[contact]];
      return `${recording.names[recording.contact_name[contact]]}\n${mode.replace("_", " ")}, impulse ` +
        `${shown(recording.contact_impulse[2 * contact])} N s normal, ` +
        `${shown(recording.contact_impulse[2 * contact + 1])} N s tangential`;
    }
    const pose = poseAt(recording, scene.poses, x, y, pixel);
    this.pick(pose);
    if (pose < 0) return "";
    if (pose > recording.bodies.length) return recording.obstacles[pose - recording.bodies.length - 1].name;
    const turned = recording.particles.includes(pose) ? "" : `, ${shown(scene.poses.angle(pose))} rad`;
    return `${recording.bodies[pose - 1]}\nat ${shown(scene.poses.x(pose))} m, ${shown(scene.poses.y(pose))} m${turned}`;
  }

  draw() {
    this.dirty = false;
    const { player, scene, camera } = this;
    const { sample, fraction } = player.place();
    scene.draw(camera, { sample, fraction, time: player.time, speed: player.speed });
    this.plot.draw(player.time, sample);
    this.events.follow(player.time, player.isPlaying);
    element("time").value = player.end > player.start ? (player.time - player.start) / (player.end - player.start) : 0;
    element("now").textContent = `${player.time.toFixed(4)} s`;
    element("play").dataset.playing = String(player.isPlaying);
    element("play").setAttribute("aria-label", player.isPlaying ? "Pause" : "Play");
    this.drawScale();
    ++this.frames;
  }

  /** A round length that is about 100 pixels long. */
  drawScale() {
    const rough = 100 / this.camera.scale, power = 10 ** Math.floor(Math.log10(rough));
    element("arrow").firstElementChild.style.width = `${this.scene.arrowLength(this.camera)}px`;
    const length = power * [5, 2, 1].find((factor) => factor * power <= rough);
    element("scale").firstElementChild.style.width = `${length * this.camera.scale}px`;
    element("scale").lastElementChild.textContent = `${shown(length)} m`;
  }
}

window.caromPage = new Page();
