// Small drawings on canvases: a pen in pixels of the page, axes, and environments as the server sends them.

import { colours, written } from "./words.js";

/** Gives a canvas its size and a pen whose unit is a pixel of the page. */
export function penOf(canvas, wide, tall) {
  const ratio = Math.min(devicePixelRatio || 1, 2);
  const size = [Math.max(1, Math.round(wide * ratio)), Math.max(1, Math.round(tall * ratio))];
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, wide, tall);
  return pen;
}

export const css = () => colours().css;

/** A line through pairs of numbers. */
export function line(pen, places, closes = false) {
  pen.beginPath();
  places.forEach(([x, y], index) => (index === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
  if (closes) pen.closePath();
}

const pairs = (flat) => { const list = []; for (let at = 0; at + 1 < flat.length; at += 2) list.push([flat[at], flat[at + 1]]); return list; };

/** What a drawing holds: lower and upper corner. */
export function boundsOfDrawing(drawing) {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  const hold = (x, y, radius = 0) => {
    [low[0], low[1], high[0], high[1]] = [Math.min(low[0], x - radius), Math.min(low[1], y - radius), Math.max(high[0], x + radius), Math.max(high[1], y + radius)];
  };
  for (const kind of ["there", "built", "structure"]) for (const flat of drawing[kind]) for (const [x, y] of pairs(flat)) hold(x, y);
  for (const kind of ["discs", "discs_there"]) for (const [x, y, radius] of drawing[kind]) hold(x, y, radius);
  for (const [x, y] of drawing.marks) hold(x, y);
  return Number.isFinite(low[0]) ? [low, high] : [[0, 0], [1, 1]];
}

/** Both bounds in one. */
export const joined = (a, b) => (a && b ? [[0, 1].map((k) => Math.min(a[0][k], b[0][k])), [0, 1].map((k) => Math.max(a[1][k], b[1][k]))] : a ?? b);

/** An environment: what was there, what was built, what is structure only (dashed), marks. Gives the function from places to pixels. */
export function drawDrawing(pen, drawing, bounds, wide, tall, named = css()) {
  const [low, high] = bounds ?? boundsOfDrawing(drawing), room = Math.min(10, wide * 0.05);
  const scale = Math.min((wide - 2 * room) / Math.max(1e-9, high[0] - low[0]), (tall - 2 * room) / Math.max(1e-9, high[1] - low[1]));
  const at = ([x, y]) => [wide / 2 + (x - (low[0] + high[0]) / 2) * scale, tall / 2 - (y - (low[1] + high[1]) / 2) * scale];
  pen.fillStyle = named("stage");
  pen.fillRect(0, 0, wide, tall);
  pen.lineCap = "round";
  for (const [kind, colour, width, dash] of [["there", "faint", 1.2, []], ["structure", "series-1", 1, [3, 3]], ["built", "series-0", wide > 200 ? 2.4 : 1.6, []]]) {
    pen.strokeStyle = named(colour);
    pen.lineWidth = width;
    pen.setLineDash(dash);
    for (const flat of drawing[kind]) { line(pen, pairs(flat).map(at)); pen.stroke(); }
  }
  pen.setLineDash([]);
  for (const [kind, colour] of [["discs_there", "obstacle"], ["discs", "series-0"]]) {
    pen.fillStyle = named(colour);
    for (const [x, y, radius] of drawing[kind]) { pen.beginPath(); pen.arc(...at([x, y]), Math.max(1, radius * scale), 0, 2 * Math.PI); pen.fill(); }
  }
  pen.strokeStyle = named("series-1");
  pen.lineWidth = 1.4;
  for (const mark of drawing.marks) { const [x, y] = at(mark); line(pen, [[x - 4, y], [x + 4, y]]); pen.stroke(); line(pen, [[x, y - 4], [x, y + 4]]); pen.stroke(); }
  return at;
}

/** The frame of a chart with numbers along its axes; gives the functions from values to places. `label` says what a height stands for. */
export function frame(pen, [left, top, right, bottom], x, y, named, label = (value) => value) {
  pen.strokeStyle = named("rule");
  pen.lineWidth = 1;
  pen.strokeRect(left + 0.5, top + 0.5, right - left - 1, bottom - top - 1);
  pen.fillStyle = named("faint");
  pen.font = "11px system-ui, sans-serif";
  pen.textBaseline = "alphabetic";
  const shares = [0, 0.5, 1];
  for (const share of shares) {
    pen.textAlign = share === 0 ? "left" : share === 1 ? "right" : "center";
    pen.fillText(written(x[0] + share * (x[1] - x[0]), 4), left + share * (right - left), bottom + 14);
    pen.textAlign = "right";
    pen.fillText(written(label(y[0] + share * (y[1] - y[0])), 3), left - 5, bottom - share * (bottom - top) + (share === 0 ? 0 : share === 1 ? 9 : 4));
  }
  return {
    across: (value) => left + (value - x[0]) / (x[1] - x[0] || 1) * (right - left),
    down: (value) => bottom - (value - y[0]) / (y[1] - y[0] || 1) * (bottom - top),
    value: (place) => x[0] + (place - left) / (right - left) * (x[1] - x[0]),
    height: (place) => y[0] + (bottom - place) / (bottom - top) * (y[1] - y[0]),
  };
}

/** Ends of the values that are there, a little apart where they are one. */
export function endsOf(values) {
  let low = Infinity, high = -Infinity;
  for (const value of values) if (value !== null) { if (value < low) low = value; if (value > high) high = value; }
  if (low > high) return [0, 1];
  return low === high ? [low - 0.5 * (Math.abs(low) || 1), high + 0.5 * (Math.abs(high) || 1)] : [low, high];
}
