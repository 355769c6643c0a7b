// Agents painted pixel by pixel. Where WebGL is computed by software, each of its points costs as much as some hundred pixels
// that are written here, so a picture of thousands of agents comes several times as soon. What a pixel shows is what the
// shader of an agent in draw.js says.

// below so many agents the points cost next to nothing
const WORTH_PAINTING = 2000;
const BY_SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
const BUCKETS = 4096;
// small agents of a flat view are stamped: so many directions, and places between pixels on each axis
const DIRECTIONS = 128, PLACES = 4, LARGEST_STAMP = 8, KEPT_STAMPS = 24;

const VERTEX = `#version 300 es
out vec2 here;
void main() {
  here = vec2(gl_VertexID == 1 ? 2 : 0, gl_VertexID == 2 ? 2 : 0);
  gl_Position = vec4(2.0 * here - 1.0, 0.0, 1.0);
}`;
const FLAT = `#version 300 es
precision mediump float;
uniform sampler2D picture;
in vec2 here;
out vec4 colour;
void main() { colour = texture(picture, here); }`;
const SPACE = `#version 300 es
precision highp float;
uniform sampler2D picture;
uniform highp sampler2D depths;
in vec2 here;
out vec4 colour;
void main() {
  colour = texture(picture, here);
  if (colour.a == 0.0) discard;
  gl_FragDepth = texture(depths, here).r;
}`;

/** Whether this machine computes WebGL by software. */
export function isSoftware(gl) {
  let name = gl.getParameter(gl.RENDERER);
  // one browser tells it only when asked for, another complains when it is
  if (name === "WebKit WebGL") name = gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
  return BY_SOFTWARE.test(name);
}

const inBytes = (colour) => colour.map((part) => Math.round(255 * part));
const clamped = (value) => (value < 0 ? 0 : value > 1 ? 1 : value);

/** How far a place, in half lengths along and aside the heading, is outside an arrowhead with its notch at the back. */
function outsideOf(along, aside, thin) {
  const ahead = along * thin, apart = aside < 0 ? -aside : aside;
  const front = (ahead - 1) * 0.3534 + apart * 0.9355, back = (ahead + 0.4) * -0.862 - apart * 0.507;
  return front > back ? front : back;
}

/** The pixels of small agents of one size and colour, found once for each direction and place between pixels that occurs. */
class Stamps {
  constructor(half, contour, ratio, ink, ground) {
    Object.assign(this, { half, contour, ratio, ink, ground, reach: ((2 * half + 2 * contour + 1) * 1.02 * ratio) / 2 });
    this.made = Array(PLACES * PLACES * (DIRECTIONS + 1)).fill(null);
  }

  /** Pixels: down, across, and what stands there where nothing stood before. */
  at(direction, right, down) {
    const index = (direction * PLACES + down) * PLACES + right;
    this.made[index] ??= this.make(direction, (right + 0.5) / PLACES, (down + 0.5) / PLACES);
    return this.made[index];
  }

  make(direction, right, down) {
    const { half, contour, ratio, reach, ink, ground } = this, by = 1 / (half * ratio), found = [];
    const turn = 2 * Math.PI * direction / DIRECTIONS, [ax, ay] = [Math.cos(turn), Math.sin(turn)];
    for (let row = Math.round(down - reach); row < Math.round(down + reach); row += 1) {
      for (let column = Math.round(right - reach); column < Math.round(right + reach); column += 1) {
        const u = (column + 0.5 - right) * by, v = (row + 0.5 - down) * by;
        const along = u * ax + v * ay, aside = v * ax - u * ay;
        const outside = half * (direction === DIRECTIONS ? Math.hypot(along, aside) - 0.6 : outsideOf(along, aside, 1));
        const cover = clamped(0.5 - outside + contour);
        if (cover < 0.05) continue;
        const filled = contour > 0 ? clamped(0.5 - outside) : 1;
        const [red, green, blue] = ink.map((part, at) => Math.round((ground[at] + (part - ground[at]) * filled) * cover));
        found.push(row, column, (Math.round(255 * cover) << 24) | (blue << 16) | (green << 8) | red);
      }
    }
    return Int32Array.from(found);
  }
}

export class Painter {
  /** `program` compiles a vertex and a fragment shader. */
  constructor(gl, program) {
    this.gl = gl;
    this.isWanted = isSoftware(gl);
    Object.assign(this, { wide: 0, tall: 0, order: new Uint32Array(0), stamps: new Map() });
    if (this.isWanted) Object.assign(this, { flat: program(VERTEX, FLAT), space: program(VERTEX, SPACE) });
  }

  paints(agents) { return this.isWanted && agents >= WORTH_PAINTING; }

