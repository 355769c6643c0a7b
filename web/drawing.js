// Drawing with mouse and keyboard: walls, obstacles, regions, gates, anchors, starts; out of files and back into them.

import { answer, choice } from "./searched.js";
import { all, clamp, drawn, element, isNumber, one, roundLength, save, say, withUnit, written } from "./words.js";

// tool: how many points an item has (0: as many as one likes), whether it has a name, whether it may have several forms
const TOOLS = [
  { id: "select", title: "Select and move", about: "click an item; drag it or one of its points" },
  { id: "wall", title: "Wall", points: 2, chains: true, about: "click its ends; it goes on from there" },
  { id: "disc", title: "Disc", points: 2, about: "click its middle, then its edge" },
  { id: "box", title: "Box", points: 2, about: "click two opposite corners" },
  { id: "polygon", title: "Polygon", points: 0, about: "click its corners, the first one again to end" },
  { id: "region", title: "Region", points: 2, named: true, forms: ["box", "disc", "polygon"], about: "a named area for behaviours" },
  { id: "gate", title: "Gate", points: 2, named: true, about: "click its ends; who passes is counted" },
  { id: "anchor", title: "Anchor", points: 1, named: true, about: "click a place where walls may begin" },
  { id: "boundary", title: "Boundary", points: 0, about: "the polygon in which constructs are to stay" },
  { id: "start", title: "Start", points: 2, named: true, forms: ["box", "disc"], about: "where a group begins" },
];
const toolOf = (id) => TOOLS.find((tool) => tool.id === id);
const NEAR = 9, KEPT = 200;
const SAVES = [["file", "file (.toml)"], ["workspace", "workspace (.toml)"], ["geojson", "GeoJSON"], ["svg", "SVG"]];
const neat = (value) => Number(value.toFixed(6));
const isRound = ({ is, form }) => is === "disc" || (["region", "start"].includes(is) && form === "disc");
const isClosed = ({ is, form }) => ["polygon", "boundary"].includes(is) || (is === "region" && form === "polygon");
const isBox = (item) => item.is === "box" || (["region", "start"].includes(item.is) && item.form === "box");

export class Draw {
  /** `tools`: notice(text), name(text), open(file, text). */
  constructor(place, tools) {
    Object.assign(this, { place, tools, sketch: null, tool: "wall", form: "box", pending: [], selected: null, cursor: null, past: [], future: [], grid: null, group: 0, drag: null });
  }

  hide() { this.place.hidden = true; }
  repaint() { /* an SVG: the style sheet does it */ }

  /** Takes a file to be drawn on when the drawing is shown. */
  take(name, text) { this.coming = { name, text }; if (!this.place.hidden) this.load(); }

  async show() {
    this.place.hidden = false;
    this.tools.name("Draw");
    if (!this.stage) this.build();
    if (this.coming || !this.sketch) await this.load();
    this.paint();
  }

  async load() {
    const { name, text } = this.coming ?? { name: "", text: "" };
    this.coming = null;
    try {
      const sketch = await answer("sketch", { method: "POST", body: `${name.replaceAll("\n", " ")}\n${text}` });
      this.sketch = { ...sketch, items: sketch.items };
      Object.assign(this, { past: [], future: [], pending: [], selected: null, group: 0, drag: null });
      this.fit();
    } catch (error) {
      this.tools.notice(`${name || "A new drawing"} cannot be opened. ${error.message}`);
      if (!this.sketch) return;
    }
    this.tools.notice("");
    this.paint();
  }

  // ------------------------------------------------ the page

