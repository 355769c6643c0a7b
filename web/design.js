// A design: its environments as a wall of drawings, how the chosen one came about, and the group in it.

import { boundsOfDrawing, css, drawDrawing, joined, penOf } from "./paper.js";
import { choice, table } from "./searched.js";
import { copyButton, rowsOfDrawing } from "./vector.js";
import { clamp, element } from "./words.js";

// drawings are asked for in blocks; only those that can be seen are on the page
const TILE = 132, CAPTION = 24, GAP = 8, BLOCK = 60, BEYOND = 2;

export class DesignView {
  constructor(overview, tools) {
    Object.assign(this, { overview, tools, behaviour: 0, population: 0, isSorted: false, chosen: null, drawings: new Map(), asked: new Set(), tiles: new Map(), step: null });
    this.order = overview.environments.map((_, index) => index);
    this.choices = element("div", { className: "options" });
    this.inner = element("div", { className: "inner", role: "group", "aria-label": "Environments. Arrow keys go from one to the next" });
    this.wall = element("div", { className: "tiles", tabIndex: -1 }, this.inner);
    this.detail = element("section", { className: "detail", "aria-live": "polite" });
    this.box = element("div", { className: "searching" }, element("div", { className: "main" }, this.choices, this.wall), this.detail);
    let waits = false;
    this.wall.addEventListener("scroll", () => { if (!waits) { waits = true; requestAnimationFrame(() => { waits = false; this.lay(); }); } }, { passive: true });
    this.inner.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.lay()).observe(this.wall);
  }

  appear() { this.show(); }
  repaint() { for (const tile of this.tiles.values()) this.draw(tile); this.drawLarge(); }

  share(index) { return this.overview.environments[index].rates[this.behaviour]?.[this.population] ?? null; }

  show() {
    const { overview } = this;
    const rate = (index) => { const share = this.share(index); return share && share[1] > 0 ? share[0] / share[1] : -1; };
    this.order = overview.environments.map((_, index) => index);
    if (this.isSorted) this.order.sort((a, b) => rate(b) - rate(a) || a - b);
    this.choices.replaceChildren(
      ...(overview.behaviours.length > 1 ? [choice("Behaviour", overview.behaviours, this.behaviour, (at) => { this.behaviour = at; this.show(); })] : []),
      ...(overview.populations.length > 1 ? [choice("Group", overview.populations.map(({ name }) => name), this.population, (at) => { this.population = at; this.show(); })] : []),
      choice("Order", ["by number", "by successes"], Number(this.isSorted), (at) => { this.isSorted = at === 1; this.show(); }),
      element("span", { className: "count", textContent: `${overview.environments.length} feasible of ${overview.generated} generated` }));
    for (const { button } of this.tiles.values()) button.remove();
    this.tiles.clear();
    this.lay();
    this.showDetail();
  }

  get columns() { return Math.max(1, Math.floor((this.wall.clientWidth - GAP) / (TILE + GAP))); }

  /** Puts those tiles on the page that can be seen, and takes the others away. */
  lay() {
    if (this.wall.clientWidth === 0) return;
    const { columns } = this, high = TILE + CAPTION + GAP;
    this.inner.style.height = `${Math.ceil(this.order.length / columns) * high + GAP}px`;
    const first = Math.max(0, Math.floor(this.wall.scrollTop / high) - BEYOND) * columns;
    const last = Math.min(this.order.length, (Math.ceil((this.wall.scrollTop + this.wall.clientHeight) / high) + BEYOND) * columns);
    for (const [place, { button }] of this.tiles) if (place < first || place >= last) { if (button !== document.activeElement) { button.remove(); this.tiles.delete(place); } }
    for (let place = first; place < last; place += 1) {
      if (!this.tiles.has(place)) this.tiles.set(place, this.tile(place));
      const { button } = this.tiles.get(place);
      const x = GAP + (place % columns) * (TILE + GAP), y = GAP + Math.floor(place / columns) * high;
      button.style.transform = `translate(${x}px, ${y}px)`;
    }
    this.wall.dataset.tiles = this.tiles.size;
  }

  tile(place) {
    const index = this.order[place], { attempt } = this.overview.environments[index], share = this.share(index);
    const canvas = element("canvas", { "aria-hidden": "true" });
    const words = share ? `${share[0]} of ${share[1]}` : "not tried";
    const button = element("button", { type: "button", className: "tile", tabIndex: place === 0 || index === this.chosen ? 0 : -1 }, canvas, element("span", {}, `${attempt} `, element("span", { className: "count", textContent: words })));
    button.setAttribute("aria-label", `Candidate ${attempt}, ${words}`);
    button.setAttribute("aria-pressed", String(index === this.chosen));
    button.style.setProperty("--share", share && share[1] > 0 ? share[0] / share[1] : 0);
    Object.assign(button.dataset, { place, environment: index });
    button.addEventListener("click", () => this.choose(index));
    this.inner.append(button);
    const tile = { index, canvas, button };
    this.draw(tile);
    return tile;
  }

  draw({ index, canvas }) {
    const drawing = this.drawings.get(index);
    if (!drawing) { this.ask(index); return; }
    drawDrawing(penOf(canvas, TILE, TILE), drawing, joined(this.overview.bounds, boundsOfDrawing(drawing)), TILE, TILE, this.named ??= css());
  }

  /** Asks for the block of drawings that this one is in. */
  async ask(index) {
    const from = Math.floor(index / BLOCK) * BLOCK;
    if (this.asked.has(from)) return;
    this.asked.add(from);
    try {
      const { drawings } = await this.tools.part({ from, count: BLOCK });
      drawings.forEach((drawing, at) => this.drawings.set(from + at, drawing));
    } catch (error) {
      this.asked.delete(from);
      this.tools.say(`Drawings did not come: ${error.message}.`);
      return;
    }
    this.named = null;
    for (const tile of this.tiles.values()) if (tile.index >= from && tile.index < from + BLOCK) this.draw(tile);
    if (this.chosen !== null && this.chosen >= from && this.chosen < from + BLOCK) this.drawLarge();
  }

  key(event) {
    const place = Number(event.target.dataset?.place);
    const step = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: -this.columns, ArrowDown: this.columns, Home: -place, End: this.order.length - 1 - place }[event.key];
    if (step === undefined || Number.isNaN(place) || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    const next = clamp(place + step, 0, this.order.length - 1), row = Math.floor(next / this.columns), high = TILE + CAPTION + GAP;
    if (row * high < this.wall.scrollTop) this.wall.scrollTop = row * high;
    if ((row + 1) * high + GAP > this.wall.scrollTop + this.wall.clientHeight) this.wall.scrollTop = (row + 1) * high + GAP - this.wall.clientHeight;
    this.lay();
    event.target.tabIndex = -1;
    const { button } = this.tiles.get(next);
    button.tabIndex = 0;
    button.focus({ preventScroll: true });
  }

  async choose(index) {
    Object.assign(this, { chosen: index, steps: null, step: null });
    for (const { index: own, button } of this.tiles.values()) button.setAttribute("aria-pressed", String(own === index));
    this.showDetail();
    if (!this.overview.derives) return;
    try {
      const { steps } = await this.tools.part({ environment: index, steps: 1 });
      if (this.chosen !== index || steps.length === 0) return;
      Object.assign(this, { steps, step: steps.length - 1 });
    } catch (error) { this.tools.say(`The derivation did not come: ${error.message}.`); return; }
    this.showDetail();
  }

  showDetail() {
    if (this.chosen === null) {
      this.detail.replaceChildren(element("p", { className: "note", textContent: `Environments by ${this.overview.source}. Choose one to see how it came about and what groups did in it, and to watch a group in it.` }));
      return;
    }
    const { overview } = this, { attempt, rates } = overview.environments[this.chosen];
    this.large = element("canvas", { className: "large", role: "img" });
    this.large.setAttribute("aria-label", `The environment of candidate ${attempt}`);
    const watch = overview.populations.map(({ name, about }, population) => {
      const button = element("button", { type: "button", className: "watch", textContent: overview.populations.length > 1 ? `Watch ${name}` : "Watch the group in it", title: about });
      button.addEventListener("click", () => this.tools.watch({ environment: this.chosen, population, trial: 1 }));
      return button;
    });
    const rows = overview.behaviours.map((name, behaviour) => [name, ...overview.populations.map((_, population) => { const share = rates[behaviour]?.[population]; return share ? `${share[0]} of ${share[1]}` : "not tried"; })]);
    const derivation = element("div", { className: "derivation" });
    if (this.steps) {
      const slider = element("input", { type: "range", min: 0, max: this.steps.length - 1, step: 1, value: this.step });
      slider.setAttribute("aria-label", "Step of the derivation");
      const said = element("output");
      const tell = () => { said.textContent = `step ${this.step} of ${this.steps.length - 1}: ${this.steps[this.step].caption}`; };
      slider.addEventListener("input", () => { this.step = Number(slider.value); tell(); this.drawLarge(); });
      tell();
      derivation.append(element("label", {}, "Derivation ", slider), said);
    }
    this.detail.replaceChildren(element("h2", { textContent: `Candidate ${attempt}` }), this.large, derivation, element("div", { className: "options" }, ...watch,
      copyButton(`Candidate ${attempt}`, () => { const drawing = this.drawingNow; return drawing && { wide: 320, tall: 320, rows: rowsOfDrawing(drawing), draw: (pen, named) => drawDrawing(pen, drawing, boundsOfDrawing(drawing), 320, 320, named) }; })),
      table("Trials that succeeded", ["", ...overview.populations.map(({ name }) => name)], rows));
    this.drawLarge();
  }

  drawLarge() {
    if (this.chosen === null || !this.large?.isConnected) return;
    const last = this.steps?.at(-1), drawing = this.steps && this.step < this.steps.length - 1 ? this.steps[this.step] : this.drawings.get(this.chosen);
    this.drawingNow = drawing;
    if (!drawing) { this.ask(this.chosen); return; }
    const wide = this.large.clientWidth || 320, whole = last ? joined(boundsOfDrawing(last), boundsOfDrawing(this.steps[0])) : null;
    drawDrawing(penOf(this.large, wide, wide), drawing, joined(joined(this.overview.bounds, whole), boundsOfDrawing(drawing)), wide, wide);
  }
}
