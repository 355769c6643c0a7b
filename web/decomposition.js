// A decomposition: the construct in the colours of its clusters, what each approach came to, and its trials watched again; of marked
// stretches, what variations of the fit do.

import { boundsOfDrawing, css, drawDrawing, line, penOf } from "./paper.js";
import { choice, table } from "./searched.js";
import { copyButton, rowsOfDrawing } from "./vector.js";
import { element, isBare, titled, written } from "./words.js";

const WIDE = 480, SIDE = 320, ROWS = 200, SERIES = 7;

const pairs = (flat) => Array.from({ length: flat.length / 2 }, (_, at) => [flat[2 * at], flat[2 * at + 1]]);
const distinct = (values) => [...new Set(values)].sort((a, b) => a - b);

export class DecompositionView {
  constructor(overview, tools) {
    Object.assign(this, { overview, tools, window: 0, heading: 0, cluster: 0, chosen: null, drawing: null, offset: Math.floor(overview.offsets / 2), trial: 1, rows: ROWS });
    this.windows = distinct(overview.approaches.map((one) => one.window));
    this.headings = distinct(overview.approaches.map((one) => one.heading));
    this.choices = element("div", { className: "options" });
    this.whole = element("canvas", { className: "whole", role: "img" });
    this.list = element("div");
    this.detail = element("section", { className: "detail", "aria-live": "polite" });
    this.box = element("div", { className: "searching" }, element("div", { className: "main rolls" }, this.choices, this.whole, this.list), this.detail);
  }

  appear() { this.show(); }
  repaint() { this.drawWhole(); this.drawLarge(); }

  nameOf(approach) { return approach.cluster === null ? "noise" : this.overview.clusters[approach.cluster].name; }
  colourOf(cluster) { return cluster === null ? "faint" : `series-${cluster % SERIES}`; }
  wordsOf({ line: number, middle, window, heading }) { return `line ${number} at ${written(middle, 4)}, window ${written(window, 4)}, approached at ${written(heading, 4)}\u00b0`; }

  show() {
    const { overview } = this, { clusters, approaches, tried, planned, intervals, unit } = overview;
    const isAny = approaches.length > 0;
    this.whole.hidden = !isAny;
    this.choices.replaceChildren(...(isAny ? [
      choice("Window", this.windows.map((value) => `${written(value, 4)} ${unit}`), this.window, (at) => { this.window = at; this.drawWhole(); }),
      choice("Approached at", this.headings.map((value) => `${written(value, 4)}\u00b0`), this.heading, (at) => { this.heading = at; this.drawWhole(); }, "The angle to the line, counter-clockwise"),
      copyButton("The construct by cluster", () => ({ wide: WIDE, tall: WIDE, rows: this.table(), draw: (pen, named) => this.paint(pen, WIDE, WIDE, named) })),
    ] : []), element("span", { className: "count", textContent: planned > 0 ? `${tried} of ${planned} approaches tried${tried === planned ? "" : "; clusters come when all are"}` : "" }));
    const parts = [];
    if (clusters.length > 0) {
      const rows = clusters.map((cluster, at) => [cluster.name, String(cluster.approaches), cluster.effects, this.button(`Its ${cluster.approaches} approaches`, "show", at === this.cluster, () => { Object.assign(this, { cluster: at, rows: ROWS }); this.show(); this.choose({ approach: approaches[cluster.medoid] }); })]);
      const groups = table("Clusters", ["", "approaches", "mean effects, less those of an empty arena", ""], rows);
      groups.querySelectorAll("tbody th").forEach((head, at) => head.replaceChildren(element("span", { className: `key s${at % SERIES}`, textContent: head.textContent })));
      parts.push(element("div", { className: "scroll" }, groups), this.approaches());
    }
    parts.push(...intervals.map((interval, at) => this.interval(interval, at)));
    this.list.replaceChildren(...parts);
    this.drawWhole();
    this.showDetail();
  }

  button(title, text, isPressed, act) {
    const button = element("button", { type: "button", className: "quiet", textContent: text, title });
    button.setAttribute("aria-pressed", String(isPressed));
    button.addEventListener("click", act);
    return button;
  }

  /** The approaches of the chosen cluster, its medoid first. */
  approaches() {
    const { clusters, approaches } = this.overview, cluster = clusters[this.cluster], medoid = approaches[cluster.medoid];
    const own = [medoid, ...approaches.filter((one) => one.cluster === this.cluster && one !== medoid)];
    const rows = own.slice(0, this.rows).map((one) => [this.wordsOf(one), one === medoid ? "medoid" : "", one.effect, this.button(`Look at ${this.wordsOf(one)}`, "choose", this.chosen?.approach === one, () => this.choose({ approach: one }))]);
    const more = own.length > this.rows ? [this.button("Show more of them", `${own.length - this.rows} more`, false, () => { this.rows += ROWS; this.show(); })] : [];
    return element("div", {}, element("div", { className: "scroll" }, table(`Approaches: ${cluster.name}`, ["", "", "effect of its own", ""], rows)), ...more);
  }