  build() {
    this.stage = drawn("svg", { class: "stage", tabindex: 0, role: "application", "aria-label": "Drawing. Arrow keys move the cross, Enter sets a point, Escape ends, Delete removes, digits choose a tool" });
    this.toolbar = element("div", { className: "options tools", role: "toolbar", "aria-label": "Tools" }, ...TOOLS.map(({ id, title, about }, index) => {
      const button = element("button", { type: "button", className: "quiet tool", textContent: title, title: `${title}: ${about} (${(index + 1) % 10})` });
      button.dataset.tool = id;
      button.addEventListener("click", () => this.use(id));
      return button;
    }));
    this.formPlace = element("span");
    const press = (name, text, title, act) => {
      const button = element("button", { type: "button", className: "quiet", textContent: text, title });
      button.dataset.do = name;
      button.addEventListener("click", act);
      return button;
    };
    this.snap = element("input", { type: "checkbox", checked: true });
    const opener = element("input", { type: "file", accept: ".toml,.svg,.geojson,.json,.wkt", hidden: true });
    opener.addEventListener("change", async () => { const [file] = opener.files; if (file) this.take(file.name, await file.text()); opener.value = ""; });
    this.target = element("select", { title: "What to save" }, ...SAVES.map(([value, text]) => element("option", { value, textContent: text })));
    const bar = element("div", { className: "options" }, press("undo", "Undo", "Undo (Ctrl and Z)", () => this.undo()), press("redo", "Redo", "Redo (Ctrl and Y)", () => this.redo()),
      element("label", { title: "Points go to the grid and to points that are near" }, this.snap, " Snap"), press("whole", "See all", "See everything (0)", () => { this.fit(); this.paint(); }),
      press("new", "New", "Begin with an empty scenario", () => this.take("", "")), press("open", "Open…", "Open a scenario, a design or map, SVG, WKT or GeoJSON; or drop it here", () => opener.click()), opener,
      element("label", {}, "Save as ", this.target), press("save-drawing", "Save", "Save (Ctrl and S)", () => this.save()), press("try", "Try it", "Watch the scenario as it is drawn", () => this.tryIt()));
    this.said = element("p", { className: "note", role: "status" });
    this.list = element("section", { className: "detail items", "aria-label": "What is drawn" });
    this.place.append(element("div", { className: "searching" }, element("div", { className: "main" }, this.toolbar, bar, this.formPlace, this.stage, this.said), this.list));
    this.listen();
    new ResizeObserver(() => this.paint()).observe(this.stage);
    this.use("wall");
  }

  use(id) {
    Object.assign(this, { tool: id, pending: [] });
    const tool = toolOf(id);
    for (const button of all("[data-tool]", this.toolbar)) button.setAttribute("aria-pressed", String(button.dataset.tool === id));
    if (tool.forms && !tool.forms.includes(this.form)) this.form = "box";
    const groups = this.sketch?.groups ?? [];
    this.formPlace.replaceChildren(...(tool.forms ? [choice("Form", tool.forms, tool.forms.indexOf(this.form), (at) => { this.form = tool.forms[at]; this.pending = []; this.paint(); })] : []),
      ...(id === "start" && groups.length > 0 ? [choice(" Group", groups.map(({ name }) => name), this.group, (at) => { this.group = at; })] : []));
    this.paint();
  }

  // ------------------------------------------------ places

  get items() { return this.sketch?.items ?? []; }

  bounds() {
    const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    const hold = ([x, y], radius = 0) => { [low[0], low[1], high[0], high[1]] = [Math.min(low[0], x - radius), Math.min(low[1], y - radius), Math.max(high[0], x + radius), Math.max(high[1], y + radius)]; };
    (this.sketch?.space ?? []).forEach(({ side }, axis) => { if (isNumber(side)) { low[axis] = Math.min(low[axis], 0); high[axis] = Math.max(high[axis], side); } });
    for (const item of this.items) for (const point of item.points) hold(point, isRound(item) ? item.radius : 0);
    for (const axis of [0, 1]) if (!(high[axis] > low[axis])) [low[axis], high[axis]] = Number.isFinite(low[axis]) ? [low[axis] - 5, low[axis] + 5] : [0, 10];
    return [low, high];
  }

  fit() { this.view = null; }

  get size() { return [this.stage.clientWidth || 600, this.stage.clientHeight || 400]; }

  /** Middle of what is seen, and pixels for a unit of length. */
  get seen() {
    if (!this.view) {
      const [low, high] = this.bounds(), [wide, tall] = this.size;
      this.view = { middle: [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2], scale: Math.min((wide - 50) / (high[0] - low[0]), (tall - 50) / (high[1] - low[1])) };
      this.cursor = this.view.middle.map(neat);
    }
    return this.view;
  }

