// The page as a whole: what is open, what the buttons and keys do, and what is shown where.

import { Charts } from "./charts.js";
import { Draw } from "./drawing.js";
import { Explanation } from "./explain.js";
import { Gallery } from "./gallery.js";
import { Pane } from "./pane.js";
import { Panel } from "./panel.js";
import { PairClock } from "./pair.js";
import { Searches, answer } from "./searched.js";
import { copyButton } from "./vector.js";
import { all, clamp, drawn, element, isNumber, one, oncePerPicture, paragraphs, save, say, wantsCalm, withUnit, written } from "./words.js";

const root = document.documentElement;
const button = (name) => one(`[data-do=${name}]`);
const at = { title: one("h1"), state: one("#state"), notice: one("#notice"), lost: one("#lost"), laboratory: one("#laboratory"),
  screens: one(".screens"), scrub: one(".scrub"), time: one(".time"), speed: one(".speed"), seed: one(".seed"), loop: one(".loop"),
  pace: one(".pace"), agent: one(".agent"), camera: one(".camera"), colour: one(".colour"), trails: one(".trails"), events: one("#events") };

// the first pane is the one that panel, charts and time speak of; `active` is the one whose agent is explained
let panes = [], active = null, given = null, clock = null, isAsking = false, drawsNext = false, program = "flockworks";
// what is said of something that is being opened, once it stands there
let toTell = "";
const lead = () => panes[0] ?? null;
const scene = () => lead()?.scene ?? null;
const isRun = () => scene()?.isRun === true;

// ------------------------------------------------ colours

const KEY = "flockworks-colours";
const preferred = matchMedia("(prefers-color-scheme: dark)");
const isDark = () => (root.dataset.theme ?? (preferred.matches ? "dark" : "light")) === "dark";
const showTheme = () => {
  button("theme").setAttribute("aria-pressed", String(isDark()));
  button("theme").setAttribute("aria-label", "Dark colours");
  button("theme").textContent = isDark() ? "Light" : "Dark";
  for (const pane of panes) pane.repaint();
  charts.repaint();
  gallery.repaint();
  searches.repaint();
  draw.repaint();
};
const switchTheme = () => {
  root.dataset.theme = isDark() ? "light" : "dark";
  try { localStorage.setItem(KEY, root.dataset.theme); } catch { /* it is forgotten, then */ }
  showTheme();
};

// ------------------------------------------------ messages to the user

const notice = (text) => { one("span", at.notice).textContent = text; at.notice.hidden = text === ""; };

let lostUntil = 0, countdown = 0;
function showConnection() {
  clearInterval(countdown);
  const lost = panes.filter(({ link }) => link?.state === "lost");
  const isLost = panes.some(({ link }) => link?.state !== "open");
  at.state.textContent = panes.length === 0 || !isLost ? program : lost.length ? "Connection lost" : "Connecting…";
  root.dataset.connection = panes.length === 0 || !isLost ? "open" : lost.length ? "lost" : "connecting";
  if (lost.length > 0) {
    lostUntil = Date.now() + 1000 * Math.max(...lost.map(({ link }) => link.seconds));
    const tell = () => {
      const left = Math.max(0, Math.ceil((lostUntil - Date.now()) / 1000));
      one("span", at.lost).textContent = `The connection to the server is lost; what you see is the last that came. Trying again${left > 0 ? ` in ${left}${"\u202f"}s` : ""}…`;
    };
    tell();
    countdown = setInterval(tell, 1000);
    at.lost.hidden = false;
  } else if (!isLost) at.lost.hidden = true;
}

// ------------------------------------------------ parts

const panel = new Panel(one("#parameters .controls"), (path, value) => { for (const pane of panes) pane.set(path, value); });
const charts = new Charts(one(".charts"), (t) => seekTime(t));
const explanation = new Explanation(one("#focal"));
const gallery = new Gallery(one("#gallery"), (what) => { location.hash = what.gallery === undefined ? `given=${what.given}` : `gallery=${encodeURIComponent(what.gallery)}`; });
const name = (text) => { at.title.textContent = text; document.title = text === "flockworks" ? text : `${text} · flockworks`; };
const searches = new Searches(one("#searched"), (number, place) => { location.hash = new URLSearchParams({ given: number, ...place }); }, name);
button("fit").after(copyButton("the scene", () => (active ?? lead())?.figure()));
const draw = new Draw(one("#drawing"), { notice, name, open: (file, text) => give(file, text) });

