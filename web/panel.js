// The parameters of a scene as labelled controls: name, symbol, unit, range, help, and the way back to the default.

import { all, element, isNumber, oncePerPicture, titled, withUnit, written } from "./words.js";

const PARTS = 200;
let counted = 0;

const stepOf = (control) => {
  if (control.step !== null && control.step > 0) return control.step;
  if (control.kind === "whole") return 1;
  return control.low !== null && control.high !== null && control.high > control.low ? (control.high - control.low) / PARTS : "any";
};

const rangeText = (control) => {
  const { low, high, unit } = control;
  if (low !== null && high !== null) return `From ${written(low)} to ${withUnit(high, unit)}.`;
  if (low !== null) return `At least ${withUnit(low, unit)}.`;
  return high !== null ? `At most ${withUnit(high, unit)}.` : "";
};
const valueText = (control, value) => (typeof value === "boolean" ? (value ? "on" : "off") : isNumber(value) ? withUnit(value, control.unit) : String(value));

/** One control: its element, and `show(value)`. */
function made(control, set) {
  const id = `control-${counted += 1}`, isNumeric = control.kind === "number" || control.kind === "whole";
  const send = oncePerPicture((value) => set(control.path, value));
  const isDefault = (value) => value === control.default;
  const inputs = [];
  const back = element("button", { type: "button", className: "quiet back", textContent: "↺", title: `Back to ${valueText(control, control.default)}` });
  back.setAttribute("aria-label", `${control.name}: back to ${valueText(control, control.default)}`);
  let current = control.value;
  const show = (value, from = null) => {
    current = value;
    for (const input of inputs) {
      if (input === from || (from === null && input === document.activeElement && input.type === "number")) continue;
      if (input.type === "checkbox") input.checked = value === true;
      else input.value = isNumber(value) ? String(Number(value.toPrecision(10))) : String(value ?? "");
    }
    back.disabled = control.default === null || isDefault(value);
    box.classList.toggle("changed", !back.disabled);
  };
  const change = (value, from = null) => { show(value, from); send(value); };
  const numeric = (input) => {
    const value = input.valueAsNumber;
    const isAllowed = Number.isFinite(value) && input.value !== "" && (control.low === null || value >= control.low)
      && (control.high === null || value <= control.high) && (control.kind !== "whole" || Number.isInteger(value));
    input.setAttribute("aria-invalid", String(!isAllowed));
    if (isAllowed) change(value, input);
  };
  const limits = { ...(control.low === null ? {} : { min: control.low }), ...(control.high === null ? {} : { max: control.high }) };
  const help = element("p", { className: "help", id: `${id}-help`, hidden: true,
    textContent: [control.about, rangeText(control), control.default === null ? "" : `Default: ${valueText(control, control.default)}.`].filter(Boolean).join(" ") });
  const ask = element("button", { type: "button", className: "quiet ask", textContent: "?", title: help.textContent });
  ask.setAttribute("aria-label", `What is ${control.name}?`);
  ask.setAttribute("aria-expanded", "false");
  ask.setAttribute("aria-controls", help.id);
  ask.addEventListener("click", () => {
    help.hidden = !help.hidden;
    ask.setAttribute("aria-expanded", String(!help.hidden));
  });
  const label = element("label", { htmlFor: id }, control.name);
  if (control.symbol) {
    const [symbol, ...index] = control.symbol.split("_");
    label.append(" ", element("var", {}, symbol, index.length ? element("sub", { textContent: index.join("_") }) : null));
  }
  const shared = { title: help.textContent };
  const row = element("div", { className: "row" });
  if (isNumeric) {
    const step = stepOf(control);
    const field = element("input", { type: "number", id, step: control.kind === "whole" ? 1 : "any", inputMode: "decimal", ...limits, ...shared });
    field.addEventListener("input", () => numeric(field));
    field.addEventListener("blur", () => { field.setAttribute("aria-invalid", "false"); show(current); });
    if (control.low !== null && control.high !== null) {
      const slider = element("input", { type: "range", ...limits, step, ...shared });
      slider.setAttribute("aria-label", titled(control.name, control.unit));
      slider.addEventListener("input", () => numeric(slider));
      inputs.push(slider);
      row.append(slider);
    }
    inputs.push(field);
    row.append(field, element("span", { className: "unit", textContent: control.unit === "1" ? "" : control.unit }));
  } else if (control.kind === "truth") {
    const box = element("input", { type: "checkbox", id, ...shared });
    box.addEventListener("change", () => change(box.checked, box));
    inputs.push(box);
    row.append(box);
  } else {
    const choice = element("select", { id, ...shared }, ...control.words.map((word) => element("option", { value: word, textContent: word })));
    choice.addEventListener("change", () => change(choice.value, choice));
    inputs.push(choice);
    row.append(choice);
  }
  back.addEventListener("click", () => change(control.default));
  const box = element("div", { className: `control ${control.kind}` }, element("div", { className: "name" }, label, ask, back), row, help);
  box.dataset.path = control.path;
  show(control.value);
  return { box, show };
}

export class Panel {
  constructor(place, set) {
    Object.assign(this, { place, set, paths: "", shown: new Map() });
  }

  /** Builds the controls, or shows new values in those that are there: who is typing keeps the place. */
  show(controls) {
    const signature = JSON.stringify(controls.map(({ value, ...rest }) => rest));
    if (signature === this.paths) {
      for (const control of controls) this.shown.get(control.path).show(control.value);
      return;
    }
    this.paths = signature;
    this.shown.clear();
    const groups = new Map();
    for (const control of controls) {
      const one = made(control, this.set);
      this.shown.set(control.path, one);
      if (!groups.has(control.group)) groups.set(control.group, []);
      groups.get(control.group).push(one.box);
    }
    this.place.replaceChildren(...[...groups].map(([name, boxes], index) => element("details", { open: index < 2 || groups.size < 4 },
      element("summary", { textContent: name || "World" }), ...boxes)));
  }

  get count() { return all(".control", this.place).length; }
}
