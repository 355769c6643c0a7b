// The focal agent in words and numbers, beside its figure: sets, components, motion, choice, and every value by stage.

import { componentStyle, drawFigure, reachOf, setMark, setStyle } from "./picture.js";
import { copyButton } from "./vector.js";
import { drawn, element, one, withUnit, written } from "./words.js";

const STAGES = ["sensing", "detection", "selection", "motion", "physics", "state"];
const vectorText = (vector, dimensions) => `(${vector.slice(0, dimensions).map((value) => written(value, 4)).join(", ")})`;
const cell = (content, properties = {}) => element("td", properties, content);

/** A table with a caption; nothing where there are no rows. */
function table(caption, heads, rows, name) {
  if (rows.length === 0) return null;
  const head = element("tr", {}, ...heads.map((text) => element("th", { scope: "col", textContent: text })));
  return element("table", { className: `values ${name}` }, element("caption", { textContent: caption }), element("thead", {}, head), element("tbody", {}, ...rows));
}

function sample(style, shape) {
  const svg = drawn("svg", { class: `sample ${style}`, viewBox: "-8 -8 16 16", "aria-hidden": "true" });
  svg.append(drawn("path", shape === null
    ? { d: "M-7 -1.6H1V-5L8 0L1 5V1.6H-7Z", class: `arrow component ${style}` }
    : { d: setMark(4.6, shape), class: `member ${style}` }));
  return svg;
}
const named = (style, shape, text) => element("th", { scope: "row" }, sample(style, shape), text);

/** What the figure of an agent shows, in numbers. */
function rowsOf(explanation) {
  const rows = [["what", "name", "agent", "x", "y", "z"]];
  const put = (what, name, vector, agent = "") => { if (vector) rows.push([what, name, agent, ...vector]); };
  put("position", "", explanation.position, explanation.agent);
  put("motion", "now", explanation.velocity);
  put("motion", "wanted", explanation.wanted);
  put("motion", "performed", explanation.performed);
  for (const part of explanation.components) put("component", part.name, part.vector);
  for (const { offset, id } of explanation.detected) put("detected", "", offset, id ?? "");
  for (const set of explanation.sets) for (const { offset, id } of set.members) put("set", set.name, offset, id ?? "");
  for (const { offset } of explanation.obstacles) put("obstacle", "", offset);
  for (const { to, hit } of explanation.rays) put("ray", hit, to);
  return rows;
}

export class Explanation {
  constructor(place) {
    this.place = place;
    this.figure = one(".inset", place);
    this.tables = one(".tables", place);
    this.copy = copyButton("the agent's figure", () => (this.shown ? { svg: this.figure, rows: rowsOf(this.shown) } : null));
    one("[data-do=nobody]", place).after(this.copy);
    this.drawn(null);
  }

  /** Notes what the figure shows; nothing is no figure to copy. */
  drawn(explanation) {
    this.shown = explanation;
    this.copy.hidden = explanation === null;
  }