const PANEL_PAUSE = 100;
let shownAt = -Infinity, shownFor = "", pictures = 0, countedFrom = performance.now();

const told = {
  hello: (pane, hello) => {
    program = hello.program;
    given = hello.given;
    showConnection();
    if (pane.opened === null && pane.firstOpening) pane.open(pane.firstOpening);
    else if (isAsking) follow();
  },
  state: (pane, state, seconds) => { pane.link = { state, seconds }; showConnection(); },
  problem: (pane, text) => { notice(text); if (!pane.scene) pane.show("This could not be opened."); },
  scene: (pane, isSame) => {
    notice(toTell);
    toTell = "";
    pane.drawing && (pane.drawing.withTrails = at.trails.checked);
    if (pane !== lead()) { clock?.add(pane); showTitle(); return; }
    showScene(pane.scene, isSame);
    clock?.add(pane);
    if (!isSame && !pane.restores && !pane.scene.isRun && !wantsCalm()) pane.send({ do: "play" });
  },
  status: (pane) => { if (pane === lead()) showStatus(); },
  metrics: (pane, message) => {
    const index = panes.indexOf(pane);
    if (message.is === "metrics_all") charts.takeAll(index, message); else charts.add(index, message);
  },
  event: (pane, event) => {
    if (pane !== lead()) return;
    charts.addEvent(event);
    showEvent(event);
  },
  file: (pane, text) => {
    if (drawsNext) { drawsNext = false; draw.take("scenario.toml", text); location.hash = "draw"; return; }
    const name = pane.scene?.title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "scenario";
    save(`${name}.toml`, text, "application/toml");
  },
  drawn: (pane, now) => {
    pictures += 1;
    if (pane === lead()) {
      if (pane.frame) {
        const { frame } = pane;
        at.time.replaceChildren(`t = ${withUnit(frame.time, pane.scene.units.time, 5)}`, element("small", { textContent: whereIs(pane.scene, frame.step) }));
        at.time.dataset.step = frame.step;
        charts.showNow(frame.time);
        if (pane.scene.isRun && !at.scrub.matches(":active")) at.scrub.value = frameOf(frame.step);
      }
    }
    if (pane === (active ?? lead())) showFocal(pane, now);
  },
  picked: (pane, agent) => { activate(pane); focus(agent); },
};

// ------------------------------------------------ what is shown

// frames count from 0, as on the command line
const whereIs = (now, step) => (now.isRun && now.of ? `frame ${frameOf(step)} of ${now.frames - 1}${now.numbered && now.numbered.first !== 0 ? `, number ${now.numbered.first + now.numbered.by * frameOf(step)}` : ""}`
  : now.isRun ? `step ${step}, frame ${frameOf(step)} of ${now.frames - 1}` : `step ${step}${now.steps === null ? "" : ` of ${now.steps}`}`);
const frameOf = (step) => Math.round((step - scene().fromStep) / scene().everySteps);

const showTitle = () => name([...new Set(panes.map((pane) => pane.scene?.title).filter(Boolean))].join(" and "));

