// The page: one state (time, what is followed), drawn whenever it changed.

import { Camera } from "./camera.js";
import { colourOf, goDark } from "./colours.js";
import { readRecording, shown } from "./data.js";
import { EventList } from "./events.js";
import { Pace } from "./pace.js";
import { contactAt, poseAt } from "./pick.js";
import { Player } from "./player.js";
import { LedgerPlot } from "./plot.js";
import { savePicture, Video } from "./save.js";
import { RunScene } from "./scene.js";
import { roundLength } from "./space.js";

const element = (id) => document.getElementById(id);
const SPEEDS = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];

class Page {
  constructor() {
    const dark = window.matchMedia("(prefers-color-scheme: dark)");
    if (dark.matches) goDark();
    dark.addEventListener("change", () => location.reload()); // colours stand in all that was made
    this.recording = readRecording(document);
    this.dirty = true;
    const changed = () => { this.dirty = true; };
    this.player = new Player(this.recording.times, changed);
    this.scene = new RunScene(element("scene"), this.recording);
    this.camera = new Camera(element("scene"), this.scene, changed);
    this.camera.show();
    const seek = (time) => {
      this.player.play(false);
      this.player.seek(time);
    };
    this.events = new EventList(element("events"), this.recording, seek);
    this.plot = new LedgerPlot(
      element("ledger"), element("cursor"), element("legend"), this.recording, (time) => this.player.seek(time));
    this.plot.showChange(element("change").checked);
    this.pace = new Pace();
    this.frames = 0;
    this.addTexts();
    this.addControls();
    this.addEventControls();
    this.addSaving();
    this.addSheets();
    this.addHover();
    new ResizeObserver(() => this.resize()).observe(document.body);
    this.resize();
    this.camera.fit();
    let before = performance.now();
    const frame = (now) => {
      this.player.advance(Math.min(0.25, (now - before) / 1000));
      if (this.pace.note(now - before, this.player.isPlaying)) this.changePace();
      before = now;
      if (this.dirty) this.draw();
      if (this.video && !this.player.isPlaying) this.video.stop(); // at the end, or where it was paused
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  changePace() {
    const { isSparing } = this.pace;
    element("pace").hidden = !isSparing;
    this.scene.resize(isSparing ? 1 : undefined);
    this.dirty = true;
  }

  resize() {
    this.scene.resize(this.pace.isSparing ? 1 : undefined);
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
    const words = new Set([...(recording.contact_mode.length ? ["stick", "slip", "impact"] : []), ...this.events.kinds]);
    element("modes").replaceChildren(...[...words].map((word) => {
      const item = document.createElement("span");
      item.innerHTML = "<i></i>";
      item.firstChild.style.background = colourOf(word);
      item.append(word.replaceAll("_", " "));
      return item;
    }));
    element("scene").setAttribute("aria-label", `${recording.title}: ${element("facts").textContent}`);
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
    element("arrows").addEventListener("change", (event) => {
      this.scene.showsArrows = event.target.checked;
      element("arrow").hidden = !event.target.checked || !(this.scene.impulseOfArrow() > 0);
      this.dirty = true;
    });
    element("arrow-size").addEventListener("input", (event) => {
      this.scene.arrowFactor = 10 ** Number(event.target.value);
      this.dirty = true;
    });
    element("change").addEventListener("change", (event) => {
      this.plot.showChange(event.target.checked);
      this.dirty = true;
    });
    element("space").checked = element("space").disabled = this.scene.isSpatial;
    element("space").addEventListener("change", (event) => {
      this.scene.showSpace(event.target.checked);
      camera.show();
    });
    element("names").replaceChildren(...recording.bodies.slice(0, 2000).map((name) => new Option(name)));
    element("followed").addEventListener("change", (event) => this.followNamed(event.target.value.trim()));
    element("followed").addEventListener("input", (event) => event.target.setCustomValidity(""));
    document.addEventListener("keydown", (event) => this.key(event));
  }

  addEventControls() {
    const { events, recording } = this, [kind, body, find] = ["kind", "of-body", "find"].map(element);
    kind.replaceChildren(new Option("all kinds", ""), ...events.kinds.map((each) => new Option(each.replaceAll("_", " "), each)));
    const filter = () => {
      const full = body.value.trim() && this.bodyNamed(body.value.trim());
      body.setCustomValidity(full === undefined ? "there is no body of this name" : "");
      events.filter({ kind: kind.value, body: full ?? body.value, text: find.value });
      this.dirty = true;
    };
    for (const control of [kind, body, find]) control.addEventListener("input", filter);
    kind.disabled = body.disabled = find.disabled = recording.event_time.length === 0;
  }

  addSaving() {
    const { player, recording } = this, canvas = element("scene"), button = element("video");
    element("png").addEventListener("click", () => savePicture(canvas, recording.title, () => this.draw()));
    button.addEventListener("click", () => {
      if (this.video) return this.video.stop();
      try {
        this.video = new Video(canvas, recording.title, () => {
          this.video = null;
          button.setAttribute("aria-pressed", "false");
        });
      } catch (error) {
        button.title = error.message;
        button.disabled = true;
        return;
      }
      button.setAttribute("aria-pressed", "true");
      player.seek(player.start);
      player.play(true);
    });
  }

  /** On a small screen events and energies lie over the scene where they are asked for. */
  addSheets() {
    const buttons = [...document.querySelectorAll(".sheet")];
    const sheetOf = (button) => element(button.getAttribute("aria-controls"));
    for (const button of buttons) {
      button.addEventListener("click", () => {
        const opens = !sheetOf(button).classList.contains("open");
        for (const each of buttons) {
          const isOpen = opens && each === button;
          sheetOf(each).classList.toggle("open", isOpen);
          each.setAttribute("aria-expanded", String(isOpen));
        }
        this.resize();
      });
    }
  }

  key(event) {
    if (event.target.matches("input[list], input[type=search], select, input[type=range]:not(#time)")) return;
    if (event.key === " " && event.target.matches("button, input:not(#time)")) return; // it presses what has the focus
    const actions = {
      " ": () => this.player.play(!this.player.isPlaying), ArrowLeft: () => this.player.step(-1),
      ArrowRight: () => this.player.step(1), Home: () => this.player.seek(this.player.start),
      End: () => this.player.seek(this.player.end), f: () => element("fit").click(),
    };
    if (!actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  }

  /** Full name of the body of a name, or of its own name where only one has it; undefined: there is none. */
  bodyNamed(name) {
    const { bodies } = this.recording, own = bodies.filter((full) => full.endsWith(` '${name}'`));
    return own.length === 1 ? own[0] : bodies.find((full) => full === name);
  }

  /** Follows a body by its full name, or by its own where only one has it; says so where there is none. */
  followNamed(name) {
    const { bodies } = this.recording, field = element("followed");
    const own = bodies.filter((full) => full.endsWith(` '${name}'`));
    const pose = bodies.indexOf(this.bodyNamed(name)) + 1;
    this.follow(pose);
    if (pose > 0 || name === "") return;
    field.value = name; // to be mended
    field.setCustomValidity(own.length > 1 ? `${own.length} bodies have this name` : "there is no body of this name");
    field.reportValidity();
  }

  /** Follows the body of a pose; 0: none. */
  follow(pose) {
    const { camera, scene, recording } = this;
    const isBody = pose > 0 && pose <= recording.bodies.length;
    camera.last = null;
    camera.follows = isBody ? () => scene.poses.place(pose) : () => null;
    element("followed").value = isBody ? recording.bodies[pose - 1] : "";
    element("followed").setCustomValidity("");
    this.dirty = true;
  }

  addHover() {
    const canvas = element("scene"), label = element("label");
    canvas.addEventListener("pointermove", (event) => {
      const text = event.buttons ? "" : this.textAt(event.offsetX, event.offsetY);
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
    canvas.addEventListener("dblclick", (event) => this.follow(this.poseAt(event.offsetX, event.offsetY)));
  }

  /** Pose of what is seen at a pixel; -1: nothing. */
  poseAt(px, py) {
    const { recording, scene, camera } = this, at = camera.sceneAt(px, py);
    const solid = scene.inSpace ? scene.space.poseAlong(scene.poses, at, camera.back) : -1;
    if (solid > 0 && solid <= recording.bodies.length) return solid;
    const flat = poseAt(recording, scene.poses, camera, px, py, !scene.inSpace);
    return flat >= 0 ? flat : solid;
  }

  pick(pose) {
    if (this.scene.uniforms.picked.value === pose) return;
    this.scene.uniforms.picked.value = pose;
    this.dirty = true;
  }

  /** Text about what is at a pixel. */
  textAt(px, py) {
    const { recording, scene, camera } = this, { dimension: d } = recording, { sample } = this.player.place();
    const contact = scene.showsContacts ? contactAt(recording, scene.contactRange(sample), camera, px, py) : -1;
    if (contact >= 0) {
      this.pick(-1);
      const mode = recording.contact_impact[contact] ? "impact" : recording.modes[recording.contact_mode[contact]];
      const [normal, ...tangential] = recording.contact_impulse.subarray(d * contact, d * contact + d);
      return `${recording.names[recording.contact_name[contact]]}\n${mode.replace("_", " ")}, impulse ` +
        `${shown(normal)} N s normal, ${shown(d === 2 ? tangential[0] : Math.hypot(...tangential))} N s tangential`;
    }
    const pose = this.poseAt(px, py);
    this.pick(pose);
    if (pose < 0) return "";
    if (pose > recording.bodies.length) return recording.obstacles[pose - recording.bodies.length - 1].name;
    const turned = d === 3 || recording.particles.includes(pose) ? "" : `, ${shown(scene.poses.angle(pose))} rad`;
    const place = scene.poses.place(pose).slice(0, d).map((value) => `${shown(value)} m`);
    return `${recording.bodies[pose - 1]}\nat ${place.join(", ")}${turned}`;
  }

  draw() {
    this.dirty = false;
    const { player, scene, camera } = this;
    const { sample, fraction } = player.place();
    scene.draw(camera, { sample, fraction, time: player.time, speed: player.speed });
    if (this.pace.isTimeForControls(performance.now(), player.isPlaying)) this.drawControls(sample);
    ++this.frames;
  }

  drawControls(sample) {
    const { player } = this;
    this.plot.draw(player.time, sample, player.isPlaying);
    this.events.follow(player.time);
    element("time").value = player.end > player.start ? (player.time - player.start) / (player.end - player.start) : 0;
    element("now").textContent = `${player.time.toFixed(4)} s`;
    element("play").dataset.playing = String(player.isPlaying);
    element("play").setAttribute("aria-label", player.isPlaying ? "Pause" : "Play");
    this.drawScale();
  }

  /** A round length that is about 100 pixels long. */
  drawScale() {
    const length = roundLength(100 / this.camera.scale);
    element("arrow").firstElementChild.style.width = `${this.scene.arrowLength(this.camera)}px`;
    element("scale").firstElementChild.style.width = `${length * this.camera.scale}px`;
    element("scale").lastElementChild.textContent = `${shown(length)} m`;
  }
}

window.caromPage = new Page();
