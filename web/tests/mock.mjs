// A server that speaks the viewer's protocol about an invented flock, for tests of the page without the program.
// `node mock.mjs [port] [what was named: run, pair, flat, space, many, ...]` serves it for a look.

import { createHash } from "node:crypto";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { fileURLToPath } from "node:url";

const WEB = new URL("..", import.meta.url);
const TYPES = { html: "text/html", js: "text/javascript", css: "text/css" };
const GREETING = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";

const SCENARIOS = {
  flat: { title: "Zones in the plane", about: "Two hundred agents keep apart, align and come together, each within its own zone.", dimensions: 2, agents: 200, size: 12, edges: "periodic", second: 40, zones: true },
  space: { title: "A school in space", about: "Three zones about each fish, and a blind zone behind it.", dimensions: 3, agents: 300, size: 12, edges: "periodic", zones: true },
  scanner: { title: "Robots with laser scanners", about: "Sixteen robots between walls see by rays only.", dimensions: 2, agents: 16, size: 6, edges: "walls", rays: true, zones: true, radius: 0.12 },
  open: { title: "An open plane", about: "Nothing ends this space.", dimensions: 2, agents: 120, size: 10, edges: "open", zones: true },
  line: { title: "On a line", about: "Thirty agents in one dimension.", dimensions: 1, agents: 30, size: 20, edges: "periodic" },
  robots: { title: "Robots in the places of walls", about: "They go on when one says so.", dimensions: 2, agents: 6, size: 10, edges: "open", of: "formation" },
  nobody: { title: "Nobody", about: "A space without agents.", dimensions: 2, agents: 0, size: 10, edges: "walls" },
  many: { title: "Twenty thousand", about: "As many as the page must draw twenty times a second.", dimensions: 2, agents: 20000, size: 200, edges: "periodic" },
  crowd: { title: "A hundred thousand", about: "More than the page must draw quickly.", dimensions: 2, agents: 100000, size: 400, edges: "periodic" },
  swarm: { title: "Twenty thousand in space", about: "In space.", dimensions: 3, agents: 20000, size: 80, edges: "periodic" },
};
const RUNS = { run: { ...SCENARIOS.flat, title: "A recorded run", run: true, seed: 3 }, other: { ...SCENARIOS.flat, title: "Another recorded run", run: true, seed: 4 } };
const NAMED = { pair: ["run", "other"] };
const FRAMES = 120, EVERY = 2, STEP = 0.1;

const length = (vector) => Math.hypot(...vector);
const scaled = (vector, factor) => vector.map((value) => value * factor);
const sum = (vectors, D) => vectors.reduce((total, vector) => total.map((value, axis) => value + vector[axis]), Array(D).fill(0));
const unit = (vector) => (length(vector) > 0 ? scaled(vector, 1 / length(vector)) : vector);

/** A flock that is a function of its plan and seed. */
class Flock {
  constructor(plan, seed) {
    Object.assign(this, { plan, step: 0, state: (seed * 2654435761 + 12345) >>> 0 });
    this.values = { "group.fish.model.speed": 1, "group.fish.model.near": 0.5, "group.fish.model.align": true, "group.fish.model.rule": "zones", "group.fish.model.count": 7 };
    const D = plan.dimensions, n = plan.agents + (plan.second ?? 0);
    this.n = n;
    this.place = Float64Array.from({ length: n * D }, () => plan.size * (plan.edges === "open" ? 0.35 + 0.3 * this.random() : this.random()));
    this.heading = new Float64Array(n * D);
    for (let i = 0; i < n; i += 1) {
      const towards = unit(Array.from({ length: D }, (_, axis) => this.random() - 0.5 + (axis === 0 ? 0.25 : 0)));
      this.heading.set(towards, i * D);
    }
    this.obstacles = plan.dimensions === 1 || plan.agents === 0 ? [] : D === 3
      ? [{ ball: { centre: [8, 8, 4], radius: 1.6 } }, { box: { low: [1, 8, 0], high: [3, 10, 3] } }]
      : [{ ball: { centre: scaled([0.72, 0.7], plan.size), radius: 0.07 * plan.size } }, { box: { low: scaled([0.1, 0.12], plan.size), high: scaled([0.2, 0.2], plan.size) } },
        { polygon: [[0.2, 0.6], [0.3, 0.6], [0.3, 0.72], [0.26, 0.64]].map((at) => scaled(at, plan.size)) }, { segment: { from: scaled([0.6, 0.15], plan.size), to: scaled([0.85, 0.25], plan.size) } }];
    this.items = D === 1 ? [] : Array.from({ length: 6 }, () => Array.from({ length: D }, () => plan.size * this.random()));
  }