function showScene(now, isSame) {
  showTitle();
  const [first = "", ...rest] = paragraphs(now.about).map((text) => element("p", { textContent: text }));
  one("#about .about").replaceChildren(first, ...(rest.length ? [element("details", {}, element("summary", { textContent: "More" }), ...rest)] : []));
  root.dataset.kind = now.isRun ? "run" : "live";
  charts.begin(now);
  panel.show(now.controls);
  one("#parameters").hidden = now.controls.length === 0;
  button("save").hidden = now.isRun;
  button("go_on").hidden = !now.goesOn;
  one("#focal .hint").hidden = now.isRun && now.of !== "";
  one("#focal .hint.recorded-hint").hidden = now.of !== "tracks";
  one("#focal").hidden = now.of === "course";
  showRecordings();
  at.scrub.max = Math.max(0, now.frames - 1);
  at.seed.value = now.seed ?? "";
  at.agent.max = Math.max(0, now.agents - 1);
  at.events.hidden = true;
  one("ol", at.events).replaceChildren();
  now.events.forEach(showEvent);
  const duration = Math.max(1, (now.frames - 1) * now.everySteps);
  one(".event-marks").replaceChildren(...now.events.map((event) => drawn("rect", { class: event.kind, x: 1000 * (event.step - now.fromStep) / duration - 1, width: Math.max(3, 1000 * (event.untilStep - event.step) / duration), height: 6 })));
  const sample = (style, path) => { const svg = drawn("svg", { class: `sample ${style}`, viewBox: "-6 -5 13 10", "aria-hidden": "true" }); svg.append(drawn("path", { d: path })); return svg; };
  const entries = (names, count) => names.map((name, index) => element("li", {}, sample(`s${index % 7}`, "M6 0L-5 4L-2.5 0L-5-4z"),
    element("span", {}, name, count ? element("span", { className: "count", textContent: ` ${count[index]}` }) : "")));
  const byLabel = at.colour.value === "label" && now.labels.length > 0;
  one("#about .legend").replaceChildren(...(byLabel ? entries(now.labels[0].names, null)
    : entries(now.groups.map((group) => (group.title && group.title !== group.name ? `${group.name}: ${group.title}` : group.name)), now.of === "tracks" && now.groups.every(({ count }) => count === 1) ? null : now.groups.map(({ count }) => (count === 1 ? "1 agent" : `${count} agents`)))));
  one("#about .legend").classList.toggle("long", now.groups.length > 8);
  one(".colouring").hidden = now.labels.length === 0;
  if (!isSame) at.colour.replaceChildren(element("option", { value: "group", textContent: "by group" }), ...now.labels.map(({ column }) => element("option", { value: "label", textContent: `by ${column}` })));
  at.speed.title = now.isRun ? "Frames per second" : "Steps per second that are wanted";
  showStatus();
}

function showEvent(event) {
  at.events.hidden = false;
  const when = `t = ${withUnit(event.t, scene().units.time, 5)}`;
  // in a recording one goes there
  const shown = isRun() ? element("button", { type: "button", className: "quiet when", textContent: when, title: "Go there" }) : element("span", { className: "when", textContent: when });
  if (isRun()) shown.addEventListener("click", () => seek(frameOf(event.step)));
  one("ol", at.events).append(element("li", { className: event.kind }, shown, ` ${event.what}`));
}

/** A choice among the recordings of a folder. */
function showRecordings() {
  const place = one(".recordings"), own = given?.[lead()?.opened?.given], names = own?.recordings ?? [];
  const shown = panes.map((pane) => pane.opened?.at?.recording ?? own?.recording ?? 0);
  place.hidden = names.length < 2;
  if (place.hidden) return;
  const number = panes.length > 1 ? -1 : shown[0];
  one("select", place).replaceChildren(...(given.length > 1 ? [element("option", { value: -1, textContent: "the first two, side by side", selected: number === -1 })] : []), ...names.map((name, index) => element("option", { value: index, textContent: name, selected: index === number })));
}

const LIVE_RATES = [1, 2, 5, 10, 20, 30, 60, 120, 250, 0], RUN_RATES = [1, 2, 5, 10, 20, 30, 60];
const ICONS = { pause: "M3.5 2.5h3v11h-3zM9.5 2.5h3v11h-3z", play: "M4 2.5v11L13 8z", reverse: "M12 2.5v11L3 8z" };

function showStatus() {
  const pane = lead(), status = pane?.status ?? {};
  const way = wayNow();
  for (const [name, sign, word] of [["play", 1, "Play"], ["reverse", -1, "Play backwards"]]) {
    button(name).setAttribute("aria-pressed", String(way === sign));
    button(name).setAttribute("aria-label", way === sign ? "Pause" : word);
    one("path", button(name)).setAttribute("d", ICONS[way === sign ? "pause" : name]);
  }
  const rates = isRun() ? RUN_RATES : LIVE_RATES;
  const rate = clock ? clock.rate : isNumber(status.rate) ? Math.abs(status.rate) : 30;
  const offered = rates.includes(rate) ? rates : [...rates, rate].sort((a, b) => (a || Infinity) - (b || Infinity));
  if (at.speed.dataset.rates !== `${isRun()}${offered}`) {
    at.speed.dataset.rates = `${isRun()}${offered}`;
    const word = isRun() ? "frames/s" : "steps/s";
    at.speed.replaceChildren(...offered.map((value) => element("option", { value, textContent: value === 0 ? "as fast as possible" : `${written(value, 4)}\u202f${word}` })));
  }
  at.speed.value = String(rate);
  at.camera.value = pane?.camera ?? "still";
  if (pane) pane.loop = at.loop.checked;
  showPace();
}

