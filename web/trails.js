// Where agents were: the positions of the last frames stay on the graphics card, and a trail joins each to the next.

const MOST_SEGMENTS = 40000, LONGEST = 28, WORTH_DRAWING = 3;

export class Trails {
  constructor(gl) {
    this.gl = gl;
    this.slots = Array.from({ length: LONGEST + 1 }, () => gl.createBuffer());
    this.clear();
  }

  clear() { Object.assign(this, { used: 0, head: -1, agents: 0, last: null, direction: 0 }); }

  get newest() { return this.slots[this.head]; }

  /** Takes the positions of a frame; a jump or a turn in time begins anew. */
  add(frame) {
    const by = this.last === null ? 0 : frame.step - this.last;
    const continues = this.agents === frame.agents && by !== 0 && (this.direction === 0 || (Math.sign(by) === Math.sign(this.direction)
      && Math.abs(by) <= 12 * Math.abs(this.direction)));
    if (by === 0 && this.agents === frame.agents && this.used > 0) this.used -= 1; else this.head = (this.head + 1) % this.slots.length;
    if (!continues && by !== 0) this.used = 0;
    if (by !== 0) this.direction = continues ? by : 0;
    Object.assign(this, { agents: frame.agents, last: frame.step });
    this.used = Math.min(this.used + 1, this.slots.length);
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.newest);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, frame.positions, this.gl.STREAM_DRAW);
  }

  /** How many segments are drawn: fewer where there are so many agents that drawing would falter. */
  segments(agents) {
    const most = Math.min(LONGEST, Math.floor(MOST_SEGMENTS / Math.max(1, agents)));
    return most < WORTH_DRAWING ? 0 : Math.min(most, this.used - 1);
  }

  /** Calls `act` with two buffers and a strength for each segment, the oldest first. */
  each(agents, act) {
    const count = this.segments(agents);
    const slot = (back) => this.slots[(this.head - back + this.slots.length) % this.slots.length];
    for (let back = count; back > 0; back -= 1) act(slot(back), slot(back - 1), 0.06 + 0.44 * (1 - (back - 1) / count));
  }
}
