// Drawings as SVG with their data: a pen that is used like that of a canvas, and a button that copies what it drew.

import { css } from "./paper.js";
import { drawn, element, save, say } from "./words.js";

const short = (value) => String(Math.round(100 * value) / 100);
const quoted = (value) => { const text = value === null || value === undefined ? "" : String(value); return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text; };

/** Rows as text with commas between. */
export const csv = (rows) => `${rows.map((row) => row.map(quoted).join(",")).join("\n")}\n`;

/** What a canvas's pen does, as elements of an SVG. */
export class VectorPen {
  constructor(wide, tall) {
    this.svg = drawn("svg", { xmlns: "http://www.w3.org/2000/svg", viewBox: `0 0 ${short(wide)} ${short(tall)}`, width: short(wide), height: short(tall), "font-family": "system-ui, sans-serif" });
    Object.assign(this, { path: "", states: [], dash: [], moves: "", fillStyle: "#000000", strokeStyle: "#000000", lineWidth: 1, lineCap: "butt", font: "11px sans-serif", textAlign: "left", globalAlpha: 1 });
    this.ruler = document.createElement("canvas").getContext("2d");
  }

  put(name, attributes, text = null) {
    const made = drawn(name, attributes, text);
    if (this.moves) made.setAttribute("transform", this.moves.trim());
    if (this.globalAlpha < 1) made.setAttribute("opacity", short(this.globalAlpha));
    this.svg.append(made);
  }

  get stroked() {
    return { stroke: this.strokeStyle, "stroke-width": short(this.lineWidth), fill: "none", ...(this.dash.length ? { "stroke-dasharray": this.dash.join(" ") } : {}), ...(this.lineCap === "butt" ? {} : { "stroke-linecap": this.lineCap }) };
  }

  beginPath() { this.path = ""; }
  moveTo(x, y) { this.path += `M${short(x)} ${short(y)}`; }
  lineTo(x, y) { this.path += `${this.path ? "L" : "M"}${short(x)} ${short(y)}`; }
  closePath() { this.path += "Z"; }
  arc(x, y, radius, from = 0, to = 2 * Math.PI) {
    const at = (angle) => `${short(x + radius * Math.cos(angle))} ${short(y + radius * Math.sin(angle))}`, middle = (from + to) / 2, r = short(radius);
    this.path += `M${at(from)}A${r} ${r} 0 0 1 ${at(middle)}A${r} ${r} 0 0 1 ${at(to)}`;
  }
  stroke() { if (this.path) this.put("path", { d: this.path, ...this.stroked }); }
  fill() { if (this.path) this.put("path", { d: this.path, fill: this.fillStyle }); }
  box(x, y, wide, tall) { return { x: short(Math.min(x, x + wide)), y: short(Math.min(y, y + tall)), width: short(Math.abs(wide)), height: short(Math.abs(tall)) }; }
  fillRect(...box) { this.put("rect", { ...this.box(...box), fill: this.fillStyle }); }
  strokeRect(...box) { this.put("rect", { ...this.box(...box), ...this.stroked }); }
  clearRect() { /* nothing stands here before */ }
  setLineDash(dash) { this.dash = [...dash]; }
  measureText(text) { this.ruler.font = this.font; return this.ruler.measureText(text); }
  fillText(text, x, y) {
    const anchor = { center: "middle", right: "end", end: "end" }[this.textAlign] ?? "start";
    this.put("text", { x: short(x), y: short(y), fill: this.fillStyle, "text-anchor": anchor, "font-size": parseFloat(/(\d[\d.]*)px/.exec(this.font)?.[1] ?? "11") }, text);
  }
  save() { this.states.push(this.moves); }
  restore() { this.moves = this.states.pop() ?? ""; }
  translate(x, y) { this.moves += ` translate(${short(x)} ${short(y)})`; }
  rotate(angle) { this.moves += ` rotate(${short(angle * 180 / Math.PI)})`; }
}

/** Does something while the page has the colours for light paper. */
export function inLight(act) {
  const root = document.documentElement, was = root.dataset.theme;
  root.dataset.theme = "light";
  try { return act(); } finally { if (was === undefined) delete root.dataset.theme; else root.dataset.theme = was; }
}