function showPace() {
  const passed = (performance.now() - countedFrom) / 1000;
  if (passed > 1) {
    at.pace.dataset.pictures = (pictures / passed / Math.max(1, panes.length)).toFixed(1);
    [pictures, countedFrom] = [0, performance.now()];
  }
  const { playing, reached } = lead()?.status ?? {};
  const drawing = at.pace.dataset.pictures ? `${at.pace.dataset.pictures} pictures/s` : "";
  at.pace.textContent = playing ? [isNumber(reached) && !isRun() ? `${written(reached, 3)} steps/s` : "", drawing].filter(Boolean).join(", ") : "";
}

/** The tables, not more often than one can read. */
function showFocal(pane, now) {
  const current = pane.focal === null ? null : pane.explanation;
  if (current === null && pane.focal !== null) return;
  const isPlaying = clock ? clock.way !== 0 : pane.status?.playing;
  const camera = pane.drawing?.camera;
  const key = current === null ? "nobody" : `${current.agent} ${current.step} ${camera?.isSpace ? [camera.turn, camera.tilt] : ""}`;
  if (current !== null && key === shownFor && current === explanation.current) return;
  if (key === shownFor && current === null) return;
  if (isPlaying && current !== null && shownFor !== "nobody" && now - shownAt < PANEL_PAUSE) return;
  [shownAt, shownFor, explanation.current] = [now, key, current];
  explanation.show(current, pane);
}

// ------------------------------------------------ what is done

function activate(pane) {
  if (active && active !== pane && active.focal !== null) active.focus(null);
  active = pane;
  panes.forEach((one) => one.place.classList.toggle("active", panes.length > 1 && one === pane));
}

function focus(agent) {
  const pane = active ?? lead();
  if (!pane?.scene) return;
  const isThere = agent !== null && agent >= 0 && agent < pane.scene.agents;
  pane.focus(isThere ? agent : null);
  if (!isThere && pane.camera === "agent") pane.setCamera("still");
  at.agent.value = isThere ? agent : "";
  at.agent.setAttribute("aria-invalid", String(agent !== null && !isThere));
  say(isThere ? `Agent ${agent}` : "Nobody is explained");
  showStatus();
}
const focusNext = (by) => {
  const pane = active ?? lead(), count = pane?.scene?.agents ?? 0;
  if (count > 0) focus(pane.focal === null ? (by > 0 ? 0 : count - 1) : (pane.focal + by + count) % count);
};

const toAll = (message) => { for (const pane of panes) pane.send(message); };
const play = (way) => {
  if (clock) { clock.run(clock.way === way ? 0 : way); return; }
  const status = lead()?.status ?? {};
  if (isRun()) {
    const before = status.playing ? Math.sign(status.rate || 1) : 0;
    if (before === way) { toAll({ do: "pause" }); return; }
    toAll({ do: "speed", rate: way * Number(at.speed.value || 20) });
    toAll({ do: "play" });
  } else toAll({ do: status.playing ? "pause" : "play" });
};
/** The way time goes: forwards, backwards, or not. */
const wayNow = () => {
  if (clock) return clock.way;
  const status = lead()?.status ?? {};
  return status.playing ? (isRun() && status.rate < 0 ? -1 : 1) : 0;
};
const step = (count) => { if (clock) clock.step(count); else if (isRun() || count > 0) toAll({ do: "step", count }); };
const seek = oncePerPicture((frame) => { if (clock) clock.seekFrame(frame); else toAll({ do: "seek", frame }); });
const seekTime = (t) => { if (scene()) seek(clamp(frameOf(t / scene().step), 0, Math.max(0, scene().frames - 1))); };
const reset = () => {
  const seed = at.seed.valueAsNumber;
  toAll({ do: "reset", seed: Number.isSafeInteger(seed) && seed >= 0 ? seed : null });
};
const forEachPane = (act) => panes.forEach(act);
const follows = () => { const to = (lead()?.camera === "agent") ? "still" : "agent"; forEachPane((pane) => pane.setCamera(to)); showStatus(); };
const flip = (box) => { box.checked = !box.checked; box.dispatchEvent(new Event("change")); };

