// The moving turbine and its controls.

import { fixed, general, labelled, make, section } from "./format.js";
import { frequencyOf } from "./modes.js";
import { Motion } from "./motion.js";
import { View } from "./scene.js";
import { canMove } from "./selection.js";
import { TransientMotion } from "./transient.js";

const QUIET = matchMedia("(prefers-reduced-motion: reduce)");
const SWING_HZ = 0.4; // of the picture of an exponent without a frequency
const ROTATION = 9; // [rad], the largest rotation in a picture relative to the amplitude
const degrees = (angle) => angle * 180 / Math.PI;

export class Player {
  constructor(results, selection, clock) {
    this.results = results;
    this.selection = selection;
    this.clock = clock;
    this.motions = new Map();
    this.time = 0;
    this.isPlaying = !QUIET.matches;
    this.isSeen = true;
    this.makeControls();
    this.canvas = make("canvas", { tabindex: "0", role: "application", "aria-label": "Turbine in three dimensions",
                                   "aria-describedby": "view-keys" });
    this.stage = make("div", { class: "stage" }, this.canvas);
    this.told = make("p", { class: "told", role: "status" });
    this.element = section("view", "Turbine", this.stage, this.told, this.controls,
      make("p", { class: "note", id: "view-keys" }, "Pointer: drag turns, wheel approaches, right button moves. Keyboard, with " +
           "the picture focused: arrows turn, + and - approach, space plays and pauses, Home resets the view."));
    this.view = null;
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    new IntersectionObserver((entries) => { this.isSeen = entries.at(-1).isIntersecting; }).observe(this.stage);
    selection.addEventListener("change", () => this.follow());
    clock.addEventListener("chosen", () => this.goTo(clock.result, clock.time));
    this.setSource(this.what.value);
  }

  /** Begins to draw. */
  start() {
    try {
      this.view = new View(this.canvas);
    } catch {
      this.stage.replaceChildren(make("p", { class: "warning", role: "alert" },
        "This browser has no WebGL, so the turbine cannot be drawn. Tables and diagrams work without it."));
      this.controls.hidden = true;
      return;
    }
    this.frameTurbine();
    requestAnimationFrame((now) => this.frame(now));
  }

  /** Puts the turbine of the present result into the view. */
  frameTurbine() {
    const places = this.isRun ? this.motion.times(24).map((t) => this.motion.steady(t).place)
      : this.turns ? [0, 1, 2, 3, 4, 5, 6, 7].map((i) => this.motion.steady(i * Math.PI / 4).place)
      : [this.motion.steady(0).place, this.motion.steady(this.geometry.kind === "path" ? Number(this.state.max) : 0).place];
    this.view.setGeometry(this.geometry, this.motion.steady(this.isRun ? this.motion.begin : 0), places);
    this.isMoved = true;
  }

  makeControls() {
    const changed = () => { this.isMoved = true; this.tell(); };
    this.what = make("select", { onchange: () => this.setSource(this.what.value, true) });
    for (const [r, entry] of this.results.entries()) {
      if (!entry.geometry) continue;
      const group = make("optgroup", { label: `${entry.file}: ${entry.title}` });
      group.append(make("option", { value: `${r}` },
        { path: "equilibria of the load path", transient: "time series" }[entry.geometry.kind] ?? "steady state"));
      for (const [m, label] of entry.modes?.label.entries() ?? [])
        if (canMove(entry, m))
          group.append(make("option", { value: `${r} ${m}` }, `${label}, ${fixed(frequencyOf(entry.modes, m), 4)} Hz`));
      this.what.append(group);
    }
    this.play = make("button", { type: "button", class: "main", onclick: () => this.setPlaying(!this.isPlaying) });
    const slider = (low, high, step, value, attributes = {}) =>
      make("input", { type: "range", min: low, max: high, step, value, oninput: changed, ...attributes });
    this.amplitude = slider(0, 20, 0.5, 6);
    this.magnification = slider(1, 20, 0.5, 1);
    this.speed = slider(-2, 1, 0.05, 0);
    this.azimuth = slider(0, 360, 1, 0);
    this.state = slider(0, 1, 0.01, 1);
    this.instant = slider(0, 1, "any", 0, { oninput: () => this.setTime(Number(this.instant.value)) });
    const name = "rotor";
    this.turning = make("input", { type: "radio", name, value: "turning", checked: true, onchange: () => this.setRotor() });
    this.held = make("input", { type: "radio", name, value: "held", onchange: () => this.setRotor() });
    this.ghost = make("input", { type: "checkbox", checked: true, onchange: changed });
    this.rotor = make("fieldset", {}, make("legend", {}, "Rotor"), labelled("turning", this.turning),
                      labelled("held at an azimuth", this.held));
    this.reset = make("button", { type: "button", onclick: () => this.view?.resetCamera() }, "Reset view");
    this.fields = { amplitude: labelled("Amplitude", this.amplitude), magnification: labelled("Magnification", this.magnification),
                    speed: labelled("Speed", this.speed), azimuth: labelled("Azimuth", this.azimuth),
                    state: labelled("State of the path", this.state), instant: labelled("Time", this.instant) };
    this.outline = labelled("undeformed outline", this.ghost);
    this.outputs = {};
    for (const [key, field] of Object.entries(this.fields)) {
      this.outputs[key] = make("output", { for: field.querySelector("input").id });
      field.append(this.outputs[key]);
    }
    this.controls = make("div", { class: "controls" }, labelled("Motion", this.what, "wide"),
      make("div", { class: "fields" }, this.play, this.reset, this.outline, this.rotor),
      make("div", { class: "fields sliders" }, Object.values(this.fields)));
    this.setPlaying(this.isPlaying);
  }

