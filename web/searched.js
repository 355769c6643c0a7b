// Searches: studies, evolutions, designs, maps, optimisations, decompositions, formations. Each kind is one file and one line of this list.

import { DecompositionView } from "./decomposition.js";
import { DesignView } from "./design.js";
import { EvolutionView } from "./evolution.js";
import { FormationView } from "./formation.js";
import { MapView } from "./map.js";
import { OptimisationView } from "./optimisation.js";
import { StudyView } from "./study.js";
import { element, one, paragraphs } from "./words.js";

const VIEWS = { study: StudyView, evolution: EvolutionView, design: DesignView, map: MapView, optimisation: OptimisationView, decomposition: DecompositionView, formation: FormationView };

/** What the server answers to a question of plain JSON. */
export async function answer(address, options = {}) {
  const response = await fetch(address, options);
  if (!response.ok) throw new Error(`the server answered ${response.status}`);
  const value = await response.json();
  if (typeof value?.problem === "string") throw new Error(value.problem);
  return value;
}

export class Searches {
  /** `watch(given, place)` opens the laboratory at a place of a search; `titled(text)` names the page. */
  constructor(place, watch, titled) { Object.assign(this, { place, watch, titled, shown: new Map(), view: null }); }

  async show(given) {
    this.place.hidden = false;
    this.given = given;
    const state = one(".state", this.place), box = one(".view", this.place);
    if (!this.shown.has(given)) {
      box.replaceChildren();
      state.textContent = "Opening…";
      try {
        const overview = await answer(`search/${given}`);
        const View = VIEWS[overview?.kind];
        if (!View) throw new Error("a search of a kind that this page does not know");
        const part = (words) => answer(`search/${given}/part?${new URLSearchParams(words)}`);
        this.shown.set(given, { overview, view: new View(overview, { part, watch: (at) => this.watch(given, at), say: (text) => { state.textContent = text; } }) });
      } catch (error) {
        state.textContent = `This could not be opened: ${error.message}.`;
        return;
      }
    }
    // another may have been asked for in the meantime
    if (this.given !== given || this.place.hidden) return;
    state.textContent = "";
    const { overview, view } = this.shown.get(given);
    this.titled(overview.title);
    const [first = "", ...rest] = paragraphs(String(overview.about ?? "")).map((text) => element("p", { textContent: text }));
    const about = element("div", { className: "about" }, first, ...(rest.length ? [element("details", {}, element("summary", { textContent: "More" }), ...rest)] : []));
    box.replaceChildren(about, view.box);
    this.view = view;
    view.appear();
  }

  hide() { this.place.hidden = true; this.view = null; this.given = null; }
  repaint() { this.view?.repaint(); }
}

/** A labelled choice; `act` is called with the chosen place in the list. */
export function choice(label, names, chosen, act, title = "") {
  const select = element("select", {}, ...names.map((name, index) => element("option", { value: index, textContent: name, selected: index === chosen })));
  select.addEventListener("change", () => act(Number(select.value)));
  return element("label", { title }, `${label} `, select);
}

/** A table of values: rows of a heading and cells. */
export const table = (caption, heads, rows) => element("table", { className: "values" }, element("caption", { textContent: caption }),
  ...(heads.length ? [element("thead", {}, element("tr", {}, ...heads.map((text) => element("th", { scope: "col", textContent: text }))))] : []),
  element("tbody", {}, ...rows.map(([head, ...cells]) => element("tr", {}, element("th", { scope: "row", textContent: head }),
    ...cells.map((cell) => (cell instanceof Node ? element("td", {}, cell) : element("td", { className: "number", textContent: cell })))))));

/** Arrow keys go from cell to cell of a grid, over so many places at most where there is none. */
export function walk(event, grid, gaps = 0) {
  const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  const { x, y } = event.target.dataset ?? {};
  if (!step || x === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
  event.preventDefault();
  event.stopPropagation();
  for (let far = 1; far <= gaps + 1; far += 1) {
    const next = one(`[data-x="${Number(x) + far * step[0]}"][data-y="${Number(y) + far * step[1]}"]`, grid);
    if (!next) continue;
    event.target.tabIndex = -1;
    next.tabIndex = 0;
    next.focus();
    return;
  }
}
