// Metrics as small charts under the scene, over one time line: the time shown, the time pointed at, and events.

import { chartAsSvg } from "./plot.js";
import { copyButton } from "./vector.js";
import { clamp, colours, element, titled, withUnit, written } from "./words.js";

// beyond so many points every second one is dropped: the line looks the same
const MOST_POINTS = 4000;
const SOON = 80;
const LEFT = 44, RIGHT = 8, TOP = 8, BOTTOM = 20;

/** Round values within a range, few. */
function ticks(low, high, most) {
  const raw = (high - low) / Math.max(1, most);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((digit) => digit * power).find((size) => size >= raw * 0.999);
  const found = [];
  for (let at = Math.ceil(low / step - 1e-9); at * step <= high + 1e-9 * step; at += 1) found.push(at === 0 ? 0 : Number((at * step).toPrecision(12)));
  return found;
}

const nearest = (places, x) => {
  let low = 0, high = places.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (places[middle] < x) low = middle + 1; else high = middle;
  }
  return low > 0 && x - places[low - 1] <= places[low] - x ? low - 1 : low;
};

export class Charts {
  /** `seek(t)` is called when a time is chosen; null where there is no way back. */
  constructor(place, seek) {
    Object.assign(this, { place, seek, metrics: [], series: [], groups: [], events: [], now: null, cursor: null, unit: "", canSeek: false, waits: false });
    addEventListener("resize", () => this.request());
    place.addEventListener("keydown", (event) => this.key(event));
  }

  /** A new scene: nothing was measured yet. `series` are lines by [pane, group]. */
  begin(scene) {
    Object.assign(this, {
      metrics: scene.metrics, groups: scene.groups.map(({ name }) => name), events: [...scene.events], unit: scene.units.time,
      canSeek: scene.isRun, now: null, cursor: null, panes: [],
    });
    this.place.hidden = this.metrics.length === 0;
    const key = JSON.stringify([this.metrics, scene.isRun]);
    if (key !== this.made) {
      this.made = key;
      this.figures = this.metrics.map((metric, index) => {
        const canvas = element("canvas", { role: "img" });
        const value = element("span", { className: "now" });
        const copy = copyButton(metric.title, () => ({ text: this.asSvg(index) }), metric.id);
        const figure = element("figure", { tabIndex: 0, title: scene.isRun ? "Click or press Enter: go to this time. Arrow keys: read out." : "Arrow keys: read out." },
          element("figcaption", {}, element("span", { className: "title", textContent: titled(metric.title, metric.unit) }), value, copy), canvas);
        figure.dataset.metric = metric.id;
        figure.classList.toggle("own", metric.own);
        canvas.addEventListener("pointermove", (event) => this.point(this.timeAt(canvas, event)));
        canvas.addEventListener("pointerleave", () => this.point(null));
        canvas.addEventListener("click", (event) => { if (this.canSeek) this.seek(this.timeAt(canvas, event)); });
        return { metric, index, canvas, value, figure };
      });
      this.place.replaceChildren(...this.figures.map(({ figure }) => figure));
    }
    this.request();
  }

  pane(index) { return (this.panes[index] ??= { t: [], lines: new Map(), stride: 1, skipped: 0 }); }

  /** Adds what was measured at one time, in a live scene. */
  add(index, { t, rows }) {
    const pane = this.pane(index);
    if (typeof t !== "number" || !Array.isArray(rows)) return;
    while (pane.t.length > 0 && pane.t.at(-1) >= t) { pane.t.pop(); for (const lines of pane.lines.values()) for (const line of lines) line.pop(); }
    pane.t.push(t);
    for (const row of rows) {
      const name = row.group ?? "";
      if (!pane.lines.has(name)) pane.lines.set(name, this.metrics.map(() => Array(pane.t.length - 1).fill(null)));
      pane.lines.get(name).forEach((line, metric) => { line[pane.t.length - 1] = row.values?.[metric] ?? null; });
    }
    if (pane.t.length > MOST_POINTS) {
      const thinned = (list) => list.filter((_, at) => at % 2 === 0);
      pane.t = thinned(pane.t);
      for (const [name, lines] of pane.lines) pane.lines.set(name, lines.map(thinned));
    }
    this.requestSoon();
  }