  get geometry() { return this.results[this.result].geometry; }
  get modes() { return this.results[this.result].modes; }
  get turns() { return this.geometry.kind === "periodic"; }
  get isRun() { return this.geometry.kind === "transient"; }
  get isHeld() { return !this.turns || this.held.checked; }

  setPlaying(isPlaying) {
    this.isPlaying = isPlaying;
    this.play.textContent = isPlaying ? "Pause" : "Play";
  }

  setRotor() {
    if (this.held.checked) this.azimuth.value = Math.round(degrees(this.turned() + this.geometry.azimuth[0])) % 360;
    this.isMoved = true;
    this.show();
  }

  /** Takes a source "result" or "result mode". By hand: the whole page chooses the mode. */
  setSource(value, byHand = false) {
    const [result, mode] = value.split(" ").map(Number);
    const isOther = result !== this.result;
    this.result = result;
    this.mode = mode ?? null;
    if (!this.motions.has(result))
      this.motions.set(result, this.isRun ? new TransientMotion(this.results[result]) : new Motion(this.results[result]));
    this.motion = this.motions.get(result);
    this.what.value = value;
    if (isOther && this.geometry.kind === "path") {
      this.state.max = this.geometry.factor.length - 1;
      this.state.value = this.state.max;
    }
    if (this.mode !== null) {
      this.size = this.motion.largest(this.mode);
      const frequency = frequencyOf(this.modes, this.mode);
      // One cycle in two seconds, and no faster than the motion itself.
      this.speed.value = Math.min(0, Math.log10(0.5 / Math.max(frequency, 0.5)));
    } else this.speed.value = 0;
    this.time = this.isRun ? this.motion.begin : 0;
    if (this.isRun) Object.assign(this.instant, { min: this.motion.begin, max: this.motion.end, value: this.motion.begin });
    if (isOther && this.view) this.frameTurbine();
    this.isMoved = true;
    this.show();
    this.tellTime();
    if (byHand)
      this.selection.choose(this.mode === null ? {} : { result, mode, label: this.modes.label[this.mode] });
  }

  /** Stands at a time of a time series with places of nodes. */
  goTo(result, time) {
    if (this.results[result].geometry?.kind !== "transient") return;
    if (result !== this.result) this.setSource(`${result}`, true);
    this.setPlaying(false);
    this.setTime(time);
  }

  setTime(time) {
    this.time = Math.min(Math.max(time, this.motion.begin), this.motion.end);
    this.instant.value = this.time;
    this.isMoved = true;
    this.tellTime();
  }

  /** The time for the diagrams and beside the slider. */
  tellTime() {
    this.outputs.instant.textContent = this.isRun ? `${fixed(this.time, 3)} s` : "";
    this.clock.show(this.isRun ? this.result : null, this.isRun ? this.time : null);
  }

  follow() {
    const { result, mode, label } = this.selection;
    if (result === null || mode === null) {
      if (label !== null) this.told.textContent = `${label}: no result of modes on this page has a shape of this name.`;
      return;
    }
    if (result === this.result && mode === this.mode) return;
    if (canMove(this.results[result], mode)) this.setSource(`${result} ${mode}`);
    else {
      const modes = this.results[result].modes;
      const why = !modes.motions || !this.results[result].geometry ? "the result has no shapes of modes"
        : modes.resolved[mode] !== 1 ? "the mode is unresolved" : modes.air[mode] ? "it is a mode of the air"
        : "it is left out for the size of the page";
      this.told.textContent = `${label}: has no shape here, ${why}.`;
    }
  }

  /** Which controls there are. */
  show() {
    const isMode = this.mode !== null;
    const isPath = this.geometry.kind === "path";
    this.rotor.hidden = !this.turns;
    this.fields.amplitude.hidden = !isMode;
    this.fields.magnification.hidden = isMode || this.isRun;
    this.fields.state.hidden = !isPath;
    this.fields.instant.hidden = !this.isRun;
    this.outline.hidden = this.isRun;
    this.fields.azimuth.hidden = !this.turns || !this.isHeld;
    const moves = isMode || (this.turns && !this.isHeld) || isPath || this.isRun;
    this.fields.speed.hidden = !moves;
    this.play.hidden = !moves;
    this.tell();
  }

