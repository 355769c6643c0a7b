// Obstacles, the floor and the edges of the space, as triangles (place, normal, colour) and lines (two ends, colour,
// width, dash, corner; six times each).

import { isNumber } from "./words.js";
import { vector } from "./frame.js";

const ROUND = 48, RINGS = 14;
const FLAT = [0, 0, 0];
// two triangles make a line: which end, and which side
const CORNERS = [[0, -1], [0, 1], [1, -1], [1, -1], [0, 1], [1, 1]];
export const LINE_NUMBERS = 13;

/** A shape as it was sent, checked; null for what is not known. */
export function readShape(shape) {
  try {
    if (shape.ball && isNumber(shape.ball.radius)) return { ball: { centre: vector(shape.ball.centre), radius: shape.ball.radius } };
    if (shape.segment) return { segment: { from: vector(shape.segment.from), to: vector(shape.segment.to) } };
    if (Array.isArray(shape.polygon) && shape.polygon.length > 2) return { polygon: shape.polygon.map(vector) };
    if (Array.isArray(shape.guide) && shape.guide.length > 1) return { guide: shape.guide.map(vector) };
    if (shape.box) return { box: { low: vector(shape.box.low), high: vector(shape.box.high) } };
  } catch { /* it is left out */ }
  return null;
}

const across = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);

/** Triangles of a simple polygon in the plane, ear by ear; corners as indices. */
function ears(corners) {
  const area = corners.reduce((sum, [x, y], at) => {
    const [u, v] = corners[(at + 1) % corners.length];
    return sum + x * v - u * y;
  }, 0);
  const left = corners.map((_, index) => index);
  if (area < 0) left.reverse();
  const found = [];
  let patience = left.length * left.length;
  while (left.length > 3 && patience > 0) {
    for (let at = 0; at < left.length; at += 1) {
      patience -= 1;
      const [a, b, c] = [left.at(at - 1), left[at], left[(at + 1) % left.length]];
      const [p, q, r] = [corners[a], corners[b], corners[c]];
      if (across(p, q, r) <= 0) continue;
      const inside = left.some((other) => ![a, b, c].includes(other)
        && across(p, q, corners[other]) >= 0 && across(q, r, corners[other]) >= 0 && across(r, p, corners[other]) >= 0);
      if (inside) continue;
      found.push([a, b, c]);
      left.splice(at, 1);
      break;
    }
  }
  found.push(left.slice(0, 3));
  return found;
}

