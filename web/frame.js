// What the server sends, read and checked: binary frames, scenes and explanations.

import { isNumber } from "./words.js";

const HEADER = 24;
const MOST_AGENTS = 5_000_000;

/**
 * A frame; its arrays are views of the buffer, in the order of the agents' ids. The numbers stand little end first, as
 * they do in every browser's arrays.
 */
export function readFrame(buffer) {
  if (!(buffer instanceof ArrayBuffer) || buffer.byteLength < HEADER) throw new Error("a frame without a beginning");
  const head = new DataView(buffer);
  const agents = head.getUint32(16, true), dimensions = head.getUint8(20), labelled = head.getUint8(21);
  if (dimensions < 1 || dimensions > 3 || agents > MOST_AGENTS || labelled > 1) throw new Error("a frame of another kind");
  const coordinates = agents * dimensions;
  const bytes = HEADER + 8 * coordinates + agents * labelled;
  if (buffer.byteLength !== bytes) throw new Error(`a frame of ${buffer.byteLength} bytes, where ${bytes} were expected`);
  return {
    number: head.getUint32(0, true),
    step: head.getUint32(4, true),
    time: head.getFloat64(8, true),
    agents,
    dimensions,
    positions: new Float32Array(buffer, HEADER, coordinates),
    headings: new Float32Array(buffer, HEADER + 4 * coordinates, coordinates),
    labels: labelled ? new Uint8Array(buffer, HEADER + 8 * coordinates, agents) : null,
  };
}

/** A place or direction of an agent with three coordinates; null for the dead and for nobody. */
export function vectorOf(values, frame, agent) {
  if (agent < 0 || agent >= frame.agents) return null;
  const at = agent * frame.dimensions;
  const vector = [0, 1, 2].map((axis) => (axis < frame.dimensions ? values[at + axis] : 0));
  return vector.every(Number.isFinite) ? vector : null;
}

