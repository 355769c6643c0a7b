// One scene on the page: its connection, its picture, its focal agent.

import { Connection } from "./connection.js";
import { Drawing } from "./draw.js";
import { readEvent, readExplanation, readFrame, readScene, vector, vectorOf } from "./frame.js";
import { drawFigure } from "./picture.js";
import { agents, backdrop } from "./sketch.js";
import { readShape } from "./solids.js";
import { inLight } from "./vector.js";
import { clamp, colours, drawn, element, isNumber, roundLength, withUnit } from "./words.js";

// an explanation comes right after its frame: a picture waits so many pictures of the screen for it, not longer
const PATIENCE = 6;
const KEPT_EXPLANATIONS = 8;
const LABELS_FROM = 80;

export class Pane {
  /** `told` has what is called: hello, state, scene, status, metrics, event, file, problem, drawn, picked. */
  constructor(place, told, name) {
    this.told = told;
    this.place = place;
    this.canvas = element("canvas", { tabIndex: 0, role: "application" });
    this.canvas.setAttribute("aria-label", `${name}. Arrow keys step, N and P go from agent to agent, question mark lists all keys`);
    this.overlay = drawn("svg", { class: "overlay", "aria-hidden": "true" });
    this.scale = element("p", { className: "scale" });
    this.veil = element("div", { className: "veil", role: "status" });
    place.append(this.canvas, this.overlay, this.scale, this.veil);
    Object.assign(this, {
      scene: null, frame: null, pending: null, unseen: [], status: null, focal: null, explanations: new Map(), waited: 0, awaited: PATIENCE,
      opened: null, changes: new Map(), restores: null, camera: "still", wantsPicture: false, ended: false, asked: null,
    });
    try {
      this.drawing = new Drawing(this.canvas);
      this.drawing.setColours(colours());
    } catch (error) {
      this.drawing = null;
      this.refused = `The picture cannot be drawn: ${error.message}.`;
    }
    this.listen();
    this.sizes = new ResizeObserver(() => this.resize());
    this.sizes.observe(place);
    this.show("Connecting…");
    this.connection = new Connection({
      state: (state, seconds) => this.connectionChanged(state, seconds),
      message: (message) => this.receive(message),
      frame: (buffer) => this.receiveFrame(buffer),
      broken: (text) => told.problem(this, `The server sent something this page cannot read: ${text}.`),
    });
  }

  end() {
    this.ended = true;
    this.sizes.disconnect();
    this.connection.end();
    this.drawing?.gl.getExtension("WEBGL_lose_context")?.loseContext();
    this.place.remove();
  }

  /** A word over the picture, or nothing. */
  show(text) {
    this.veil.textContent = this.refused ?? text;
    this.veil.hidden = this.veil.textContent === "";
  }

  // ------------------------------------------------ what is sent

  send(message) { return this.connection.send(message); }

  open(what) {
    Object.assign(this, { opened: what, restores: null, scene: null, focal: null });
    this.changes.clear();
    this.show("Opening…");
    this.send({ do: "open", ...what });
  }

  set(path, value) {
    this.changes.set(path, value);
    this.send({ do: "set", path, value });
  }

  focus(agent) {
    this.focal = agent;
    this.explanations.clear();
    this.awaited = agent === null ? PATIENCE : 0;
    this.send({ do: "focus", agent });
    // who was chosen is seen before the explanation comes
    if (this.drawing && this.scene) this.annotate();
    this.request();
  }

  // ------------------------------------------------ what comes

  connectionChanged(state, seconds) {
    if (state === "lost") {
      const { playing = false, rate = null, frame = null } = this.status ?? {};
      this.restores ??= this.scene && { playing, rate, frame, seed: this.scene.seed, loop: this.loop };
      this.show(this.scene ? "" : "The server does not answer. Is flockworks view still running?");
    }
    this.told.state(this, state, seconds);
  }

  receive(message) {
    const act = {
      hello: () => {
        this.told.hello(this, { program: String(message.program ?? "flockworks"), given: Array.isArray(message.given) ? message.given : [] });
        // after a lost connection: what was open before
        if (this.restores && this.opened) this.send({ do: "open", ...this.opened });
      },
      scene: () => this.receiveScene(readScene(message)),
      obstacles: () => {
        this.drawing?.setObstacles((message.list ?? []).map(readShape).filter((shape) => shape !== null));
        this.request();
      },
      items: () => { this.drawing?.setItems((message.places ?? []).map(vector)); this.request(); },
      status: () => {
        const number = (value) => (isNumber(value) ? value : null);
        this.status = {
          playing: message.playing === true, step: number(message.step), t: number(message.t), frame: number(message.frame),
          rate: number(message.rate), reached: number(message.reached),
        };
        this.told.status(this);
        this.request();
      },
      metrics: () => { if (this.scene) this.told.metrics(this, message); },
      metrics_all: () => { if (this.scene) this.told.metrics(this, message); },
      explain: () => {
        const explanation = readExplanation(message.explanation);
        if (explanation.agent !== this.focal) return;
        this.explanations.set(explanation.step, explanation);
        if (this.explanations.size > KEPT_EXPLANATIONS) this.explanations.delete(this.explanations.keys().next().value);
        this.request();
      },
      event: () => this.told.event(this, readEvent(message)),
      file: () => { if (typeof message.text === "string") this.told.file(this, message.text); },
      problem: () => this.told.problem(this, String(message.text ?? "The server met a problem.")),
    }[message.is];
    // a message of a later protocol is no error
    act?.();
  }

