// A map: its cells over two of its axes, and the environment and the group at the point that is chosen.

import { boundsOfDrawing, css, drawDrawing, frame, line, penOf } from "./paper.js";
import { choice, table } from "./searched.js";
import { copyButton, rowsOfDrawing } from "./vector.js";
import { clamp, element, titled, withUnit, written } from "./words.js";

const LEFT = 50, RIGHT = 10, TOP = 8, BOTTOM = 38, STRIDE = 40;

export class MapView {
  constructor(overview, tools) {
    Object.assign(this, { overview, tools, x: 0, y: overview.axes.length > 1 ? 1 : null, chosen: null, found: null });
    this.point = overview.axes.map(({ low, high }) => (low + high) / 2);
    this.choices = element("div", { className: "options" });
    this.panels = overview.panels.map((panel, index) => this.panel(panel, index));
    this.detail = element("section", { className: "detail", "aria-live": "polite" });
    this.box = element("div", { className: "searching" }, element("div", { className: "main" }, this.choices, element("div", { className: "panels" }, ...this.panels.map(({ figure }) => figure))), this.detail);
    new ResizeObserver(() => this.repaint()).observe(this.box);
  }

  appear() { this.show(); this.repaint(); this.showDetail(); }

  panel(panel, index) {
    const canvas = element("canvas", { tabIndex: 0, role: "img" });
    canvas.setAttribute("aria-label", `Map ${panel.name}. Arrow keys move the point, Enter shows what is there`);
    const control = panel.control[1] > 0 ? `; without a construct ${written(panel.control[0] / panel.control[1], 3)}` : "";
    const own = { panel, index, canvas, at: null }, names = this.overview.axes.map(({ name }) => name);
    const copy = copyButton(`Map ${panel.name}`, () => ({
      wide: 640, tall: 460, rows: [[...names.map((name) => `${name} from`), ...names.map((name) => `${name} to`), "share of successes", "valid"], ...panel.cells], draw: (pen, named) => this.paint(pen, 640, 460, own, named),
    }));
    own.figure = element("figure", {}, element("figcaption", {}, `${panel.name}${panel.about ? `: ${panel.about}` : ""}${control} `, copy), canvas);
    canvas.addEventListener("click", (event) => {
      const box = canvas.getBoundingClientRect(), to = [own.at.value(event.clientX - box.left), own.at.height(event.clientY - box.top)];
      this.move(this.x, to[0]);
      if (this.y !== null) this.move(this.y, to[1]);
      this.choose(index);
    });
    canvas.addEventListener("keydown", (event) => {
      if (event.altKey || event.ctrlKey || event.metaKey) return;
      const step = (axis, by) => { if (axis !== null) { const { low, high } = this.overview.axes[axis]; this.move(axis, this.point[axis] + by * (high - low) / STRIDE); } this.repaint(); };
      const act = { ArrowLeft: () => step(this.x, -1), ArrowRight: () => step(this.x, 1), ArrowDown: () => step(this.y, -1), ArrowUp: () => step(this.y, 1), Enter: () => this.choose(index) }[event.key];
      if (!act) return;
      event.preventDefault();
      event.stopPropagation();
      act();
    });
    return own;
  }

  move(axis, value) { const { low, high } = this.overview.axes[axis]; this.point[axis] = clamp(value, low, high); }

  show() {
    const { axes } = this.overview, names = axes.map(({ name }) => name);
    const swap = (key, other) => (at) => { if (this[other] === at) this[other] = this[key]; this[key] = at; this.show(); this.repaint(); };
    const sliders = axes.map((axis, index) => {
      if (index === this.x || index === this.y) return null;
      const said = element("output", { textContent: withUnit(this.point[index], axis.unit, 4) });
      const slider = element("input", { type: "range", min: axis.low, max: axis.high, step: (axis.high - axis.low) / 200, value: this.point[index] });
      slider.addEventListener("input", () => { this.move(index, slider.valueAsNumber); said.textContent = withUnit(this.point[index], axis.unit, 4); this.repaint(); });
      return element("label", { title: "The map is cut here" }, `${axis.name} `, slider, said);
    });
    this.choices.replaceChildren(...(axes.length > 2 ? [choice("Across", names, this.x, swap("x", "y")), choice("Up", names, this.y, swap("y", "x"))] : []), ...sliders.filter(Boolean),
      element("span", { className: "count", textContent: "The darker a cell, the more trials succeeded; + marks valid cells. Click a point to see its environment." }));
  }

  repaint() { for (const panel of this.panels) this.draw(panel); this.drawLarge(); }

  draw(own) {
    const wide = own.canvas.clientWidth;
    if (wide === 0) return;
    const tall = this.y === null ? 120 : clamp(wide * 0.72, 220, 460);
    own.canvas.style.height = `${tall}px`;
    own.at = this.paint(penOf(own.canvas, wide, tall), wide, tall, own, css());
  }