  room(wide, tall, isSpace) {
    const { gl } = this;
    if (this.wide === wide && this.tall === tall && (this.depth !== null || !isSpace)) { this.pixels.fill(0); return; }
    gl.deleteTexture(this.picture);
    gl.deleteTexture(this.depths);
    const texture = (kind) => {
      const made = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, made);
      gl.texStorage2D(gl.TEXTURE_2D, 1, kind, wide, tall);
      for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
      return made;
    };
    Object.assign(this, { wide, tall, picture: texture(gl.RGBA8), depths: isSpace ? texture(gl.R32F) : null });
    this.pixels = new Int32Array(wide * tall);
    this.parts = new Uint8ClampedArray(this.pixels.buffer);
    this.depth = isSpace ? new Float32Array(wide * tall) : null;
  }

  /** The rows of the agents from the farthest to the nearest by `far`. */
  ordered(agents, far) {
    if (this.order.length < agents) this.order = new Uint32Array(agents);
    const { order } = this;
    let least = Infinity, most = -Infinity;
    for (let agent = 0; agent < agents; agent += 1) { const w = far[agent]; if (w < least) least = w; if (w > most) most = w; }
    const ends = new Uint32Array(BUCKETS + 1), by = (BUCKETS - 1) / (most - least || 1);
    const bucket = (w) => (w === w ? ((most - w) * by) | 0 : BUCKETS - 1);
    for (let agent = 0; agent < agents; agent += 1) ends[bucket(far[agent]) + 1] += 1;
    for (let k = 0; k < BUCKETS; k += 1) ends[k + 1] += ends[k];
    for (let agent = 0; agent < agents; agent += 1) order[ends[bucket(far[agent])]++] = agent;
    return order;
  }

  /**
   * Draws the agents of a frame over what is drawn already. `view` has the matrix, axes, scale and colours that the shader is given,
   * and each agent's series and radius.
   */
  draw(frame, view) {
    const { gl } = this, { matrix: m, across, up, ratio, nearness, fog, stage, palette, contour, series, radii } = view;
    const { agents, dimensions: D, positions, headings } = frame;
    const wide = gl.canvas.width, tall = gl.canvas.height, isSpace = view.isSpace;
    this.room(wide, tall, isSpace);
    const { parts, depth: depths } = this;
    let far = null;
    if (isSpace) {
      far = this.far?.length === agents ? this.far : new Float32Array(agents);
      this.far = far;
      for (let agent = 0; agent < agents; agent += 1) {
        const k = agent * D;
        far[agent] = m[3] * positions[k] + m[7] * positions[k + 1] + m[11] * positions[k + 2] + m[15];
      }
    }
    const order = isSpace ? this.ordered(agents, far) : null;
    let size = null, colour = null, stamps = null;
    const ends = { left: wide, right: 0, low: tall, high: 0 };
    const ground = inBytes(stage), inks = Array.from({ length: 8 }, (_, k) => inBytes([...palette.subarray(3 * k, 3 * k + 3)]));
    for (let at = 0; at < agents; at += 1) {
      const agent = isSpace ? order[at] : at, k = agent * D;
      const x = positions[k], y = D > 1 ? positions[k + 1] : 0, z = D > 2 ? positions[k + 2] : 0;
      const w = isSpace ? far[agent] : 1;
      // of the dead nothing is shown, nor of what is behind the eye
      if (!(x === x) || w < 0.06 * nearness) continue;
      const middle_x = ((m[0] * x + m[4] * y + m[8] * z + m[12]) / w + 1) / 2 * wide;
      const middle_y = ((m[1] * x + m[5] * y + m[9] * z + m[13]) / w + 1) / 2 * tall;
      const half = Math.min(Math.max(radii[agent] * view.scale, view.smallest) * nearness / w, view.largest);
      const reach = ((2 * half + 2 * contour + 1) * 1.02 * ratio) / 2;
      const left = Math.max(0, Math.round(middle_x - reach)), right = Math.min(wide, Math.round(middle_x + reach));
      const low = Math.max(0, Math.round(middle_y - reach)), high = Math.min(tall, Math.round(middle_y + reach));
      if (left >= right || low >= high) continue;
      const hx = headings[k], hy = D > 1 ? headings[k + 1] : 0, hz = D > 2 ? headings[k + 2] : 0;
      let ax = hx * across[0] + hy * across[1] + hz * across[2], ay = hx * up[0] + hy * up[1] + hz * up[2];
      const seen = Math.sqrt(ax * ax + ay * ay), moves = hx * hx + hy * hy + hz * hz > 0.25;
      if (seen > 1e-3) { ax /= seen; ay /= seen; } else { ax = 1; ay = 0; }
      if (left < ends.left) ends.left = left;
      if (right > ends.right) ends.right = right;
      if (low < ends.low) ends.low = low;
      if (high > ends.high) ends.high = high;
      const own = series[agent] === 255 ? 7 : series[agent] % 7, ink = inks[own];
      if (!isSpace && half <= LARGEST_STAMP && (!moves || seen > 0.99)) {
        if (half !== size || own !== colour) [size, colour, stamps] = [half, own, this.stampsOf(half, contour, ratio, ink, ground)];
        const direction = moves ? Math.round(Math.atan2(ay, ax) * DIRECTIONS / 2 / Math.PI + DIRECTIONS) % DIRECTIONS : DIRECTIONS;
        this.stamp(stamps, direction, middle_x, middle_y);
        continue;
      }
      const thin = 1 / Math.max(seen, 0.4), by = 1 / (half * ratio);
      const pale = fog > 0 ? 0.55 * clamped((w / fog - 0.7) / 0.6) : 0;
      const red = ink[0] + (ground[0] - ink[0]) * pale, green = ink[1] + (ground[1] - ink[1]) * pale, blue = ink[2] + (ground[2] - ink[2]) * pale;
      const depth = isSpace ? ((m[2] * x + m[6] * y + m[10] * z + m[14]) / w + 1) / 2 : 0;
      // where nothing is covered any more, in half lengths
      const most = (0.45 + contour) / half;
      const forth = by * ax, aslant = -by * ay;
      for (let row = low; row < high; row += 1) {
        const u = (left + 0.5 - middle_x) * by, v = (row + 0.5 - middle_y) * by;
        let along = u * ax + v * ay - forth, aside = v * ax - u * ay - aslant, index = row * wide + left - 1;
        for (let column = left; column < right; column += 1) {
          along += forth;
          aside += aslant;
          index += 1;
          const from = moves ? outsideOf(along, aside, thin) : Math.sqrt(along * along + aside * aside) - 0.6;
          if (from > most) continue;
          const outside = from * half;
          const cover = outside > contour - 0.5 ? 0.5 - outside + contour : 1, rest = 1 - cover;
          const filled = contour === 0 || outside < -0.5 ? 1 : outside > 0.5 ? 0 : 0.5 - outside;
          const lit = !moves || fog === 0 ? 1 : aside * (ax + ay) > 0 ? 1.06 : 0.8, to = 4 * index;
          parts[to] = (ground[0] + (red * lit - ground[0]) * filled) * cover + parts[to] * rest;
          parts[to + 1] = (ground[1] + (green * lit - ground[1]) * filled) * cover + parts[to + 1] * rest;
          parts[to + 2] = (ground[2] + (blue * lit - ground[2]) * filled) * cover + parts[to + 2] * rest;
          parts[to + 3] = 255 * cover + parts[to + 3] * rest;
          if (isSpace) depths[index] = depth;
        }
      }
    }
    this.show(isSpace, ends);
  }

  stampsOf(half, contour, ratio, ink, ground) {
    const key = [half, contour, ratio, ink, ground].join(" ");
    if (!this.stamps.has(key)) {
      if (this.stamps.size >= KEPT_STAMPS) this.stamps.clear();
      this.stamps.set(key, new Stamps(half, contour, ratio, ink, ground));
    }
    return this.stamps.get(key);
  }

  /** Stamps an agent whose middle is at a place of the canvas. */
  stamp(stamps, direction, x, y) {
    const { pixels, wide, tall } = this, left = Math.floor(x), low = Math.floor(y);
    const stamp = stamps.at(direction, ((x - left) * PLACES) | 0, ((y - low) * PLACES) | 0);
    for (let at = 0; at < stamp.length; at += 3) {
      const row = low + stamp[at], column = left + stamp[at + 1], own = stamp[at + 2];
      if (row < 0 || row >= tall || column < 0 || column >= wide) continue;
      const index = row * wide + column, below = pixels[index];
      if (below === 0 || own >>> 24 === 255) { pixels[index] = own; continue; }
      // over what stands there: two of the four parts at a time, each divided by 255
      const rest = 255 - (own >>> 24);
      const even = (below & 0xff00ff) * rest + 0x800080, odd = ((below >>> 8) & 0xff00ff) * rest + 0x800080;
      pixels[index] = own + (((even + ((even >>> 8) & 0xff00ff)) >>> 8) & 0xff00ff) + ((odd + ((odd >>> 8) & 0xff00ff)) & 0xff00ff00);
    }
  }

  /** Puts what was painted over what is drawn. */
  show(isSpace, { left, right, low, high }) {
    if (left >= right) return;
    const { gl, wide, tall } = this, { made, at } = isSpace ? this.space : this.flat;
    gl.useProgram(made);
    const give = (unit, texture, name, format, kind, content) => {
      gl.activeTexture(unit === 0 ? gl.TEXTURE0 : gl.TEXTURE1);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, low, wide, high - low, format, kind, content, low * wide * (content.length / wide / tall));
      gl.uniform1i(at(name), unit);
    };
    if (isSpace) give(1, this.depths, "depths", gl.RED, gl.FLOAT, this.depth);
    give(0, this.picture, "picture", gl.RGBA, gl.UNSIGNED_BYTE, this.parts);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(left, low, right - left, high - low);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.disable(gl.SCISSOR_TEST);
  }
}
