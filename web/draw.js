// The drawing of a scene with WebGL 2: agents, obstacles, edges and food, each kind with one call.

import { Camera } from "./camera.js";
import { solids } from "./solids.js";
import { Trails } from "./trails.js";
import { clamp } from "./words.js";

// beyond so many agents, arrowheads are drawn without a contour and smaller
const MANY = 5000;
const NEAR_ENOUGH = 26;
const MOST_PIXELS_PER_UNIT = 2;

const COMMON = `#version 300 es
precision highp float;
uniform mat4 world;
uniform vec2 screen;
uniform vec3 palette[8];
uniform vec3 stage;
uniform float fog;
vec3 coloured(uint series) { return palette[series == 255u ? 7u : series % 7u]; }
vec3 paler(vec3 colour, float w) { return fog > 0.0 ? mix(colour, stage, 0.55 * clamp((w / fog - 0.7) / 0.6, 0.0, 1.0)) : colour; }
bool isMissing(vec3 place) { return !(place.x == place.x) || isnan(place.x); }
const vec4 NOWHERE = vec4(2.0, 2.0, 2.0, 1.0);
`;
const FRAGMENT = `#version 300 es
precision mediump float;
in vec4 tint;
out vec4 colour;
void main() { colour = vec4(tint.rgb * tint.a, tint.a); }`;

// an arrowhead in the plane, or a disc at rest; drawn twice for a contour
const FLAT = COMMON + `
layout(location=0) in vec4 shape;
layout(location=1) in float contour;
layout(location=2) in vec3 place;
layout(location=3) in vec3 heading;
layout(location=4) in uint series;
layout(location=5) in float radius;
uniform float scale, smallest;
out vec4 tint;
void main() {
  if (isMissing(place)) { gl_Position = NOWHERE; return; }
  vec2 ahead = heading.xy;
  float half_length = clamp(radius * scale, smallest, 400.0);
  float moves = length(ahead);
  vec2 at = moves > 0.5 ? mat2(ahead, vec2(-ahead.y, ahead.x)) * shape.xy : 0.65 * shape.zw;
  vec2 grown = contour > 0.5 ? at * half_length + 1.1 * normalize(at) : at * half_length;
  gl_Position = world * vec4(place, 1.0);
  gl_Position.xy += grown * 2.0 / screen;
  tint = vec4(contour > 0.5 ? stage : coloured(series), 1.0);
}`;

// a dart in space, a tetrahedron at rest
const DART = COMMON + `
layout(location=0) in vec3 corner;
layout(location=1) in vec3 normal;
layout(location=2) in vec3 place;
layout(location=3) in vec3 heading;
layout(location=4) in uint series;
layout(location=5) in float radius;
uniform float scale, smallest, distance_to_centre;
uniform vec3 light;
out vec4 tint;
void main() {
  vec4 at = world * vec4(place, 1.0);
  if (isMissing(place) || at.w < 0.06 * distance_to_centre) { gl_Position = NOWHERE; return; }
  float size = max(radius, smallest / scale);
  bool moves = dot(heading, heading) > 0.25;
  vec3 ahead = moves ? normalize(heading) : vec3(0.0, 0.0, 1.0);
  vec3 aside = normalize(cross(ahead, abs(ahead.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
  mat3 turned = mat3(ahead, aside, cross(aside, ahead));
  gl_Position = world * vec4(place + turned * (moves ? corner : corner * vec3(0.6, 1.0, 1.0)) * size, 1.0);
  float lit = 0.72 + 0.28 * dot(turned * normal, light);
  tint = vec4(paler(coloured(series) * lit, at.w), 1.0);
}`;

