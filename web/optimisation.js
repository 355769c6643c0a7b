// An optimisation: scores over evaluations by method, archives of kinds, the best constructs, and the group in any of them.

import { boundsOfDrawing, css, drawDrawing, endsOf, frame, line, penOf } from "./paper.js";
import { choice, table } from "./searched.js";
import { clamp, element, titled, withUnit, written } from "./words.js";
import { copyButton, rowsOfDrawing } from "./vector.js";

const LEFT = 50, RIGHT = 10, TOP = 8, BOTTOM = 38, SCORES = 230, TILE = 120, SIDE = 320, DASHES = [[], [7, 3], [3, 2], [11, 3, 3, 3]];
const keyOf = (place) => JSON.stringify(Object.entries(place).sort());

export class OptimisationView {
  constructor(overview, tools) {
    Object.assign(this, { overview, tools, chosen: null, found: new Map(), cells: new Map(), tiles: [] });
    this.archived = overview.methods.findIndex(({ kinds }) => kinds);
    this.run = 0;
    this.choices = element("div", { className: "options" });
    this.scores = element("canvas", { role: "img" });
    this.scores.setAttribute("aria-label", "Best score so far over evaluations, mean of the runs of each method; the tables beside say how it ended");
    const title = "Best score so far, mean over runs";
    this.figure = element("figure", {}, element("figcaption", {}, `${title} `, copyButton(title, () => this.scoresAsSvg())), this.scores, element("ul", { className: "legend", "aria-label": "Methods" }, ...overview.methods.map(({ name }, at) => element("li", { className: `key s${at % 7}`, textContent: name }))));
    this.best = element("div", { className: "bests" });
    this.archive = element("canvas", { tabIndex: 0, role: "img" });
    this.archiveFigure = this.archived < 0 ? null : element("figure", {}, element("figcaption", {}, "The best of every kind ", copyButton("The best of every kind", () => this.archiveAsSvg())), this.archive);
    this.detail = element("section", { className: "detail", "aria-live": "polite" });
    this.box = element("div", { className: "searching" }, element("div", { className: "main rolls" }, this.choices, this.figure, element("h3", { textContent: "The best of each method" }), this.best, ...(this.archiveFigure ? [this.archiveFigure] : [])), this.detail);
    this.archive.addEventListener("click", (event) => { const box = this.archive.getBoundingClientRect(); this.pick(event.clientX - box.left, event.clientY - box.top); });
    this.archive.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.repaint()).observe(this.scores);
  }

  appear() { this.show(); }
  repaint() { this.drawScores(); this.drawArchive(); for (const tile of this.tiles) this.drawTile(tile); this.drawLarge(); }

  /** The run of a method whose best new trials found best. */
  bestRun(method) {
    let found = null;
    this.overview.runs[method].forEach(({ best }, run) => { if (best && (found === null || best.score > this.overview.runs[method][found].best.score)) found = run; });
    return found;
  }

  show() {
    const { overview } = this, { methods, runs, lighter, control } = overview;
    this.choices.replaceChildren(...(this.archived >= 0 && runs[this.archived].length > 1 ? [choice("Run of the archive", runs[this.archived].map((_, run) => `run ${run + 1}`), this.run, (at) => { this.run = at; this.askCells(); this.repaint(); })] : []),
      element("span", { className: "count", textContent: `${overview.schema}: ${overview.axes.map(({ name }) => name).join(", ")}; ${overview.evaluations} evaluations in each of ${runs[0]?.length ?? 0} runs${control ? `; without a construct ${control[0]} of ${control[1]} succeed` : ""}` }));
    const places = methods.map(({ name }, method) => [name, this.bestRun(method), method]).filter(([, run]) => run !== null).map(([name, run, method]) => [name, { method, run }, runs[method][run].best]);
    this.tiles = places.map(([name, place, best]) => this.tile(name, place, `${best.successes} of ${best.trials}`));
    if (lighter) this.tiles.push(this.tile("made lighter", { lighter: 1 }, `${written(lighter.before, 3)} to ${written(lighter.after, 3)}`));
    this.best.replaceChildren(...(this.tiles.length ? this.tiles.map(({ button }) => button) : [element("p", { className: "note", textContent: "No run was confirmed by new trials yet." })]));
    this.askCells();
    this.repaint();
    this.showDetail();
  }

  tile(name, place, words) {
    const canvas = element("canvas", { "aria-hidden": "true" });
    const button = element("button", { type: "button", className: "best" }, canvas, element("span", {}, `${name} `, element("span", { className: "count", textContent: words })));
    button.setAttribute("aria-label", `${name}: ${words}`);
    button.addEventListener("click", () => this.choose(place));
    const tile = { canvas, button, place };
    this.ask(place).then(() => this.drawTile(tile));
    return tile;
  }

  drawTile({ canvas, place }) {
    const found = this.found.get(keyOf(place));
    if (found) drawDrawing(penOf(canvas, TILE, TILE), found.drawing, null, TILE, TILE);
  }

  async ask(place) {
    const key = keyOf(place);
    if (this.found.has(key)) return "";
    try { this.found.set(key, await this.tools.part(place)); return ""; } catch (error) { return error.message; }
  }

  // ------------------------------------------------ scores

  /** Of each method the mean over its runs of the best score so far: places and values. */
  curves() {
    return this.overview.runs.map((runs) => {
      const each = runs.map(({ scores, every }) => { let best = -Infinity; return scores.map((score, at) => { best = Math.max(best, score ?? -Infinity); return [(at + 1) * every, best]; }); });
      const most = Math.min(...each.map((list) => list.length));
      return Array.from({ length: Number.isFinite(most) ? most : 0 }, (_, at) => [each[0][at][0], each.reduce((sum, list) => sum + list[at][1], 0) / each.length]).filter(([, value]) => Number.isFinite(value));
    });
  }

  paintScores(pen, wide, tall, named) {
    const curves = this.curves(), all = curves.flat().map(([, value]) => value);
    // what the first few drew says little, and would flatten all that follows
    const late = curves.flatMap((curve) => curve.filter((_, at) => at >= curve.length * 0.04).map(([, value]) => value));
    const at = frame(pen, [LEFT, TOP, wide - RIGHT, tall - BOTTOM], [0, this.overview.evaluations], endsOf(late.length ? late : all), named);
    curves.forEach((curve, method) => {
      pen.strokeStyle = named(`series-${method % 7}`);
      pen.lineWidth = 1.8;
      pen.setLineDash(DASHES[method % DASHES.length]);
      line(pen, curve.map(([x, y]) => [at.across(x), clamp(at.down(y), TOP, tall - BOTTOM)]));
      pen.stroke();
    });
    pen.setLineDash([]);
    pen.fillStyle = named("text");
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.fillText("evaluations", (LEFT + wide - RIGHT) / 2, tall - 6);
  }

  drawScores() {
    const wide = this.scores.clientWidth;
    if (wide === 0) return;
    this.scores.style.height = `${SCORES}px`;
    this.paintScores(penOf(this.scores, wide, SCORES), wide, SCORES, css());
  }

  scoresAsSvg() {
    const { methods, runs } = this.overview;
    const rows = [["method", "run", "evaluation", "score"], ...runs.flatMap((own, method) => own.flatMap(({ scores, every }, run) => scores.map((score, at) => [methods[method].name, run + 1, at * every + 1, score])))];
    return { wide: 640, tall: SCORES + 20, rows, draw: (pen, named) => {
      this.paintScores(pen, 640, SCORES, named);
      methods.forEach(({ name }, at) => { pen.textAlign = "left"; pen.fillStyle = named(`series-${at % 7}`); pen.fillText(name, LEFT + at * 130, SCORES + 14); });
    } };
  }

  // ------------------------------------------------ the archive

  get elites() { return this.archived < 0 ? [] : this.overview.runs[this.archived][this.run]?.elites ?? []; }

  async askCells() {
    if (this.archived < 0 || this.cells.has(this.run)) return;
    const run = this.run;
    try { this.cells.set(run, await this.tools.part({ method: this.archived, run, cells: 1 })); } catch (error) { this.tools.say(`The cells of the archive did not come: ${error.message}.`); return; }
    this.drawArchive();
  }

  paintArchive(pen, wide, tall, named) {
    const { kinds } = this.overview.methods[this.archived], [x, y = { name: "", unit: "", low: 0, high: 1 }] = kinds;
    const at = frame(pen, [LEFT, TOP, wide - RIGHT, tall - BOTTOM], [x.low, x.high], [y.low, y.high], named);
    const [low, high] = endsOf(this.elites.map(({ score }) => score)), byCell = new Map(this.elites.map((elite) => [elite.cell, elite]));
    const shade = (score) => 0.12 + 0.8 * (score - low) / (high - low || 1);
    const raster = this.cells.get(this.run);
    pen.fillStyle = named("series-0");
    if (raster) raster.cells.forEach((cell, index) => {
      const elite = byCell.get(cell);
      if (!elite) return;
      const [column, row] = [index % raster.columns, Math.floor(index / raster.columns)], [w, h] = [(wide - LEFT - RIGHT) / raster.columns, (tall - TOP - BOTTOM) / raster.rows];
      pen.globalAlpha = shade(elite.score);
      pen.fillRect(LEFT + column * w, tall - BOTTOM - (row + 1) * h, w + 0.4, h + 0.4);
    });
    pen.globalAlpha = 1;
    for (const elite of this.elites) {
      const isChosen = this.chosen?.elite !== undefined && this.elites[this.chosen.elite] === elite && this.chosen.run === this.run;
      pen.fillStyle = named("text");
      pen.strokeStyle = named("series-1");
      pen.lineWidth = 2;
      pen.beginPath();
      pen.arc(at.across(elite.kind[0]), kinds.length > 1 ? at.down(elite.kind[1]) : at.down(0.5), isChosen ? 5 : 1.7, 0, 2 * Math.PI);
      if (isChosen) pen.stroke(); else pen.fill();
    }
    pen.fillStyle = named("text");
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.fillText(titled(x.name, x.unit), (LEFT + wide - RIGHT) / 2, tall - 6);
    if (kinds.length > 1) { pen.save(); pen.translate(11, (TOP + tall - BOTTOM) / 2); pen.rotate(-Math.PI / 2); pen.fillText(titled(y.name, y.unit), 0, 0); pen.restore(); }
    return at;
  }

  drawArchive() {
    const wide = this.archive.clientWidth;
    if (this.archived < 0 || wide === 0) return;
    const tall = clamp(wide * 0.5, 240, 380), { name, kinds, cells } = this.overview.methods[this.archived];
    this.archive.style.height = `${tall}px`;
    this.archive.setAttribute("aria-label", `Archive of ${name}: ${this.elites.length} kinds of ${cells}, by ${kinds.map((kind) => kind.name).join(" and ")}. Arrow keys go from one to the next, Enter shows it`);
    this.at = this.paintArchive(penOf(this.archive, wide, tall), wide, tall, css());
  }

  archiveAsSvg() {
    const { kinds } = this.overview.methods[this.archived];
    return { wide: 640, tall: 340, rows: [["cell", ...kinds.map(({ name, unit }) => titled(name, unit)), "score"], ...this.elites.map(({ cell, kind, score }) => [cell, ...kind, score])], draw: (pen, named) => this.paintArchive(pen, 640, 340, named) };
  }

  placeOf({ kind }) { return [this.at.across(kind[0]), kind.length > 1 ? this.at.down(kind[1]) : this.at.down(0.5)]; }

  /** The elite in whose cell a place is; else the nearest. */
  pick(x, y) {
    if (!this.at || this.elites.length === 0) return;
    const apart = (elite) => { const [a, b] = this.placeOf(elite); return Math.hypot(a - x, b - y); };
    const nearest = this.elites.reduce((best, elite) => (apart(elite) < apart(best) ? elite : best));
    const raster = this.cells.get(this.run);
    const column = raster && clamp(Math.floor((x - LEFT) / (this.archive.clientWidth - LEFT - RIGHT) * raster.columns), 0, raster.columns - 1);
    const row = raster && clamp(Math.floor((this.archive.clientHeight - BOTTOM - y) / (this.archive.clientHeight - TOP - BOTTOM) * raster.rows), 0, raster.rows - 1);
    const own = raster && this.elites.find(({ cell }) => cell === raster.cells[row * raster.columns + column]);
    this.choose({ method: this.archived, run: this.run, elite: this.elites.indexOf(own ?? nearest) });
  }

  key(event) {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1], Enter: [0, 0] }[event.key];
    if (!way || event.altKey || event.ctrlKey || event.metaKey || this.elites.length === 0 || !this.at) return;
    event.preventDefault();
    event.stopPropagation();
    const now = this.chosen?.elite !== undefined && this.chosen.run === this.run ? this.elites[this.chosen.elite] : null;
    if (!now || event.key === "Enter") { this.choose({ method: this.archived, run: this.run, elite: this.chosen?.elite ?? 0 }); return; }
    const here = this.placeOf(now);
    // the nearest that lies that way, far aside counting double
    const cost = (elite) => { const [x, y] = this.placeOf(elite), [a, b] = [x - here[0], y - here[1]], along = a * way[0] + b * way[1]; return along > 0.5 ? along + 2 * Math.abs(a * way[1] - b * way[0]) : Infinity; };
    const next = this.elites.reduce((best, elite) => (cost(elite) < cost(best) ? elite : best));
    if (Number.isFinite(cost(next))) this.choose({ method: this.archived, run: this.run, elite: this.elites.indexOf(next) });
  }

  // ------------------------------------------------ what is chosen

  async choose(place) {
    this.chosen = place;
    this.drawArchive();
    const problem = await this.ask(place);
    if (this.chosen === place) this.showDetail(problem);
  }

  showDetail(problem = "") {
    const { overview } = this, { axes, methods, runs } = overview;
    const bests = runs.flatMap((own, method) => own.flatMap(({ best }, run) => (best ? [{ method, run, best }] : [])));
    const button = (place, text) => { const made = element("button", { type: "button", className: "quiet", textContent: text }); made.addEventListener("click", () => this.choose(place)); return made; };
    const list = bests.length ? element("div", { className: "scroll" }, table("The best of each run, by new trials", ["", "score", "successes", titled("wall", overview.unit === "unit" ? "" : overview.unit), ""],
      bests.map(({ method, run, best }) => [`${methods[method].name} ${run + 1}`, written(best.score, 4), `${best.successes} of ${best.trials}`, written(best.material, 3), button({ method, run }, "show")]))) : null;
    if (!this.chosen) { this.detail.replaceChildren(...[element("p", { className: "note", textContent: "Choose a construct or a cell of the archive to see it and to watch the group in it." }), list].filter(Boolean)); return; }
    const found = this.found.get(keyOf(this.chosen));
    if (!found) { this.detail.replaceChildren(...[element("p", { className: "state", textContent: problem ? `Nothing is shown: ${problem}.` : "Drawing…" }), list].filter(Boolean)); return; }
    this.large = element("canvas", { className: "large", role: "img" });
    this.large.setAttribute("aria-label", `The construct: ${found.name}`);
    const watch = element("button", { type: "button", className: "watch", textContent: "Watch the group in it" });
    watch.addEventListener("click", () => this.tools.watch({ ...this.chosen, trial: 1 }));
    const rows = [...axes.map(({ name, unit }, axis) => [name, withUnit(found.point[axis] ?? null, unit, 5)]).filter((_, axis) => found.point.length > axis), ["score", written(found.score, 4)], ["length of wall", withUnit(found.material, overview.unit === "unit" ? "" : overview.unit, 4)],
      ...(found.found ? [["successes", `${found.found.successes} of ${found.found.trials}`], ["mean fitness", written(found.found.fitness, 4)], ["mean steps of successes", written(found.found.steps, 4)]] : [])];
    this.detail.replaceChildren(...[element("h2", { textContent: found.name }), this.large,
      element("div", { className: "options" }, watch, copyButton(found.name, () => ({ wide: SIDE, tall: SIDE, rows: rowsOfDrawing(found.drawing), draw: (pen, named) => drawDrawing(pen, found.drawing, boundsOfDrawing(found.drawing), SIDE, SIDE, named) }))), table("The construct", [], rows), list].filter(Boolean));
    this.drawLarge();
  }

  drawLarge() {
    const found = this.chosen && this.found.get(keyOf(this.chosen));
    if (!found || !this.large?.isConnected) return;
    const wide = this.large.clientWidth || SIDE;
    drawDrawing(penOf(this.large, wide, wide), found.drawing, null, wide, wide);
  }
}
