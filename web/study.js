// A study: its cells as small multiples over its factors, and the trials of the cell that is chosen.

import { css, endsOf, line, penOf } from "./paper.js";
import { choice, table, walk } from "./searched.js";
import { copyButton } from "./vector.js";
import { clamp, element, one, titled, withUnit, written } from "./words.js";

const WIDE = 74, TALL = 40, BINS = 14;

export class StudyView {
  constructor(overview, tools) {
    Object.assign(this, { overview, tools, reading: 0, part: 0, values: new Map(), chosen: null });
    this.choices = element("div", { className: "options" });
    this.grids = element("div", { className: "grids" });
    this.detail = element("section", { className: "detail", "aria-live": "polite" });
    this.box = element("div", { className: "searching" }, element("div", { className: "main" }, this.choices, this.grids), this.detail);
    this.usePart(0);
  }

  usePart(index) {
    this.part = index;
    const { factors } = this.overview.parts[index];
    // the longest factors lie along the axes
    const order = factors.map((_, at) => at).sort((a, b) => factors[b].levels.length - factors[a].levels.length);
    [this.across, this.down] = [order[0] ?? null, order[1] ?? null];
    this.chosen = null;
  }

  appear() { this.show(); }
  repaint() { this.drawCells(); this.showDetail(); }

  async show() {
    const { overview } = this, part = overview.parts[this.part], reading = overview.readings[this.reading];
    const names = part.factors.map((factor) => factor.about || factor.name);
    const swap = (key, other) => (at) => { if (this[other] === at) this[other] = this[key]; this[key] = at; this.show(); };
    this.choices.replaceChildren(
      ...(overview.parts.length > 1 ? [choice("Part", overview.parts.map(({ title, name }) => title || name), this.part, (at) => { this.usePart(at); this.show(); })] : []),
      choice("Reading", overview.readings.map(({ name }) => name), this.reading, (at) => { this.reading = at; this.show(); }, "What is read off each trial"),
      ...(names.length > 0 ? [choice("Across", names, this.across, swap("across", "down"))] : []),
      ...(names.length > 1 ? [choice("Down", names, this.down, swap("down", "across"))] : []));
    if (!this.values.has(this.reading)) {
      this.tools.say("Reading the trials…");
      try { this.values.set(this.reading, (await this.tools.part({ reading: this.reading })).cells); }
      catch (error) { this.tools.say(`The trials did not come: ${error.message}.`); return; }
      this.tools.say("");
    }
    const all = this.values.get(this.reading);
    const [from, to] = part.cells;
    this.ends = endsOf(all.slice(from, to).flatMap(({ values }) => values));
    this.legend = element("p", { className: "note", textContent: `${titled(reading.about || reading.name, reading.unit)}: in each cell the trials over ${written(this.ends[0], 4)} to ${written(this.ends[1], 4)}, and a line at their mean. Arrow keys go from cell to cell.` });
    this.cells = [];
    const others = part.factors.map((_, at) => at).filter((at) => at !== this.across && at !== this.down);
    const panels = new Map();
    for (let cell = from; cell < to; cell += 1) {
      const levels = overview.levels[cell];
      const key = others.map((at) => `${part.factors[at].name} = ${part.factors[at].levels[levels[at]]}`).join(", ");
      if (!panels.has(key)) panels.set(key, []);
      panels.get(key).push(cell);
    }
    this.grids.replaceChildren(this.legend, ...[...panels].map(([key, cells]) => this.grid(key, cells, part)));
    this.drawCells();
    this.showDetail();
  }

  grid(caption, list, part) {
    const levels = (factor) => (factor === null ? [0] : [...new Set(list.map((cell) => this.overview.levels[cell][factor]))].sort((a, b) => a - b));
    const [columns, rows] = [levels(this.across), levels(this.down)];
    const at = new Map(list.map((cell) => [`${this.across === null ? 0 : this.overview.levels[cell][this.across]} ${this.down === null ? 0 : this.overview.levels[cell][this.down]}`, cell]));
    const name = (factor, level) => (factor === null ? "" : part.factors[factor].levels[level]);
    const reading = this.overview.readings[this.reading].name;
    const grid = element("table", { className: "multiples" }, element("caption", {}, `${caption} `, copyButton([reading, caption].filter(Boolean).join(", "), () => this.gridAsSvg(part, list, columns, rows))));
    grid.append(element("thead", {}, element("tr", {}, element("th", { textContent: this.down === null ? "" : part.factors[this.down].name }),
      ...columns.map((level) => element("th", { scope: "col", textContent: name(this.across, level) })))));
    const body = element("tbody");
    rows.forEach((row, y) => body.append(element("tr", {}, element("th", { scope: "row", textContent: name(this.down, row) }), ...columns.map((column, x) => {
      const cell = at.get(`${column} ${row}`);
      return element("td", {}, cell === undefined ? "" : this.cell(cell, x, y));
    }))));
    grid.append(body);
    grid.addEventListener("keydown", (event) => walk(event, grid));
    const first = one("button.multiple", grid);
    if (first) first.tabIndex = 0;
    return element("div", { className: "scroll" }, grid);
  }

  nameOf(cell) {
    const { factors } = this.overview.parts[this.part];
    return factors.map((factor, at) => `${factor.name} = ${factor.levels[this.overview.levels[cell][at]]}`).join(", ") || "the scenario as it is";
  }