  random() { this.state = (Math.imul(this.state, 1664525) + 1013904223) >>> 0; return this.state / 4294967296; }
  at(list, i) { const D = this.plan.dimensions; return Array.from(list.subarray(i * D, i * D + D)); }

  /** Whom an agent sees: [id, offset, distance], the nearest first. */
  seen(i, range) {
    const { size, edges, dimensions: D } = this.plan, found = [], offset = [0, 0, 0];
    for (let j = 0; j < this.n; j += 1) {
      let [squared, ahead] = [0, 0];
      for (let axis = 0; axis < D; axis += 1) {
        offset[axis] = this.place[j * D + axis] - this.place[i * D + axis];
        if (edges === "periodic") offset[axis] -= size * Math.round(offset[axis] / size);
        squared += offset[axis] ** 2;
        ahead += this.heading[i * D + axis] * offset[axis];
      }
      if (j !== i && squared < range ** 2 && ahead > Math.cos(135 * Math.PI / 180) * Math.sqrt(squared)) found.push([j, offset.slice(0, D), Math.sqrt(squared)]);
    }
    return found.sort((a, b) => a[2] - b[2]);
  }

  decision(i) {
    const D = this.plan.dimensions, near = this.values["group.fish.model.near"];
    const seen = this.seen(i, 2), within = (low, high) => seen.filter(([, , distance]) => distance >= low && distance < high);
    const [close, middle, far] = [within(0, near), within(near, 1.2), within(1.2, 2)];
    const mean = (list, of) => unit(sum(list.map(of), D));
    const apart = scaled(mean(close, ([, offset]) => unit(offset)), -1.4);
    const align = this.values["group.fish.model.align"] ? scaled(mean(middle, ([j]) => this.at(this.heading, j)), 0.8) : Array(D).fill(0);
    const together = scaled(mean(far, ([, offset]) => unit(offset)), 0.45);
    const parts = close.length > 0 ? [apart, scaled(align, 0), scaled(together, 0)] : [scaled(apart, 0), align, together];
    const wanted = unit(sum([scaled(this.at(this.heading, i), 1.2), ...parts], D));
    return { seen, close, middle, far, parts, wanted: scaled(wanted, this.values["group.fish.model.speed"]) };
  }

  advance() {
    const { dimensions: D, size, edges, zones } = this.plan;
    // only a flock with zones decides; a large one flies straight, so that the mock is never what is slow
    const next = zones ? this.heading.slice() : this.heading;
    if (zones) for (let i = 0; i < this.n; i += 1) next.set(unit(this.decision(i).wanted), i * D);
    this.heading = next;
    for (let at = 0; at < this.place.length; at += 1) {
      const value = this.place[at] + STEP * this.values["group.fish.model.speed"] * next[at];
      if (edges === "walls" && (value < 0 || value > size)) this.heading[at] *= -1;
      else this.place[at] = edges === "periodic" ? (value + size) % size : value;
    }
    this.step += 1;
  }

