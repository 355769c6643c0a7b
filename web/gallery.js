// The wall of built-in scenarios, and of what the command line named: those in view play, each over a connection of its own.

import { Camera } from "./camera.js";
import { Connection } from "./connection.js";
import { boundsOf, readFrame, readScene } from "./frame.js";
import { agents, backdrop } from "./sketch.js";
import { readShape } from "./solids.js";
import { colours, element, one, paragraphs, wantsCalm } from "./words.js";

// where nothing shall move, a card shows its scenario after so many steps, when something has happened
const STILL_STEPS = 120;
// time between two pictures of a card, in ms: there are many of them on the page
const PAUSE = 90;
const WIDE = 320, TALL = 200;

export class Gallery {
  constructor(place, openScenario) {
    Object.assign(this, { place, openScenario, cards: [], isLoaded: false });
    this.watch = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        const card = this.cards.find(({ box }) => box === target);
        if (card && !card.isSearch) { if (isIntersecting) card.preview ??= new Preview(card); else this.end(card); }
      }
    });
  }

  /** Shows the wall, with what the command line named before what is built in. */
  async show(given) {
    this.place.hidden = false;
    const wall = one(".wall", this.place), state = one(".state", this.place);
    if (!this.isLoaded) {
      state.textContent = "Loading the gallery…";
      try {
        const answer = await fetch("gallery.json");
        if (!answer.ok) throw new Error(`the server answered ${answer.status}`);
        const list = await answer.json();
        if (!Array.isArray(list)) throw new Error("the gallery is no list");
        this.list = list.filter((item) => item !== null && typeof item === "object" && typeof item.id === "string");
        this.isLoaded = true;
      } catch (error) {
        state.textContent = `The gallery did not come: ${error.message}.`;
        return;
      }
    }
    const named = given.map((item, index) => ({ given: index, title: String(item.name), isSearch: item.kind === "search", about: item.kind === "search" ? `A folder: ${item.of}.` : item.kind === "run" ? "A recorded run, named on the command line." : "A scenario, named on the command line or dropped here." }));
    state.textContent = this.list.length + named.length === 0 ? "There is nothing in the gallery." : "";
    this.cards.forEach((card) => this.end(card));
    this.cards = [...named, ...this.list].map((item) => this.card(item));
    wall.replaceChildren(...this.cards.map(({ box }) => box));
    this.begin();
  }

  hide() {
    this.place.hidden = true;
    this.watch.disconnect();
    this.cards.forEach((card) => this.end(card));
  }

  /** From now on, cards that come into view play. */
  begin() {
    this.watch.disconnect();
    this.cards.forEach((card) => { this.end(card); this.watch.observe(card.box); });
  }

  end(card) { card.preview?.end(); card.preview = null; }

  card(item) {
    const canvas = element("canvas", { width: WIDE, height: TALL });
    const facts = [item.dimensions ? `${item.dimensions}-D` : "", item.agents ? `${item.agents} agents` : "", ...(Array.isArray(item.models) ? item.models : [])];
    const about = element("p", { textContent: paragraphs(String(item.about ?? ""))[0] ?? "" });
    const button = element("button", { type: "button", className: "open", textContent: item.title ?? item.id });
    const box = element("li", { className: "card" }, canvas, element("h3", {}, button), about, element("p", { className: "facts-of", textContent: facts.filter(Boolean).join(" · ") }));
    canvas.setAttribute("aria-hidden", "true");
    // of a search there is no single scene
    const card = { box, canvas, what: item.given === undefined ? { gallery: item.id } : { given: item.given }, isSearch: item.isSearch === true, preview: null };
    box.dataset.id = item.id ?? `given-${item.given}`;
    button.addEventListener("click", () => this.openScenario(card.what));
    return card;
  }

  repaint() { if (!this.place.hidden) this.begin(); }
}

/** What a card shows: a simulation of its own, or a record. */
class Preview {
  constructor(card) {
    Object.assign(this, { card, scene: null, frame: null, unseen: [], obstacles: [], behind: null, timer: 0, waits: false, drawn: -Infinity, isCalm: wantsCalm() });
    this.camera = new Camera();
    this.connection = new Connection({
      state: () => {},
      message: (message) => this.receive(message),
      frame: (buffer) => {
        this.frame = readFrame(buffer);
        this.unseen.push(this.frame.number);
        if (this.scene && this.frame.dimensions === this.scene.dimensions) this.request(); else this.seen();
      },
      // a preview is no place for complaints: the scene itself says what is wrong
      broken: () => this.end(),
    });
  }

  end() { clearTimeout(this.timer); this.connection.end(); }

  /** The newest frame was drawn, and those before it passed over: the server sends none while two are unseen. */
  seen() { for (const number of this.unseen.splice(0)) this.connection.send({ do: "seen", number }); }

  receive(message) {
    const { connection } = this;
    if (message.is === "hello") connection.send({ do: "open", ...this.card.what });
    if (message.is === "problem") this.end();
    if (message.is === "scene") {
      Object.assign(this, { scene: readScene(message), frame: null, obstacles: [], behind: null });
      const { isRun, frames } = this.scene;
      if (this.isCalm) connection.send(isRun ? { do: "seek", frame: Math.floor(frames / 2) } : { do: "step", count: STILL_STEPS });
      else { if (isRun) connection.send({ do: "loop", on: true }); connection.send({ do: "play" }); }
    }
    if (message.is === "obstacles" && this.scene) {
      Object.assign(this, { obstacles: (message.list ?? []).map(readShape).filter((shape) => shape !== null), behind: null });
    }
  }

  request() {
    if (this.waits) return;
    this.waits = true;
    this.timer = setTimeout(() => requestAnimationFrame((now) => { this.waits = false; this.picture(now); }), Math.max(0, this.drawn + PAUSE - performance.now()));
  }

  picture(now) {
    const { card: { canvas }, frame, scene, camera } = this;
    if (this.connection.ended || !frame || !scene) return;
    this.drawn = now;
    const ratio = Math.min(devicePixelRatio || 1, 2), before = this.behind && [camera.scale, ...camera.centre];
    Object.assign(camera, { wide: WIDE, tall: TALL });
    camera.setBounds(scene.dimensions, ...boundsOf(scene, frame));
    camera.fit();
    // what does not move is drawn once
    if (!before || [camera.scale, ...camera.centre].some((value, at) => value !== before[at])) {
      this.behind ??= element("canvas", { width: WIDE * ratio, height: TALL * ratio });
      const pen = this.behind.getContext("2d");
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      backdrop(pen, scene, camera, this.obstacles, colours());
    }
    Object.assign(canvas, { width: WIDE * ratio, height: TALL * ratio });
    const pen = canvas.getContext("2d");
    pen.drawImage(this.behind, 0, 0);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    agents(pen, scene, camera, frame, colours());
    this.card.box.dataset.step = frame.step;
    this.seen();
    // a still is done when its steps are
    if (this.isCalm && (scene.isRun ? frame.step > 0 : frame.step >= Math.min(STILL_STEPS, scene.steps ?? STILL_STEPS))) this.end();
  }
}