const searchOf = (words) => { const number = Number(words.get("given") ?? 0); return given?.[number]?.kind === "search" ? number : null; };
const acts = {
  gallery: () => { location.hash = "all"; },
  overview: () => { const number = searchOf(new URLSearchParams(location.hash.slice(1))); if (number !== null) location.hash = `given=${number}`; },
  draw: () => { if (at.laboratory.hidden || isRun() || !lead()?.scene) location.hash = "draw"; else lead().send({ do: "save" }), drawsNext = true; },
  keys: () => one("#keys").showModal(),
  theme: switchTheme,
  dismiss: () => notice(""),
  reconnect: () => forEachPane((pane) => pane.connection.again()),
  first: () => { if (clock) clock.run(0); seek(0); },
  last: () => { if (clock) clock.run(0); seek(Number(at.scrub.max)); },
  back: () => step(-1), forth: () => step(1),
  reverse: () => play(-1), play: () => play(1),
  reset, fit: () => { forEachPane((pane) => { if (pane.camera !== "still") pane.camera = "still"; pane.fit(); }); showStatus(); },
  save: () => lead()?.send({ do: "save" }),
  go_on: () => { if (!scene()?.goesOn) return; lead().send({ do: "go_on" }); say("Next formation"); },
  previous: () => focusNext(-1), next: () => focusNext(1), nobody: () => focus(null),
  closer: () => { (active ?? lead())?.closer(); showStatus(); },
};
for (const [name, act] of Object.entries(acts)) button(name).addEventListener("click", act);
at.scrub.addEventListener("input", () => { if (clock) clock.run(0); else if (lead()?.status?.playing) toAll({ do: "pause" }); seek(Number(at.scrub.value)); });
at.speed.addEventListener("change", () => {
  const rate = Number(at.speed.value);
  if (clock) clock.rate = rate;
  else toAll({ do: "speed", rate: isRun() && lead()?.status?.rate < 0 ? -rate : rate });
});
at.loop.addEventListener("change", () => { if (clock) clock.loop = at.loop.checked; else toAll({ do: "loop", on: at.loop.checked }); showStatus(); });
one(".recordings select").addEventListener("change", (event) => { const number = Number(event.target.value); location.hash = number < 0 ? "" : new URLSearchParams({ given: 0, recording: number }); });
at.seed.addEventListener("keydown", (event) => { if (event.key === "Enter") reset(); });
at.agent.addEventListener("input", () => focus(Number.isInteger(at.agent.valueAsNumber) ? at.agent.valueAsNumber : null));
at.camera.addEventListener("change", () => forEachPane((pane) => pane.setCamera(at.camera.value)));
at.trails.addEventListener("change", () => forEachPane((pane) => { if (pane.drawing) { pane.drawing.withTrails = at.trails.checked; pane.request(); } }));
at.colour.addEventListener("change", () => {
  forEachPane((pane) => { if (pane.drawing) { pane.drawing.byLabel = at.colour.value === "label"; pane.request(); } });
  showScene(scene(), true);
});

// ------------------------------------------------ keys