  toScreen([x, y]) { const { middle, scale } = this.seen, [wide, tall] = this.size; return [wide / 2 + (x - middle[0]) * scale, tall / 2 - (y - middle[1]) * scale]; }
  toWorld([x, y]) { const { middle, scale } = this.seen, [wide, tall] = this.size; return [middle[0] + (x - wide / 2) / scale, middle[1] - (y - tall / 2) / scale]; }
  get step() { return roundLength(22 / this.seen.scale); }

  /** A point where it is wanted: at a point that is near, else on the grid. */
  snapped(place, except = null) {
    if (!this.snap.checked) return place.map(neat);
    const near = this.items.filter((item) => item !== except).flatMap(({ points }) => points).concat(this.pending)
      .map((point) => [point, Math.hypot(...this.toScreen(point).map((value, axis) => value - this.toScreen(place)[axis]))]).filter(([, far]) => far < NEAR).sort((a, b) => a[1] - b[1])[0];
    return near ? [...near[0]] : place.map((value) => neat(Math.round(value / this.step) * this.step));
  }

  // ------------------------------------------------ what is done

  change(act) {
    this.past.push(JSON.stringify(this.items));
    if (this.past.length > KEPT) this.past.shift();
    this.future = [];
    act();
    this.paint();
  }

  go(from, to) {
    if (from.length === 0) return;
    to.push(JSON.stringify(this.items));
    this.sketch.items = JSON.parse(from.pop());
    // what is dragged is no longer there
    Object.assign(this, { selected: null, pending: [], drag: null });
    this.paint();
  }

  undo() { if (this.pending.length > 0) { this.pending.pop(); this.paint(); } else this.go(this.past, this.future); }
  redo() { this.go(this.future, this.past); }

  nameFor(id) {
    if (id === "start") return this.sketch.groups[this.group]?.name ?? "";
    for (let number = 1; ; number += 1) if (!this.items.some((item) => item.is === id && item.name === `${id}-${number}`)) return `${id}-${number}`;
  }

  /** Sets a point with the tool that is chosen. */
  set(place) {
    const tool = toolOf(this.tool);
    if (!this.sketch || this.tool === "select") return;
    const last = this.pending.at(-1), isSame = last && Math.hypot(last[0] - place[0], last[1] - place[1]) < 1e-9;
    const form = tool.forms ? this.form : "box";
    const isOpen = tool.points === 0 || form === "polygon";
    const first = this.pending[0], isBack = isOpen && this.pending.length > 2 && (isSame || Math.hypot(first[0] - place[0], first[1] - place[1]) < 1e-9);
    if (isSame && !isBack) return;
    const isFlat = (this.tool === "box" || (tool.forms && form === "box")) && last && (last[0] === place[0] || last[1] === place[1]);
    if (isFlat) { this.tools.notice("A box needs a width and a height."); return; }
    if (!isBack) this.pending.push(place);
    if (isOpen ? isBack : this.pending.length === tool.points) {
      const points = this.pending;
      const item = { is: this.tool, name: tool.named ? this.nameFor(this.tool) : "", points, radius: 0, form, index: null };
      if (isRound(item)) { item.radius = neat(Math.hypot(points[1][0] - points[0][0], points[1][1] - points[0][1])); item.points = [points[0]]; }
      this.pending = tool.chains ? [points.at(-1)] : [];
      this.change(() => {
        // there is one boundary, and one start of each group
        if (["boundary", "start"].includes(item.is)) this.sketch.items = this.items.filter((other) => other.is !== item.is || other.name !== item.name);
        this.items.push(item);
        this.selected = this.items.length - 1;
      });
      say(`${tool.title} drawn`);
    } else this.paint();
  }

  remove(index) { this.drag = null; if (this.items[index]) this.change(() => { this.items.splice(index, 1); this.selected = null; }); }
  move(index, [x, y]) { for (const point of this.items[index].points) [point[0], point[1]] = [neat(point[0] + x), neat(point[1] + y)]; }

