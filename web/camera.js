// From places in the world to places on the canvas: a flat view that pans and zooms, and one in space that turns.

import { clamp } from "./words.js";

const FIRST = { turn: -0.62, tilt: 0.5 };
const MARGIN = 18, FOOT = 34;
// how far the eye is from the middle of what it looks at, in radii of the scene
const FAR = 3.4;

export class Camera {
  constructor() {
    Object.assign(this, { wide: 1, tall: 1, centre: [0, 0, 0], scale: 1, fitted: 1, distance: 1, ...FIRST });
    this.setBounds(2, [0, 0, 0], [1, 1, 0]);
  }

  get isSpace() { return this.dimensions === 3; }

  /** What is to be seen as a whole. */
  setBounds(dimensions, low, high) {
    Object.assign(this, { dimensions, low, high });
    const size = [0, 1, 2].map((axis) => high[axis] - low[axis]);
    this.radius = Math.hypot(...size) / 2 || 1;
    this.distance = FAR * this.radius;
  }

  resize(wide, tall) {
    const before = this.fitted;
    Object.assign(this, { wide, tall });
    this.fitted = this.fittingScale();
    this.scale *= this.fitted / before;
  }

  fittingScale() {
    const room = [Math.max(20, this.wide - 2 * MARGIN), Math.max(20, this.tall - MARGIN - FOOT)];
    const size = [0, 1, 2].map((axis) => this.high[axis] - this.low[axis]);
    if (!this.isSpace) return Math.min(room[0] / (size[0] || 1), size[1] > 0 ? room[1] / size[1] : Infinity);
    // the box as it is seen at first fits; turning it changes nothing but the direction
    const before = [this.turn, this.tilt, this.centre, this.scale];
    Object.assign(this, FIRST, { centre: this.middle(), scale: 1 });
    let [across, down] = [0, 0];
    for (let bits = 0; bits < 8; bits += 1) {
      const place = [0, 1, 2].map((axis) => (bits >> axis & 1 ? this.high[axis] : this.low[axis]));
      const [x, y] = this.project(place);
      across = Math.max(across, Math.abs(x - this.wide / 2));
      down = Math.max(down, Math.abs(y - this.tall / 2));
    }
    [this.turn, this.tilt, this.centre, this.scale] = before;
    return Math.min(room[0] / across, room[1] / down) / 2;
  }

  middle() { return [0, 1, 2].map((axis) => (this.low[axis] + this.high[axis]) / 2); }

  /** The first view: all of it. */
  fit() {
    Object.assign(this, FIRST);
    this.fitted = this.fittingScale();
    this.scale = this.fitted;
    this.centre = this.middle();
    if (!this.isSpace) this.centre[1] -= (FOOT - MARGIN) / 2 / this.scale;
  }

  /** Directions of the screen in the world: across, up, and away from the eye. */
  axes() {
    if (!this.isSpace) return [[1, 0, 0], [0, 1, 0], [0, 0, 0]];
    const [ct, st, cl, sl] = [Math.cos(this.turn), Math.sin(this.turn), Math.cos(this.tilt), Math.sin(this.tilt)];
    return [[ct, -st, 0], [st * sl, ct * sl, cl], [st * cl, ct * cl, -sl]];
  }

  /** From the world to clip coordinates, column by column. */
  matrix() {
    const [across, up, away] = this.axes();
    const [sx, sy] = [2 * this.scale / this.wide, 2 * this.scale / this.tall];
    const along = (axis) => -(axis[0] * this.centre[0] + axis[1] * this.centre[1] + axis[2] * this.centre[2]);
    if (!this.isSpace) return new Float32Array([sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, 0, 0, sx * along(across), sy * along(up), 0, 1]);
    const d = this.distance, near = 0.05 * d, far = 8 * d;
    const [a, b] = [(far + near) / (far - near), -2 * far * near / (far - near)];
    const rows = [0, 1, 2].flatMap((k) => [across[k] * sx * d, up[k] * sy * d, away[k] * a, away[k]]);
    return new Float32Array([...rows, along(across) * sx * d, along(up) * sy * d, (d + along(away)) * a + b, d + along(away)]);
  }

  /** A place on the canvas: [across, down, depth, canvas units per unit of length there]. */
  project(place) {
    const offset = [place[0] - this.centre[0], place[1] - this.centre[1], place[2] - this.centre[2]];
    if (!this.isSpace) return [this.wide / 2 + offset[0] * this.scale, this.tall / 2 - offset[1] * this.scale, 0, this.scale];
    const [across, up, away] = this.axes().map((axis) => axis[0] * offset[0] + axis[1] * offset[1] + axis[2] * offset[2]);
    const here = this.scale * this.distance / Math.max(this.distance + away, 0.05 * this.distance);
    return [this.wide / 2 + across * here, this.tall / 2 - up * here, away, here];
  }

  pan(across, down) {
    const [x, y] = this.axes();
    for (const axis of [0, 1, 2]) this.centre[axis] += (down * y[axis] - across * x[axis]) / this.scale;
  }

  turnBy(across, tilt) {
    this.turn += across;
    this.tilt = clamp(this.tilt + tilt, -Math.PI / 2, Math.PI / 2);
  }

  /** Zooms; in a flat view the place under the pointer stays where it is. */
  zoom(by, x = this.wide / 2, y = this.tall / 2) {
    const before = this.scale;
    this.scale = clamp(this.scale * by, this.fitted * 0.05, this.fitted * 2000);
    if (this.isSpace) return;
    const gain = 1 / before - 1 / this.scale;
    this.centre[0] += (x - this.wide / 2) * gain;
    this.centre[1] -= (y - this.tall / 2) * gain;
  }

  /** Looks at a length as large as so much of the canvas. */
  showLength(length, part) { this.scale = part * Math.min(this.wide, this.tall) / length; }
}
