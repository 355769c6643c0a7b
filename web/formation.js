// A formation file: tasks by methods, and any trial watched again, with robots and walls.

import { boundsOfDrawing, css, drawDrawing, penOf } from "./paper.js";
import { choice, table, walk } from "./searched.js";
import { clamp, element, isBare, one, titled, withUnit, written } from "./words.js";
import { copyButton, rowsOfDrawing } from "./vector.js";

const TASK = 92, WIDE = 104, TALL = 40, SIDE = 320;

export class FormationView {
  constructor(overview, tools) {
    Object.assign(this, { overview, tools, reading: 0, chosen: null });
    this.byPlace = new Map(overview.cells.map((cell) => [`${cell.task} ${cell.method}`, cell]));
    this.choices = element("div", { className: "options" });
    this.grids = element("div", { className: "grids" });
    this.detail = element("section", { className: "detail", "aria-live": "polite" });
    this.box = element("div", { className: "searching" }, element("div", { className: "main" }, this.choices, this.grids), this.detail);
  }

  appear() { this.show(); }
  repaint() { for (const part of this.drawn ?? []) part(); this.drawLarge(); }

  valuesOf(cell) { return (cell?.trials ?? []).map(({ values }) => values[this.reading]); }
  mean(cell) { const there = this.valuesOf(cell).filter((value) => value !== null); return there.length ? there.reduce((sum, value) => sum + value, 0) / there.length : null; }

  show() {
    const { overview } = this, { tasks, methods, readings } = overview, reading = readings[this.reading];
    this.choices.replaceChildren(choice("Reading", readings.map(({ name }) => name.replaceAll("_", " ")), this.reading, (at) => { this.reading = at; this.show(); }, "What is read off each trial"),
      element("span", { className: "count", textContent: `${overview.targets} targets, ${overview.trials} trials of each task with each method` }),
      copyButton(`${overview.title}: ${reading.name}`, () => this.asTable()));
    const all = overview.cells.flatMap((cell) => this.valuesOf(cell)).filter((value) => value !== null);
    this.most = isBare(reading.unit) && this.reading === 0 ? 1 : Math.max(1e-12, ...all);
    const note = element("p", { className: "note", textContent: `${titled(reading.about, reading.unit)}. A bar for each trial, and the mean; ${written(this.most, 4)} is the full height. Arrow keys go from cell to cell.` });
    const grid = element("table", { className: "multiples" });
    grid.append(element("thead", {}, element("tr", {}, element("th", { textContent: "task" }), ...methods.map(({ name, about }) => element("th", { scope: "col", textContent: name, title: about })))));
    const body = element("tbody");
    this.drawn = [];
    this.buttons = [];
    tasks.forEach((task, y) => {
      const canvas = element("canvas", { className: "task", "aria-hidden": "true" });
      const draw = () => drawDrawing(penOf(canvas, TASK, TASK), task.drawing, null, TASK, TASK);
      this.drawn.push(draw);
      const count = task.walls === 1 ? "1 wall" : `${task.walls} walls`;
      body.append(element("tr", {}, element("th", { scope: "row" }, canvas, element("span", { textContent: task.name }), element("span", { className: "count", textContent: ` ${count}${task.timed ? ", timed" : ""}` })),
        ...methods.map((method, x) => element("td", {}, this.cell(this.byPlace.get(`${y} ${x}`), x, y)))));
    });
    grid.append(body);
    grid.addEventListener("keydown", (event) => walk(event, grid, Math.max(this.overview.methods.length, this.overview.tasks.length)));
    this.grids.replaceChildren(note, element("div", { className: "scroll" }, grid));
    const first = one("button", grid);
    if (first) first.tabIndex = 0;
    this.drawn.forEach((draw) => draw());
    this.showDetail();
  }

  cell(cell, x, y) {
    const { tasks, methods, readings } = this.overview;
    if (!cell) return methods[x].tasks.includes(y) ? element("span", { className: "count", textContent: "not tried yet" }) : "";
    const canvas = element("canvas", { "aria-hidden": "true" }), mean = this.mean(cell), { unit } = readings[this.reading];
    const text = mean === null ? "\u2013" : withUnit(mean, unit, 3);
    const button = element("button", { type: "button", className: "multiple formation", tabIndex: -1 }, canvas, element("span", { textContent: text }));
    button.setAttribute("aria-label", `Task ${tasks[y].name} by ${methods[x].name}: ${text}, ${cell.trials.length} trials`);
    button.setAttribute("aria-pressed", String(this.chosen === cell));
    Object.assign(button.dataset, { x, y });
    button.addEventListener("click", () => this.choose(cell));
    this.buttons.push([cell, button]);
    this.drawn.push(() => this.bars(penOf(canvas, WIDE, TALL), cell, css()));
    return button;
  }