  /** Takes all that was measured in a run. */
  takeAll(index, { t, groups, own }) {
    const pane = this.pane(index);
    if (!Array.isArray(t) || !Array.isArray(groups)) return;
    // lines with times of their own
    pane.own = new Map((Array.isArray(own) ? own : []).map(({ id, lines }) => [id, lines]));
    pane.t = t;
    pane.lines = new Map(groups.map((group) => [group.group ?? "", this.metrics.map((_, metric) => group.values?.[metric] ?? [])]));
    this.request();
  }

  addEvent(event) { this.events.push(event); this.request(); }
  showNow(t) { if (t !== this.now) { this.now = t; this.requestSoon(); } }
  point(t) { this.cursor = t; this.request(); }

  key(event) {
    if (event.target.matches("button")) return;
    const times = this.panes[0]?.t ?? [];
    if (times.length === 0 || event.altKey || event.ctrlKey || event.metaKey) return;
    const at = nearest(times, this.cursor ?? this.now ?? times[0]);
    const to = { ArrowLeft: at - 1, ArrowRight: at + 1, PageUp: at - 10, PageDown: at + 10, Home: 0, End: times.length - 1 }[event.key];
    if (to !== undefined) this.point(times[clamp(to, 0, times.length - 1)]);
    else if (event.key === "Escape" && this.cursor !== null) this.point(null);
    else if (event.key === "Enter" && this.canSeek && this.cursor !== null) this.seek(this.cursor);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  get ends() {
    let [low, high] = [Infinity, -Infinity];
    for (const pane of this.panes ?? []) if (pane?.t.length) [low, high] = [Math.min(low, pane.t[0]), Math.max(high, pane.t.at(-1))];
    return high > low ? [low, high] : Number.isFinite(low) ? [low, low + 1] : [0, 1];
  }

  timeAt(canvas, event) {
    const box = canvas.getBoundingClientRect(), [low, high] = this.ends;
    return low + (high - low) * clamp((event.clientX - box.left - LEFT) / Math.max(1, box.width - LEFT - RIGHT), 0, 1);
  }

  request() {
    if (this.waits) return;
    this.waits = true;
    requestAnimationFrame(() => { this.waits = false; if (!this.place.hidden) this.draw(); });
  }

  /** For what comes with every frame: the charts need not be as quick as the scene. */
  requestSoon() {
    if (this.comes) return;
    this.comes = true;
    setTimeout(() => { this.comes = false; this.request(); }, SOON);
  }

  repaint() { this.request(); }

  linesOf(index) {
    if (this.metrics[index].own) return (this.panes ?? []).flatMap((pane, number) => (pane?.own?.get(this.metrics[index].id) ?? []).map(({ name, t, y }) => ({ name, number, t, y })));
    return (this.panes ?? []).flatMap((pane, number) => [...(pane?.lines ?? [])].map(([name, all]) => ({ name, number, t: pane.t, y: all[index] ?? [] })));
  }

  /** A chart as the text of an SVG with its data. */
  asSvg(index) {
    const metric = this.metrics[index], lines = this.linesOf(index);
    const named = lines.map(({ name, number, ...rest }) => ({ name: number > 0 ? `run ${number + 1}: ${name}` : name, ...rest }));
    return chartAsSvg(metric.title, metric.unit, this.unit, named, this.ends, metric.range);
  }

  draw() {
    const { css } = colours(), ends = this.ends;
    // with more than one line, the colours are those of the groups; what is of the whole world is neutral
    const colourOf = (name) => { const at = this.groups.indexOf(name); return at < 0 ? css("text") : css(`series-${at % 7}`); };
    for (const figure of this.figures ?? []) this.drawOne(figure, css, ends, colourOf);
  }

  drawOne({ metric, index, canvas, value }, css, [from, to], colourOf) {
    const wide = canvas.clientWidth, tall = canvas.clientHeight;
    if (wide === 0) return;
    const ratio = Math.min(devicePixelRatio || 1, 2);
    canvas.width = Math.round(wide * ratio);
    canvas.height = Math.round(tall * ratio);
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    const lines = this.linesOf(index);
    let [low, high] = metric.range ?? [Infinity, -Infinity];
    if (!metric.range) {
      for (const line of lines) for (const y of line.y) if (y !== null && Number.isFinite(y)) [low, high] = [Math.min(low, y), Math.max(high, y)];
      if (!Number.isFinite(low)) [low, high] = [0, 1];
      if (high - low < 1e-9 * Math.max(1, Math.abs(high))) [low, high] = [low - 0.5, high + 0.5];
    }
    const x = (t) => LEFT + (wide - LEFT - RIGHT) * (t - from) / (to - from);
    const y = (v) => tall - BOTTOM - (tall - TOP - BOTTOM) * (v - low) / (high - low);
    pen.font = "11px system-ui, sans-serif";
    pen.fillStyle = css("faint");
    pen.lineWidth = 1;
    const vertical = (t, colour, dash = []) => {
      pen.strokeStyle = colour;
      pen.setLineDash(dash);
      pen.beginPath();
      pen.moveTo(x(t), TOP);
      pen.lineTo(x(t), tall - BOTTOM);
      pen.stroke();
      pen.setLineDash([]);
    };
    pen.textAlign = "right";
    const few = ticks(low, high, 2);
    for (const tick of few.length > 1 ? few : ticks(low, high, 4)) {
      pen.strokeStyle = css("grid");
      pen.beginPath();
      pen.moveTo(LEFT, y(tick));
      pen.lineTo(wide - RIGHT, y(tick));
      pen.stroke();
      pen.fillText(written(tick, 4), LEFT - 6, y(tick) + 4);
    }
    pen.textAlign = "center";
    const marks = ticks(from, to, Math.max(2, wide / 90));
    marks.forEach((tick, at) => {
      const text = at === marks.length - 1 ? withUnit(tick, this.unit, 4) : written(tick, 4);
      pen.fillText(text, clamp(x(tick), LEFT, wide - RIGHT - pen.measureText(text).width / 2), tall - 5);
    });
    for (const event of this.events) {
      if (event.t < from || event.t > to) continue;
      if (event.kind === "gap" || event.kind === "flag") {
        // what lasts is a bar at the upper edge: not every gap may cross the whole chart
        pen.fillStyle = css(event.kind === "flag" ? "acts" : "faint");
        pen.fillRect(x(event.t) - 0.5, TOP - 4, Math.max(2, x(Math.min(event.untilT, to)) - x(event.t)), 3);
        continue;
      }
      vertical(event.t, css("faint"), [2, 3]);
      pen.fillStyle = css("text");
      pen.beginPath();
      pen.moveTo(x(event.t), TOP + 6);
      pen.lineTo(x(event.t) - 4, TOP - 1);
      pen.lineTo(x(event.t) + 4, TOP - 1);
      pen.fill();
    }
    for (const line of lines) {
      pen.strokeStyle = colourOf(line.name);
      pen.lineWidth = 1.6;
      pen.setLineDash(line.number > 0 ? [5, 3] : []);
      pen.beginPath();
      let isDown = false;
      for (let at = 0; at < line.t.length; at += 1) {
        const v = line.y[at];
        if (v === null || v === undefined || !Number.isFinite(v)) { isDown = false; continue; }
        if (isDown) pen.lineTo(x(line.t[at]), y(v)); else pen.moveTo(x(line.t[at]), y(v));
        isDown = true;
      }
      pen.stroke();
    }
    pen.setLineDash([]);
    const shown = this.cursor ?? this.now;
    if (shown !== null && shown >= from && shown <= to) vertical(shown, this.cursor === null ? css("accent") : css("text"));
    // of many lines the numbers would fill the page: they are read off one by one
    const told = lines.length > 6 ? [] : lines;
    const texts = told.filter(({ t }) => t.length > 0).map((line) => {
      const at = nearest(line.t, shown ?? line.t.at(-1));
      const v = line.y[at];
      if (v !== null && v !== undefined && Number.isFinite(v) && shown !== null) {
        pen.fillStyle = colourOf(line.name);
        pen.beginPath();
        pen.arc(x(line.t[at]), y(v), 3, 0, 2 * Math.PI);
        pen.fill();
      }
      // the unit stands once, at the end
      const whose = `${line.number > 0 ? `run ${line.number + 1}: ` : ""}${line.name}`;
      return (lines.length > 1 && whose ? `${whose} ` : "") + (line === told.at(-1) ? withUnit(v ?? null, metric.unit, 3) : written(v ?? null, 3));
    });
    const time = this.cursor === null ? "" : `t = ${withUnit(this.cursor, this.unit, 4)}: `;
    value.textContent = time + (lines.length > 6 ? `${lines.length} lines` : texts.join(" · "));
    canvas.setAttribute("aria-label", `${metric.title}: ${value.textContent || "nothing measured yet"}`);
  }
}
