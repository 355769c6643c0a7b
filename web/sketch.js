// A picture of a scene without WebGL: for the cards of the gallery, of which there are many, and for copies as SVG.

import { LINE_NUMBERS, solids } from "./solids.js";
import { clamp } from "./words.js";

const MOST_AGENTS = 1500;
const css = ([red, green, blue]) => `rgb(${Math.round(255 * red)} ${Math.round(255 * green)} ${Math.round(255 * blue)})`;
const ARROW = [[1, 0], [-0.8, 0.68], [-0.4, 0], [-0.8, -0.68]];

/** Draws all of a scene that stands still; `ends` are the corners of the space, where they are not those the camera shows. */
export function backdrop(pen, scene, camera, obstacles, colours, ends = camera) {
  pen.fillStyle = css(camera.isSpace ? colours.stage : colours.ground);
  pen.fillRect(0, 0, camera.wide, camera.tall);
  const { triangles, lines } = solids(scene, ends, obstacles, colours);
  const path = (places, closes) => {
    pen.beginPath();
    places.forEach(([x, y], at) => (at === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
    if (closes) pen.closePath();
  };
  for (let at = 0; at < triangles.length; at += 27) {
    path([0, 9, 18].map((corner) => camera.project(triangles.subarray(at + corner, at + corner + 3))), true);
    pen.fillStyle = css(triangles.subarray(at + 6, at + 9));
    pen.strokeStyle = pen.fillStyle;
    pen.lineWidth = 0.6;
    pen.fill();
    pen.stroke();
  }
  for (let at = 0; at < lines.length; at += 6 * LINE_NUMBERS) {
    path([camera.project(lines.subarray(at, at + 3)), camera.project(lines.subarray(at + 3, at + 6))], false);
    pen.strokeStyle = css(lines.subarray(at + 6, at + 9));
    pen.lineWidth = lines[at + 9] * 0.8;
    pen.setLineDash(lines[at + 10] > 0 ? [4, 4] : []);
    pen.stroke();
  }
  pen.setLineDash([]);
}

/** Draws the agents of a frame; of very many, only some. */
export function agents(pen, scene, camera, frame, colours, most = MOST_AGENTS) {
  const { positions, headings, dimensions: D } = frame;
  const [across, up] = camera.axes();
  const stride = Math.max(1, Math.ceil(frame.agents / most)), least = frame.agents > 400 ? 2.2 : 3.4;
  const along = (axis, index) => { let total = 0; for (let k = 0; k < D; k += 1) total += axis[k] * headings[index * D + k]; return total; };
  for (let group = 0; group < scene.groups.length; group += 1) {
    const { first, count, radius } = scene.groups[group];
    pen.fillStyle = css(colours.series[group % 7]);
    pen.beginPath();
    for (let index = first; index < Math.min(first + count, frame.agents); index += stride) {
      const place = [0, 1, 2].map((axis) => (axis < D ? positions[index * D + axis] : 0));
      if (Number.isNaN(place[0])) continue;
      const [x, y, , scale] = camera.project(place), half = clamp(radius * scale, least, 30);
      const [a, b] = [along(across, index), along(up, index)];
      ARROW.forEach(([ahead, aside], corner) => {
        const [u, v] = [x + half * (ahead * a - aside * b), y - half * (ahead * b + aside * a)];
        if (corner === 0) pen.moveTo(u, v); else pen.lineTo(u, v);
      });
    }
    pen.fill();
  }
}
