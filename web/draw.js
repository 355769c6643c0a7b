// The drawing of a scene with WebGL 2: agents, obstacles, edges and food, each kind with one call.

import { Camera } from "./camera.js";
import { boundsOf, boundsOfAgents } from "./frame.js";
import { Painter } from "./painter.js";
import { solids } from "./solids.js";
import { Trails } from "./trails.js";
import { clamp } from "./words.js";

// beyond so many agents, arrowheads are drawn without a contour
const MANY = 5000;
const NEAR_ENOUGH = 26, LARGEST = 200;
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

// An agent is a point, and its shape is found for each pixel: where WebGL is computed by software, instances of a shape
// cost a hundred times as much.
const AGENT = COMMON + `
layout(location=0) in vec3 place;
layout(location=1) in vec3 heading;
layout(location=2) in uint series;
layout(location=3) in float radius;
uniform vec3 across, up;
uniform float scale, smallest, largest, ratio, nearness, contour;
out vec3 tint;
flat out vec4 shape;
flat out float size;
void main() {
  vec4 at = world * vec4(place, 1.0);
  if (isMissing(place) || at.w < 0.06 * nearness) { gl_Position = NOWHERE; gl_PointSize = 1.0; return; }
  // things shrink with their distance; in a flat view nearness is 1, and so is w
  float closer = nearness / at.w;
  float half_length = min(max(radius * scale, smallest) * closer, largest);
  vec2 ahead = vec2(dot(heading, across), dot(heading, up));
  float seen = length(ahead);
  bool moves = dot(heading, heading) > 0.25;
  size = (2.0 * half_length + 2.0 * contour + 1.0) * 1.02;
  shape = vec4(seen > 1e-3 ? ahead / seen : vec2(1.0, 0.0), half_length, moves ? max(seen, 0.4) : 0.0);
  gl_Position = at;
  gl_PointSize = size * ratio;
  tint = paler(coloured(series), at.w);
}`;
const AGENT_FRAGMENT = `#version 300 es
precision highp float;
in vec3 tint;
flat in vec4 shape;
flat in float size;
uniform vec3 stage;
uniform float contour, fog;
out vec4 colour;
void main() {
  vec2 at = (gl_PointCoord - 0.5) * vec2(size, -size);
  vec2 own = vec2(dot(at, shape.xy), dot(at, vec2(-shape.y, shape.x))) / shape.z;
  float outside;
  vec3 shade = tint;
  if (shape.w > 0.0) {
    // an arrowhead with its notch at the back, shorter where it points at the eye or away
    vec2 half_shape = vec2(own.x / shape.w, abs(own.y));
    outside = max(dot(half_shape - vec2(1.0, 0.0), vec2(0.3534, 0.9355)), dot(half_shape + vec2(0.4, 0.0), vec2(-0.862, -0.507)));
    if (fog > 0.0) shade *= own.y * (shape.x + shape.y) > 0.0 ? 1.06 : 0.8;
  } else outside = length(own) - 0.6;
  outside *= shape.z;
  float cover = clamp(0.5 - outside + contour, 0.0, 1.0);
  if (cover < 0.05) discard;
  colour = vec4(mix(stage, shade, contour > 0.0 ? clamp(0.5 - outside, 0.0, 1.0) : 1.0) * cover, cover);
}`;

// lines so many units of the screen wide, dashed if asked; each is two triangles
const LINE = COMMON + `
layout(location=0) in vec3 start;
layout(location=1) in vec3 end;
layout(location=2) in vec3 line_colour;
layout(location=3) in vec2 width_and_dash;
layout(location=4) in vec2 corner;
out vec4 tint;
out float along;
out float aside;
out float dash;
void main() {
  vec4 from = world * vec4(start, 1.0), to = world * vec4(end, 1.0);
  dash = width_and_dash.y;
  if (from.w <= 0.01 || to.w <= 0.01) { gl_Position = NOWHERE; return; }
  vec2 first = from.xy / from.w * screen * 0.5, last = to.xy / to.w * screen * 0.5;
  float length_of_way = max(length(last - first), 1e-6);
  vec2 direction = (last - first) / length_of_way;
  float reach = width_and_dash.x * 0.5 + 0.5;
  vec4 here = corner.x < 0.5 ? from : to;
  vec2 at = mix(first, last, corner.x) + vec2(-direction.y, direction.x) * corner.y * reach;
  along = corner.x * length_of_way;
  aside = corner.y * reach;
  gl_Position = vec4(at * 2.0 / screen, here.z / here.w, 1.0);
  tint = vec4(line_colour, reach);
}`;
const LINE_FRAGMENT = `#version 300 es
precision highp float;
in vec4 tint;
in float along;
in float aside;
in float dash;
out vec4 colour;
void main() {
  if (dash > 0.0 && mod(along, 2.0 * dash) > dash) discard;
  float cover = clamp(tint.a - abs(aside), 0.0, 1.0);
  colour = vec4(tint.rgb * cover, cover);
}`;