  frame(number) {
    const { dimensions: D } = this.plan, { n } = this, count = n * D;
    const bytes = Buffer.alloc(24 + 8 * count + n);
    bytes.writeUInt32LE(number, 0);
    bytes.writeUInt32LE(this.step, 4);
    bytes.writeDoubleLE(this.step * STEP, 8);
    bytes.writeUInt32LE(n, 16);
    bytes.writeUInt8(D, 20);
    bytes.writeUInt8(1, 21);
    new Uint8Array(bytes.buffer, bytes.byteOffset + 24).set(new Uint8Array(new Float32Array(this.place).buffer));
    new Uint8Array(bytes.buffer, bytes.byteOffset + 24 + 4 * count).set(new Uint8Array(new Float32Array(this.heading).buffer));
    for (let i = 0; i < n; i += 1) bytes[24 + 8 * count + i] = i % 5 === 4 ? 255 : i % 3;
    return bytes;
  }

  metrics() {
    const D = this.plan.dimensions, groups = [["fish", 0, this.plan.agents], ...(this.plan.second ? [["hunters", this.plan.agents, this.n]] : [])];
    return groups.map(([group, from, to]) => {
      const headings = Array.from({ length: Math.min(400, to - from) }, (_, k) => this.at(this.heading, from + k));
      const polarisation = headings.length ? length(sum(headings, D)) / headings.length : null;
      return { group, values: [polarisation, polarisation === null ? null : 2 + Math.sin(this.step / 20), this.values["group.fish.model.speed"]] };
    });
  }

  explain(i) {
    const D = this.plan.dimensions, { seen, close, middle, far, parts, wanted } = this.decision(i);
    const position = this.at(this.place, i), heading = this.at(this.heading, i), speed = this.values["group.fish.model.speed"];
    const listed = (list) => list.map(([id, offset]) => ({ offset, id: this.plan.rays ? null : id }));
    const decides = close.length > 0, third = scaled(wanted, 0.8);
    const ball = this.obstacles[0]?.ball;
    const obstacles = !ball ? [] : [ball].map(({ centre, radius }) => {
      const to = centre.map((value, axis) => value - position[axis]), distance = length(to) - radius;
      return { offset: scaled(unit(to), distance), distance, away: scaled(unit(to), -1) };
    }).filter(({ distance }) => distance > 0 && distance < 2);
    const rays = !this.plan.rays ? [] : Array.from({ length: 61 }, (_, k) => {
      const angle = Math.atan2(heading[1], heading[0]) + (k - 30) * 4.5 * Math.PI / 180, ray = [Math.cos(angle), Math.sin(angle)];
      const hit = seen.find(([, offset]) => { const along = offset[0] * ray[0] + offset[1] * ray[1]; return along > 0 && Math.abs(offset[0] * ray[1] - offset[1] * ray[0]) < this.plan.radius; });
      return { to: scaled(ray, hit ? hit[2] - this.plan.radius : 2), hit: hit ? "member" : "nothing", lost: k % 17 === 5 };
    });
    return {
      agent: i, group: i < this.plan.agents ? "fish" : "hunters", model: "invented_zones", step: this.step, t: this.step * STEP,
      position, velocity: scaled(heading, speed), heading, radius: this.plan.radius ?? 0.08,
      sensing: { kind: this.plan.rays ? "laser" : "ideal", range: 2, field_of_view: D === 1 ? null : 270 }, rays, detected: listed(seen),
      sets: [{ name: "repulsion", rule: "within the zone", acts: decides, low: 0, high: this.values["group.fish.model.near"], angle: null, members: listed(close) },
        { name: "orientation", rule: "within the zone", acts: !decides, low: this.values["group.fish.model.near"], high: 1.2, angle: null, members: listed(middle) },
        { name: "attraction", rule: "within the zone", acts: !decides, low: 1.2, high: 2, angle: null, members: listed(far) }],
      obstacles,
      components: ["keep apart", "align", "come together"].map((name, k) => ({ name, vector: parts[k], magnitude: length(parts[k]) })),
      values: [{ stage: "sensing", name: "range", value: 2, unit: "m" }, { stage: "detection", name: "members detected", value: seen.length, unit: "" },
        { stage: "selection", name: "zone that decides", value: decides ? "repulsion" : "orientation and attraction", unit: "" },
        { stage: "motion", name: "angle of the wanted direction", value: Math.atan2(wanted[1] ?? 0, wanted[0]) * 180 / Math.PI, unit: "degrees" },
        { stage: "motion", name: "unit of the components", value: "m/s", unit: "-" }, { stage: "motion", name: "turning", value: 12.345678, unit: "degrees" }, { stage: "physics", name: "displacement", value: STEP * length(third), unit: "m" }],
      choice: [{ name: "explore", probability: 0.2, chosen: false }, { name: "follow", probability: 0.7, chosen: true }, { name: "rest", probability: 0.1, chosen: false }],
      wanted: { velocity: wanted, displacement: scaled(wanted, STEP) },
      performed: { position: sum([position, scaled(third, STEP)], D), velocity: third, met: "nothing" },
    };
  }
}