  /** The variations of the fit of a stretch. */
  interval({ name, expected, variations }, at) {
    const rows = variations.map((variation, number) => [variation.angle === null ? "without any wall" : `turned by ${written(variation.angle, 4)}\u00b0, stretched by ${written(variation.factor, 4)}`,
      `${variation.successes} of ${variation.trials}`, this.button("Look at this variation", "choose", this.chosen?.interval === at && this.chosen.variation === number, () => this.choose({ interval: at, variation: number }))]);
    return element("div", { className: "scroll" }, table(`${name}: ${expected}`, ["", "successes", ""], rows));
  }

  async choose(chosen) {
    Object.assign(this, { chosen, drawing: null, trial: 1 });
    this.show();
    this.detail.scrollIntoView({ block: "nearest" });
    await this.ask();
  }

  get place() {
    const { chosen } = this;
    return chosen.approach ? { approach: chosen.approach.approach, offset: this.offset } : { interval: chosen.interval, variation: chosen.variation };
  }

  async ask() {
    const { chosen } = this;
    try {
      const { drawing } = await this.tools.part(this.place);
      // another may have been chosen in the meantime
      if (this.chosen === chosen) { this.drawing = drawing; this.drawLarge(); }
    } catch (error) { this.tools.say(`The drawing did not come: ${error.message}.`); }
  }

  showDetail() {
    const { overview, chosen } = this;
    if (!chosen) { this.detail.replaceChildren(element("p", { className: "note", textContent: "Choose a cluster, an approach of it or a variation of a stretch to see what stands there, and to watch the group come by, computed again from its seed." })); return; }
    const { approach } = chosen, count = approach ? overview.trials : overview.varied_trials;
    const title = approach ? this.nameOf(approach) : overview.intervals[chosen.interval].name;
    this.large = element("canvas", { className: "large", role: "img" });
    this.large.setAttribute("aria-label", approach ? "The fragment in its arena (dashed), the group at its start (cross) and its way" : "The fit as it is varied, and the point about which it is turned (cross)");
    const watch = element("button", { type: "button", className: "watch", textContent: "Watch", title: "Watch the group, live" });
    watch.addEventListener("click", () => this.tools.watch({ ...this.place, trial: this.trial }));
    const options = element("div", { className: "options" }, ...(approach && overview.offsets > 1 ? [choice("Offset", Array.from({ length: overview.offsets }, (_, at) => String(at + 1)), this.offset, (at) => { this.offset = at; this.ask(); }, "From right to left of the approach")] : []),
      ...(count > 1 ? [choice("Trial", Array.from({ length: count }, (_, at) => String(at + 1)), this.trial - 1, (at) => { this.trial = at + 1; })] : []), watch,
      copyButton(title, () => { const { drawing } = this; return drawing && { wide: SIDE, tall: SIDE, rows: rowsOfDrawing(drawing), draw: (pen, named) => drawDrawing(pen, drawing, boundsOfDrawing(drawing), SIDE, SIDE, named) }; }));
    const said = approach ? this.wordsOf(approach) : "";
    const short = (value) => (value === null ? "\u2013" : written(value, 4));
    const numbers = approach ? [element("div", { className: "scroll" }, table("What was found", ["", "found", "less empty"], overview.numbers.map(({ name, unit }, at) => [titled(name.replaceAll("_", " "), isBare(unit) ? "" : unit), short(approach.found[at]), short(approach.relative[at])])))] : [];
    this.detail.replaceChildren(element("h2", { textContent: title }), ...(said ? [element("p", { className: "note", textContent: said })] : []), this.large, options, ...numbers);
    this.drawLarge();
  }

  drawLarge() {
    if (!this.chosen || !this.drawing || !this.large?.isConnected) return;
    const wide = this.large.clientWidth || SIDE;
    drawDrawing(penOf(this.large, wide, wide), this.drawing, null, wide, wide);
  }

  /** The approaches that are drawn: of the chosen window and heading. */
  get seen() { return this.overview.approaches.filter((one) => one.window === this.windows[this.window] && one.heading === this.headings[this.heading]); }

  table() { return [["line", "middle", "window", "heading", "effect", "cluster"], ...this.seen.map((one) => [one.line, one.middle, one.window, one.heading, one.effect, this.nameOf(one)])]; }

  drawWhole() {
    if (this.whole.hidden || !this.whole.isConnected) return;
    const wide = this.whole.clientWidth || WIDE, tall = this.whole.clientHeight || WIDE;
    this.whole.setAttribute("aria-label", `The construct; ${this.seen.length} fragments in the colours of their clusters, as in the table below`);
    this.paint(penOf(this.whole, wide, tall), wide, tall, css());
  }

  paint(pen, wide, tall, named) {
    const { construct } = this.overview, bounds = boundsOfDrawing(construct), at = drawDrawing(pen, construct, bounds, wide, tall, named);
    pen.lineWidth = 4;
    for (const one of this.seen) {
      pen.strokeStyle = named(this.colourOf(one.cluster));
      line(pen, pairs(one.points).map(at));
      pen.stroke();
    }
  }
}
