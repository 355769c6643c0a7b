// The common clock of two recorded runs: the page asks both for the frame of the same time, and waits for both.

import { clamp } from "./words.js";

export class PairClock {
  /** `all()` gives the panes, the leading one first; `changed` is called when the clock starts or stops. */
  constructor(all, changed) {
    Object.assign(this, { all, changed, way: 0, rate: 20, loop: false, t: 0, before: null, ended: false });
  }

  get panes() { return this.all().filter((pane) => pane.scene !== null); }

  add(pane) {
    pane.asked = null;
    if (this.panes[0] === pane) this.t = Math.max(this.t, this.timeOf(0));
    this.ask();
  }

  end() { this.ended = true; }

  /** Time of a frame of the run that leads. */
  timeOf(frame, { scene } = this.panes[0]) { return (scene.fromStep + frame * scene.everySteps) * scene.step; }
  get spacing() { const { scene } = this.panes[0]; return scene.everySteps * scene.step; }
  get last() { return Math.max(...this.panes.map((pane) => this.timeOf(Math.max(0, pane.scene.frames - 1), pane))); }
  get first() { return Math.min(...this.panes.map((pane) => this.timeOf(0, pane))); }

  /** Asks each run for its frame of now; false while an answer is missing. */
  ask() {
    let areHere = true;
    for (const pane of this.panes) {
      const { scene } = pane;
      const frame = clamp(Math.round((this.t / scene.step - scene.fromStep) / scene.everySteps), 0, Math.max(0, scene.frames - 1));
      if (pane.asked !== null && pane.frame?.step !== scene.fromStep + pane.asked * scene.everySteps) { areHere = false; continue; }
      if (pane.asked === frame) continue;
      if (pane.send({ do: "seek", frame })) pane.asked = frame;
      areHere = false;
    }
    // what was asked for while an answer was missing is asked again when it came
    if (!areHere && this.way === 0 && !this.ended) requestAnimationFrame(() => { if (!this.ended) this.ask(); });
    return areHere;
  }

  run(way) {
    const starts = this.way === 0 && way !== 0;
    this.way = this.panes.length > 0 ? way : 0;
    if (starts && this.t >= this.last && way > 0) this.t = this.first;
    if (starts && this.t <= this.first && way < 0) this.t = this.last;
    this.before = null;
    this.changed();
    if (starts && this.way !== 0) requestAnimationFrame((now) => this.tick(now));
    else if (way === 0) this.ask();
  }

  tick(now) {
    if (this.way === 0 || this.ended || this.panes.length === 0) return;
    requestAnimationFrame((then) => this.tick(then));
    const passed = this.before === null ? 0 : Math.min(0.25, (now - this.before) / 1000);
    // the clock stands while a run has not come after
    if (!this.ask()) { this.before = now; return; }
    this.before = now;
    this.t += this.way * this.rate * passed * this.spacing;
    if (this.t < this.first || this.t > this.last) {
      if (this.loop) this.t = this.way > 0 ? this.first : this.last;
      else { this.t = clamp(this.t, this.first, this.last); this.run(0); }
    }
  }

  step(count) {
    this.t = clamp(this.timeOf(Math.round((this.t - this.timeOf(0)) / this.spacing) + count), this.first, this.last);
    this.run(0);
  }

  seekFrame(frame) { this.t = this.timeOf(frame); this.ask(); }
}