  /** `pane` gives the units, the frame for headings, and the direction from which a space is seen. */
  show(explanation, pane) {
    this.drawn(explanation);
    this.place.classList.toggle("none", explanation === null);
    if (explanation === null) { this.tables.replaceChildren(); this.figure.replaceChildren(); return; }
    const { scene } = pane;
    const speed = `${scene.units.length}/${scene.units.time}`;
    this.place.classList.toggle("recorded", explanation.recorded);
    if (explanation.recorded) { this.showRecorded(explanation); return; }
    const facts = this.drawInset(explanation, pane, scene);
    const rangeOf = (set) => [
      set.high === null ? "" : `${written(set.low ?? 0, 4)} to ${withUnit(set.high, scene.units.length, 4)}`,
      set.angle === null ? "" : `${written(set.angle, 4)}°`].filter(Boolean).join(", ");
    const sets = explanation.sets.map((set, index) => element("tr", { className: set.acts ? "acts" : "" },
      named(setStyle(set, index), index, set.name), cell(rangeOf(set)), cell(set.rule),
      cell(`${set.members.length}${set.acts ? " · acts" : ""}`, { className: "number" })));
    const components = explanation.components.map((part, index) => element("tr", {},
      named(componentStyle(index), null, part.name), cell(vectorText(part.vector, scene.dimensions)),
      cell(withUnit(part.magnitude ?? Math.hypot(...part.vector), explanation.unit), { className: "number" })));
    const met = explanation.met === "nothing" ? "the way was free" : `met: ${explanation.met}`;
    const motions = [["now", explanation.velocity, ""], ["wanted", explanation.wanted, ""], ["performed", explanation.performed, met]]
      .filter(([, vector]) => vector !== null).map(([name, vector, note]) => element("tr", {},
        element("th", { scope: "row", textContent: name }), cell(`${vectorText(vector, scene.dimensions)}${note ? ` · ${note}` : ""}`),
        cell(withUnit(Math.hypot(...vector), speed), { className: "number" })));
    const choice = explanation.choice.map((option) => {
      const bar = element("meter", { min: 0, max: 1, value: option.probability ?? 0, ariaLabel: `probability of ${option.name}` });
      return element("tr", { className: option.chosen ? "chosen" : "" },
        element("th", { scope: "row", textContent: option.chosen ? `${option.name} ✓` : option.name }), cell(bar),
        cell(written(option.probability, 4), { className: "number" }));
    });
    // the stages in their order, and whatever else was told after them
    const order = (row) => { const at = STAGES.indexOf(row.stage); return at < 0 ? STAGES.length : at; };
    let before = null;
    const values = explanation.values.map((row, at) => [row, at]).sort(([a, i], [b, j]) => order(a) - order(b) || i - j).map(([row]) => {
      const stage = row.stage === before ? "" : row.stage;
      before = row.stage;
      return element("tr", { className: stage ? "first" : "" }, element("th", { scope: "row", textContent: stage }), cell(row.name),
        cell(typeof row.value === "number" ? withUnit(row.value, row.unit) : String(row.value ?? "missing"), { className: typeof row.value === "number" ? "number" : "number words" }));
    });
    const seen = explanation.detected.length;
    const sensing = [explanation.sensing.kind, explanation.sensing.range === null ? "no limit" : `to ${withUnit(explanation.sensing.range, scene.units.length, 4)}`,
      explanation.sensing.opening === null ? "all around" : `${written(explanation.sensing.opening, 4)}° wide`].join(", ");
    const summary = element("p", { className: "who" }, element("strong", { textContent: `Agent ${explanation.agent}` }),
      ` of ${explanation.group}, ${explanation.model}. Sensing ${sensing}: ${seen} detected${explanation.rays.length ? `, ${explanation.rays.length} rays` : ""}`
      + `${explanation.obstacles.length ? `, ${explanation.obstacles.length} points of obstacles` : ""}.`);
    const scales = element("p", { className: "note scales", textContent: [
      facts.longest > 0 ? `Longest component: ${withUnit(facts.longest, explanation.unit, 3)}.` : "",
      facts.fastest > 0 ? `Longest motion: ${withUnit(facts.fastest, speed, 3)}.` : ""].filter(Boolean).join(" ") });
    this.tables.replaceChildren(...[scales, summary,
      table("Sets", ["set", "where", "rule", "members"], sets, "sets"),
      table("Components of the motion", ["component", "vector", "magnitude"], components, "components"),
      table("Motion", ["", "velocity", "speed"], motions, "motions"),
      table("Behaviour", ["option", "", "probability"], choice, "choice"),
      table("Values by stage", ["stage", "quantity", "value"], values, "stages")].filter((part) => part !== null));
  }

  /** Of a recorded individual nobody knows why it moves: what it does, and what was measured of it. */
  showRecorded({ name, agent, group, values }) {
    this.drawn(null);
    this.figure.replaceChildren();
    let before = null;
    const rows = values.map((row) => {
      const stage = row.stage === before ? "" : row.stage;
      before = row.stage;
      return element("tr", { className: stage ? "first" : "" }, element("th", { scope: "row", textContent: stage }), cell(row.name),
        cell(typeof row.value === "number" ? withUnit(row.value, row.unit, 5) : String(row.value ?? "missing"), { className: "number" }));
    });
    this.tables.replaceChildren(element("p", { className: "who" }, element("strong", { textContent: name || `Individual ${agent}` }), ` of ${group}, recorded.`),
      table("What was seen and measured", ["", "quantity", "value"], rows, "stages"));
  }

  /** The figure again, large enough to read whatever the scene's zoom is. */
  drawInset(explanation, pane, scene) {
    const wide = this.figure.clientWidth || 320, tall = this.figure.clientHeight || wide;
    const reach = reachOf(explanation);
    const scale = 0.43 * Math.min(wide, tall) / reach;
    const [across, up, away] = pane.drawing ? pane.drawing.camera.axes() : [[1, 0, 0], [0, 1, 0], [0, 0, 0]];
    const along = (axis, offset) => axis[0] * offset[0] + axis[1] * offset[1] + axis[2] * offset[2];
    const project = (place) => {
      const offset = place.map((value, axis) => value - explanation.position[axis]);
      return [wide / 2 + scale * along(across, offset), tall / 2 - scale * along(up, offset), along(away, offset), scale];
    };
    this.figure.setAttribute("viewBox", `0 0 ${wide} ${tall}`);
    return drawFigure(this.figure, explanation, {
      project, wide, tall, isSpace: scene.dimensions === 3, hatch: "hatch", withBodies: true, withLabels: true,
      radius: () => Math.min(Math.max(explanation.radius * scale, 6), 26), headingOf: (id) => pane.headingOf(id),
    }, scene.units);
  }
}
