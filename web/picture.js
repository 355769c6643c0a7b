// The textbook figure of one agent's step: what it perceives, whom it selects, and the arrows its law adds up.

import { clamp, drawn, withUnit, written } from "./words.js";

const ROUND = 64;
const LETTER = 7.3, LINE = 15;
const TAU = 2 * Math.PI;

const length = (vector) => Math.hypot(...vector);
const add = (a, b, factor = 1) => a.map((value, axis) => value + factor * b[axis]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (vector) => { const size = length(vector); return size > 1e-12 ? vector.map((value) => value / size) : [0, 0, 0]; };

/** Series of a set in the figure and in the table: red where it acts. */
export const setStyle = (set, index) => (set.acts ? "acts" : `s${[0, 4, 3, 2, 5, 6][index % 6]}`);
export const componentStyle = (index) => `s${[0, 1, 3, 4, 2, 5, 6][index % 7]}`;

/** How far the figure reaches about the agent: its sensing, or else its sets, or else whom it sees. */
export function reachOf(explanation) {
  const { sensing, sets, detected, rays, obstacles, radius } = explanation;
  const bounds = sets.map((set) => set.high).filter((high) => high !== null && high > 0);
  const seen = [...sets.flatMap((set) => set.members), ...detected, ...obstacles].map(({ offset }) => length(offset));
  const far = [...seen, ...rays.map(({ to }) => length(to))];
  if (sensing.range !== null && sensing.range > 0) return sensing.range;
  if (bounds.length > 0) return Math.max(...bounds);
  return Math.max(...far.map((distance) => 1.12 * distance), 8 * radius, 1e-6);
}

/** A circle about the agent; in space, the silhouette of a ball. */
const ring = (centre, pixels, attributes) => drawn("circle", { cx: centre[0], cy: centre[1], r: Math.max(0, pixels), ...attributes });

const pathOf = (points, closed = true) => points.map(([x, y], at) => `${at === 0 ? "M" : "L"}${x.toFixed(1)} ${y.toFixed(1)}`).join("") + (closed ? "Z" : "");

/** An arrow between two points of the screen, as one closed outline. */
function arrowPath([x, y], [u, v], width) {
  const long = Math.hypot(u - x, v - y) || 1e-6;
  const [a, b] = [(u - x) / long, (v - y) / long];
  const head = Math.min(3.6 * width + 3, long * 0.62), half = width / 2, wing = Math.min(1.55 * width + 2.2, head * 0.75);
  const at = (along, aside) => [x + a * along - b * aside, y + b * along + a * aside];
  return pathOf([at(0, half), at(long - head, half), at(long - head, wing), at(long, 0), at(long - head, -wing), at(long - head, -half), at(0, -half)]);
}

/** A mark of a member by the number of its set, so that colour is never the only difference. */
function mark([x, y], size, shape) {
  if (shape % 4 === 0) return `M${x - size} ${y}a${size} ${size} 0 1 0 ${2 * size} 0a${size} ${size} 0 1 0 ${-2 * size} 0`;
  const corners = [[], [[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]], [[0, -1.25], [1.15, 0.8], [-1.15, 0.8]], [[0, -1.3], [1.3, 0], [0, 1.3], [-1.3, 0]]][shape % 4];
  return pathOf(corners.map(([a, b]) => [x + a * size, y + b * size]));
}
export const setMark = (size, index) => mark([0, 0], size, index);

/** Text with a halo, set where it covers no other text. */
class Labels {
  constructor(wide, tall) { Object.assign(this, { wide, tall, taken: [], made: [] }); }

  /** How much of a box covers what is there. */
  covered(one) {
    return this.taken.reduce((sum, other) => sum
      + Math.max(0, Math.min(one[2], other[2]) - Math.max(one[0], other[0])) * Math.max(0, Math.min(one[3], other[3]) - Math.max(one[1], other[1])), 0);
  }

  /** Keeps a point free of text. */
  avoid([x, y], size) { this.taken.push([x - size, y - size, x + size, y + size]); }

  add(text, [x, y], direction, style) {
    const across = text.length * LETTER;
    const far = Math.hypot(...direction) || 1;
    const [a, b] = [direction[0] / far, direction[1] / far];
    const box = (shift, aside) => {
      const middle = [x + a * (across / 2 * Math.abs(a) + 9) - b * aside, y + b * (LINE / 2 + 8) + a * aside + shift];
      middle[0] = clamp(middle[0], across / 2 + 3, this.wide - across / 2 - 3);
      middle[1] = clamp(middle[1], LINE / 2 + 3, this.tall - LINE / 2 - 3);
      return [middle[0] - across / 2, middle[1] - LINE / 2, middle[0] + across / 2, middle[1] + LINE / 2];
    };
    const covered = (one) => this.covered(one);
    const tries = [[0, 0], [0, 10], [0, -10], [15, 0], [-15, 0], [0, 22], [0, -22], [30, 0], [-30, 0], [45, 0], [-45, 0]].map(([shift, aside]) => box(shift, aside));
    this.put(text, tries.reduce((least, one) => (covered(one) < covered(least) ? one : least)), style);
  }

  /** Sets text over the spot where it covers least. */
  addWithin(text, spots, style) {
    const half = text.length * LETTER / 2;
    const boxes = spots.map(([x, y]) => [x - half, y - LINE / 2, x + half, y + LINE / 2]);
    this.put(text, boxes.reduce((least, one) => (this.covered(one) < this.covered(least) ? one : least)), style);
  }

  put(text, best, style) {
    this.taken.push(best);
    this.made.push(drawn("text", { x: (best[0] + best[2]) / 2, y: best[3] - 4, class: `label ${style}`, "text-anchor": "middle" }, text));
  }
}

/**
 * Draws into `svg`. `view` has `project`, `wide`, `tall`, `isSpace`, `radius` (of a body, in units of the canvas),
 * `headingOf(id)`, `withBodies` (draw those the figure speaks of) and `withLabels`.
 */
export function drawFigure(svg, explanation, view, units) {
  const { position, heading, sensing, sets } = explanation;
  const { project, isSpace } = view;
  const centre = project(position), scale = centre[3];
  const reach = reachOf(explanation), pixels = reach * scale;
  const parts = [], labels = new Labels(view.wide, view.tall);
  const put = (name, attributes) => parts.push(drawn(name, attributes));
  const at = (offset) => project(add(position, offset));
  const speed = `${units.length}/${units.time}`;
  const moves = length(heading) > 0.5;
  const angle = Math.atan2(heading[1], heading[0]);
  const polar = (radius, direction) => at([radius * Math.cos(direction), radius * Math.sin(direction), 0]);
  /** Part of a ring in the plane, from one radius to another, `opening` wide about a direction. */
  const sector = (low, high, direction, opening) => {
    const arc = (radius, from, to) => Array.from({ length: ROUND + 1 }, (_, k) => polar(radius, from + (to - from) * k / ROUND));
    const [from, to] = [direction - opening / 2, direction + opening / 2];
    if (opening >= TAU - 1e-9) return pathOf(arc(high, from, to)) + (low > 0 ? pathOf(arc(low, to, from)) : "");
    return pathOf([...arc(high, from, to), ...(low > 0 ? arc(low, to, from) : [centre])]);
  };
  const radians = (degrees) => clamp(degrees * Math.PI / 180, 0, TAU);

  // ------------------------------------------------ what can be perceived
  const opening = sensing.opening !== null && moves ? radians(sensing.opening) : TAU;
  const isBlind = opening < TAU - 1e-6;
  if (isSpace) {
    put("circle", { cx: centre[0], cy: centre[1], r: pixels, class: "region" });
    const circle = (normal, away, radius) => {
      const side = unit(cross(normal, Math.abs(normal[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0])), other = cross(normal, side);
      return Array.from({ length: ROUND }, (_, k) => at(add(add(add([0, 0, 0], normal, away), side, radius * Math.cos(TAU * k / ROUND)), other, radius * Math.sin(TAU * k / ROUND))));
    };
    put("path", { d: pathOf(circle([0, 0, 1], 0, reach)), class: "equator" });
    if (isBlind) {
      const half = Math.PI - opening / 2;
      const rim = circle(unit(heading.map((value) => -value)), reach * Math.cos(half), reach * Math.sin(half));
      put("path", { d: pathOf(rim), class: "blind" });
      for (let k = 0; k < ROUND; k += 8) put("path", { d: pathOf([centre, rim[k]], false), class: "blind" });
      if (view.withLabels) labels.add("blind", at(heading.map((value) => -0.85 * reach * value)), [0, 1], "faint");
    }
  } else {
    put("path", { d: sector(0, reach, angle, opening), class: "region" });
    if (isBlind) {
      put("path", { d: sector(0, reach, angle + Math.PI, TAU - opening), class: "blind", fill: `url(#${view.hatch})` });
      if (view.withLabels) labels.add("blind", polar(0.72 * reach, angle + Math.PI), [0, 0], "faint");
    }
  }
  sets.forEach((set, index) => {
    const [low, high] = [set.low ?? 0, set.high];
    if (high === null || high <= 0 || high > 1e3 * reach) return;
    const style = `zone ${setStyle(set, index)}`;
    if (isSpace) { parts.push(ring(centre, high * scale, { class: style })); return; }
    const wide = set.angle !== null && moves ? radians(set.angle) : opening;
    put("path", { d: sector(low, high, angle, wide), class: style, "fill-rule": "evenodd" });
  });

  // ------------------------------------------------ what is perceived
  for (const hit of ["nothing", "obstacle", "member"]) {
    const rays = explanation.rays.filter((ray) => ray.hit === hit && !ray.lost);
    if (rays.length === 0) continue;
    put("path", { d: rays.map(({ to }) => pathOf([centre, at(to)], false)).join(""), class: `ray ${hit}` });
    if (hit !== "nothing") put("path", { d: rays.map(({ to }) => mark(at(to), 2, 0)).join(""), class: `hit ${hit}` });
  }
  const lost = explanation.rays.filter((ray) => ray.lost);
  if (lost.length > 0) put("path", { d: lost.map(({ to }) => pathOf([centre, at(to)], false)).join(""), class: "ray lost" });
  for (const { offset, distance } of explanation.obstacles) {
    const there = at(offset);
    put("path", { d: pathOf([centre, there], false), class: "to-obstacle" });
    put("path", { d: pathOf([[there[0] - 4, there[1] - 4], [there[0] + 4, there[1] + 4]], false) + pathOf([[there[0] - 4, there[1] + 4], [there[0] + 4, there[1] - 4]], false), class: "obstacle-seen" });
    if (view.withLabels && distance !== null && explanation.obstacles.length <= 3) {
      labels.add(withUnit(distance, units.length, 3), there, add(there, centre, -1), "faint");
    }
  }
  const body = view.radius(scale), gap = view.withLabels ? 4 : 1.5;
  const selected = new Set(sets.flatMap((set) => set.members.map(({ offset }) => offset.join())));
  const bodies = (list, style) => {
    if (!view.withBodies || list.length === 0) return;
    const shape = ({ offset, id }) => {
      const there = at(offset), direction = id === null ? null : view.headingOf(id);
      if (!direction || length(direction) < 0.5) return mark(there, 3.2, 0);
      const tip = at(add(offset, direction, 0.02 * reach));
      const [a, b] = unit([tip[0] - there[0], tip[1] - there[1], 0]);
      return pathOf([[1, 0], [-0.8, 0.68], [-0.4, 0], [-0.8, -0.68]].map(([along, aside]) => [
        there[0] + body * (a * along - b * aside), there[1] + body * (b * along + a * aside)]));
    };
    put("path", { d: list.map(shape).join(""), class: `body ${style}` });
  };
  const ignored = explanation.detected.filter(({ offset }) => !selected.has(offset.join()));
  bodies(ignored, "ignored");
  if (ignored.length > 0) put("path", { d: ignored.map(({ offset }) => mark(at(offset), body + gap - 1, 0)).join(""), class: "detected" });
  const links = sets.filter((set) => set.acts).flatMap((set) => set.members);
  if (links.length > 0) put("path", { d: links.map(({ offset }) => pathOf([centre, at(offset)], false)).join(""), class: "link" });
  sets.forEach((set, index) => {
    if (set.members.length === 0) return;
    const style = setStyle(set, index);
    bodies(set.members, style);
    put("path", { d: set.members.map(({ offset }) => mark(at(offset), body + gap, index)).join(""), class: `member ${style}`, "data-set": set.name, "data-count": set.members.length });
  });

  // ------------------------------------------------ what it makes of it
  const longest = Math.max(...explanation.components.map((part) => length(part.vector)), 0);
  const arm = clamp(pixels * 0.62, 34, Math.min(view.wide, view.tall) * 0.36);
  const tipOf = (vector, full, arms) => add(centre.slice(0, 2), (() => {
    const ahead = project(add(position, vector, arms / scale / full));
    // what is near the eye must not make an arrow longer than it is
    return [ahead[0] - centre[0], ahead[1] - centre[1]];
  })());
  const arrow = (vector, full, arms, width, style, data) => {
    const tip = tipOf(vector, full, arms);
    for (const part of [0.4, 0.65, 0.9]) labels.avoid([0, 1].map((axis) => centre[axis] + part * (tip[axis] - centre[axis])), 5);
    put("path", { d: arrowPath(centre, tip, width), class: `arrow ${style}`, ...data });
    return tip;
  };
  const { wanted, performed } = explanation;
  const fastest = Math.max(wanted ? length(wanted) : 0, performed ? length(performed) : 0);
  const motionArm = arm * 0.78;
  const captions = [];
  const isShown = (tip) => Math.hypot(tip[0] - centre[0], tip[1] - centre[1]) > 3;
  const agree = wanted && performed && length(add(wanted, performed, -1)) < 1e-6 * Math.max(1e-12, fastest);
  if (fastest > 0) {
    const motion = (vector, style, width, word) => {
      const tip = arrow(vector, fastest, motionArm, width, style, { "data-arrow": style, "data-magnitude": length(vector) });
      if (view.withLabels && isShown(tip) && word) captions.push([`${word} ${withUnit(length(vector), speed, 3)}`, tip, style]);
    };
    if (wanted) motion(wanted, "wanted", 7.5, agree ? "" : "wanted");
    if (performed) motion(performed, "performed", 3, agree ? "wanted = performed" : "performed");
  }
  explanation.components.forEach((part, index) => {
    if (!(length(part.vector) > 0)) return;
    const tip = arrow(part.vector, longest, arm, 3.6, `component ${componentStyle(index)}`, {
      "data-arrow": part.name, "data-magnitude": part.magnitude ?? length(part.vector),
    });
    if (view.withLabels && isShown(tip)) captions.unshift([`${part.name} ${written(part.magnitude ?? length(part.vector), 3)}`, tip, componentStyle(index)]);
  });
  for (const { away, offset } of explanation.obstacles) {
    if (away && length(away) > 0 && view.withLabels) put("path", { d: arrowPath(at(offset), tipOf(add(offset, unit(away), 0.16 * reach), 1, scale), 1.6), class: "arrow away" });
  }
  labels.avoid(centre, body + 8);
  const marked = [...explanation.detected, ...sets.flatMap((set) => set.members)];
  if (view.withLabels && marked.length < 200) for (const { offset } of marked) labels.avoid(at(offset), body + 2);
  for (const [text, tip, style] of captions) labels.add(text, tip, [tip[0] - centre[0], tip[1] - centre[1]], style);

  // names of the zones last: they give way to everything else
  if (view.withLabels && view.withBodies && !isSpace) {
    sets.forEach((set, index) => {
      const low = set.low ?? 0;
      if (set.high === null || (set.high - low) * scale < LINE || set.high > reach * 1.001) return;
      const spots = [-0.36, 0.36, -0.2, 0.2, 0].map((turn) => polar((low + set.high) / 2, angle + turn * opening));
      labels.addWithin(set.name, spots, setStyle(set, index));
    });
  }

  // ------------------------------------------------ the agent itself
  const me = moves ? at(heading.map((value) => value * 0.02 * reach)) : null;
  const [a, b] = me ? unit([me[0] - centre[0], me[1] - centre[1], 0]) : [1, 0];
  const own = Math.max(body * 1.15, 5);
  parts.push(ring(centre, own + 5, { class: "focal-ring", "data-agent": explanation.agent }));
  put("path", {
    class: "focal",
    d: me ? pathOf([[1, 0], [-0.8, 0.68], [-0.4, 0], [-0.8, -0.68]].map(([along, aside]) => [centre[0] + own * (a * along - b * aside), centre[1] + own * (b * along + a * aside)])) : mark(centre, own * 0.7, 0),
  });
  if (view.withLabels && sensing.range !== null && !isSpace) {
    const spot = polar(reach, isBlind ? angle + 0.72 * Math.PI / 2 : Math.PI * 0.28);
    if (spot[0] > 40 && spot[0] < view.wide - 40 && spot[1] > 10) labels.add(withUnit(reach, units.length, 3), spot, add(spot, centre, -1), "faint");
  }
  svg.replaceChildren(...parts, ...labels.made);
  return { longest, fastest, reach };
}