// lines so many units of the screen wide, dashed if asked
const WIDE_LINE = `
vec4 widened(vec4 from, vec4 to, vec2 corner, float width, out float along) {
  vec2 start = from.xy / from.w * screen * 0.5, end = to.xy / to.w * screen * 0.5;
  vec2 way = end - start;
  float length_of_way = max(length(way), 1e-6);
  vec2 direction = way / length_of_way;
  vec2 at = mix(start, end, corner.x) + vec2(-direction.y, direction.x) * corner.y * width * 0.5;
  along = corner.x * length_of_way;
  vec4 end_here = corner.x < 0.5 ? from : to;
  return vec4(at * 2.0 / screen, end_here.z / end_here.w, 1.0);
}`;
const LINE = COMMON + WIDE_LINE + `
layout(location=0) in vec2 corner;
layout(location=1) in vec3 start;
layout(location=2) in vec3 end;
layout(location=3) in vec3 line_colour;
layout(location=4) in vec2 width_and_dash;
out vec4 tint;
out float along;
out float dash;
void main() {
  vec4 from = world * vec4(start, 1.0), to = world * vec4(end, 1.0);
  dash = width_and_dash.y;
  along = 0.0;
  if (from.w <= 0.01 || to.w <= 0.01) { gl_Position = NOWHERE; return; }
  gl_Position = widened(from, to, corner, width_and_dash.x, along);
  tint = vec4(line_colour, 1.0);
}`;
const LINE_FRAGMENT = `#version 300 es
precision mediump float;
in vec4 tint;
in float along;
in float dash;
out vec4 colour;
void main() { if (dash > 0.0 && mod(along, 2.0 * dash) > dash) discard; colour = tint; }`;

const TRAIL = COMMON + WIDE_LINE + `
layout(location=0) in vec2 corner;
layout(location=1) in vec3 start;
layout(location=2) in vec3 end;
layout(location=4) in uint series;
uniform vec3 longest;
uniform float strength;
out vec4 tint;
void main() {
  if (isMissing(start) || isMissing(end) || any(greaterThan(abs(end - start), longest))) { gl_Position = NOWHERE; return; }
  vec4 from = world * vec4(start, 1.0), to = world * vec4(end, 1.0);
  if (from.w <= 0.01 || to.w <= 0.01) { gl_Position = NOWHERE; return; }
  float along;
  gl_Position = widened(from, to, corner, 1.3, along);
  tint = vec4(paler(coloured(series), to.w), strength);
}`;

const SOLID = COMMON + `
layout(location=0) in vec3 place;
layout(location=1) in vec3 normal;
layout(location=2) in vec3 solid_colour;
uniform vec3 light;
out vec4 tint;
void main() {
  gl_Position = world * vec4(place, 1.0);
  float lit = dot(normal, normal) > 0.1 ? 0.8 + 0.25 * dot(normal, light) : 1.0;
  tint = vec4(paler(solid_colour * lit, gl_Position.w), 1.0);
}`;

// food: a hollow diamond
const POINT = COMMON + `
layout(location=0) in vec3 place;
uniform float size;
uniform vec3 line_colour;
out vec4 tint;
void main() { gl_Position = world * vec4(place, 1.0); gl_PointSize = size; tint = vec4(paler(line_colour, gl_Position.w), 1.0); }`;
const POINT_FRAGMENT = `#version 300 es
precision mediump float;
in vec4 tint;
uniform vec3 filling;
out vec4 colour;
void main() {
  vec2 at = abs(gl_PointCoord - 0.5) * 2.0;
  float out_of_middle = at.x + at.y;
  if (out_of_middle > 1.0) discard;
  colour = vec4(out_of_middle > 0.62 ? tint.rgb : filling, 1.0);
}`;

// as many corners as the disc has; the last ones add nothing
const ARROW = [[-0.8, 0.68], [1, 0], [-0.4, 0], ...Array(5).fill([-0.8, -0.68])];
// a strip over a regular octagon zigzags between its two sides
const OCTAGON = [3, 4, 2, 5, 1, 6, 0, 7].map((at) => [Math.cos((at + 0.5) * Math.PI / 4), Math.sin((at + 0.5) * Math.PI / 4)]);

function flatShape() {
  const part = (contour) => ARROW.map((corner, index) => [...corner, ...OCTAGON[index], contour]);
  const [back, front] = [part(1), part(0)];
  return new Float32Array([...back, back.at(-1), front[0], ...front].flat());
}

function dartShape() {
  const tip = [1.15, 0, 0];
  const tail = [0, 1, 2].map((at) => [-0.75, 0.62 * Math.cos(at * 2.0944), 0.62 * Math.sin(at * 2.0944)]);
  const faces = [[tip, tail[0], tail[1]], [tip, tail[1], tail[2]], [tip, tail[2], tail[0]], [tail[0], tail[2], tail[1]]];
  const normal = ([a, b, c]) => {
    const [u, v] = [b, c].map((corner) => corner.map((value, axis) => value - a[axis]));
    const across = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    return across.map((value) => value / Math.hypot(...across));
  };
  return new Float32Array(faces.flatMap((face) => face.flatMap((corner) => [...corner, ...normal(face)])));
}