const control = (name, kind, rest) => ({ path: `group.fish.model.${name}`, group: "fish", symbol: "", unit: "", kind, low: null, high: null, step: null, words: [], ...rest });
const CONTROLS = [
  control("speed", "number", { name: "speed", symbol: "v", about: "How fast an agent moves.", unit: "m/s", low: 0, high: 3, step: 0.1, default: 1 }),
  control("near", "number", { name: "radius of repulsion", symbol: "r_r", about: "Within this distance agents keep apart.", unit: "m", low: 0, high: 1.2, default: 0.5 }),
  control("count", "whole", { name: "preferred neighbours", symbol: "k", about: "How many are looked at.", low: 1, high: 20, default: 7 }),
  control("align", "truth", { name: "alignment", about: "Whether agents take the direction of others.", default: true }),
  control("rule", "word", { name: "selection", about: "Which neighbours are selected.", words: ["zones", "nearest", "visible"], default: "zones" }),
];

/** What one page sees: a flock or a run, its time, and what it was asked. */
class Session {
  constructor(say, show, named, log) {
    Object.assign(this, { say, show, named, log, flock: null, number: 0, unseen: 0, focus: null, playing: false, rate: 30, frameAt: 0, loop: false, history: [] });
    say({ is: "hello", program: "flockworks mock", given: named.map((name) => ({ kind: RUNS[name] ? "run" : "scenario", name })) });
  }

  end() { clearInterval(this.timer); }

  open(name) {
    const plan = RUNS[name] ?? SCENARIOS[name];
    if (!plan) { this.say({ is: "problem", text: `there is no scenario ${name}` }); return; }
    this.plan = plan;
    this.begin(plan.seed ?? 1);
  }

  begin(seed) {
    const { plan } = this;
    Object.assign(this, { seed, flock: new Flock(plan, seed), frameAt: 0, playing: false });
    const axes = Array(plan.dimensions).fill(0);
    this.history = [];
    const all = [];
    if (plan.run) {
      for (let frame = 0; frame < FRAMES; frame += 1) {
        this.history.push([this.flock.step, this.flock.place.slice(), this.flock.heading.slice()]);
        all.push(this.flock.metrics());
        for (let step = 0; step < EVERY; step += 1) this.flock.advance();
      }
    }
    this.say({
      is: "scene", kind: plan.run ? "run" : "live", of: plan.of ?? "", goes_on: plan.of === "formation", title: plan.title, about: plan.about, seed, dimensions: plan.dimensions,
      units: { length: "m", time: "s" }, space: { edges: axes.map(() => plan.edges), size: axes.map(() => plan.size), low: axes, high: axes.map(() => plan.size) },
      groups: [{ name: "fish", model: "invented_zones", title: "Invented zones", first: 0, count: plan.agents, radius: plan.radius ?? 0.08 },
        ...(plan.second ? [{ name: "hunters", model: "invented_zones", title: "Invented hunters", first: plan.agents, count: plan.second, radius: 0.12 }] : [])],
      labels: [{ column: "behaviour", names: ["explore", "follow", "rest"] }], step: STEP, steps: plan.run ? FRAMES * EVERY : 1000,
      frames: plan.run ? FRAMES : 0, from_step: 0, every_steps: EVERY,
      metrics: [{ id: "polarisation", title: "Polarisation", unit: "", range: [0, 1] }, { id: "distance", title: "Nearest neighbour", unit: "m", range: null }, { id: "speed", title: "Mean speed", unit: "m/s", range: null }],
      controls: plan.run ? [] : CONTROLS.map((one) => ({ ...one, value: this.flock.values[one.path] })), events: plan.run ? [{ step: 60, t: 6, what: "speed became 1 m/s" }] : [],
    });
    this.say({ is: "obstacles", list: this.flock.obstacles });
    this.say({ is: "items", places: this.flock.items });
    if (plan.run) {
      const times = this.history.map(([step]) => step * STEP);
      this.say({ is: "metrics_all", t: times, groups: all[0].map(({ group }, at) => ({ group, values: [0, 1, 2].map((metric) => all.map((rows) => rows[at].values[metric])) })) });
    }
    this.tell();
  }

