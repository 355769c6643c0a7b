// An evolution: fitness and genes over the generations, and any generation to be watched.

import { css, endsOf, frame, line, penOf } from "./paper.js";
import { choice, table } from "./searched.js";
import { copyButton } from "./vector.js";
import { clamp, element, titled, written } from "./words.js";

const SHOWN = 12, WIDE = 100, TALL = 190, LOW = 120, LEFT = 46, RIGHT = 8, TOP = 6, BOTTOM = 22;

export class EvolutionView {
  constructor(overview, tools) {
    Object.assign(this, { overview, tools, run: 0, generation: null, genes: new Map() });
    this.choices = element("div", { className: "options" });
    const rowsOfFitness = () => [["run", "generation", "best", "mean", "worst"], ...overview.runs.flatMap(({ name, spread }) => spread.map((values, generation) => [name, generation, ...values]))];
    this.fitness = this.chart("Fitness", "fitness of the best candidate (line) and mean (dashed)", (pen, wide, tall, named) => this.paintFitness(pen, wide, tall, named), TALL, rowsOfFitness);
    this.charts = overview.genes.map((gene, column) => {
      const rows = () => [["generation", "candidate", gene.name], ...(this.genes.get(this.run) ?? []).flatMap(({ generation, candidates }) => candidates.map((values, candidate) => [generation, candidate, values[1 + column]]))];
      return { ...this.chart(titled(gene.name, gene.unit), gene.about || gene.name, (pen, wide, tall, named) => this.paintGene(pen, wide, tall, gene, named), LOW, rows), gene };
    });
    this.detail = element("section", { className: "detail", "aria-live": "polite" });
    this.box = element("div", { className: "searching" }, element("div", { className: "main" }, this.choices, this.fitness.figure,
      element("div", { className: "alleles" }, ...this.charts.map(({ figure }) => figure))), this.detail);
    new ResizeObserver(() => this.repaint()).observe(this.fitness.canvas.parentElement);
  }

  get generations() { return this.overview.runs[this.run]?.spread ?? []; }