// a trail's line is left out where it would cross the whole space; its last end knows that
const TRAIL = COMMON + `
layout(location=0) in vec3 place;
layout(location=1) in vec3 before;
layout(location=2) in uint series;
uniform vec3 longest;
uniform int agents, head, slots, drawn;
flat out float is_broken;
out vec4 tint;
void main() {
  is_broken = isMissing(place) || isMissing(before) || any(greaterThan(abs(place - before), longest)) ? 1.0 : 0.0;
  gl_Position = isMissing(place) ? NOWHERE : world * vec4(place, 1.0);
  int age = (head - gl_VertexID / agents + 2 * slots) % slots;
  tint = vec4(paler(coloured(series), gl_Position.w), 0.5 * max(0.06, 1.0 - float(age) / float(drawn + 1)));
}`;
const TRAIL_FRAGMENT = `#version 300 es
precision mediump float;
flat in float is_broken;
in vec4 tint;
out vec4 colour;
void main() { if (is_broken > 0.5) discard; colour = vec4(tint.rgb * tint.a, tint.a); }`;

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

export class Drawing {
  constructor(canvas) {
    this.canvas = canvas;
    this.camera = new Camera();
    // shapes and lines have soft edges of their own, which cost less than samples
    this.gl = canvas.getContext("webgl2", { antialias: false, alpha: false });
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
      agent: program(AGENT, AGENT_FRAGMENT), line: program(LINE, LINE_FRAGMENT), trail: program(TRAIL, TRAIL_FRAGMENT),
      solid: program(SOLID, FRAGMENT), point: program(POINT, POINT_FRAGMENT),
    };
    this.buffers = Object.fromEntries(["headings", "groups", "labels", "radii", "lines", "solids", "items"].map((name) => [name, gl.createBuffer()]));
    [, this.largest] = gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE);
    this.trails = new Trails(gl);
    this.painter = new Painter(gl, program);
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
    this.hasView = keepsView && this.hasView;
    this.uploadAgents();
    this.setObstacles([]);
    this.setItems([]);
    if (!this.hasView) this.fit();
  }

  /** What never changes of the agents: whose they are, and how large. */
  uploadAgents() {
    const { scene } = this;
    const groups = new Uint8Array(scene.agents).fill(255), radii = new Float32Array(scene.agents);
    scene.groups.forEach((group, index) => {
      groups.fill(index % 7, group.first, group.first + group.count);
      radii.fill(group.radius, group.first, group.first + group.count);
    });
    this.own = { groups, radii };
    this.fill("groups", groups);
    this.trails.begin(scene, groups);
    this.fill("radii", radii);
  }

  /** The view of everything: the space where it ends, the agents where it does not. */
  fit() {
    const { space, dimensions } = this.scene;
    const [low, high] = boundsOf(this.scene, this.frame);
    this.ends = { low, high };
    this.camera.setBounds(dimensions, low, high);
    this.camera.fit();
    this.hasView = this.frame !== null || space.edges.every((edge) => edge !== "open");
    this.upload();
  }

  setObstacles(list) { this.obstacles = list; this.upload(); }

  setItems(places) {
    this.items = places;
    this.counts.items = places.length;
    this.fill("items", new Float32Array(places.flat()));
  }

  /** Obstacles, the floor and the edges of the space, as triangles and lines. */
  upload() {
    if (!this.ends || !this.colours) return;
    const { triangles, lines } = solids(this.scene, this.ends, this.obstacles, this.colours);
    this.fill("solids", triangles);
    this.fill("lines", lines);
    this.counts.solids = triangles.length / 9;
    this.counts.lines = lines.length / 13;
  }

  setFrame(frame) {
    if (frame.dimensions !== this.scene.dimensions || frame.agents > this.scene.agents) {
      throw new Error("a frame of another scene");
    }
    this.frame = frame;
    this.trails.add(frame);
    if (!this.painter.paints(frame.agents)) this.fill("headings", frame.headings, this.gl.STREAM_DRAW);
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

  /** An attribute: where it stands, how many numbers, from which buffer. */
  attribute(place, size, buffer, { stride = 0, offset = 0, kind = this.gl.FLOAT } = {}) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(place);
    if (kind === gl.UNSIGNED_BYTE) gl.vertexAttribIPointer(place, size, kind, stride, offset);
    else gl.vertexAttribPointer(place, size, kind, false, stride, offset);
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
      [[3, 0], [3, 12], [3, 24], [2, 36], [2, 44]].forEach(([size, offset], place) => this.attribute(place, size, this.buffers.lines, { stride: 52, offset }));
      gl.drawArrays(gl.TRIANGLES, 0, this.counts.lines);
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
    const D = frame.dimensions, byLabel = frame.labels !== null && this.byLabel;
    const parts = this.withTrails ? this.trails.parts() : null;
    if (parts) {
      const at = this.use("trail");
      gl.uniform3fv(at("longest"), [0, 1, 2].map((axis) => (
        scene.space.edges[axis] === "periodic" ? (scene.space.high[axis] - scene.space.low[axis]) / 2 : 1e30)));
      for (const name of ["agents", "head", "slots", "drawn"]) gl.uniform1i(at(name), parts[name]);
      this.attribute(0, D, this.trails.places, { offset: parts.bytes });
      this.attribute(1, D, this.trails.places);
      this.attribute(2, 1, byLabel ? this.trails.labels : this.trails.groups, { kind: gl.UNSIGNED_BYTE });
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.trails.lines);
      gl.depthMask(false);
      for (const [first, count] of parts.ranges) gl.drawElements(gl.LINES, count, gl.UNSIGNED_INT, first * 4);
      gl.depthMask(true);
      free();
    }
    const [across, up] = camera.axes(), ratio = this.canvas.width / camera.wide;
    const view = {
      across, up, ratio, scale: camera.scale, smallest: this.smallest(), largest: Math.min(LARGEST, this.largest / ratio / 2.3),
      nearness: camera.isSpace ? camera.distance : 1, contour: frame.agents > MANY ? 0 : 1,
    };
    if (this.painter.paints(frame.agents)) {
      this.painter.draw(frame, {
        ...view, matrix: this.matrix, palette: this.palette, stage: this.colours.stage, isSpace: camera.isSpace,
        fog: camera.isSpace ? camera.distance : 0, radii: this.own.radii, series: byLabel ? frame.labels : this.own.groups,
      });
      return;
    }
    const at = this.use("agent");
    gl.uniform3fv(at("across"), across);
    gl.uniform3fv(at("up"), up);
    for (const name of ["scale", "smallest", "largest", "ratio", "nearness", "contour"]) gl.uniform1f(at(name), view[name]);
    this.attribute(0, D, this.trails.places, { offset: this.trails.newest });
    this.attribute(1, D, this.buffers.headings);
    this.attribute(2, 1, byLabel ? this.buffers.labels : this.buffers.groups, { kind: gl.UNSIGNED_BYTE });
    this.attribute(3, 1, this.buffers.radii);
    gl.drawArrays(gl.POINTS, 0, frame.agents);
    free();
  }

  /** The least half length of an agent on the canvas. */
  smallest() {
    const agents = this.frame?.agents ?? 0;
    const zoomed = clamp(Math.sqrt(this.camera.scale / this.camera.fitted), 0.7, 2.2);
    const size = agents > 8000 ? 2 : agents > 3000 ? 2.6 : agents > 800 ? 3.6 : 5.2;
    return size * zoomed * (this.camera.wide < 500 ? 0.8 : 1) * (this.camera.isSpace ? 1.2 : 1);
  }

  /** How large an agent is drawn, half its length. */
  halfLength(radius, scale) {
    if (this.camera.isSpace) return Math.max(radius, this.smallest() / this.camera.scale) * scale;
    return clamp(radius * scale, this.smallest(), LARGEST);
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

  /** Looks at the middle of the agents, and zooms when they no longer fit, or have become small. */
  keepInView(zooms) {
    const bounds = boundsOfAgents(this.frame), { camera } = this;
    if (!bounds) return;
    const flat = bounds.map((ends) => ends.map((end, axis) => (axis < this.frame.dimensions ? end : 0)));
    camera.setBounds(this.frame.dimensions, ...flat);
    camera.centre = camera.middle();
    const fitting = camera.fittingScale();
    camera.fitted = fitting;
    if (zooms && (fitting < camera.scale || fitting > 2 * camera.scale)) camera.scale = 0.85 * fitting;
  }
}