  receiveScene(scene) {
    const before = this.scene;
    const isSame = before !== null && ["title", "dimensions", "isRun"].every((name) => before[name] === scene[name]);
    Object.assign(this, { scene, frame: null, pending: null, asked: null });
    this.explanations.clear();
    this.drawing?.setScene(scene, isSame);
    this.show(scene.agents === 0 ? "Nobody is in this scene." : "");
    if (!isSame) {
      this.focal = null;
      this.camera = scene.of === "" && scene.space.edges.every((edge) => edge === "open") ? "flock" : "still";
    }
    if (this.focal !== null && this.focal >= scene.agents) this.focal = null;
    if (this.focal !== null) this.send({ do: "focus", agent: this.focal });
    this.told.scene(this, isSame);
    const { restores } = this;
    this.restores = null;
    if (restores) this.restore(restores);
    this.request();
  }

  /** Puts a scene that was opened again into the state it had: values, pace, place. */
  restore({ playing, rate, frame, seed, loop }) {
    if (!this.scene.isRun && seed !== null && seed !== this.scene.seed) this.send({ do: "reset", seed });
    for (const [path, value] of this.changes) this.send({ do: "set", path, value });
    if (rate !== null) this.send({ do: "speed", rate });
    if (loop) this.send({ do: "loop", on: true });
    if (this.scene.isRun && frame !== null) this.send({ do: "seek", frame });
    if (playing) this.send({ do: "play" });
  }

  receiveFrame(buffer) {
    const frame = readFrame(buffer);
    this.unseen.push(frame.number);
    if (!this.scene) return;
    if (frame.dimensions !== this.scene.dimensions || frame.agents > this.scene.agents) {
      this.answer();
      throw new Error("a frame of another scene");
    }
    this.pending = frame;
    this.waited = 0;
    this.request();
  }

  /** The server sends on when it knows that its frames were drawn, or passed over for a later one. */
  answer() {
    for (const number of this.unseen.splice(0)) this.send({ do: "seen", number });
  }

  // ------------------------------------------------ the picture

  request() {
    if (this.wantsPicture || this.ended) return;
    this.wantsPicture = true;
    requestAnimationFrame((now) => {
      this.wantsPicture = false;
      if (!this.ended) this.picture(now);
    });
  }

  get explanation() { return this.frame && this.focal !== null ? this.explanations.get(this.frame.step) ?? null : null; }

  headingOf(agent) { return this.frame ? vectorOf(this.frame.headings, this.frame, agent) : null; }

  picture(now) {
    if (!this.scene) return;
    // a picture of agents would come between a click and its answer
    if (this.frame && this.awaited < PATIENCE && this.explanations.size === 0) {
      this.awaited += 1;
      this.request();
      return;
    }
    if (this.pending) {
      // frames that were under way when the agent was chosen come without
      const isUnexplained = this.focal !== null && this.explanations.size > 0 && !this.explanations.has(this.pending.step);
      if (isUnexplained && this.frame && this.waited < PATIENCE) {
        this.waited += 1;
        this.request();
        return;
      }
      this.frame = this.pending;
      this.pending = null;
      this.drawing?.setFrame(this.frame);
    }
    if (this.drawing) {
      this.aim();
      this.drawing.draw();
      this.annotate();
    }
    this.answer();
    this.told.drawn(this, now);
  }

  aim() {
    const { camera } = this.drawing;
    if (!this.frame) return;
    if (this.camera === "flock") this.drawing.keepInView(!this.hasOwnZoom);
    const target = this.camera === "agent" && this.focal !== null ? vectorOf(this.frame.positions, this.frame, this.focal) : null;
    if (target) camera.centre = target;
  }

  annotate() {
    const { camera } = this.drawing;
    const long = roundLength(110 / camera.scale);
    this.scale.style.width = `${long * camera.scale}px`;
    const written = withUnit(long, this.scene.units.length);
    this.scale.dataset.length = camera.isSpace ? `${written} in the middle` : written;
    const explanation = this.explanation;
    const view = {
      project: (place) => camera.project(place), wide: camera.wide, tall: camera.tall, isSpace: camera.isSpace, hatch: "hatch",
      radius: (scale) => clamp(this.drawing.halfLength(explanation?.radius ?? 0, scale), 3, 60), withBodies: false, headingOf: () => null,
    };
    if (explanation && !explanation.recorded) {
      const range = explanation.sensing.range ?? Math.max(...explanation.sets.map((set) => set.high ?? 0), 0);
      view.withLabels = range * camera.scale >= LABELS_FROM;
      drawFigure(this.overlay, explanation, view, this.scene.units);
      return;
    }
    const place = this.focal === null || !this.frame ? null : vectorOf(this.frame.positions, this.frame, this.focal);
    if (!place) { if (this.overlay.firstChild) this.overlay.replaceChildren(); return; }
    const [x, y, , scale] = camera.project(place);
    this.overlay.replaceChildren(drawn("circle", { cx: x, cy: y, r: view.radius(scale) + 6, class: "focal-ring", "data-agent": this.focal }));
  }