const KEYS = [
  ["Space", "play or pause", { " ": () => play(wayNow() || 1) }],
  ["B", "play a run backwards", { b: () => isRun() && acts.reverse() }],
  ["→ and ←", "one step on; in a run, back as well", { ArrowRight: () => step(1), ArrowLeft: () => step(-1) }],
  ["Page Up, Page Down", "ten steps", { PageDown: () => step(10), PageUp: () => step(-10) }],
  ["Home, End", "first and last frame of a run", { Home: () => isRun() && acts.first(), End: () => isRun() && acts.last() }],
  ["R", "back to the start", { r: () => !isRun() && reset() }],
  ["L", "loop a run", { l: () => isRun() && flip(at.loop) }],
  ["N, P", "next and previous agent", { n: acts.next, p: acts.previous }],
  ["A", "type the number of an agent", { a: () => at.agent.focus() }],
  ["F", "follow the agent with the camera", { f: follows }],
  ["Z", "go near the agent", { z: acts.closer }],
  ["Escape", "explain nobody; put a message away", { Escape: () => (at.notice.hidden ? focus(null) : notice("")) }],
  ["+ and −, or the wheel", "zoom", { "+": () => forEachPane((pane) => pane.zoom(1.2)), "=": () => forEachPane((pane) => pane.zoom(1.2)), "-": () => forEachPane((pane) => pane.zoom(1 / 1.2)) }],
  ["Shift and arrows, or drag", "move a flat view, turn a view in space", {}],
  ["Shift and drag", "move a view in space", {}],
  ["0", "see everything", { 0: acts.fit }],
  ["T", "trails", { t: () => flip(at.trails) }],
  ["G", "robots in the places of walls: the next formation", { g: acts.go_on }],
  ["S", "save the scenario", { s: () => !isRun() && acts.save() }],
  ["M", "the gallery", { m: acts.gallery }],
  ["U", "the overview of a search", { u: acts.overview }],
  ["W", "draw", { w: acts.draw }],
  ["D", "light or dark", { d: switchTheme }],
  ["?", "this list", { "?": acts.keys }],
];
const TURNS = { ArrowLeft: [-14, 0], ArrowRight: [14, 0], ArrowUp: [0, -14], ArrowDown: [0, 14] };
const keyed = Object.assign({}, ...KEYS.map(([, , does]) => does));
one("#keys tbody").append(...KEYS.map(([key, what]) => element("tr", {}, element("th", { scope: "row", textContent: key }), element("td", { textContent: what }))));
document.addEventListener("keydown", (event) => {
  if (event.altKey || event.ctrlKey || event.metaKey || event.defaultPrevented || one("#keys").open) return;
  const own = event.target.closest?.("input, select, textarea, button, summary");
  // what a control does with a key by itself, it keeps
  if (own?.matches("select, textarea, input[type=number]") && event.key !== "Escape") return;
  if (own && ([" ", "Enter"].includes(event.key) || (own.matches("input[type=range]") && /^(Arrow|Page|Home|End)/.test(event.key)))) return;
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const isGeneral = ["m", "u", "w", "d", "?"].includes(key);
  if (at.laboratory.hidden && !isGeneral) return;
  const turn = event.shiftKey ? TURNS[key] : null;
  const act = turn ? () => forEachPane((pane) => pane.move(...turn)) : keyed[key];
  if (!act) return;
  event.preventDefault();
  act();
});

// ------------------------------------------------ what is open

function closePanes() {
  clock?.end();
  panes.forEach((pane) => pane.end());
  [panes, active, clock] = [[], null, null];
  explanation.show(null, null);
  shownFor = "nobody";
  at.agent.value = "";
}

function openPanes(openings) {
  leave();
  at.laboratory.hidden = false;
  clock = openings.length > 1 ? new PairClock(() => panes, () => showStatus()) : null;
  at.screens.classList.toggle("pair", openings.length > 1);
  panes = openings.map((what, index) => {
    const place = element("div", { className: "screen" });
    at.screens.append(place);
    const own = given?.[what?.given], recorded = own?.recordings?.length > 1 ? own.recordings[own.recording ?? 0] : own?.name;
    const name = openings.length > 1 ? `Run ${index + 1}${recorded ? `: ${recorded}` : ""}` : "Scene";
    if (openings.length > 1) place.append(element("p", { className: "name", textContent: name }));
    const pane = new Pane(place, told, name);
    pane.firstOpening = what;
    return pane;
  });
  showStatus();
}

/** Leaves whatever is shown. */
function leave() {
  closePanes();
  gallery.hide();
  searches.hide();
  draw.hide();
  at.laboratory.hidden = true;
}

/** Opens what the address says; without a word, what the command line named, or else the gallery. */
function follow() {
  const words = new URLSearchParams(location.hash.slice(1));
  const isPair = given?.length === 2 && given.every(({ kind }) => kind === "run");
  const number = Number(words.get("given"));
  const place = Object.fromEntries([...words].filter(([key]) => key !== "given").map(([key, value]) => [key, Number(value)]));
  const openings = words.has("gallery") ? [{ gallery: words.get("gallery") }]
    : words.has("all") || words.has("draw") ? [] : given === null ? null
      : words.has("given") && Number.isInteger(number) ? [{ given: number, at: place }]
        : isPair ? [{ given: 0 }, { given: 1 }] : given.length === 1 ? [{ given: 0, at: {} }] : [];
  const search = openings?.length === 1 ? searchOf(words) : null;
  button("overview").hidden = search === null || Object.keys(place).length === 0;
  if (search !== null && Object.keys(openings[0].at).length === 0) {
    leave();
    showConnection();
    delete root.dataset.kind;
    searches.show(search);
    return;
  }
  if (words.has("draw")) {
    leave();
    showConnection();
    delete root.dataset.kind;
    draw.show();
    return;
  }
  // what the command line named, only the server knows
  isAsking = openings === null;
  if (isAsking) { openPanes([null]); return; }
  // the connection that was made to ask what there is serves for it
  const asking = panes.length === 1 && panes[0].opened === null && panes[0].firstOpening === null;
  if (openings.length === 1 && asking && panes[0].connection.isOpen) { panes[0].open(openings[0]); return; }
  if (openings.length > 0) { openPanes(openings); return; }
  leave();
  showConnection();
  name("flockworks");
  delete root.dataset.kind;
  gallery.show(given ?? []);
}