  /** Sends the frame that is shown, its explanation, and the status. */
  tell() {
    // as the server does: no frame while two are unseen, and the last one as soon as there is room
    this.stale = this.unseen >= 2;
    if (this.stale) return;
    if (this.plan.run) [this.flock.step, this.flock.place, this.flock.heading] = this.history[this.frameAt];
    this.number += 1;
    this.unseen += 1;
    this.show(this.flock.frame(this.number));
    if (this.focus !== null) this.say({ is: "explain", explanation: this.flock.explain(this.focus) });
    if (!this.plan.run) this.say({ is: "metrics", step: this.flock.step, t: this.flock.step * STEP, rows: this.flock.metrics() });
    this.status();
  }

  status() {
    this.say({ is: "status", playing: this.playing, step: this.flock.step, t: this.flock.step * STEP, frame: this.plan.run ? this.frameAt : null, rate: this.rate, reached: Math.abs(this.rate) || 60 });
  }

  tick() {
    if (!this.playing || this.unseen >= 2) return;
    this.onward(this.plan.run ? Math.sign(this.rate) : 1);
    this.tell();
  }

  onward(by) {
    if (!this.plan.run) { for (let step = 0; step < by; step += 1) this.flock.advance(); return; }
    this.frameAt += by;
    if (this.frameAt < 0 || this.frameAt >= FRAMES) {
      if (this.loop && this.playing) this.frameAt = (this.frameAt + FRAMES) % FRAMES;
      else { this.frameAt = Math.max(0, Math.min(FRAMES - 1, this.frameAt)); this.playing = false; }
    }
  }

  receive(message) {
    this.log(message);
    const { do: what } = message;
    if (what === "open") this.open(message.gallery ?? this.named[message.given]);
    if (!this.flock) return;
    clearInterval(this.timer);
    if (what === "play" || what === "pause") { this.playing = what === "play"; this.status(); }
    if (what === "step") { this.playing = false; this.onward(message.count); this.tell(); }
    if (what === "speed") { this.rate = message.rate; this.status(); }
    if (what === "loop") this.loop = message.on;
    if (what === "reset") this.begin(message.seed ?? this.seed);
    if (what === "seek") { this.playing = false; this.frameAt = Math.max(0, Math.min(FRAMES - 1, message.frame)); this.tell(); }
    if (what === "set") {
      this.flock.values[message.path] = message.value;
      this.say({ is: "event", step: this.flock.step, t: this.flock.step * STEP, what: `${message.path} became ${message.value}` });
    }
    if (what === "go_on") this.say({ is: "event", step: this.flock.step, t: this.flock.step * STEP, what: "next formation" });
    if (what === "focus") { this.focus = message.agent; if (message.agent !== null) this.say({ is: "explain", explanation: this.flock.explain(message.agent) }); }
    if (what === "save") this.say({ is: "file", text: `title = "${this.plan.title}"\nspeed = ${this.flock.values["group.fish.model.speed"]}\n` });
    if (what === "seen") { this.unseen = this.number - message.number; if (this.stale) this.tell(); }
    this.timer = setInterval(() => this.tick(), 1000 / (Math.abs(this.rate) || 120));
  }
}