export class Drawing {
  constructor(canvas) {
    this.canvas = canvas;
    this.camera = new Camera();
    this.gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (this.gl === null) throw new Error("this browser does not draw with WebGL 2");
    Object.assign(this, { scene: null, frame: null, obstacles: [], items: [], colours: null, byLabel: false, withTrails: true });
    this.makeParts();
  }

  makeParts() {
    const { gl } = this;
    const program = (vertex, fragment) => {
      const made = gl.createProgram();
      for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
        const shader = gl.createShader(kind);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        gl.attachShader(made, shader);
      }
      gl.linkProgram(made);
      if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
        const logs = gl.getAttachedShaders(made).map((shader) => gl.getShaderInfoLog(shader));
        throw new Error(`a shader does not fit this machine: ${[gl.getProgramInfoLog(made), ...logs].join(" ")}`);
      }
      const places = new Map();
      const at = (name) => { if (!places.has(name)) places.set(name, gl.getUniformLocation(made, name)); return places.get(name); };
      return { made, at };
    };
    this.programs = {
      flat: program(FLAT, FRAGMENT), dart: program(DART, FRAGMENT), line: program(LINE, LINE_FRAGMENT),
      trail: program(TRAIL, FRAGMENT), solid: program(SOLID, FRAGMENT), point: program(POINT, POINT_FRAGMENT),
    };
    const filled = (data) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      if (data) gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
      return buffer;
    };
    this.buffers = {
      flat: filled(flatShape()), dart: filled(dartShape()), corner: filled(new Float32Array([0, -1, 0, 1, 1, -1, 1, 1])),
      headings: filled(), groups: filled(), labels: filled(), radii: filled(), lines: filled(), solids: filled(), items: filled(),
    };
    this.trails = new Trails(gl);
    this.counts = { lines: 0, solids: 0, items: 0 };
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  /** After the machine took the drawing away and gave it back. */
  restore() {
    this.makeParts();
    if (this.scene) { this.upload(); this.uploadAgents(); }
    if (this.frame) this.setFrame(this.frame);
  }

  fill(name, data, use = this.gl.STATIC_DRAW) {
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.buffers[name]);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, data, use);
  }

  setColours(colours) { this.colours = colours; if (this.scene) this.upload(); }

  setScene(scene, keepsView) {
    this.scene = scene;
    this.frame = null;
    this.trails.clear();
    this.hasView = keepsView && this.hasView;
    this.uploadAgents();
    this.setObstacles([]);
    this.setItems([]);
    if (!this.hasView) this.fit();
  }

  /** What never changes of the agents: whose they are, and how large. */
  uploadAgents() {
    const { scene } = this;
    const groups = new Uint8Array(scene.agents).fill(7), radii = new Float32Array(scene.agents);
    scene.groups.forEach((group, index) => {
      groups.fill(index % 7, group.first, group.first + group.count);
      radii.fill(group.radius, group.first, group.first + group.count);
    });
    this.fill("groups", groups);
    this.fill("radii", radii);
  }

  /** The view of everything: the space where it ends, the agents where it does not. */
  fit() {
    const { space, dimensions } = this.scene;
    const bounds = this.frame ? this.agentBounds() : null;
    const side = (ends, which) => [0, 1, 2].map((axis) => {
      if (axis >= dimensions) return 0;
      const isOpen = space.edges[axis] === "open";
      return (isOpen && bounds ? bounds[which][axis] : ends[axis]) ?? (which === 0 ? 0 : 1);
    });
    const low = side(space.low, 0), high = side(space.high, 1);
    for (let axis = 0; axis < dimensions; axis += 1) if (!(high[axis] > low[axis])) high[axis] = low[axis] + 1;
    this.camera.setBounds(dimensions, low, high);
    this.camera.fit();
    this.hasView = this.frame !== null || space.low.every((end) => end !== null);
    this.upload();
  }

  /** Where the agents are, of a sample of them, with some room. */
  agentBounds() {
    const { positions, agents, dimensions } = this.frame;
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const stride = Math.max(1, Math.floor(agents / 2000));
    for (let agent = 0; agent < agents; agent += stride) {
      for (let axis = 0; axis < dimensions; axis += 1) {
        const value = positions[agent * dimensions + axis];
        if (value < low[axis]) low[axis] = value;
        if (value > high[axis]) high[axis] = value;
      }
    }
    if (!Number.isFinite(low[0])) return null;
    const room = 0.15 * Math.max(...low.slice(0, dimensions).map((end, axis) => high[axis] - end), 1e-9);
    return [low.map((end) => end - room), high.map((end) => end + room)];
  }

  setObstacles(list) { this.obstacles = list; this.upload(); }

  setItems(places) {
    this.items = places;
    this.counts.items = places.length;
    this.fill("items", new Float32Array(places.flat()));
  }

  /** Obstacles, the floor and the edges of the space, as triangles and lines. */
  upload() {
    if (!this.scene || !this.colours) return;
    const { triangles, lines } = solids(this.scene, this.camera, this.obstacles, this.colours);
    this.fill("solids", triangles);
    this.fill("lines", lines);
    this.counts.solids = triangles.length / 9;
    this.counts.lines = lines.length / 11;
  }

  setFrame(frame) {
    if (frame.dimensions !== this.scene.dimensions || frame.agents > this.scene.agents) {
      throw new Error("a frame of another scene");
    }
    this.frame = frame;
    this.trails.add(frame);
    this.fill("headings", frame.headings, this.gl.STREAM_DRAW);
    if (frame.labels) this.fill("labels", frame.labels, this.gl.STREAM_DRAW);
    if (!this.hasView) this.fit();
  }

  resize(wide, tall) {
    const ratio = Math.min(devicePixelRatio || 1, MOST_PIXELS_PER_UNIT);
    this.canvas.width = Math.max(1, Math.round(wide * ratio));
    this.canvas.height = Math.max(1, Math.round(tall * ratio));
    this.camera.resize(wide, tall);
  }

  use(name) {
    const { gl, camera, colours } = this;
    const { made, at } = this.programs[name];
    gl.useProgram(made);
    gl.uniformMatrix4fv(at("world"), false, this.matrix);
    gl.uniform2f(at("screen"), camera.wide, camera.tall);
    gl.uniform3fv(at("palette"), this.palette);
    gl.uniform3fv(at("stage"), colours.stage);
    gl.uniform1f(at("fog"), camera.isSpace ? camera.distance : 0);
    if (at("light")) {
      const [across, up, away] = camera.axes();
      gl.uniform3fv(at("light"), [0, 1, 2].map((axis) => -0.45 * across[axis] + 0.7 * up[axis] - 0.55 * away[axis]));
    }
    return at;
  }

  /** An attribute: where it stands, how many numbers, from which buffer; `each` 1 for one per thing drawn. */
  attribute(place, size, buffer, { stride = 0, offset = 0, each = 0, kind = this.gl.FLOAT } = {}) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(place);
    if (kind === gl.UNSIGNED_BYTE) gl.vertexAttribIPointer(place, size, kind, stride, offset);
    else gl.vertexAttribPointer(place, size, kind, false, stride, offset);
    gl.vertexAttribDivisor(place, each);
  }

  draw() {
    const { gl, camera, colours, canvas } = this;
    if (!colours || !this.scene || gl.isContextLost()) return;
    this.matrix = camera.matrix();
    this.palette = new Float32Array([...colours.series, colours.faint].flat());
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...(camera.isSpace ? colours.stage : colours.ground), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (camera.isSpace) gl.enable(gl.DEPTH_TEST); else gl.disable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    const free = () => { for (let place = 0; place < 6; place += 1) gl.disableVertexAttribArray(place); };

    if (this.counts.solids > 0) {
      this.use("solid");
      [3, 3, 3].forEach((size, place) => this.attribute(place, size, this.buffers.solids, { stride: 36, offset: 12 * place }));
      gl.drawArrays(gl.TRIANGLES, 0, this.counts.solids);
      free();
    }
    if (this.counts.lines > 0) {
      this.use("line");
      this.attribute(0, 2, this.buffers.corner);
      [[3, 0], [3, 12], [3, 24], [2, 36]].forEach(([size, offset], index) => {
        this.attribute(index + 1, size, this.buffers.lines, { stride: 44, offset, each: 1 });
      });
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.counts.lines);
      free();
    }
    if (this.frame) this.drawAgents(free);
    if (this.counts.items > 0) {
      const at = this.use("point");
      gl.uniform1f(at("size"), 11 * canvas.width / camera.wide);
      gl.uniform3fv(at("line_colour"), colours.text);
      gl.uniform3fv(at("filling"), colours.ground);
      this.attribute(0, 3, this.buffers.items);
      gl.drawArrays(gl.POINTS, 0, this.counts.items);
      free();
    }
  }

  drawAgents(free) {
    const { gl, camera, frame, scene } = this;
    const D = frame.dimensions, many = frame.agents > MANY;
    const series = frame.labels && this.byLabel ? this.buffers.labels : this.buffers.groups;
    if (this.withTrails && this.trails.segments(frame.agents) > 0) {
      const at = this.use("trail");
      const longest = [0, 1, 2].map((axis) => (
        scene.space.edges[axis] === "periodic" ? (scene.space.high[axis] - scene.space.low[axis]) / 2 : 1e30));
      gl.uniform3fv(at("longest"), longest);
      this.attribute(0, 2, this.buffers.corner);
      this.attribute(4, 1, series, { each: 1, kind: gl.UNSIGNED_BYTE });
      if (camera.isSpace) gl.depthMask(false);
      this.trails.each(frame.agents, (from, to, strength) => {
        this.attribute(1, D, from, { each: 1 });
        this.attribute(2, D, to, { each: 1 });
        gl.uniform1f(at("strength"), strength);
        gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, frame.agents);
      });
      gl.depthMask(true);
      free();
    }
    const at = this.use(camera.isSpace ? "dart" : "flat");
    gl.uniform1f(at("scale"), camera.scale);
    gl.uniform1f(at("smallest"), this.smallest());
    this.attribute(2, D, this.trails.newest, { each: 1 });
    this.attribute(3, D, this.buffers.headings, { each: 1 });
    this.attribute(4, 1, series, { each: 1, kind: gl.UNSIGNED_BYTE });
    this.attribute(5, 1, this.buffers.radii, { each: 1 });
    if (camera.isSpace) {
      gl.uniform1f(at("distance_to_centre"), camera.distance);
      [3, 3].forEach((size, place) => this.attribute(place, size, this.buffers.dart, { stride: 24, offset: 12 * place }));
      gl.drawArraysInstanced(gl.TRIANGLES, 0, 12, frame.agents);
    } else {
      this.attribute(0, 4, this.buffers.flat, { stride: 20 });
      this.attribute(1, 1, this.buffers.flat, { stride: 20, offset: 16 });
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, many ? 10 : 0, many ? 8 : 18, frame.agents);
    }
    free();
  }

  /** The least half length of an agent on the canvas. */
  smallest() {
    const agents = this.frame?.agents ?? 0;
    const zoomed = clamp(Math.sqrt(this.camera.scale / this.camera.fitted), 0.7, 2.2);
    const size = agents > 20000 ? 2 : agents > 4000 ? 2.6 : agents > 800 ? 3.6 : 5.2;
    return size * zoomed * (this.camera.wide < 500 ? 0.8 : 1) * (this.camera.isSpace ? 1.2 : 1);
  }

  /** How large an agent is drawn, half its length. */
  halfLength(radius, scale) {
    if (this.camera.isSpace) return Math.max(radius, this.smallest() / this.camera.scale) * scale;
    return clamp(radius * scale, this.smallest(), 400);
  }

  /** The agent that is nearest to a point of the canvas, or null. */
  pick(x, y) {
    if (!this.frame) return null;
    const { positions, agents, dimensions } = this.frame;
    const place = [0, 0, 0];
    let [best, least] = [null, Infinity];
    for (let agent = 0; agent < agents; agent += 1) {
      for (let axis = 0; axis < dimensions; axis += 1) place[axis] = positions[agent * dimensions + axis];
      const [across, down, depth, scale] = this.camera.project(place);
      // of two at nearly the same spot, the one in front
      const apart = Math.hypot(across - x, down - y) + (this.camera.isSpace ? 2 * depth / this.camera.radius : 0);
      if (apart < least && Math.hypot(across - x, down - y) < Math.max(NEAR_ENOUGH, this.halfLength(0, scale))) [best, least] = [agent, apart];
    }
    return best;
  }

  /** The middle of the agents, of a sample of them. */
  middleOfAgents() {
    const bounds = this.frame ? this.agentBounds() : null;
    return bounds && bounds[0].map((low, axis) => (axis < this.frame.dimensions ? (low + bounds[1][axis]) / 2 : 0));
  }
}