/** `low` and `high` are the corners of what is shown of the space. */
export function solids(scene, { low, high }, obstacles, colours) {
  const triangles = [], lines = [];
  const isSpace = scene.dimensions === 3;
  const triangle = (corners, normals, colour) => corners.forEach((corner, index) => triangles.push(...corner, ...(normals[index] ?? normals[0]), ...colour));
  const line = (from, to, colour, width, dash = 0) => {
    for (const corner of CORNERS) lines.push(...from, ...to, ...colour, width, dash, ...corner);
  };
  const outline = (corners, colour, width) => corners.forEach((corner, at) => line(corner, corners[(at + 1) % corners.length], colour, width));
  const quad = (a, b, c, d, normal, colour) => { triangle([a, b, c], [normal], colour); triangle([a, c, d], [normal], colour); };
  const corner = (bits) => [0, 1, 2].map((axis) => (bits >> axis & 1 ? high[axis] : low[axis]));

  // of what was recorded, the box that holds all of it is the floor
  const hasEnds = scene.of === "tracks" || scene.space.edges.some((edge) => edge !== "open");
  if (scene.dimensions === 2 && hasEnds) quad(corner(0), corner(1), corner(3), corner(2), FLAT, colours.stage);
  if (isSpace) {
    const parts = 8;
    for (let at = 1; at < parts; at += 1) {
      const between = (axis) => low[axis] + (high[axis] - low[axis]) * at / parts;
      line([between(0), low[1], low[2]], [between(0), high[1], low[2]], colours.grid, 1);
      line([low[0], between(1), low[2]], [high[0], between(1), low[2]], colours.grid, 1);
    }
  }
  for (let axis = 0; axis < scene.dimensions; axis += 1) {
    for (let bits = 0; bits < 1 << scene.dimensions; bits += 1) {
      if (bits >> axis & 1) continue;
      // this edge runs along one axis and ends the others
      const others = scene.space.edges.filter((_, other) => other !== axis || scene.dimensions === 1);
      const walls = others.includes("walls"), closes = others.includes("periodic");
      if (!walls && !closes && !isSpace) continue;
      const strong = walls && !isSpace;
      line(corner(bits), corner(bits | 1 << axis), strong ? colours.text : walls || closes ? colours.faint : colours.rule,
        strong ? 2 : 1.2, walls || !closes ? 0 : 5);
    }
  }

  const ball = ({ centre, radius }) => {
    const around = (at) => [Math.cos(2 * Math.PI * at / ROUND), Math.sin(2 * Math.PI * at / ROUND)];
    if (!isSpace) {
      const rim = Array.from({ length: ROUND }, (_, at) => [centre[0] + radius * around(at)[0], centre[1] + radius * around(at)[1], 0]);
      rim.forEach((place, at) => triangle([centre, place, rim[(at + 1) % ROUND]], [FLAT], colours.obstacle));
      outline(rim, colours.faint, 1.1);
      return;
    }
    const normal = (ring, at) => {
      const height = Math.PI * (ring / RINGS - 0.5), [x, y] = around(at * 2);
      return [Math.cos(height) * x, Math.cos(height) * y, Math.sin(height)];
    };
    const place = (direction) => direction.map((value, axis) => centre[axis] + radius * value);
    for (let ring = 0; ring < RINGS; ring += 1) {
      for (let at = 0; at < ROUND / 2; at += 1) {
        const [a, b, c, d] = [normal(ring, at), normal(ring, at + 1), normal(ring + 1, at + 1), normal(ring + 1, at)];
        triangle([a, b, c].map(place), [a, b, c], colours.obstacle);
        triangle([a, c, d].map(place), [a, c, d], colours.obstacle);
      }
    }
  };
  const polygon = (corners) => {
    // seen along the axis in which it is thinnest
    const extent = [0, 1, 2].map((axis) => Math.max(...corners.map((place) => place[axis])) - Math.min(...corners.map((place) => place[axis])));
    const thin = isSpace ? extent.indexOf(Math.min(...extent)) : 2;
    const flat = corners.map((place) => place.filter((_, axis) => axis !== thin));
    for (const ear of ears(flat)) triangle(ear.map((index) => corners[index]), [FLAT], colours.obstacle);
    outline(corners, colours.faint, 1.1);
  };
  const box = ({ low: least, high: most }) => {
    if (!isSpace) {
      polygon([[least[0], least[1], 0], [most[0], least[1], 0], [most[0], most[1], 0], [least[0], most[1], 0]]);
      return;
    }
    for (let axis = 0; axis < 3; axis += 1) {
      const [a, b] = [0, 1, 2].filter((other) => other !== axis);
      for (const [at, sign] of [[least[axis], -1], [most[axis], 1]]) {
        const normal = [0, 0, 0];
        normal[axis] = sign;
        const place = (first, second) => {
          const made = [0, 0, 0];
          [made[axis], made[a], made[b]] = [at, first, second];
          return made;
        };
        const face = [place(least[a], least[b]), place(most[a], least[b]), place(most[a], most[b]), place(least[a], most[b])];
        quad(...face, normal, colours.obstacle);
        outline(face, colours.faint, 1);
      }
    }
  };
  for (const shape of obstacles) {
    if (shape.ball) ball(shape.ball);
    if (shape.segment) line(shape.segment.from, shape.segment.to, colours.text, 2.4);
    if (shape.polygon) polygon(shape.polygon);
    if (shape.box) box(shape.box);
    if (shape.guide) shape.guide.slice(1).forEach((place, at) => line(shape.guide[at], place, colours.faint, 1.2, 4));
  }
  return { triangles: new Float32Array(triangles), lines: new Float32Array(lines) };
}