  tell() {
    const speed = 10 ** Number(this.speed.value);
    this.outputs.amplitude.textContent = `${general(Number(this.amplitude.value), 3)} % of size`;
    this.outputs.magnification.textContent = `${general(Number(this.magnification.value), 3)} ×`;
    this.outputs.speed.textContent = `${general(speed, 2)} × real time`;
    this.outputs.azimuth.textContent = `${this.azimuth.value}°`;
    if (this.geometry.kind === "path") {
      const at = Number(this.state.value);
      const first = Math.min(Math.floor(at), this.geometry.factor.length - 1);
      const next = Math.min(first + 1, this.geometry.factor.length - 1);
      const factor = this.geometry.factor[first] + (at - first) * (this.geometry.factor[next] - this.geometry.factor[first]);
      this.outputs.state.textContent = `load factor ${general(factor, 3)}`;
    }
    if (this.isRun) {
      const { time, rows, is_even: isEven } = this.geometry;
      this.told.textContent = `Time series: ${time.length} of ${rows} rows` +
        (isEven ? "" : "; no motion between them, because the rotor turns too far from one to the next");
      return;
    }
    const title = this.mode === null ? (this.geometry.kind === "path" ? "Equilibria of the load path" : "Steady state")
      : this.modes.label[this.mode];
    const frequency = this.mode === null ? null : frequencyOf(this.modes, this.mode);
    const text = frequency === null ? title : frequency > 0 ? `${title}, ${fixed(frequency, 4)} Hz`
      : `${title}: no frequency; the picture swings its shape`;
    const left = this.modes?.motions?.left_out ?? 0;
    this.told.textContent = text + (left > 0 ? ` (${left} modes of higher frequency have no shape here, for the size of the page)` : "");
  }

  /** Angle that the rotor has turned since t = 0. */
  turned() {
    if (!this.turns) return 0;
    return this.held.checked ? this.motion.turnedAt(Number(this.azimuth.value) * Math.PI / 180)
      : this.geometry.rotor_speed * this.time;
  }

  scale() {
    const wanted = Number(this.amplitude.value) / 100;
    const { displacement, rotation } = this.size;
    const bound = Math.min(displacement > 0 ? this.geometry.size / displacement : Infinity,
                           rotation > 0 ? ROTATION / rotation : Infinity);
    return Number.isFinite(bound) ? wanted * bound : 0;
  }

  /** Places and axes at the present time. */
  pose() {
    if (this.isRun) return this.motion.steady(this.time);
    if (this.mode === null)
      return this.motion.steady(this.geometry.kind === "path" ? Number(this.state.value) : this.turned(),
                                Number(this.magnification.value));
    const frequency = frequencyOf(this.modes, this.mode);
    // A real exponent has the frequency 0: while the rotor turns, its shape repeats with the rotor.
    const swing = frequency === 0 && this.isHeld ? SWING_HZ / 10 ** Number(this.speed.value) : frequency;
    const phase = frequency === 0 && !this.isHeld ? 0 : 2 * Math.PI * swing * this.time;
    return this.motion.moved(this.mode, phase, this.turned(), this.scale());
  }

  frame(now) {
    requestAnimationFrame((next) => this.frame(next));
    const passed = Math.min(0.1, (now - (this.before ?? now)) / 1000);
    this.before = now;
    if (!this.isSeen || document.hidden) return;
    if (this.isPlaying && !this.play.hidden) {
      this.time += passed * 10 ** Number(this.speed.value);
      if (this.isRun) this.setTime(this.time < this.motion.end ? this.time : this.motion.begin);
      if (this.geometry.kind === "path" && this.mode === null) {
        const last = Number(this.state.max);
        this.state.value = (Number(this.state.value) + passed * 10 ** Number(this.speed.value) * last / 5) % (last || 1);
        this.tell();
      }
      this.isMoved = true;
    }
    if (this.isMoved) {
      this.isMoved = false;
      const at = this.geometry.kind === "path" ? Number(this.state.value) : this.turned();
      this.present = this.pose();
      this.view.move(this.present, this.ghost.checked && !this.isRun ? this.motion.undeformed(at) : null);
      this.frames = (this.frames ?? 0) + 1;
    }
    this.view.render();
  }

  key(event) {
    const step = 0.1;
    const actions = { ArrowLeft: () => this.view.orbit(-step, 0), ArrowRight: () => this.view.orbit(step, 0),
                      ArrowUp: () => this.view.orbit(0, step), ArrowDown: () => this.view.orbit(0, -step),
                      "+": () => this.view.orbit(0, 0, 0.9), "=": () => this.view.orbit(0, 0, 0.9),
                      "-": () => this.view.orbit(0, 0, 1 / 0.9), Home: () => this.view.resetCamera(),
                      " ": () => this.setPlaying(!this.isPlaying) };
    if (!this.view || !actions[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    actions[event.key]();
  }

  colour() { this.view?.colour(); }
}

export function player(results, selection, clock) {
  return results.some(({ geometry }) => geometry) ? new Player(results, selection, clock) : null;
}
