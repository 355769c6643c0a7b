// A chart as SVG with its data in it, on white, for documents.

import { drawn, titled, written } from "./words.js";

const WIDE = 640, TALL = 320, LEFT = 62, RIGHT = 16, TOP = 34, BOTTOM = 46;
const COLOURS = ["#0072b2", "#d55e00", "#00845f", "#b3518c", "#a87700", "#3c93cf", "#5b5b5b"];
const DASHES = ["", "7 2.5", "3 1.6", "11 2.5 2.5 2.5", "5 3.5", "1.6 1.6"];
const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** `lines` are `{ name, t, y }`; rows of the data are (line, time, value). */
export function chartAsSvg(title, unit, timeUnit, lines, ends, range) {
  const values = lines.flatMap(({ y }) => y).filter((value) => Number.isFinite(value));
  let [low, high] = range ?? [Math.min(...values), Math.max(...values)];
  if (!(high > low)) [low, high] = Number.isFinite(low) ? [low - 0.5, low + 0.5] : [0, 1];
  const across = (t) => LEFT + (t - ends[0]) / (ends[1] - ends[0]) * (WIDE - LEFT - RIGHT);
  const down = (value) => TALL - BOTTOM - (value - low) / (high - low) * (TALL - TOP - BOTTOM);
  const svg = drawn("svg", { xmlns: "http://www.w3.org/2000/svg", viewBox: `0 0 ${WIDE} ${TALL}`, width: WIDE, height: TALL, "font-family": "system-ui, sans-serif", "font-size": 12 });
  const add = (name, attributes, text = null) => svg.append(drawn(name, attributes, text));
  const rows = lines.flatMap(({ name, t, y }) => t.map((time, at) => [quoted(name), time, y[at] ?? ""].join(",")));
  add("title", {}, title);
  add("metadata", {}, `${["line", titled("time", timeUnit), titled(title, unit)].map(quoted).join(",")}\n${rows.join("\n")}\n`);
  add("rect", { width: WIDE, height: TALL, fill: "#ffffff" });
  add("text", { x: LEFT, y: 18, "font-weight": 600 }, titled(title, unit));
  for (const share of [0, 0.25, 0.5, 0.75, 1]) {
    const [t, value] = [ends[0] + share * (ends[1] - ends[0]), low + share * (high - low)];
    add("path", { d: `M${LEFT} ${down(value)}H${WIDE - RIGHT}`, stroke: "#d9dde1", fill: "none" });
    add("text", { x: LEFT - 7, y: down(value) + 4, "text-anchor": "end", fill: "#59626b" }, written(value, 4));
    add("text", { x: across(t), y: TALL - BOTTOM + 18, "text-anchor": "middle", fill: "#59626b" }, written(t, 4));
  }
  add("text", { x: (LEFT + WIDE - RIGHT) / 2, y: TALL - 8, "text-anchor": "middle", fill: "#59626b" }, titled("time", timeUnit));
  lines.forEach(({ name, t, y }, index) => {
    let d = "", isDown = false;
    t.forEach((time, at) => {
      if (!Number.isFinite(y[at])) { isDown = false; return; }
      d += `${isDown ? "L" : "M"}${across(time).toFixed(1)} ${down(y[at]).toFixed(1)}`;
      isDown = true;
    });
    const stroke = COLOURS[index % COLOURS.length];
    add("path", { d: d || "M0 0", fill: "none", stroke, "stroke-width": 1.6, "stroke-dasharray": DASHES[index % DASHES.length] });
    if (lines.length > 1) add("text", { x: WIDE - RIGHT, y: TOP + 14 * (index + 1), "text-anchor": "end", fill: stroke }, name);
  });
  return new XMLSerializer().serializeToString(svg);
}
