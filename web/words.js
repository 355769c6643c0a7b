// Numbers, units and elements, written as the report page writes them.

export const THIN = "\u202f", MINUS = "\u2212";

export const one = (selector, within = document) => within.querySelector(selector);
export const all = (selector, within = document) => [...within.querySelectorAll(selector)];
export const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
export const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

/** A number with at most so many digits. */
export const written = (value, digits = 7) => {
  if (!isNumber(value)) return "missing";
  const size = Math.abs(value);
  const inPowers = size !== 0 && (size < 1e-3 || size >= 1e7);
  const text = inPowers
    ? value.toExponential(Math.min(digits, 7) - 1).replace(/(\.\d*?)0*e\+?/, "$1e").replace(".e", "e")
    : String(Number(value.toPrecision(digits)));
  return text.replace(/^-/, MINUS).replace("e-", `e${MINUS}`);
};

/** Whether a quantity is a bare number. */
export const isBare = (unit) => ["", "1", "-"].includes((unit ?? "").trim());

export const withUnit = (value, unit, digits = 7) => {
  const text = written(value, digits);
  return text === "missing" || isBare(unit) ? text : text + THIN + unit.trim();
};

export const titled = (title, unit) => (isBare(unit) ? title : `${title} (${unit.trim()})`);

/** An element with properties and children. */
export const element = (name, properties = {}, ...children) => {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key in made) made[key] = value; else made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== null));
  return made;
};

/** An element of a drawing. */
export const drawn = (name, attributes = {}, text = null) => {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== null) made.textContent = text;
  return made;
};

/** The paragraphs of a text whose lines were broken by hand. */
export const paragraphs = (text) => text.split(/\n\s*\n/).map((part) => part.replace(/\s+/g, " ").trim()).filter(Boolean);

/** Tells those who listen instead of looking. */
export const say = (text) => { one("#said").textContent = text; };

export const save = (name, text, type) => {
  const link = element("a", { href: URL.createObjectURL(new Blob([text], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  say(`${name} was made`);
};

/** A round length, 1, 2 or 5 times a power of ten, of at most so much. */
export const roundLength = (most) => {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].map((digit) => digit * power).find((length) => length <= most * (1 + 1e-9)) ?? power;
};

/** Does something at most once in a picture of the screen, with what was asked for last. */
export const oncePerPicture = (act) => {
  let asked = null, waits = false;
  return (...what) => {
    asked = what;
    if (waits) return;
    waits = true;
    requestAnimationFrame(() => { waits = false; act(...asked); });
  };
};

/** Colours of the style sheet by name, as three numbers from 0 to 1. */
export const colours = () => {
  const looks = getComputedStyle(document.documentElement);
  const named = (name) => looks.getPropertyValue(`--${name}`).trim();
  const parts = (name) => [1, 3, 5].map((at) => parseInt(named(name).slice(at, at + 2), 16) / 255);
  const names = ["ground", "stage", "text", "faint", "rule", "grid", "obstacle", "accent"];
  return {
    ...Object.fromEntries(names.map((name) => [name, parts(name)])),
    series: [0, 1, 2, 3, 4, 5, 6].map((index) => parts(`series-${index}`)),
    css: named,
  };
};

export const wantsCalm = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