  cell(index, x, y) {
    const { values } = this.values.get(this.reading)[index];
    const there = values.filter((value) => value !== null);
    const mean = there.reduce((sum, value) => sum + value, 0) / there.length;
    const canvas = element("canvas", { "aria-hidden": "true" });
    const button = element("button", { type: "button", className: "multiple", tabIndex: -1, title: `${this.nameOf(index)}: mean ${written(mean, 4)}, ${there.length} trials` }, canvas);
    button.setAttribute("aria-label", button.title);
    button.setAttribute("aria-pressed", String(index === this.chosen));
    Object.assign(button.dataset, { cell: index, x, y });
    button.addEventListener("click", () => this.choose(index));
    this.cells.push({ index, canvas, button, there, mean });
    return button;
  }

  paintCell(pen, { there, mean }, named) {
    const [low, high] = this.ends;
    const bins = new Array(BINS).fill(0);
    for (const value of there) bins[clamp(Math.floor((value - low) / (high - low) * BINS), 0, BINS - 1)] += 1;
    const most = Math.max(1, ...bins);
    pen.fillStyle = named("stage");
    pen.fillRect(0, 0, WIDE, TALL);
    pen.fillStyle = named("series-0");
    bins.forEach((count, bin) => pen.fillRect(1 + bin * (WIDE - 2) / BINS, TALL - (TALL - 4) * count / most, (WIDE - 2) / BINS - 0.6, (TALL - 4) * count / most));
    if (there.length === 0) return;
    pen.strokeStyle = named("series-1");
    pen.lineWidth = 1.6;
    const x = 1 + (mean - low) / (high - low) * (WIDE - 2);
    line(pen, [[x, 0], [x, TALL]]);
    pen.stroke();
  }

  drawCells() { const named = css(); for (const cell of this.cells ?? []) this.paintCell(penOf(cell.canvas, WIDE, TALL), cell, named); }

  /** The cells of a grid as one drawing: levels of the factors beside them, the trials as data. */
  gridAsSvg(part, list, columns, rows) {
    const { overview } = this, left = 120, top = 24, high = TALL + 8, of = (factor, level) => (factor === null ? "" : part.factors[factor].levels[level]);
    const data = [[...part.factors.map(({ name }) => name), "trial", overview.readings[this.reading].name], ...list.flatMap((index) => {
      const { trials, values } = this.values.get(this.reading)[index];
      return values.map((value, at) => [...part.factors.map((factor, k) => factor.levels[overview.levels[index][k]]), trials?.[at] ?? at + 1, value]);
    })];
    const own = new Map(this.cells.filter(({ index }) => list.includes(index)).map((cell) => [`${this.across === null ? 0 : overview.levels[cell.index][this.across]} ${this.down === null ? 0 : overview.levels[cell.index][this.down]}`, cell]));
    return { wide: left + columns.length * (WIDE + 6), tall: top + rows.length * high, rows: data, draw: (pen, named) => {
      pen.font = "11px sans-serif";
      columns.forEach((level, x) => { pen.fillStyle = named("text"); pen.textAlign = "center"; pen.fillText(of(this.across, level), left + x * (WIDE + 6) + WIDE / 2, 15); });
      rows.forEach((row, y) => {
        pen.fillStyle = named("text");
        pen.textAlign = "left";
        pen.fillText(of(this.down, row), 4, top + y * high + TALL / 2 + 4);
        columns.forEach((column, x) => {
          const cell = own.get(`${column} ${row}`);
          if (!cell) return;
          pen.save();
          pen.translate(left + x * (WIDE + 6), top + y * high);
          this.paintCell(pen, cell, named);
          pen.restore();
        });
      });
    } };
  }

  choose(index) {
    this.chosen = index;
    for (const { index: own, button } of this.cells) button.setAttribute("aria-pressed", String(own === index));
    this.showDetail();
    this.detail.scrollIntoView({ block: "nearest" });
  }

  showDetail() {
    const own = this.cells?.find(({ index }) => index === this.chosen), reading = this.overview.readings[this.reading];
    if (!own) {
      this.detail.replaceChildren(element("p", { className: "note", textContent: `${this.overview.levels.length} cells, ${this.overview.trials} trials. Choose a cell to see its trials; choose a trial to watch it, computed again from its seed.` }));
      return;
    }
    const { trials, values } = this.values.get(this.reading)[own.index];
    const numbered = values.map((value, at) => ({ trial: trials?.[at] ?? at + 1, value })).sort((a, b) => (a.value ?? Infinity) - (b.value ?? Infinity));
    const spread = Math.sqrt(own.there.reduce((sum, value) => sum + (value - own.mean) ** 2, 0) / Math.max(1, own.there.length - 1));
    const rows = [["mean", withUnit(own.mean, reading.unit, 5)], ["standard deviation", withUnit(spread, reading.unit, 4)], ["trials", String(own.there.length)]];
    const list = element("ul", { className: "trials" }, ...numbered.map(({ trial, value }) => {
      const button = element("button", { type: "button", className: "quiet", title: `Watch trial ${trial}, seed ${this.overview.seed + trial}` }, `${trial} `, element("span", { className: "count", textContent: written(value, 4) }));
      button.dataset.trial = trial;
      button.addEventListener("click", () => this.tools.watch({ cell: own.index, trial }));
      return element("li", {}, button);
    }));
    this.detail.replaceChildren(element("h2", { textContent: this.nameOf(own.index) }), table(reading.about || reading.name, [], rows),
      element("h3", { textContent: "Trials, by what was read" }), list);
  }
}