  /** The scene as a drawing with its data; null where there is none. */
  figure() {
    const { scene, frame, drawing } = this;
    if (!scene || !frame || !drawing) return null;
    const { camera, ends, obstacles } = drawing, D = scene.dimensions, axes = ["x", "y", "z"].slice(0, D);
    const groupOf = (agent) => scene.groups.find(({ first, count }) => agent >= first && agent < first + count)?.name ?? "";
    const rows = [["agent", "group", ...axes, ...axes.map((axis) => `heading_${axis}`)]];
    for (let agent = 0; agent < frame.agents; agent += 1) {
      const [place, heading] = [frame.positions, frame.headings].map((values) => Array.from(values.subarray(agent * D, agent * D + D)));
      rows.push([agent, groupOf(agent), ...place, ...heading]);
    }
    const draw = (pen) => {
      const light = inLight(colours);
      backdrop(pen, scene, camera, obstacles, light, ends);
      agents(pen, scene, camera, frame, light, frame.agents);
    };
    return { wide: camera.wide, tall: camera.tall, rows, draw };
  }

  resize() {
    const { clientWidth: wide, clientHeight: tall } = this.place;
    if (wide === 0 || tall === 0) return;
    this.overlay.setAttribute("viewBox", `0 0 ${wide} ${tall}`);
    this.drawing?.resize(wide, tall);
    // a canvas that changed its size is blank until it is drawn
    this.drawing?.draw();
    this.request();
  }

  repaint() { this.drawing?.setColours(colours()); this.request(); }

  setCamera(mode) { this.camera = mode; this.hasOwnZoom = false; this.request(); }
  fit() { if (this.drawing && this.scene) { this.hasOwnZoom = false; this.drawing.fit(); this.request(); } }
  zoom(by, x, y) { if (this.drawing) { this.hasOwnZoom = true; this.drawing.camera.zoom(by, x, y); this.request(); } }
  /** Moves what is seen by so much of the canvas: a flat view slides, a space turns. */
  move(across, down, slides = false) {
    if (!this.drawing) return;
    const { camera } = this.drawing;
    if (camera.isSpace && !slides) camera.turnBy(across * 0.008, down * 0.008);
    else { camera.pan(across, down); if (this.camera !== "still") { this.camera = "still"; this.told.status(this); } }
    this.request();
  }
  /** Goes near: the agent's range fills the canvas, and the camera goes with it. */
  closer() {
    if (!this.drawing || this.focal === null) return;
    const { explanation } = this;
    const reach = explanation ? (explanation.sensing.range ?? Math.max(...explanation.sets.map((set) => set.high ?? 0), 0)) : 0;
    this.drawing.camera.showLength(2 * (reach > 0 ? reach : this.drawing.camera.radius / 8), 0.86);
    this.setCamera("agent");
  }

  listen() {
    const { canvas } = this;
    const touching = new Map();
    let moved = 0;
    const at = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
    canvas.addEventListener("pointerdown", (event) => {
      touching.set(event.pointerId, at(event));
      if (touching.size === 1) moved = 0;
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = touching.get(event.pointerId);
      if (!before) return;
      const here = at(event), [across, down] = [here[0] - before[0], here[1] - before[1]];
      moved += Math.abs(across) + Math.abs(down);
      const other = [...touching.entries()].find(([id]) => id !== event.pointerId)?.[1];
      touching.set(event.pointerId, here);
      if (other) {
        const [apart, was] = [here, before].map(([x, y]) => Math.hypot(x - other[0], y - other[1]));
        this.zoom(apart / Math.max(1, was), (here[0] + other[0]) / 2, (here[1] + other[1]) / 2);
      } else if (moved > 4) this.move(across, down, event.shiftKey || event.buttons === 2);
    });
    canvas.addEventListener("pointerup", (event) => {
      if (touching.delete(event.pointerId) && moved <= 4 && event.button === 0) this.told.picked(this, this.drawing?.pick(...at(event)) ?? null);
    });
    canvas.addEventListener("pointercancel", (event) => touching.delete(event.pointerId));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-clamp(event.deltaY, -120, 120) * 0.002), ...at(event));
    }, { passive: false });
    canvas.addEventListener("webglcontextlost", (event) => { event.preventDefault(); if (!this.ended) this.show("The picture was lost; waiting for it to come back…"); });
    canvas.addEventListener("webglcontextrestored", () => { this.drawing.restore(); this.show(""); this.request(); });
  }
}
