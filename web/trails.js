// Where agents were: the places of the last frames stay on the graphics card, and a trail joins each to the next.

const MOST_SEGMENTS = 10000, LONGEST = 28, WORTH_DRAWING = 3;
// in a simulation, places farther apart than so many steps do not tell the way between them
const MOST_STEPS = 25;

/**
 * One buffer of slots, each with the places of all agents at one frame, used in turn. Slot 0 repeats the last one, so
 * that every line leads from one slot to the next; before it stands an empty slot, because the shader looks one back.
 */
export class Trails {
  constructor(gl) {
    this.gl = gl;
    for (const name of ["places", "groups", "labels", "lines"]) this[name] = gl.createBuffer();
    Object.assign(this, { agents: 0, slots: 1, head: 1, used: 0 });
  }

  /** Makes room for a scene. Where there are very many agents, no trails are kept: drawing would falter. */
  begin(scene, groups) {
    const { gl } = this, agents = Math.max(1, scene.agents);
    const most = Math.min(LONGEST, Math.floor(MOST_SEGMENTS / agents));
    const slots = most < WORTH_DRAWING ? 1 : most + 1;
    Object.assign(this, { agents, slots, head: 1, used: 0, last: null, direction: 0, spacing: scene.isRun ? scene.everySteps : null });
    this.slotBytes = agents * scene.dimensions * 4;
    const room = (name, content) => { gl.bindBuffer(gl.ARRAY_BUFFER, this[name]); gl.bufferData(gl.ARRAY_BUFFER, content, gl.DYNAMIC_DRAW); };
    room("places", (slots + 2) * this.slotBytes);
    const series = new Uint8Array((slots + 1) * agents).fill(255);
    room("labels", series);
    for (let slot = 0; slot <= slots; slot += 1) series.set(groups, slot * agents);
    room("groups", series);
    const lines = new Uint32Array(slots > 1 ? 2 * slots * agents : 0);
    for (let at = 0; at < lines.length / 2; at += 1) { lines[2 * at] = at; lines[2 * at + 1] = at + agents; }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.lines);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, lines, gl.STATIC_DRAW);
  }

  /** Where the newest places begin, in bytes. */
  get newest() { return (this.head + 1) * this.slotBytes; }

  /** Takes the places of a frame; a jump or a turn in time begins anew. */
  add(frame) {
    const by = this.last === null ? 0 : frame.step - this.last;
    const usual = this.spacing ?? Math.abs(this.direction), most = this.spacing === null ? MOST_STEPS : Infinity;
    const turns = by * this.direction < 0, jumps = Math.abs(by) > Math.min(usual > 0 ? 12 * usual : Infinity, most);
    const continues = this.count === frame.agents && by !== 0 && !turns && !jumps;
    if (continues) this.head = this.head % this.slots + 1;
    this.used = continues ? Math.min(this.used + 1, this.slots) : by === 0 && this.used > 0 ? this.used : 1;
    if (by !== 0) this.direction = continues ? by : 0;
    Object.assign(this, { count: frame.agents, last: frame.step });
    const { gl } = this;
    for (const slot of this.head === this.slots ? [this.head, 0] : [this.head]) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.places);
      gl.bufferSubData(gl.ARRAY_BUFFER, (slot + 1) * this.slotBytes, frame.positions);
      if (!frame.labels || this.slots === 1) continue;
      gl.bindBuffer(gl.ARRAY_BUFFER, this.labels);
      gl.bufferSubData(gl.ARRAY_BUFFER, slot * this.agents, frame.labels);
    }
  }

  /** What is to be drawn: ranges of indices, and what the shader must know; null for nothing. */
  parts() {
    const { agents, slots, head } = this, drawn = this.used - 1;
    if (drawn < 1 || this.count !== agents) return null;
    // the line into slot k stands k - 1 slots from the beginning
    const range = (from, to) => [2 * (from - 1) * agents, 2 * (to - from + 1) * agents];
    const first = head - drawn + 1;
    const ranges = first >= 1 ? [range(first, head)] : [range(1, head), range(first + slots, slots)];
    return { agents, slots, head, drawn, ranges, bytes: this.slotBytes };
  }
}