  chart(title, about, paint, tall, rows) {
    const canvas = element("canvas", { tabIndex: 0, role: "img" });
    canvas.setAttribute("aria-label", `${title} over generations. Arrow keys choose a generation`);
    const figure = element("figure", {}, element("figcaption", { title: about }, `${title} `, copyButton(title, () => ({ wide: 640, tall, rows: rows(), draw: (pen, named) => paint(pen, 640, tall, named) }))), canvas);
    canvas.addEventListener("pointerdown", (event) => { const { left } = canvas.getBoundingClientRect(); this.choose(this.scale?.value(event.clientX - left) ?? 0); });
    canvas.addEventListener("keydown", (event) => {
      const last = this.generations.length - 1, now = this.generation ?? last;
      const to = { ArrowLeft: now - 1, ArrowRight: now + 1, PageUp: now - 10, PageDown: now + 10, Home: 0, End: last }[event.key];
      if (to === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      event.stopPropagation();
      this.choose(to);
    });
    return { canvas, figure };
  }

  appear() { this.show(); }

  async show() {
    const { runs, genes } = this.overview;
    const number = element("input", { type: "number", min: 0, max: Math.max(0, this.generations.length - 1), step: 1, value: this.generation ?? Math.max(0, this.generations.length - 1), className: "generation" });
    number.addEventListener("change", () => this.choose(number.valueAsNumber));
    this.number = number;
    this.choices.replaceChildren(choice("Run", runs.map(({ name }) => name), this.run, (at) => { this.run = at; this.generation = null; this.show(); }),
      element("label", { title: "The generation that is marked and can be watched" }, "Generation ", number));
    if (this.generation === null) this.generation = Math.max(0, this.generations.length - 1);
    this.repaint();
    this.showDetail();
    if (genes.length === 0 || this.genes.has(this.run)) return;
    const run = this.run;
    try { this.genes.set(run, (await this.tools.part({ run })).generations); }
    catch (error) { this.tools.say(`The candidates did not come: ${error.message}.`); return; }
    this.repaint();
    this.showDetail();
  }

  choose(generation) {
    if (!Number.isFinite(generation)) return;
    this.generation = clamp(Math.round(generation), 0, Math.max(0, this.generations.length - 1));
    this.number.value = this.generation;
    this.repaint();
    this.showDetail();
  }

  repaint() {
    const wide = this.fitness.canvas.clientWidth;
    if (wide === 0) return;
    const named = css();
    this.scale = this.paintFitness(penOf(this.fitness.canvas, wide, TALL), wide, TALL, named);
    for (const { canvas, gene } of this.charts) if (canvas.clientWidth > 0) this.paintGene(penOf(canvas, canvas.clientWidth, LOW), canvas.clientWidth, LOW, gene, named);
  }

  get last() { return Math.max(1, ...this.overview.runs.map(({ spread }) => spread.length - 1)); }

  paintFitness(pen, wide, tall, named) {
    const all = this.overview.runs.flatMap(({ spread }) => spread.flatMap(([best, mean]) => [best, mean]));
    const at = frame(pen, [LEFT, TOP, wide - RIGHT, tall - BOTTOM], [0, this.last], endsOf(all), named);
    this.overview.runs.forEach(({ spread }, index) => {
      const isShown = index === this.run;
      pen.strokeStyle = named(isShown ? "series-0" : "faint");
      pen.globalAlpha = isShown ? 1 : 0.35;
      for (const [column, dash] of [[0, []], [1, [4, 3]]]) {
        if (column === 1 && !isShown) continue;
        pen.setLineDash(dash);
        pen.lineWidth = isShown ? 1.8 : 1;
        line(pen, spread.map((one, generation) => [generation, one[column]]).filter(([, value]) => value !== null).map(([x, y]) => [at.across(x), at.down(y)]));
        pen.stroke();
      }
    });
    pen.globalAlpha = 1;
    pen.setLineDash([]);
    this.mark(pen, at, tall, named);
    return at;
  }

  mark(pen, at, tall, named) {
    if (this.generation === null) return;
    pen.strokeStyle = named("series-1");
    pen.lineWidth = 1.4;
    line(pen, [[at.across(this.generation), TOP], [at.across(this.generation), tall - BOTTOM]]);
    pen.stroke();
  }

  /** All alleles of a gene: a dot for each candidate, and a line through the means. */
  paintGene(pen, wide, tall, gene, named) {
    const column = 1 + this.overview.genes.indexOf(gene);
    // what spans powers of ten is seen by its powers
    const isWide = gene.low > 0 && gene.high / gene.low >= WIDE, place = (value) => (isWide ? Math.log10(value) : value);
    const at = frame(pen, [LEFT, TOP, wide - RIGHT, tall - BOTTOM], [0, this.last], [place(gene.low), place(gene.high)], named, (value) => (isWide ? 10 ** value : value));
    const told = this.genes.get(this.run) ?? [];
    pen.fillStyle = named("series-2");
    pen.globalAlpha = 0.45;
    for (const { generation, candidates } of told) for (const candidate of candidates) pen.fillRect(at.across(generation) - 0.8, at.down(place(candidate[column])) - 0.8, 1.6, 1.6);
    pen.globalAlpha = 1;
    pen.strokeStyle = named("text");
    pen.lineWidth = 1.2;
    line(pen, told.map(({ generation, candidates }) => [at.across(generation), at.down(candidates.reduce((sum, one) => sum + place(one[column]), 0) / candidates.length)]));
    pen.stroke();
    this.mark(pen, at, tall, named);
  }

  showDetail() {
    const { overview, generation } = this, spread = this.generations[generation];
    if (!spread) { this.detail.replaceChildren(element("p", { className: "note", textContent: "This run has no generation yet." })); return; }
    const place = { run: this.run, generation };
    const button = element("button", { type: "button", className: "watch", textContent: overview.shared ? `Watch generation ${generation}` : `Watch the best of generation ${generation}` });
    button.addEventListener("click", () => this.tools.watch(place));
    const rows = [["best", written(spread[0], 5)], ["mean", written(spread[1], 5)], ["worst", written(spread[2], 5)]];
    const told = (this.genes.get(this.run) ?? []).find((one) => one.generation === generation);
    const ranked = (told?.candidates ?? []).map((values, candidate) => ({ values, candidate })).sort((a, b) => (b.values[0] ?? -Infinity) - (a.values[0] ?? -Infinity)).slice(0, SHOWN);
    const watch = (candidate) => {
      const button = element("button", { type: "button", className: "quiet", textContent: "watch", title: `Watch candidate ${candidate}` });
      button.addEventListener("click", () => this.tools.watch({ ...place, candidate }));
      return button;
    };
    const candidates = ranked.map(({ values, candidate }) => [String(candidate), ...values.map((value) => written(value, 4)), ...(overview.shared ? [] : [watch(candidate)])]);
    this.detail.replaceChildren(element("h2", { textContent: `Generation ${generation}` }), button, table("Fitness", [], rows),
      ...(candidates.length ? [element("div", { className: "scroll" }, table(ranked.length === SHOWN ? `The best ${SHOWN} candidates` : "Candidates", ["", "fitness", ...overview.genes.map(({ name }) => name), ...(overview.shared ? [] : [""])], candidates))] : []));
  }
}