/** The colours for light paper, whatever the page has. */
const ofPaper = () => inLight(() => {
  const names = ["ground", "stage", "text", "faint", "rule", "grid", "obstacle", "accent", ...[0, 1, 2, 3, 4, 5, 6].map((at) => `series-${at}`)];
  const named = css(), found = new Map(names.map((name) => [name, named(name)]));
  return (name) => found.get(name) ?? "#000000";
});

const LOOKS = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-opacity", "stroke-dasharray", "stroke-linecap", "stroke-linejoin", "opacity", "font-size", "font-weight", "text-anchor", "paint-order"];

/** An SVG of the page that stands alone: what its style sheet says is in its elements. */
function standingAlone(svg) {
  const copy = svg.cloneNode(true), box = svg.getBoundingClientRect();
  const [from, to] = [svg, copy].map((root) => [root, ...root.querySelectorAll("*")]);
  inLight(() => from.forEach((part, at) => {
    const looks = getComputedStyle(part);
    if (looks.display === "none") to[at].setAttribute("display", "none");
    for (const name of LOOKS) to[at].setAttribute(name, looks.getPropertyValue(name));
    to[at].removeAttribute("class");
  }));
  Object.entries({ xmlns: "http://www.w3.org/2000/svg", width: short(box.width), height: short(box.height), "font-family": "system-ui, sans-serif" }).forEach(([name, value]) => copy.setAttribute(name, value));
  return copy;
}

/**
 * A drawing as the text of an SVG. `draw(pen, named)` draws, or `svg` is one of the page; `rows` are its data, the names of
 * columns first.
 */
export function asSvg({ title, wide, tall, rows, draw, svg }) {
  if (svg) {
    const copy = standingAlone(svg);
    copy.prepend(drawn("title", {}, title), drawn("metadata", {}, csv(rows)));
    return new XMLSerializer().serializeToString(copy);
  }
  const pen = new VectorPen(wide, tall), named = ofPaper();
  pen.svg.append(drawn("title", {}, title), drawn("metadata", {}, csv(rows)));
  pen.fillStyle = named("ground");
  pen.fillRect(0, 0, wide, tall);
  draw(pen, named);
  return new XMLSerializer().serializeToString(pen.svg);
}

const fileOf = (title) => title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "figure";

/**
 * A button that copies a drawing as SVG with its data; where the browser does not allow that, it saves it. `what()` is as for
 * [`asSvg`], or has the `text` of an SVG.
 */
export function copyButton(title, what, file = fileOf(title)) {
  const button = element("button", { type: "button", className: "quiet copy", textContent: "Copy", title: `Copy ${title} as SVG with its data` });
  button.setAttribute("aria-label", button.title);
  button.addEventListener("click", async (event) => {
    event.stopPropagation();
    const drawing = what();
    // what has not come yet cannot be copied
    if (!drawing) return;
    const svg = drawing.text ?? asSvg({ title, ...drawing });
    let word = "Copied";
    try { await navigator.clipboard.writeText(svg); } catch { save(`${file}.svg`, svg, "image/svg+xml"); word = "Saved"; }
    button.textContent = word;
    say(`${title}: ${word}`);
    setTimeout(() => { button.textContent = "Copy"; }, 2000);
  });
  return button;
}

/** The data of a drawing of an environment. */
export function rowsOfDrawing(drawing) {
  const rows = [["what", "number", "x", "y", "radius"]];
  for (const kind of ["there", "structure", "built"]) drawing[kind].forEach((flat, number) => { for (let at = 0; at + 1 < flat.length; at += 2) rows.push([kind, number, flat[at], flat[at + 1], ""]); });
  for (const [kind, what] of [["discs_there", "disc there"], ["discs", "disc built"]]) drawing[kind].forEach(([x, y, radius], number) => rows.push([what, number, x, y, radius]));
  drawing.marks.forEach(([x, y], number) => rows.push(["mark", number, x, y, ""]));
  return rows;
}