// ------------------------------------------------ files that are dropped on the page

/** Opens what the server took: its answer to files that were handed over. */
function openGiven({ given: number, all: list, told = "" }) {
  given = list;
  toTell = told;
  const to = `#given=${number}`;
  if (location.hash === to) follow(); else location.hash = to;
}

/** Hands a file over to the server, and opens it. */
async function give(name, text) {
  try { openGiven(await answer("given", { method: "POST", body: `${name.replaceAll("\n", " ")}\n${text}` })); }
  catch (error) { notice(`${name} cannot be opened. ${error.message}`); }
}

const MOST_DROPPED = 512 * 1024 * 1024;

/** All files of what was dropped, with their paths. */
async function filesOf(entry, path = "") {
  if (entry.isFile) return [{ path: path + entry.name, file: await new Promise((resolve, reject) => { entry.file(resolve, reject); }) }];
  const reader = entry.createReader(), found = [];
  for (;;) {
    const some = await new Promise((resolve, reject) => { reader.readEntries(resolve, reject); });
    if (some.length === 0) break;
    for (const one of some) found.push(...await filesOf(one, `${path}${entry.name}/`));
  }
  return found;
}

/** Hands over files as they are: a line that says which, then one after the other. */
async function giveFiles(files) {
  const name = files[0].path.split("/")[0];
  const size = files.reduce((sum, { file }) => sum + file.size, 0);
  if (size > MOST_DROPPED) { notice(`${name} is larger than ${MOST_DROPPED >> 20} MB, which is too much to hand over; name it on the command line: flockworks view ${name}`); return; }
  notice(`Opening ${name}…`);
  try {
    const head = JSON.stringify(files.map(({ path, file }) => ({ path, size: file.size })));
    const told = await answer("dropped", { method: "POST", body: new Blob([`${head}\n`, ...files.map(({ file }) => file)]) });
    notice("");
    openGiven(told);
  } catch (error) { notice(`${name} cannot be opened. ${error.message}`); }
}

document.addEventListener("dragover", (event) => { if (event.dataTransfer?.types.includes("Files")) { event.preventDefault(); root.dataset.drop = "over"; } });
document.addEventListener("dragleave", (event) => { if (event.relatedTarget === null) delete root.dataset.drop; });
document.addEventListener("drop", async (event) => {
  delete root.dataset.drop;
  const entries = [...(event.dataTransfer?.items ?? [])].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  const files = [...(event.dataTransfer?.files ?? [])];
  if (files.length === 0) return;
  event.preventDefault();
  const [file] = files;
  try {
    if (entries.some((entry) => entry.isDirectory) || files.length > 1) {
      const found = entries.length ? (await Promise.all(entries.map((entry) => filesOf(entry)))).flat() : files.map((one) => ({ path: one.name, file: one }));
      if (found.length > 0) await giveFiles(found); else notice(`${file.name} is empty.`);
      return;
    }
    // drawings are drawn on; where one draws already, scenarios are too
    const isDrawing = /\.(svg|geojson|json|wkt)$/i.test(file.name) || (!one("#drawing").hidden && /\.toml$/i.test(file.name));
    if (isDrawing) { draw.take(file.name, await file.text()); location.hash = "draw"; }
    else if (/\.toml$/i.test(file.name)) await give(file.name, await file.text());
    else await giveFiles([{ path: file.name, file }]);
  } catch (error) { notice(`${file.name} cannot be read: ${error.message}.`); }
});

try { if (["light", "dark"].includes(localStorage.getItem(KEY))) root.dataset.theme = localStorage.getItem(KEY); } catch { /* the system's colours, then */ }
preferred.addEventListener("change", showTheme);
addEventListener("hashchange", follow);
setInterval(showPace, 1000);
follow();
showTheme();