/** A frame of the WebSocket protocol, from the server: unmasked, in one piece. */
function framed(content) {
  const isText = typeof content === "string", body = Buffer.from(content), size = body.length;
  const head = Buffer.from([isText ? 0x81 : 0x82, size < 126 ? size : size < 65536 ? 126 : 127]);
  const long = Buffer.alloc(size < 126 ? 0 : size < 65536 ? 2 : 8);
  if (long.length === 2) long.writeUInt16BE(size);
  if (long.length === 8) long.writeBigUInt64BE(BigInt(size));
  return Buffer.concat([head, long, body]);
}

/** Starts the server; `named` are scenarios or runs of this file, as if the command line had named them. */
export async function startMock({ port = 0, named = [], gallery = ["flat", "space", "scanner", "open", "line", "nobody"] } = {}) {
  const received = [], sockets = new Set(), waiting = [];
  const server = createServer(async (request, response) => {
    const path = request.url === "/" ? "index.html" : request.url.slice(1);
    try {
      if (path === "gallery.json") {
        response.setHeader("content-type", "application/json");
        response.end(JSON.stringify(gallery.map((id) => ({ id, title: SCENARIOS[id].title, about: SCENARIOS[id].about, dimensions: SCENARIOS[id].dimensions, models: ["invented_zones"], agents: SCENARIOS[id].agents }))));
        return;
      }
      if (!/^[a-z]+\.(html|js|css)$/.test(path)) throw new Error("no such page");
      const body = await readFile(fileURLToPath(new URL(path, WEB)));
      response.setHeader("content-type", `${TYPES[path.split(".")[1]]}; charset=utf-8`);
      response.end(body);
    } catch {
      response.statusCode = 404;
      response.end();
    }
  });
  server.on("upgrade", (request, socket) => {
    const key = createHash("sha1").update(request.headers["sec-websocket-key"] + GREETING).digest("base64");
    socket.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${key}\r\n\r\n`);
    const log = (message) => {
      received.push(message);
      for (const one of waiting.filter(({ wanted }) => wanted(message))) { waiting.splice(waiting.indexOf(one), 1); one.tell(message); }
    };
    const session = new Session((message) => socket.write(framed(JSON.stringify(message))), (bytes) => socket.write(framed(bytes)), named, log);
    sockets.add(socket);
    let rest = Buffer.alloc(0);
    socket.on("data", (data) => {
      rest = Buffer.concat([rest, data]);
      while (rest.length >= 6) {
        const short = rest[1] & 127, head = short === 126 ? 4 : short === 127 ? 10 : 2;
        if (rest.length < head + 4) return;
        const size = short === 126 ? rest.readUInt16BE(2) : short === 127 ? Number(rest.readBigUInt64BE(2)) : short;
        if (rest.length < head + 4 + size) return;
        const mask = rest.subarray(head, head + 4), body = Buffer.from(rest.subarray(head + 4, head + 4 + size)).map((byte, at) => byte ^ mask[at % 4]);
        const kind = rest[0] & 15;
        rest = rest.subarray(head + 4 + size);
        if (kind === 8) { socket.end(); return; }
        if (kind === 1) session.receive(JSON.parse(body.toString()));
      }
    });
    const over = () => { session.end(); sockets.delete(socket); };
    socket.on("close", over);
    socket.on("error", over);
  });
  await new Promise((done) => { server.listen(port, "127.0.0.1", done); });
  return {
    address: `http://127.0.0.1:${server.address().port}/`,
    port: server.address().port,
    received,
    /** Sends as it is to every page: text or bytes, in whatever state. */
    inject: (content) => { for (const socket of sockets) socket.write(framed(content)); },
    /** The next message that is as wanted. */
    next: (wanted) => new Promise((tell) => { waiting.push({ wanted, tell }); }),
    stop: () => new Promise((done) => { for (const socket of sockets) socket.destroy(); server.close(done); server.closeAllConnections(); }),
  };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const names = process.argv.slice(3).flatMap((name) => NAMED[name] ?? [name]);
  const mock = await startMock({ port: Number(process.argv[2] ?? 0), named: names });
  console.log(mock.address);
}