  bars(pen, cell, named) {
    const values = this.valuesOf(cell), each = Math.min(14, (WIDE - 2) / Math.max(1, values.length));
    pen.fillStyle = named("stage");
    pen.fillRect(0, 0, WIDE, TALL);
    values.forEach((value, at) => {
      if (value === null) return;
      const high = clamp(value / this.most, 0, 1) * (TALL - 4);
      pen.fillStyle = named("series-0");
      // a trial in which nothing was done is a line, not nothing
      pen.fillRect(1 + at * each, TALL - 1 - Math.max(1, high), Math.max(0.6, each - 1), Math.max(1, high));
    });
  }

  /** The whole as a drawing of bars. */
  asTable() {
    const { tasks, methods, readings, cells } = this.overview, left = 110, top = 26, wide = left + methods.length * (WIDE + 8), tall = top + tasks.length * (TALL + 24);
    const rows = [["task", "method", "trial", ...readings.map(({ name }) => name)], ...cells.flatMap((cell) => cell.trials.map(({ trial, values }) => [tasks[cell.task].name, methods[cell.method].name, trial, ...values]))];
    return { wide, tall, rows, draw: (pen, named) => {
      pen.font = "11px sans-serif";
      pen.fillStyle = named("text");
      pen.textAlign = "center";
      methods.forEach(({ name }, x) => pen.fillText(name, left + x * (WIDE + 8) + WIDE / 2, 16));
      tasks.forEach(({ name }, y) => {
        pen.fillStyle = named("text");
        pen.textAlign = "left";
        pen.fillText(name, 4, top + y * (TALL + 24) + TALL / 2);
        methods.forEach((_, x) => {
          const cell = this.byPlace.get(`${y} ${x}`);
          if (!cell) return;
          pen.save();
          pen.translate(left + x * (WIDE + 8), top + y * (TALL + 24));
          this.bars(pen, cell, named);
          pen.fillStyle = named("text");
          pen.fillText(withUnit(this.mean(cell), readings[this.reading].unit, 3), 2, TALL + 13);
          pen.restore();
        });
      });
    } };
  }

  choose(cell) {
    this.chosen = cell;
    for (const [own, button] of this.buttons) button.setAttribute("aria-pressed", String(own === cell));
    this.showDetail();
    this.detail.scrollIntoView({ block: "nearest" });
  }

  showDetail() {
    const { tasks, methods, readings } = this.overview, cell = this.chosen;
    if (!cell) { this.detail.replaceChildren(element("p", { className: "note", textContent: "Choose a task with a method to see its trials; choose a trial to watch it, computed again from its seed, with robots and walls." })); return; }
    const task = tasks[cell.task], method = methods[cell.method];
    this.large = element("canvas", { className: "large", role: "img" });
    this.large.setAttribute("aria-label", `Task ${task.name}: its path and gates (dashed) and its walls`);
    const watch = (trial, text, className) => {
      const button = element("button", { type: "button", className, textContent: text, title: `Watch trial ${trial}` });
      button.dataset.trial = trial;
      button.addEventListener("click", () => this.tools.watch({ task: cell.task, method: cell.method, trial }));
      return button;
    };
    const short = (value, unit) => (value === null ? "\u2013" : withUnit(value, unit, 3));
    const columns = readings.filter((_, at) => cell.trials.some(({ values }) => values[at] !== null));
    const rows = cell.trials.map(({ trial, values }) => [String(trial), ...columns.map((reading) => short(values[readings.indexOf(reading)], "")), watch(trial, "watch", "quiet")]);
    this.detail.replaceChildren(element("h2", { textContent: `${task.name}, ${method.name}` }), ...(method.about ? [element("p", { className: "note", textContent: `${method.about}.` })] : []),
      this.large, copyButton(`Task ${task.name}`, () => ({ wide: SIDE, tall: SIDE, rows: rowsOfDrawing(task.drawing), draw: (pen, named) => drawDrawing(pen, task.drawing, boundsOfDrawing(task.drawing), SIDE, SIDE, named) })),
      element("div", { className: "options" }, watch(cell.trials[0]?.trial ?? 1, "Watch the first trial", "watch")),
      element("div", { className: "scroll" }, table("Trials", ["", ...columns.map(({ name, unit }) => titled(name.replaceAll("_", " "), unit)), ""], rows)));
    this.drawLarge();
  }

  drawLarge() {
    if (!this.chosen || !this.large?.isConnected) return;
    const wide = this.large.clientWidth || SIDE;
    drawDrawing(penOf(this.large, wide, wide), this.overview.tasks[this.chosen.task].drawing, null, wide, wide);
  }
}