  paint(pen, wide, tall, own, named) {
    const { axes } = this.overview, count = axes.length, y = this.y === null ? { name: "", unit: "", low: 0, high: 1 } : axes[this.y], x = axes[this.x];
    const at = frame(pen, [LEFT, TOP, wide - RIGHT, tall - BOTTOM], [x.low, x.high], [y.low, y.high], named);
    const others = axes.map((_, axis) => axis).filter((axis) => axis !== this.x && axis !== this.y);
    // colour-blind safe: one hue, by how much of it there is; what is valid has a sign as well
    for (const cell of own.panel.cells) {
      if (others.some((axis) => this.point[axis] < cell[axis] || this.point[axis] > cell[count + axis])) continue;
      const [left, right] = [at.across(cell[this.x]), at.across(cell[count + this.x])];
      const [bottom, top] = this.y === null ? [at.down(0), at.down(1)] : [at.down(cell[this.y]), at.down(cell[count + this.y])];
      const rate = cell[2 * count], isValid = cell[2 * count + 1] === 1;
      pen.globalAlpha = rate > 0 ? 0.08 + 0.85 * rate : 0;
      pen.fillStyle = named("series-0");
      pen.fillRect(left, top, Math.max(0.5, right - left), Math.max(0.5, bottom - top));
      pen.globalAlpha = 1;
      if (!isValid) continue;
      const arm = clamp(Math.min(right - left, bottom - top) * 0.3, 0.8, 4), [cx, cy] = [(left + right) / 2, (top + bottom) / 2];
      pen.strokeStyle = named("ground");
      pen.lineWidth = 1.2;
      line(pen, [[cx - arm, cy], [cx + arm, cy]]); pen.stroke();
      line(pen, [[cx, cy - arm], [cx, cy + arm]]); pen.stroke();
    }
    pen.fillStyle = named("text");
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.fillText(titled(x.name, x.unit), (LEFT + wide - RIGHT) / 2, tall - 6);
    if (this.y !== null) { pen.save(); pen.translate(11, (TOP + tall - BOTTOM) / 2); pen.rotate(-Math.PI / 2); pen.fillText(titled(y.name, y.unit), 0, 0); pen.restore(); }
    pen.strokeStyle = named("series-1");
    pen.lineWidth = 1.6;
    const [px, py] = [at.across(this.point[this.x]), this.y === null ? at.down(0.5) : at.down(this.point[this.y])];
    pen.beginPath();
    pen.arc(px, py, own.index === this.chosen ? 6 : 4, 0, 2 * Math.PI);
    pen.stroke();
    return at;
  }

  get place() { return Object.fromEntries([["panel", this.chosen], ...this.point.map((value, axis) => [`x${axis}`, value])]); }

  async choose(panel) {
    this.chosen = panel;
    this.repaint();
    const place = this.place, key = JSON.stringify(place);
    this.asked = key;
    this.found = null;
    let problem = "";
    try { this.found = await this.tools.part(place); } catch (error) { problem = error.message; }
    if (this.asked !== key) return;
    this.showDetail(problem);
  }

  showDetail(problem = "") {
    const { axes, panels } = this.overview;
    if (this.chosen === null) { this.detail.replaceChildren(element("p", { className: "note", textContent: `Parameters of ${this.overview.schema}. Choose a point of a map: its environment is drawn, and the group can be watched in it.` })); return; }
    const rows = axes.map(({ name, unit }, axis) => [name, withUnit(this.point[axis], unit, 5)]);
    if (!this.found) { this.detail.replaceChildren(element("h2", { textContent: panels[this.chosen].name }), table("The point", [], rows), element("p", { className: "state", textContent: problem ? `Nothing is shown: ${problem}.` : "Drawing…" })); return; }
    const { successes, trials, fitness } = this.found;
    this.large = element("canvas", { className: "large", role: "img" });
    this.large.setAttribute("aria-label", "The environment at the point");
    const button = element("button", { type: "button", className: "watch", textContent: "Watch the group in it" });
    button.addEventListener("click", () => this.tools.watch({ ...this.place, trial: 1 }));
    const { drawing } = this.found;
    const copy = copyButton("Environment", () => ({ wide: 320, tall: 320, rows: rowsOfDrawing(drawing), draw: (pen, named) => drawDrawing(pen, drawing, boundsOfDrawing(drawing), 320, 320, named) }));
    this.detail.replaceChildren(element("h2", { textContent: panels[this.chosen].name }), this.large, element("div", { className: "options" }, button, copy), table("The point", [], rows),
      table("Its cell", [], [["trials that succeeded", `${successes} of ${trials}`], ["mean fitness", written(fitness, 4)]]));
    this.drawLarge();
  }

  drawLarge() {
    if (!this.found || !this.large?.isConnected) return;
    const wide = this.large.clientWidth || 320;
    drawDrawing(penOf(this.large, wide, wide), this.found.drawing, null, wide, wide);
  }
}
