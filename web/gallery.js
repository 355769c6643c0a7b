// The wall of built-in scenarios: a still of each; they play in turn, and the one that is pointed at plays.

import { Camera } from "./camera.js";
import { Connection } from "./connection.js";
import { boundsOf, readFrame, readScene } from "./frame.js";
import { sketch } from "./sketch.js";
import { readShape } from "./solids.js";
import { colours, element, one, paragraphs, wantsCalm } from "./words.js";

// a still shows a scenario after so many steps, when something has happened
const STILL_STEPS = 120;
// how long a card plays before it is the next one's turn, in ms
const TURN = 5000;
const WIDE = 320, TALL = 200;

export class Gallery {
  constructor(place, openScenario) {
    Object.assign(this, { place, openScenario, cards: [], preview: null, isLoaded: false });
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
    this.cards = [...named, ...this.list].map((item) => this.card(item));
    wall.replaceChildren(...this.cards.map(({ box }) => box));
    this.takeStills();
  }

  hide() {
    this.place.hidden = true;
    this.preview?.end();
    this.preview = null;
  }

  card(item) {
    const canvas = element("canvas", { width: WIDE, height: TALL });
    const facts = [item.dimensions ? `${item.dimensions}-D` : "", item.agents ? `${item.agents} agents` : "", ...(Array.isArray(item.models) ? item.models : [])];
    const about = element("p", { textContent: paragraphs(String(item.about ?? ""))[0] ?? "" });
    const button = element("button", { type: "button", className: "open", textContent: item.title ?? item.id });
    const box = element("li", { className: "card" }, canvas, element("h3", {}, button), about, element("p", { className: "facts-of", textContent: facts.filter(Boolean).join(" · ") }));
    canvas.setAttribute("aria-hidden", "true");
    // of a search there is no single scene
    const card = { box, canvas, what: item.given === undefined ? { gallery: item.id } : { given: item.given }, isSearch: item.isSearch === true, isDrawn: item.isSearch === true };
    box.dataset.id = item.id ?? `given-${item.given}`;
    button.addEventListener("click", () => this.openScenario(card.what));
    const play = () => { if (!wantsCalm() && !card.isSearch) this.preview?.play(card); };
    const stop = () => this.preview?.stop(card);
    box.addEventListener("pointerenter", play);
    box.addEventListener("pointerleave", stop);
    button.addEventListener("focus", play);
    button.addEventListener("blur", stop);
    return card;
  }

  takeStills() {
    this.preview?.end();
    const edges = (card) => card.box.getBoundingClientRect();
    const stillOf = () => this.cards.find((card) => !card.isDrawn && edges(card).top < 2 * innerHeight);
    const after = (last) => {
      const from = this.cards.indexOf(last) + 1;
      const inTurn = [...this.cards.slice(from), ...this.cards.slice(0, from)];
      return inTurn.find((card) => edges(card).top >= 0 && edges(card).top < innerHeight);
    };
    this.preview = new Preview(stillOf, after);
    this.place.onscroll = () => this.preview?.next();
  }

  repaint() {
    for (const card of this.cards) card.isDrawn = card.isSearch;
    if (!this.place.hidden) this.takeStills();
  }
}

/** One connection, lent to a card at a time. */
class Preview {
  /** `nextCard()` is one that needs a still, `after(card)` the one whose turn it is to play. */
  constructor(nextCard, after) {
    Object.assign(this, { nextCard, after, card: null, plays: false, scene: null, frame: null, obstacles: [], waits: false, last: null, turn: 0 });
    this.camera = new Camera();
    this.connection = new Connection({
      state: () => {},
      message: (message) => this.receive(message),
      frame: (buffer) => {
        const frame = readFrame(buffer);
        if (this.scene && frame.dimensions === this.scene.dimensions) { this.frame = frame; this.request(); }
        else this.connection.send({ do: "seen", number: frame.number });
      },
      // a preview is no place for complaints: the scene itself says what is wrong
      broken: () => this.done(),
    });
  }

  end() { clearTimeout(this.turn); this.connection.end(); }

  open(card, plays) {
    // a frame that was not drawn in time is seen too: the server sends none while two are unseen
    if (this.frame) this.connection.send({ do: "seen", number: this.frame.number });
    Object.assign(this, { card, plays, scene: null, frame: null, obstacles: [] });
    if (card) this.connection.send({ do: "open", ...card.what });
  }

  next() {
    if (this.card !== null || !this.connection.isOpen) return;
    const still = this.nextCard() ?? null;
    this.open(still, false);
    clearTimeout(this.turn);
    // who scrolls or points finds the wall as it was: a turn begins when nothing else has for a while
    if (still === null && !wantsCalm()) this.turn = setTimeout(() => this.takeTurn(), TURN / 10);
  }

  takeTurn() {
    const card = this.card === null ? this.after(this.last) : undefined;
    if (!card) return;
    this.last = card;
    this.open(card, true);
    this.turn = setTimeout(() => this.stop(card), TURN);
  }

  done() {
    if (this.card) this.card.isDrawn = true;
    this.card = null;
    this.next();
  }

  play(card) {
    clearTimeout(this.turn);
    if (this.card === card && this.scene) { this.plays = true; this.connection.send({ do: "play" }); } else this.open(card, true);
  }

  stop(card) {
    if (this.card !== card || !this.plays) return;
    clearTimeout(this.turn);
    this.connection.send({ do: "pause" });
    this.done();
  }

  receive(message) {
    if (message.is === "hello") this.next();
    if (message.is === "problem" && this.card) this.done();
    if (message.is === "scene" && this.card) {
      this.scene = readScene(message);
      if (this.plays) this.connection.send({ do: "play" });
      else if (this.scene.isRun) this.connection.send({ do: "seek", frame: Math.floor(this.scene.frames / 2) });
      else this.connection.send({ do: "step", count: STILL_STEPS });
    }
    if (message.is === "obstacles" && this.scene) this.obstacles = (message.list ?? []).map(readShape).filter((shape) => shape !== null);
  }

  request() {
    if (this.waits) return;
    this.waits = true;
    requestAnimationFrame(() => {
      this.waits = false;
      const { card, frame, scene, camera } = this;
      if (!card || !frame || !scene) return;
      const bounds = boundsOf(scene, frame), ratio = Math.min(devicePixelRatio || 1, 2);
      Object.assign(camera, { wide: WIDE, tall: TALL });
      camera.setBounds(scene.dimensions, ...bounds);
      camera.fit();
      Object.assign(card.canvas, { width: WIDE * ratio, height: TALL * ratio });
      sketch(card.canvas.getContext("2d"), scene, camera, frame, this.obstacles, colours(), ratio);
      this.connection.send({ do: "seen", number: frame.number });
      // a still is done when its steps are
      if (!this.plays && (scene.isRun ? frame.step > 0 : frame.step >= Math.min(STILL_STEPS, scene.steps ?? STILL_STEPS))) this.done();
    });
  }
}