/** Where the agents are, of a sample of them, with some room. */
export function boundsOfAgents({ positions, agents, dimensions }) {
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

/** What is to be seen as a whole: the space where it ends, the agents where it does not; of what is known to its end, all of it. */
export function boundsOf({ space, dimensions, of }, frame) {
  const agents = frame && !of ? boundsOfAgents(frame) : null;
  const side = (ends, which) => [0, 1, 2].map((axis) => {
    if (axis >= dimensions) return 0;
    return (space.edges[axis] === "open" && agents ? agents[which][axis] : ends[axis]) ?? which;
  });
  const low = side(space.low, 0), high = side(space.high, 1);
  for (let axis = 0; axis < dimensions; axis += 1) if (!(high[axis] > low[axis])) high[axis] = low[axis] + 1;
  return [low, high];
}

const list = (value) => (Array.isArray(value) ? value : []);
const objects = (value) => list(value).filter((part) => part !== null && typeof part === "object");
const text = (value, otherwise = "") => (typeof value === "string" ? value : otherwise);
const number = (value, otherwise = null) => (isNumber(value) ? value : otherwise);

/** Three coordinates of a list of one to three numbers; what is missing is 0. */
export const vector = (value) => {
  const parts = list(value);
  if (parts.length === 0 || parts.length > 3 || !parts.every(isNumber)) throw new Error("a vector without numbers");
  return [parts[0], parts[1] ?? 0, parts[2] ?? 0];
};
const perhapsVector = (value) => { try { return vector(value); } catch { return null; } };

function readControl(control) {
  if (typeof control.path !== "string" || !["number", "whole", "truth", "word"].includes(control.kind)) return null;
  return {
    path: control.path, kind: control.kind, group: text(control.group), name: text(control.name, control.path).replaceAll("_", " "),
    symbol: text(control.symbol), about: text(control.about), unit: text(control.unit),
    low: number(control.low), high: number(control.high), step: number(control.step),
    default: control.default ?? null, value: control.value ?? control.default ?? null,
    words: list(control.words).filter((word) => typeof word === "string"),
  };
}

export function readScene(message) {
  const dimensions = message.dimensions;
  if (![1, 2, 3].includes(dimensions)) throw new Error("a scene without dimensions");
  const groups = objects(message.groups).map((group, index) => ({
    name: text(group.name, `group ${index + 1}`), model: text(group.model), title: text(group.title),
    first: number(group.first, 0), count: number(group.count, 0), radius: number(group.radius, 0),
  }));
  const space = message.space ?? {};
  const axes = [0, 1, 2].slice(0, dimensions);
  return {
    isRun: message.kind === "run", of: text(message.of), goesOn: message.goes_on === true, recording: text(message.recording),
    numbered: isNumber(message.numbered?.first) && isNumber(message.numbered?.by) ? { first: message.numbered.first, by: message.numbered.by } : null, title: text(message.title, "Untitled"), about: text(message.about),
    seed: number(message.seed), dimensions, groups,
    units: { length: text(message.units?.length), time: text(message.units?.time) },
    space: {
      edges: axes.map((axis) => text(list(space.edges)[axis], "open")),
      low: axes.map((axis) => number(list(space.low)[axis])),
      high: axes.map((axis) => number(list(space.high)[axis])),
    },
    agents: groups.reduce((most, group) => Math.max(most, group.first + group.count), 0),
    labels: objects(message.labels).slice(0, 1).map((label) => ({ column: text(label.column, "label"), names: list(label.names).map(String) })),
    step: number(message.step, 1), steps: number(message.steps),
    frames: Math.max(0, number(message.frames, 0)), fromStep: number(message.from_step, 0),
    everySteps: Math.max(1, number(message.every_steps, 1)),
    metrics: objects(message.metrics).map((metric) => ({
      id: text(metric.id), title: text(metric.title, text(metric.id)), unit: text(metric.unit),
      range: list(metric.range).length === 2 && metric.range.every(isNumber) ? metric.range : null, own: metric.own === true,
    })),
    controls: objects(message.controls).map(readControl).filter((control) => control !== null),
    events: objects(message.events).map(readEvent),
  };
}

export const readEvent = (event) => ({
  step: number(event.step, 0), t: number(event.t, 0), what: text(event.what, "something"), kind: text(event.kind, "event"),
  untilStep: number(event.until_step, number(event.step, 0)), untilT: number(event.until_t, number(event.t, 0)),
});

const member = (value) => ({ offset: perhapsVector(value.offset), id: number(value.id) });
const members = (value) => objects(value).map(member).filter(({ offset }) => offset !== null);

export function readExplanation(value) {
  if (value === null || typeof value !== "object" || !isNumber(value.agent)) throw new Error("an explanation of nobody");
  const velocity = (part) => perhapsVector(part?.velocity);
  return {
    agent: value.agent, recorded: value.recorded === true, name: text(value.name), group: text(value.group), model: text(value.model), step: number(value.step), t: number(value.t),
    position: vector(value.position), velocity: velocity(value), heading: perhapsVector(value.heading) ?? [0, 0, 0],
    radius: number(value.radius, 0),
    sensing: {
      kind: text(value.sensing?.kind, "ideal"), range: number(value.sensing?.range),
      opening: number(value.sensing?.field_of_view),
    },
    rays: objects(value.rays).map((ray) => ({ to: perhapsVector(ray.to), hit: text(ray.hit, "nothing"), lost: ray.lost === true }))
      .filter(({ to }) => to !== null),
    detected: members(value.detected),
    sets: objects(value.sets).map((set) => ({
      name: text(set.name), rule: text(set.rule), acts: set.acts === true,
      low: number(set.low), high: number(set.high), angle: number(set.angle), members: members(set.members),
    })),
    obstacles: objects(value.obstacles).map((seen) => ({
      offset: perhapsVector(seen.offset), distance: number(seen.distance), away: perhapsVector(seen.away),
    })).filter(({ offset }) => offset !== null),
    components: objects(value.components).map((part) => ({
      name: text(part.name), vector: perhapsVector(part.vector) ?? [0, 0, 0], magnitude: number(part.magnitude),
    })),
    values: objects(value.values).map((row) => ({ stage: text(row.stage), name: text(row.name), value: row.value, unit: text(row.unit) })),
    choice: objects(value.choice).map((option) => ({
      name: text(option.name), probability: number(option.probability), chosen: option.chosen === true,
    })),
    wanted: velocity(value.wanted),
    performed: velocity(value.performed),
    // the unit of all components is told among the values
    unit: text(objects(value.values).find((row) => row.name === "unit of the components")?.value),
    met: text(value.performed?.met, "nothing"),
  };
}