  async saved(target) {
    const { name, base, items } = this.sketch;
    const file = await answer("sketch/save", { method: "POST", body: JSON.stringify({ as: target, name, base, items }) });
    if (file.left_out > 0) this.tools.notice(`${file.left_out} items have no place in a scenario and are left out: save them as GeoJSON or a workspace.`);
    return file;
  }
  async save() {
    try { const { name, text } = await this.saved(this.target.value); save(name, text, "text/plain"); }
    catch (error) { this.tools.notice(`It cannot be saved. ${error.message}`); }
  }
  async tryIt() {
    try { const { name, text } = await this.saved("file"); this.tools.open(name, text); }
    catch (error) { this.tools.notice(`It cannot be tried. ${error.message}`); }
  }

  // ------------------------------------------------ mouse and keyboard

  listen() {
    const { stage } = this;
    const at = (event) => { const box = stage.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
    stage.addEventListener("pointerdown", (event) => {
      const here = at(event), [point, item] = [event.target.dataset?.point, event.target.closest?.("[data-item]")?.dataset.item];
      stage.setPointerCapture(event.pointerId);
      if (event.button === 1 || event.button === 2) { this.drag = { pans: true, last: here }; return; }
      if (this.tool === "select") {
        this.selected = item === undefined ? null : Number(item);
        this.drag = item === undefined ? { pans: true, last: here } : { item: Number(item), point: point === undefined ? null : Number(point), last: this.toWorld(here), before: JSON.stringify(this.items) };
        this.paint();
        return;
      }
      this.cursor = this.snapped(this.toWorld(here));
      this.drag = { draws: true, from: here };
      this.set(this.cursor);
    });
    stage.addEventListener("pointermove", (event) => {
      const here = at(event), { drag } = this;
      if (drag?.pans) {
        const { scale, middle } = this.seen;
        this.view = { scale, middle: [middle[0] - (here[0] - drag.last[0]) / scale, middle[1] + (here[1] - drag.last[1]) / scale] };
        drag.last = here;
      } else if (drag?.item !== undefined) {
        const item = this.items[drag.item], place = this.toWorld(here);
        if (drag.point !== null && drag.point >= item.points.length) item.radius = Math.max(this.step / 10, neat(Math.hypot(...this.snapped(place, item).map((value, axis) => value - item.points[0][axis]))));
        else if (drag.point !== null) item.points[drag.point] = this.snapped(place, item);
        else {
          const step = this.snap.checked ? this.step : 1e-6, by = place.map((value, axis) => Math.round((value - drag.last[axis]) / step) * step);
          this.move(drag.item, by);
          drag.last = drag.last.map((value, axis) => value + by[axis]);
        }
      } else this.cursor = this.snapped(this.toWorld(here));
      this.paint();
    });
    const up = (event) => {
      const { drag } = this;
      this.drag = null;
      if (drag?.before && drag.before !== JSON.stringify(this.items)) { this.past.push(drag.before); this.future = []; this.paint(); }
      // a line that is drawn in one go ends where the button is let go
      if (drag?.draws && Math.hypot(...at(event).map((value, axis) => value - drag.from[axis])) > NEAR) this.set(this.snapped(this.toWorld(at(event))));
    };
    stage.addEventListener("pointerup", up);
    stage.addEventListener("pointercancel", () => {
      if (this.drag?.before) this.sketch.items = JSON.parse(this.drag.before);
      this.drag = null;
      this.paint();
    });
    stage.addEventListener("contextmenu", (event) => event.preventDefault());
    stage.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-clamp(event.deltaY, -120, 120) * 0.002), this.toWorld(at(event)));
    }, { passive: false });
    this.place.addEventListener("keydown", (event) => this.key(event));
  }

  zoom(by, about) {
    const { scale, middle } = this.seen;
    this.view = { scale: scale * by, middle: middle.map((value, axis) => about[axis] + (value - about[axis]) / by) };
    this.paint();
  }

  key(event) {
    const isTyping = event.target.matches("input:not([type=checkbox]), select");
    if (event.ctrlKey || event.metaKey) {
      const act = { z: () => (event.shiftKey ? this.redo() : this.undo()), y: () => this.redo(), s: () => this.save() }[event.key.toLowerCase()];
      if (!act || isTyping) return;
      event.preventDefault();
      act();
      return;
    }
    if (event.altKey || isTyping || !this.sketch) return;
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    const onStage = event.target === this.stage;
    const digit = /^[0-9]$/.test(event.key) ? TOOLS[(Number(event.key) + 9) % 10] : null;
    const act = by && onStage ? () => this.nudge(by, event.shiftKey)
      : event.key === "Enter" && onStage ? () => { this.cursor = this.snapped(this.cursor); this.set([...this.cursor]); }
        : event.key === "Escape" ? () => { this.pending = []; this.selected = null; this.paint(); }
          : ["Delete", "Backspace"].includes(event.key) && this.selected !== null ? () => this.remove(this.selected)
            : ["+", "="].includes(event.key) ? () => this.zoom(1.2, this.seen.middle) : event.key === "-" ? () => this.zoom(1 / 1.2, this.seen.middle)
              : digit ? () => this.use(digit.id) : null;
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  }

  nudge([x, y], isFar) {
    const step = this.step * (isFar ? 5 : 1), by = [x * step, y * step];
    if (this.tool === "select" && this.selected !== null) { this.change(() => this.move(this.selected, by)); return; }
    this.cursor = this.cursor.map((value, axis) => neat(Math.round((value + by[axis]) / this.step) * this.step));
    say(this.cursor.map((value) => written(value, 6)).join(", "));
    this.paint();
  }

  // ------------------------------------------------ the picture

  paint() {
    if (!this.stage || this.place.hidden || !this.sketch) return;
    const [wide, tall] = this.size, { step } = this, parts = [];
    this.stage.setAttribute("viewBox", `0 0 ${wide} ${tall}`);
    const put = (name, attributes) => { const made = drawn(name, attributes); parts.push(made); return made; };
    const path = (points, closes) => `M${points.map((point) => this.toScreen(point).map((value) => value.toFixed(1)).join(" ")).join("L")}${closes ? "z" : ""}`;
    const [low, high] = [this.toWorld([0, tall]), this.toWorld([wide, 0])];
    let lines = "";
    for (let x = Math.ceil(low[0] / step); x * step <= high[0]; x += 1) lines += `M${this.toScreen([x * step, 0])[0].toFixed(1)} 0v${tall}`;
    for (let y = Math.ceil(low[1] / step); y * step <= high[1]; y += 1) lines += `M0 ${this.toScreen([0, y * step])[1].toFixed(1)}h${wide}`;
    put("path", { class: "lattice", d: lines });
    const space = this.sketch.space ?? [], side = (axis) => (isNumber(space[axis]?.side) ? space[axis].side : null);
    [[0, 1], [1, 0]].forEach(([axis, other]) => {
      if (side(axis) === null) return;
      const ends = side(other) === null ? [low[other], high[other]] : [0, side(other)];
      for (const value of [0, side(axis)]) put("path", { class: space[axis].edge === "walls" ? "edge" : "edge seam", d: path(ends.map((end) => (axis === 0 ? [value, end] : [end, value]))) });
    });
    this.items.forEach((item, index) => {
      if (item.points.length === 0) return;
      const group = put("g", { class: `item ${item.is}${index === this.selected ? " selected" : ""}`, "data-item": index });
      const add = (name, attributes) => group.append(drawn(name, attributes));
      const [x, y] = this.toScreen(item.points[0]), { scale } = this.seen;
      if (isRound(item)) add("circle", { cx: x, cy: y, r: Math.max(1, item.radius * scale) });
      else if (isBox(item)) { const [a, b] = item.points, corners = [a, [b[0], a[1]], b, [a[0], b[1]]]; add("path", { d: path(corners, true) }); }
      else if (item.is === "anchor") add("path", { d: `M${x - 6} ${y}h12M${x} ${y - 6}v12` });
      else { if (!isClosed(item)) add("path", { class: "wide", d: path(item.points) }); add("path", { d: path(item.points, isClosed(item)) }); }
      if (item.name) group.append(drawn("text", { x: x + 7, y: y - 6, class: "label" }, item.name));
      if (index === this.selected && this.tool === "select") {
        const handles = isRound(item) ? [...item.points, [item.points[0][0] + item.radius, item.points[0][1]]] : item.points;
        handles.forEach((point, at) => { const [u, v] = this.toScreen(point); add("circle", { class: "handle", cx: u, cy: v, r: 5, "data-point": at, "data-item": index }); });
      }
    });
    if (this.tool !== "select" && this.cursor) {
      const points = [...this.pending, this.cursor], tool = toolOf(this.tool), form = tool.forms ? this.form : this.tool;
      const [x, y] = this.toScreen(this.cursor);
      if (this.pending.length > 0) {
        if (form === "disc") { const [u, v] = this.toScreen(points[0]); put("circle", { class: "pending", cx: u, cy: v, r: Math.hypot(x - u, y - v) }); }
        else if (form === "box") { const [a, b] = points; put("path", { class: "pending", d: path([a, [b[0], a[1]], b, [a[0], b[1]]], true) }); }
        else put("path", { class: "pending", d: path(points) });
      }
      put("path", { class: "cursor", d: `M${x - 8} ${y}h16M${x} ${y - 8}v16` });
    }
    this.stage.replaceChildren(...parts);
    const unit = this.sketch.unit, tool = toolOf(this.tool);
    this.said.textContent = `${tool.title}: ${tool.about}.${this.cursor ? ` Cross at ${this.cursor.map((value) => withUnit(value, unit, 6)).join(", ")}; grid ${withUnit(step, unit, 4)}.` : ""}`;
    one("[data-do=undo]", this.place).disabled = this.past.length + this.pending.length === 0;
    one("[data-do=redo]", this.place).disabled = this.future.length === 0;
    this.showList();
  }

  /** The items as a list in which everything can be typed. */
  showList() {
    const key = JSON.stringify([this.items, this.selected]);
    if (key === this.listed || this.list.contains(document.activeElement) && document.activeElement.matches("input")) return;
    this.listed = key;
    const number = (value, label, act) => {
      const input = element("input", { type: "number", step: "any", value });
      input.setAttribute("aria-label", label);
      input.addEventListener("change", () => { if (Number.isFinite(input.valueAsNumber)) this.change(() => act(input.valueAsNumber)); });
      return input;
    };
    const entry = (item, index) => {
      const words = item.is === "other" ? "an obstacle that cannot be drawn" : item.is;
      const choose = element("button", { type: "button", className: "quiet", textContent: words, title: "Select it" });
      choose.setAttribute("aria-pressed", String(index === this.selected));
      choose.addEventListener("click", () => { this.selected = index; this.use("select"); });
      const away = element("button", { type: "button", className: "quiet", textContent: "Remove", title: `Remove this ${item.is}` });
      away.addEventListener("click", () => this.remove(index));
      const row = element("li", {}, element("div", { className: "options" }, choose, ...(item.is === "other" ? [] : [away])));
      if (index !== this.selected) return row;
      if (toolOf(item.is)?.named && item.is !== "start") {
        const name = element("input", { type: "text", value: item.name });
        name.setAttribute("aria-label", "Name");
        name.addEventListener("change", () => this.change(() => { item.name = name.value.trim() || item.name; }));
        row.append(element("label", { className: "options" }, "Name ", name));
      }
      item.points.forEach((point, at) => row.append(element("div", { className: "options" }, number(point[0], `x of point ${at + 1}`, (value) => { point[0] = value; }), number(point[1], `y of point ${at + 1}`, (value) => { point[1] = value; }))));
      if (isRound(item)) row.append(element("label", { className: "options" }, "Radius ", number(item.radius, "Radius", (value) => { if (value > 0) item.radius = value; })));
      return row;
    };
    this.list.replaceChildren(element("h2", { textContent: this.sketch.name || "A new drawing" }), element("p", { className: "note", textContent: `${this.items.length} items${this.sketch.kind === "drawing" ? "" : ` in a ${this.sketch.kind}`}` }),
      element("ul", { className: "items" }, ...this.items.map(entry)));
  }
}
