"use strict";
// The page shows its charts, scenes and words without this. Added here: read-outs, the player, downloads, colours.
(() => {
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  const one = (selector, within = document) => within.querySelector(selector);
  const figures = JSON.parse(one("#figures").textContent);
  const root = document.documentElement;
  const THIN = "\u202f", MINUS = "\u2212", MISSING = "missing";

  // ---------------------------------------------------------------- words and numbers

  /** A number with at most seven digits. */
  const written = (value) => {
    if (value === null || !Number.isFinite(value)) return MISSING;
    const size = Math.abs(value);
    const inPowers = size !== 0 && (size < 1e-3 || size >= 1e7);
    const text = inPowers
      ? value.toExponential(6).replace(/\.?0*e\+?/, "e")
      : String(Number(value.toPrecision(7)));
    return text.replace(/^-/, MINUS);
  };
  const withUnit = (value, unit) => {
    const text = written(value);
    return text === MISSING || unit.trim() === "" || unit.trim() === "1" ? text : text + THIN + unit.trim();
  };
  const titled = (axis) => (["", "1"].includes(axis.unit.trim()) ? axis.label : `${axis.label} (${axis.unit})`);
  const say = (text) => { one("#said").textContent = text; };
  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  /** An element with properties and children. */
  const element = (name, properties = {}, ...children) => {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  };
  const drawn = (name, attributes) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
  };

  // ---------------------------------------------------------------- colours

  const onColours = [];
  const preferred = matchMedia("(prefers-color-scheme: dark)");
  const KEY = "flockworks-colours";
  const remembered = () => { try { return localStorage.getItem(KEY); } catch { return null; } };
  const remember = (theme) => { try { localStorage.setItem(KEY, theme); } catch { /* it is forgotten, then */ } };
  const themeButton = one("#theme");
  const isDark = () => (root.dataset.theme ?? (preferred.matches ? "dark" : "light")) === "dark";
  const showTheme = () => {
    themeButton.setAttribute("aria-pressed", String(isDark()));
    themeButton.setAttribute("aria-label", "Dark colours");
    themeButton.textContent = isDark() ? "Light" : "Dark";
    for (const repaint of onColours) repaint();
  };
  if (["light", "dark"].includes(remembered())) root.dataset.theme = remembered();
  themeButton.addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    remember(root.dataset.theme);
    showTheme();
  });
  preferred.addEventListener("change", showTheme);

  /** Does something in light colours: what is printed or saved stands on white. */
  const inLight = (act) => {
    const before = root.dataset.theme;
    root.dataset.theme = "light";
    const result = act();
    if (before === undefined) delete root.dataset.theme; else root.dataset.theme = before;
    return result;
  };

  // ---------------------------------------------------------------- files

  const save = (name, blob) => {
    const link = element("a", { href: URL.createObjectURL(blob), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    say(`${name} was made`);
  };
  const saveText = (name, text, type) => save(name, new Blob([text], { type: `${type};charset=utf-8` }));
  const cell = (text) => (/[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

  const LOOKS = ["fill", "stroke", "stroke-width", "stroke-linecap", "stroke-linejoin", "stroke-dasharray", "paint-order",
    "font-family", "font-size", "font-style"];

  /** A drawing as a file of its own, with its data: what the style sheet says is written into its elements. */
  const alone = (svg, data) => inLight(() => {
    const copy = svg.cloneNode(true);
    const originals = all("*", svg), copies = all("*", copy);
    originals.forEach((original, index) => {
      const looks = getComputedStyle(original);
      for (const look of LOOKS) copies[index].setAttribute(look, looks.getPropertyValue(look));
      copies[index].removeAttribute("class");
    });
    for (const temporary of all("[data-temporary]", copy)) temporary.remove();
    const { width, height } = svg.viewBox.baseVal;
    copy.setAttribute("width", width * 2);
    copy.setAttribute("height", height * 2);
    for (const attribute of ["class", "tabindex"]) copy.removeAttribute(attribute);
    copy.prepend(drawn("rect", { width, height, fill: "#ffffff" }));
    if (data) {
      const metadata = drawn("metadata", {});
      metadata.textContent = data;
      copy.prepend(metadata);
    }
    return new XMLSerializer().serializeToString(copy);
  });

  /** The data of a chart: a column for each line, or rows of (line, x, y) where the lines have different places. */
  const csv = (chart) => {
    const value = (number) => (number === null || number === undefined ? "" : String(number));
    const rows = [];
    const named = (x) => chart.x.names?.[x] ?? value(x);
    if (chart.places.length <= 1) {
      const columns = (line) => (line.spread ? [line.name, `${line.name} (${chart.spread})`] : [line.name]);
      const values = (line, at) => (line.spread ? [value(line.y[at]), value(line.spread[at])] : [value(line.y[at])]);
      rows.push([titled(chart.x), ...chart.lines.flatMap(columns)]);
      (chart.places[0] ?? []).forEach((x, at) => rows.push([named(x), ...chart.lines.flatMap((line) => values(line, at))]));
    } else {
      const spread = chart.lines.some((line) => line.spread);
      rows.push(["line", titled(chart.x), titled(chart.y), ...(spread ? [chart.spread] : [])]);
      for (const line of chart.lines) {
        line.y.forEach((y, at) => rows.push([
          line.name, named(chart.places[line.x][at]), value(y), ...(spread ? [value(line.spread?.[at])] : [])]));
      }
    }
    return rows.map((row) => row.map(cell).join(",") + "\n").join("");
  };

  /** The first rows of a CSV text, as rows of cells. */
  const rowsOf = (text, most) => {
    const rows = [];
    let row = [], part = "", quoted = false;
    for (let at = 0; at < text.length && rows.length < most; at += 1) {
      const letter = text[at];
      if (quoted) {
        if (letter !== '"') part += letter;
        else if (text[at + 1] === '"') { part += '"'; at += 1; } else quoted = false;
      } else if (letter === '"') quoted = true;
      else if (letter === ",") { row.push(part); part = ""; }
      else if (letter === "\n") { rows.push([...row, part]); row = []; part = ""; }
      else if (letter !== "\r") part += letter;
    }
    if (rows.length < most && (part !== "" || row.length > 0)) rows.push([...row, part]);
    return rows;
  };

  for (const item of all("[data-table]")) {
    const table = figures.tables[Number(item.dataset.table)];
    one("[data-do=table]", item).addEventListener("click", () => saveText(table.file, table.csv, "text/csv"));
    one("details", item).addEventListener("toggle", (event) => {
      const place = one(".scroll", item);
      if (!event.target.open || place.childElementCount > 0) return;
      const [names = [], ...rows] = rowsOf(table.csv, 7);
      const line = (cells, kind) => element("tr", {}, ...cells.map((text) => element(kind, { textContent: text })));
      place.append(element("table", {}, element("thead", {}, line(names, "th")),
        element("tbody", {}, ...rows.map((row) => line(row, "td")))));
    });
  }

  /** Copies a text; where the browser does not allow that, does something else and says what. */
  const copied = async (button, text, otherwise) => {
    const done = (word) => { button.textContent = word; say(word); };
    try {
      await navigator.clipboard.writeText(text);
      done("Copied");
    } catch {
      done(otherwise());
    }
    setTimeout(() => { button.textContent = "Copy"; }, 2000);
  };
  for (const button of all("[data-do=copy]")) {
    const source = one(`#${button.dataset.copy}`);
    button.addEventListener("click", () => copied(button, source.textContent, () => { getSelection().selectAllChildren(source); return "Selected"; }));
  }

  /** The two buttons of a drawing: save it as SVG, and copy it, its data in it. */
  const giveAway = (place, name, svg, data) => {
    const text = () => alone(svg, data());
    one("[data-do=svg]", place).addEventListener("click", () => saveText(`${name}.svg`, text(), "image/svg+xml"));
    const button = one("[data-do=copy-svg]", place);
    button.addEventListener("click", () => {
      const whole = text();
      copied(button, whole, () => { saveText(`${name}.svg`, whole, "image/svg+xml"); return "Saved"; });
    });
  };
  for (const moment of all(".moment")) {
    giveAway(moment, moment.dataset.file, one("svg", moment), () => figures.parts[Number(moment.dataset.part)]);
  }

  // ---------------------------------------------------------------- charts

  /** Index of the place that is nearest to x; places ascend. */
  const nearest = (places, x) => {
    let low = 0, high = places.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (places[middle] < x) low = middle + 1; else high = middle;
    }
    return low > 0 && x - places[low - 1] <= places[low] - x ? low - 1 : low;
  };

  const readOut = (figure) => {
    const chart = figures.charts[Number(figure.dataset.chart)];
    const plot = one(".plot", figure), svg = one("svg", plot);
    giveAway(figure, chart.id, svg, () => csv(chart));
    one("[data-do=csv]", figure).addEventListener("click", () => saveText(`${chart.id}.csv`, csv(chart), "text/csv"));
    const places = chart.places.map((list) => list.filter((x) => x !== null));
    const steps = places.length === 1 ? places[0] : [...new Set(places.flat())].sort((a, b) => a - b);
    if (steps.length === 0) return;
    plot.tabIndex = 0;
    const [left, right, top, bottom] = chart.plot;
    const across = (x) => left + (x - chart.x.ends[0]) / (chart.x.ends[1] - chart.x.ends[0]) * (right - left);
    const down = (y) => bottom - (y - chart.y.ends[0]) / (chart.y.ends[1] - chart.y.ends[0]) * (bottom - top);
    const layer = drawn("g", { "data-temporary": "" });
    const cross = drawn("path", { class: "cross" });
    const marks = chart.lines.map((_, index) => drawn("circle", { class: `mark s${index % 7}`, r: 4 }));
    const box = element("div", { className: "readout", hidden: true });
    box.setAttribute("role", "status");
    layer.append(cross, ...marks);
    plot.append(box);
    let at = null;

    const hide = () => { at = null; layer.remove(); box.hidden = true; };
    const show = (index) => {
      at = clamp(index, 0, steps.length - 1);
      const x = steps[at];
      cross.setAttribute("d", `M${across(x)} ${top}V${bottom}`);
      const rows = chart.lines.map((line, index) => {
        const own = chart.places[line.x];
        const point = nearest(own, x);
        const y = line.y[point] ?? null;
        const shown = y !== null && own[point] === x;
        marks[index].toggleAttribute("hidden", !shown);
        marks[index].setAttribute("r", shown ? 4 : 0);
        if (shown) {
          marks[index].setAttribute("cx", across(x));
          marks[index].setAttribute("cy", clamp(down(y), -1e5, 1e5));
        }
        const spread = line.spread?.[point];
        const give = y !== null && spread !== null && spread !== undefined ? ` ± ${withUnit(spread, chart.y.unit)}` : "";
        const elsewhere = own.length > 0 && own[point] !== x ? ` (at ${withUnit(own[point], chart.x.unit)})` : "";
        return element("tr", {},
          element("th", { scope: "row", className: `s${index % 7}`, textContent: line.name }),
          element("td", { textContent: withUnit(y, chart.y.unit) + give + elsewhere }));
      });
      const where = chart.x.names?.[x] ?? withUnit(x, chart.x.unit);
      const caption = element("caption", { textContent: `${chart.x.label} ${where}` });
      box.replaceChildren(element("table", {}, caption, element("tbody", {}, ...rows)));
      svg.append(layer);
      box.hidden = false;
      // beside the crosshair, on the side with more room, and never out of the figure
      const scale = svg.getBoundingClientRect().width / svg.viewBox.baseVal.width;
      const middle = across(x) * scale;
      const wanted = middle > plot.clientWidth / 2 ? middle - box.offsetWidth - 12 : middle + 12;
      const from = clamp(wanted, 0, Math.max(0, plot.clientWidth - box.offsetWidth));
      box.style.transform = `translate(${from}px, ${top * scale}px)`;
    };
    const follow = (event) => {
      const frame = svg.getBoundingClientRect();
      const place = (event.clientX - frame.left) / frame.width * svg.viewBox.baseVal.width;
      const share = clamp((place - left) / (right - left), 0, 1);
      show(nearest(steps, chart.x.ends[0] + share * (chart.x.ends[1] - chart.x.ends[0])));
    };
    svg.addEventListener("pointermove", follow);
    svg.addEventListener("pointerdown", follow);
    svg.addEventListener("pointerleave", (event) => { if (event.pointerType === "mouse" && document.activeElement !== plot) hide(); });
    plot.addEventListener("blur", hide);
    document.addEventListener("pointerdown", (event) => { if (at !== null && !plot.contains(event.target)) hide(); });
    plot.addEventListener("keydown", (event) => {
      if (event.altKey || event.ctrlKey || event.metaKey) return;
      const stride = event.shiftKey ? 10 : 1, leap = Math.max(1, Math.round(steps.length / 20));
      const moves = {
        ArrowRight: () => show(at === null ? 0 : at + stride),
        ArrowLeft: () => show(at === null ? steps.length - 1 : at - stride),
        PageDown: () => show((at ?? 0) + leap),
        PageUp: () => show((at ?? 0) - leap),
        Home: () => show(0),
        End: () => show(steps.length - 1),
        Escape: hide,
      };
      if (!(event.key in moves)) return;
      event.preventDefault();
      moves[event.key]();
    });
  };
  all("[data-chart]").forEach(readOut);

  // ---------------------------------------------------------------- the player

  const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

  /** What was squeezed as it was packed. */
  const unsqueezed = async (replay) => {
    const stream = new Blob([bytesOf(replay.squeezed)]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    const all = new Uint8Array(await new Response(stream).arrayBuffer());
    const agents = replay.groups.reduce((sum, [, members]) => sum + members, 0), axes = replay.bounds.length;
    const frames = replay.times.length, words = axes * agents, turns = agents * (axes === 3 ? 2 : 1);
    const count = frames * words, each = 2 * words + turns;
    const bytes = new Uint8Array(frames * each), one = new Uint16Array(words), two = new Uint16Array(words);
    for (let frame = 0; frame < frames; frame += 1) {
      for (let k = 0; k < words; k += 1) {
        const at = frame * words + k, coded = all[at] << 8 | all[count + at];
        const foretold = replay.order === 2 && frame > 1 ? 2 * one[k] - two[k] : one[k];
        two[k] = one[k];
        one[k] = foretold + (coded >> 1 ^ -(coded & 1));
        bytes[frame * each + 2 * k] = one[k] & 255;
        bytes[frame * each + 2 * k + 1] = one[k] >> 8;
      }
      for (let k = 0; k < turns; k += 1) {
        const at = frame * each + 2 * words + k;
        bytes[at] = (frame > 0 ? bytes[at - each] : 0) + all[2 * count + frame * turns + k];
      }
    }
    return bytes;
  };

  /** Positions and headings as they were packed (crates/lab/src/report/replay.rs says how). */
  const unpacked = (replay, bytes) => {
    const group = replay.groups.flatMap(([index, members]) => Array(members).fill(index));
    const agents = group.length, axes = replay.bounds.length;
    const perFrame = agents * (2 * axes + (axes === 3 ? 2 : 1));
    const ABSENT = 65535, MOST = 65534;
    const position = new Float32Array(replay.times.length * agents * 3);
    for (let frame = 0; frame < replay.times.length; frame += 1) {
      for (let axis = 0; axis < axes; axis += 1) {
        const [low, high] = replay.bounds[axis];
        for (let agent = 0; agent < agents; agent += 1) {
          const at = frame * perFrame + 2 * (axis * agents + agent);
          const word = bytes[at] | bytes[at + 1] << 8;
          position[3 * (frame * agents + agent) + axis] = word === ABSENT ? NaN : low + word / MOST * (high - low);
        }
      }
    }
    const heading = (frame, agent) => {
      const at = frame * perFrame + 2 * axes * agents + agent;
      if (bytes[at] === 255) return null;
      const azimuth = bytes[at] / 255 * 2 * Math.PI;
      if (axes < 3) return [Math.cos(azimuth), axes < 2 ? 0 : Math.sin(azimuth), 0];
      const polar = bytes[at + agents] / 254 * Math.PI;
      return [Math.sin(polar) * Math.cos(azimuth), Math.sin(polar) * Math.sin(azimuth), Math.cos(polar)];
    };
    const place = (frame, agent) => {
      const at = 3 * (frame * agents + agent);
      return [position[at], position[at + 1], position[at + 2]];
    };
    return { group, agents, axes, place, heading };
  };

  /** A round length, 1, 2 or 5 times a power of ten, of at most so much. */
  const roundLength = (most) => {
    const power = 10 ** Math.floor(Math.log10(most));
    return [5, 2, 1].map((digit) => digit * power).find((length) => length <= most * (1 + 1e-9)) ?? power;
  };

  // a trail is so many frames long, and shorter where there are so many agents that drawing would falter
  const TRAIL = 24, TRAIL_STEPS = 30000, MANY = 800;
  const FADES = 5, ROOM = 12, FOOT = 30, DRAWER = 3;
  const ARROW = [[1, 0], [-0.8, 0.68], [-0.4, 0], [-0.8, -0.68]];
  const FIRST_VIEW = { turn: -0.62, tilt: 0.5, zoom: 1 };

  const play = (player, replay, bytes) => {
    const { stage, times } = replay;
    const data = unpacked(replay, bytes);
    const frames = times.length;
    const space = stage.axes === 3;
    const AXES = [0, 1, 2];
    const inside = (low, high) => ({
      size: AXES.map((axis) => (axis < stage.axes ? high[axis] - low[axis] : 0)),
      centre: AXES.map((axis) => (axis < stage.axes ? (high[axis] + low[axis]) / 2 : 0)),
      corners: [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => AXES.map((axis) => (bits >> axis & 1 ? high : low)[axis])),
    });
    const whole = inside(stage.low, stage.high);
    // what is looked at: the stage, or the surroundings of the agents
    let { size, centre, corners } = whole;
    const canvas = one("canvas", player), pen = canvas.getContext("2d");
    const scrub = one(".scrub", player), time = one(".time", player);
    const trails = one(".trails", player), loop = one(".loop", player), speed = one(".speed", player);
    const button = (name) => one(`[data-do=${name}]`, player);
    // a whole recording lasts some ten seconds, at no more frames a second than a film
    const pace = clamp(frames / 10, 4, 30);
    const view = { ...FIRST_VIEW };
    let frame = 0, way = 0, cursor = 0, before = null;
    let wide = 0, tall = 0, colours = {};

    const readColours = () => {
      const looks = getComputedStyle(root);
      for (const name of ["stage", "text", "faint", "rule", "grid", "obstacle", "ground"]) {
        colours[name] = looks.getPropertyValue(`--${name}`).trim();
      }
      colours.series = [0, 1, 2, 3, 4, 5, 6].map((index) => looks.getPropertyValue(`--series-${index}`).trim());
    };
    const series = (group) => colours.series[group % colours.series.length];

    const corner = (bits) => whole.corners[bits];

    // In the open a group can travel so far that nothing is seen of it on the whole stage: then the view follows it. Its size stays
    // what the group needs when it is widest, so that nobody is ever outside, and nothing but the group's own motion changes a length.
    const follow = one(".follow", player);
    const open = AXES.filter((axis) => axis < stage.axes && stage.edges[axis] === "open");
    const boxes = follow === null ? [] : times.map((_, at) => {
      const low = [Infinity, Infinity, Infinity], high = low.map((end) => -end);
      for (let index = 0; index < data.agents; index += 1) {
        const place = data.place(at, index);
        if (Number.isNaN(place[0])) continue;
        for (const axis of open) [low[axis], high[axis]] = [Math.min(low[axis], place[axis]), Math.max(high[axis], place[axis])];
      }
      return { low, high };
    });
    const widest = boxes.reduce((most, box) => Math.max(most, ...open.map((axis) => box.high[axis] - box.low[axis])), 0);
    const reach = AXES.map((axis) => 1.1 * Math.max(widest / 10, ...boxes.map((box) => box.high[axis] - box.low[axis])));
    if (follow !== null) follow.checked = widest > 0 && 2.5 * widest < Math.max(...open.map((axis) => whole.size[axis]));
    const look = () => {
      const box = boxes[frame];
      if (!follow?.checked || widest === 0 || !(box?.low[open[0]] <= box?.high[open[0]])) return whole;
      const end = (side) => AXES.map((axis) => (open.includes(axis)
        ? (box.low[axis] + box.high[axis]) / 2 + side * reach[axis] / 2 : (side < 0 ? stage.low : stage.high)[axis]));
      return inside(end(-1), end(1));
    };
    const radius = () => Math.hypot(...size) / 2;
    /** A camera that looks at the middle of what is looked at from a distance, upright. */
    const camera = ({ turn, tilt }, scale, offset) => {
      const far = 3.4 * radius();
      const [cosTurn, sinTurn, cosTilt, sinTilt] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
      return (place) => {
        const x = place[0] - centre[0], y = place[1] - centre[1], z = place[2] - centre[2];
        const across = x * cosTurn - y * sinTurn, away = x * sinTurn + y * cosTurn;
        const up = z * cosTilt + away * sinTilt, depth = away * cosTilt - z * sinTilt;
        const here = scale * far / Math.max(far + depth, 0.05 * far);
        return [offset[0] + across * here, offset[1] - up * here, depth, here];
      };
    };
    // from a place on the stage to the screen: [across, down, depth, units of the screen per unit of length]
    let project;
    const aim = () => {
      ({ size, centre, corners } = look());
      const room = [wide - 2 * ROOM, tall - ROOM - FOOT];
      const middle = [wide / 2, ROOM + room[1] / 2];
      if (!space) {
        const scale = Math.min(room[0] / size[0], stage.axes === 2 ? room[1] / size[1] : Infinity);
        project = ([x, y]) => [middle[0] + (x - centre[0]) * scale, middle[1] - (y - centre[1]) * scale, 0, scale];
        return;
      }
      // the whole stage fits into the first view; turning it changes nothing but the direction
      const seen = corners.map(camera(FIRST_VIEW, 1, [0, 0]));
      const [lefts, tops] = [0, 1].map((axis) => seen.map((place) => place[axis]));
      const [least, most] = [[Math.min(...lefts), Math.min(...tops)], [Math.max(...lefts), Math.max(...tops)]];
      const scale = 0.97 * Math.min(...[0, 1].map((axis) => room[axis] / (most[axis] - least[axis])));
      const offset = [0, 1].map((axis) => middle[axis] - scale * view.zoom * (least[axis] + most[axis]) / 2);
      project = camera(view, scale * view.zoom, offset);
    };

    const path = (places, closed) => {
      pen.beginPath();
      places.forEach(([x, y], index) => (index === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
      if (closed) pen.closePath();
    };
    const edge = (kind) => {
      pen.strokeStyle = kind === "wall" && !space ? colours.text : colours.faint;
      pen.lineWidth = kind === "wall" && !space ? 2 : 1.1;
      pen.setLineDash(kind === "seam" ? [5, 5] : []);
      pen.stroke();
      pen.setLineDash([]);
    };

    /** The ends of the stage, as things to draw: [depth, act]. */
    const edges = () => {
      const things = [];
      for (let axis = 0; axis < stage.axes; axis += 1) {
        for (let bits = 0; bits < 1 << stage.axes; bits += 1) {
          if (bits >> axis & 1) continue;
          // this edge runs along one axis and ends the others
          const others = [0, 1, 2].filter((other) => other !== axis && other < stage.axes).map((other) => stage.edges[other]);
          const kind = others.includes("wall") ? "wall" : others.includes("seam") ? "seam" : "open";
          if (kind === "open") continue;
          const ends = [corner(bits), corner(bits | 1 << axis)].map(project);
          things.push([(ends[0][2] + ends[1][2]) / 2 + (space ? 1e-6 : 0), () => { path(ends, false); edge(kind); }]);
        }
      }
      if (stage.axes === 1) {
        const [from, to] = [stage.low, stage.high].map(project);
        things.push([0, () => { path([from, to], false); edge("open"); }]);
        for (const [x, y] of stage.edges[0] === "open" ? [] : [from, to]) {
          things.push([0, () => { path([[x, y - 14], [x, y + 14]], false); edge(stage.edges[0]); }]);
        }
      }
      return things;
    };

    const paint = (shade = 0, fill = colours.obstacle) => {
      pen.fillStyle = fill;
      pen.fill();
      pen.globalAlpha = shade;
      pen.fillStyle = colours.faint;
      pen.fill();
      pen.globalAlpha = 1;
      pen.strokeStyle = colours.faint;
      pen.lineWidth = 0.8;
      pen.stroke();
    };
    /** What is far away in space is paler. */
    const paleness = (depth) => (space ? 1 - 0.5 * clamp((depth / radius() + 1) / 2, 0, 1) : 1);
    /** An obstacle as things to draw. */
    const obstacle = (outline) => {
      if (outline.ball) {
        const [x, y, depth, scale] = project(outline.ball);
        const radius = Math.max(1, outline.radius * scale);
        return [[depth, () => {
          let fill = colours.obstacle;
          if (space) {
            fill = pen.createRadialGradient(x - radius * 0.35, y - radius * 0.4, radius * 0.1, x, y, radius * 1.25);
            const [lit, rim] = isDark() ? [colours.faint, colours.obstacle] : [colours.obstacle, colours.faint];
            fill.addColorStop(0, lit);
            fill.addColorStop(1, rim);
          }
          pen.beginPath();
          pen.arc(x, y, radius, 0, 2 * Math.PI);
          paint(0, fill);
        }]];
      }
      if (outline.segment) {
        const ends = outline.segment.map(project);
        return [[(ends[0][2] + ends[1][2]) / 2, () => { path(ends, false); edge("wall"); }]];
      }
      const faces = outline.polygon ? [outline.polygon] : [];
      if (outline.cuboid && !space) {
        const [low, high] = outline.cuboid;
        faces.push([low, [high[0], low[1], 0], [high[0], high[1], 0], [low[0], high[1], 0]]);
      } else if (outline.cuboid) {
        for (let axis = 0; axis < 3; axis += 1) {
          const [a, b] = [0, 1, 2].filter((other) => other !== axis);
          for (const at of outline.cuboid) {
            const corner = (first, second) => {
              const place = [...at];
              [place[a], place[b]] = [outline.cuboid[first][a], outline.cuboid[second][b]];
              return place;
            };
            faces.push([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
          }
        }
      }
      return faces.map((face, index) => {
        const seen = face.map(project);
        const depth = seen.reduce((sum, place) => sum + place[2], 0) / seen.length;
        return [depth, () => { path(seen, true); paint(space ? [0.32, 0.16, 0][index >> 1] ?? 0 : 0); }];
      });
    };

    /** An agent as a thing to draw: an arrowhead, a disc at rest. */
    const agent = (index, smallest) => {
      const place = data.place(frame, index);
      if (Number.isNaN(place[0])) return null;
      const [x, y, depth, scale] = project(place);
      const group = data.group[index];
      const half = clamp((stage.radius[group] ?? 0) * scale, space ? smallest * scale / project(centre)[3] : smallest, 80);
      const heading = data.heading(frame, index);
      let arrow = null;
      if (heading) {
        const ahead = 1e-3 * Math.max(...size) || 1;
        const [u, v] = project(place.map((value, axis) => value + ahead * heading[axis]));
        const across = u - x, down = v - y, length = Math.hypot(across, down);
        const seen = Math.min(1, length / (ahead * scale));
        if (seen > 0.2) {
          const [cos, sin] = [across / length, down / length];
          arrow = ARROW.map(([along, aside]) => {
            const [a, b] = [along * half * Math.max(seen, 0.5), aside * half];
            return [x + a * cos - b * sin, y + a * sin + b * cos];
          });
        }
      }
      return [depth, () => {
        pen.globalAlpha = paleness(depth);
        if (arrow) path(arrow, true); else { pen.beginPath(); pen.arc(x, y, half * 0.6, 0, 2 * Math.PI); }
        // the outline parts it from those behind it; drawn first, it hides nothing of the agent
        if (data.agents <= MANY) {
          pen.strokeStyle = colours.stage;
          pen.lineWidth = 1.4;
          pen.stroke();
        }
        pen.fillStyle = series(group);
        pen.fill();
        pen.globalAlpha = 1;
      }];
    };

    const seams = [0, 1, 2].filter((axis) => axis < stage.axes && stage.edges[axis] === "seam");
    const crossesSeam = (from, to) => seams.some((axis) => Math.abs(to[axis] - from[axis]) > whole.size[axis] / 2);
    const drawTrails = () => {
      const first = Math.max(0, frame - clamp(Math.round(TRAIL_STEPS / data.agents), 4, TRAIL)), steps = frame - first;
      if (steps === 0) return;
      const paths = new Map();
      for (let index = 0; index < data.agents; index += 1) {
        let from = data.place(first, index), start = project(from);
        for (let at = first + 1; at <= frame; at += 1) {
          const to = data.place(at, index), end = project(to);
          if (!Number.isNaN(from[0]) && !Number.isNaN(to[0]) && !crossesSeam(from, to)) {
            const key = data.group[index] * FADES + Math.floor((at - first - 1) * FADES / steps);
            if (!paths.has(key)) paths.set(key, new Path2D());
            paths.get(key).moveTo(start[0], start[1]);
            paths.get(key).lineTo(end[0], end[1]);
          }
          [from, start] = [to, end];
        }
      }
      pen.lineWidth = 1.2;
      for (const [key, lines] of paths) {
        pen.globalAlpha = 0.08 + 0.42 * (key % FADES + 1) / FADES;
        pen.strokeStyle = series(Math.floor(key / FADES));
        pen.stroke(lines);
      }
      pen.globalAlpha = 1;
    };

    const scaleBar = () => {
      const scale = project(centre)[3], length = roundLength(110 / scale), base = tall - 12;
      pen.strokeStyle = colours.text;
      pen.lineWidth = 1.4;
      path([[ROOM, base - 5], [ROOM, base], [ROOM + length * scale, base], [ROOM + length * scale, base - 5]], false);
      pen.stroke();
      pen.fillStyle = colours.faint;
      pen.font = "12px system-ui, sans-serif";
      pen.textAlign = "left";
      pen.fillText(withUnit(length, stage.unit) + (space ? " in the middle" : ""), ROOM + length * scale + 7, base + 1);
      if (frames > 0) {
        pen.textAlign = "right";
        pen.fillText(`t = ${withUnit(times[frame], replay.timeUnit)}`, wide - ROOM, base + 1);
      }
    };

    const draw = () => {
      if (wide === 0) return;
      const ratio = Math.min(devicePixelRatio || 1, DRAWER);
      if (canvas.width !== Math.round(wide * ratio) || canvas.height !== Math.round(tall * ratio)) {
        canvas.width = Math.round(wide * ratio);
        canvas.height = Math.round(tall * ratio);
      }
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      pen.lineJoin = "round";
      pen.fillStyle = colours.stage;
      pen.fillRect(0, 0, wide, tall);
      aim();
      const outlines = replay.obstacles.length > 1 ? replay.obstacles[frame] ?? [] : replay.obstacles[0] ?? [];
      const things = outlines.flatMap(obstacle);
      const behind = edges();
      if (!space) things.splice(0).forEach(([, act]) => act());
      if (frames > 0 && trails.checked) drawTrails();
      const smallest = (data.agents > MANY ? 3 : 5) * (space ? 1.2 : 1) * (wide < 500 ? 0.8 : 1);
      for (let index = 0; frames > 0 && index < data.agents; index += 1) {
        const thing = agent(index, smallest);
        if (thing) things.push(thing);
      }
      // what is far away is drawn first
      things.push(...behind);
      if (space) things.sort((a, b) => b[0] - a[0]);
      for (const [, act] of things) act();
      scaleBar();
    };

    const show = () => {
      draw();
      scrub.value = frame;
      const now = frames > 0 ? `t = ${withUnit(times[frame], replay.timeUnit)}` : "no frames";
      scrub.setAttribute("aria-valuetext", now);
      time.replaceChildren(now, element("small", { textContent: frames > 0 ? `${frame + 1} of ${frames}` : "" }));
    };
    const go = (to) => { frame = clamp(Math.round(to), 0, Math.max(0, frames - 1)); cursor = frame; show(); };

    const tick = (now) => {
      if (way === 0) return;
      const passed = before === null ? 0 : Math.min(0.25, (now - before) / 1000);
      before = now;
      cursor += way * passed * pace * Number(speed.value);
      if (cursor < 0 || cursor >= frames) {
        if (loop.checked) cursor = (cursor % frames + frames) % frames;
        else { go(way > 0 ? frames - 1 : 0); run(0); return; }
      }
      const next = clamp(Math.floor(cursor), 0, frames - 1);
      if (next !== frame) { frame = next; show(); }
      requestAnimationFrame(tick);
    };
    const ICONS = { pause: "M3.5 2.5h3v11h-3zM9.5 2.5h3v11h-3z", play: "M4 2.5v11L13 8z", reverse: "M12 2.5v11L3 8z" };
    /** Plays forwards (1), backwards (-1), or not at all (0). */
    const run = (to) => {
      const started = way === 0 && to !== 0;
      way = frames > 1 ? to : 0;
      for (const [name, sign, word] of [["play", 1, "Play"], ["reverse", -1, "Play backwards"]]) {
        const running = way === sign;
        button(name).setAttribute("aria-pressed", String(running));
        button(name).setAttribute("aria-label", running ? "Pause" : word);
        one("path", button(name)).setAttribute("d", ICONS[running ? "pause" : name]);
      }
      if (way === 0 || !started) return;
      if (!loop.checked && frame === (way > 0 ? frames - 1 : 0)) go(way > 0 ? 0 : frames - 1);
      cursor = frame;
      before = null;
      requestAnimationFrame(tick);
    };
    const step = (by) => { run(0); go(frame + by); };
    const turn = (across, down) => {
      view.turn += across;
      view.tilt = clamp(view.tilt + down, -Math.PI / 2, Math.PI / 2);
      draw();
    };
    const zoom = (by) => { view.zoom = clamp(view.zoom * by, 0.3, 12); draw(); };
    const acts = {
      first: () => { run(0); go(0); },
      back: () => step(-1),
      reverse: () => run(way === -1 ? 0 : -1),
      play: () => run(way === 1 ? 0 : 1),
      forth: () => step(1),
      last: () => { run(0); go(frames - 1); },
      picture: () => canvas.toBlob((blob) => { if (blob) save(`frame-${frame + 1}.png`, blob); }),
      view: () => { Object.assign(view, FIRST_VIEW); draw(); },
    };
    for (const [name, act] of Object.entries(acts)) button(name)?.addEventListener("click", act);
    for (const name of ["first", "back", "reverse", "play", "forth", "last"]) button(name).disabled = frames < 2;
    scrub.max = Math.max(0, frames - 1);
    scrub.disabled = frames < 2;
    scrub.addEventListener("input", () => { run(0); go(Number(scrub.value)); });
    trails.addEventListener("change", draw);
    follow?.addEventListener("change", () => fit());
    const perFrame = frames > 1 ? Math.abs(times[frames - 1] - times[0]) / (frames - 1) : 0;
    if (perFrame > 0) {
      const seconds = Number((perFrame * pace).toPrecision(2));
      one(".pace", player).textContent = `At 1×, a second shows ${withUnit(seconds, replay.timeUnit)}.`;
    }

    player.addEventListener("keydown", (event) => {
      if (event.altKey || event.ctrlKey || event.metaKey) return;
      const own = event.target.closest("button, select, input");
      const turning = space && event.shiftKey;
      const keys = {
        " ": () => run(way === 0 ? 1 : 0),
        b: acts.reverse,
        ArrowLeft: () => (turning ? turn(-0.1, 0) : step(-1)),
        ArrowRight: () => (turning ? turn(0.1, 0) : step(1)),
        Home: acts.first,
        End: acts.last,
        PageUp: () => step(-10),
        PageDown: () => step(10),
        ...(turning ? { ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1) } : {}),
        ...(space ? { "+": () => zoom(1.2), "-": () => zoom(1 / 1.2), 0: acts.view } : {}),
      };
      // what a control does with a key by itself, it keeps
      if (own && (event.key === " " ? own !== scrub : own.matches("select"))) return;
      const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!act) return;
      event.preventDefault();
      act();
    });
    if (space) {
      let last = null;
      const end = () => { last = null; canvas.classList.remove("turning"); };
      canvas.addEventListener("pointerdown", (event) => {
        last = [event.clientX, event.clientY];
        canvas.setPointerCapture(event.pointerId);
        canvas.classList.add("turning");
      });
      canvas.addEventListener("pointermove", (event) => {
        if (!last) return;
        turn((event.clientX - last[0]) * 0.008, (event.clientY - last[1]) * 0.008);
        last = [event.clientX, event.clientY];
      });
      for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, end);
      // the wheel scrolls the page until the player is being used
      canvas.addEventListener("wheel", (event) => {
        if (document.activeElement !== canvas && !event.ctrlKey) return;
        event.preventDefault();
        zoom(Math.exp(-clamp(event.deltaY, -120, 120) * 0.002));
      }, { passive: false });
    }

    const fit = () => {
      const room = one(".screen", player).clientWidth - 2;
      if (room <= 0) return;
      const shape = stage.axes === 1 ? 0 : space ? 0.72 : look().size[1] / look().size[0];
      const most = Math.max(260, Math.min(620, innerHeight * 0.76));
      wide = room;
      tall = stage.axes === 1 ? 110 : clamp((room - 2 * ROOM) * shape + ROOM + FOOT, 120, most);
      canvas.style.height = `${Math.round(tall) + 2}px`;
      tall = Math.round(tall);
      draw();
    };
    const repaint = () => { readColours(); draw(); };
    readColours();
    go(0);
    fit();
    new ResizeObserver(fit).observe(one(".screen", player));
    onColours.push(repaint);
    addEventListener("beforeprint", () => inLight(repaint));
    addEventListener("afterprint", repaint);
  };
  for (const player of all("[data-replay]")) {
    const replay = figures.replays[Number(player.dataset.replay)];
    if (replay.squeezed === undefined) play(player, replay, bytesOf(replay.packed));
    else {
      const time = one(".time", player);
      time.textContent = "unpacking…";
      unsqueezed(replay).then((bytes) => play(player, replay, bytes), () => { time.textContent = "This browser is too old to unpack the recording."; });
    }
  }

  // on paper nobody can unfold anything
  const folded = () => all("details.source:not([open])");
  let unfolded = [];
  addEventListener("beforeprint", () => { unfolded = folded(); for (const part of unfolded) part.open = true; });
  addEventListener("afterprint", () => { for (const part of unfolded) part.open = false; });
  showTheme();
})();
