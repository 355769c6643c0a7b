// Searches, drawing and exports with the real program behind them: what is shown is what is there, what is drawn is obeyed,
// what is sent plays without a network.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { after, before, describe, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { built } from "./built.mjs";

const root = fileURLToPath(new URL("../..", import.meta.url));
const pictures = `${root}target/pages`;
const scratch = mkdtempSync(`${tmpdir()}/flockworks-shown-`);
const OF_THE_BROWSER = /GPU stall due to ReadPixels/;
// a program that is built already; left out, it is built
const GIVEN = process.env.FLOCKWORKS_PROGRAM;

/** Three recordings of two shipped tables; the second time the fish are looked at for impossible speeds. */
const SEVERAL = `kind = "tracks"
title = "Fish and people"
[[recording]]
file = "${root}studies/tracks/sticklebacks.csv"
name = "shoal"
fps = "unknown"
units = "px"
[[recording]]
file = "${root}studies/tracks/corridor.txt"
name = "corridor"
[[recording]]
file = "${root}studies/tracks/sticklebacks.csv"
name = "in seconds"
fps = 25
units = "px"
[clean]
greatest_speed = 300
[measure]
parameters = { linking_distance = 80, x1 = 0, y1 = 0, x2 = 600, y2 = 600 }
`;

let browser, program;
const run = (...words) => execFileSync(program, words, { cwd: root, stdio: ["ignore", "pipe", "pipe"] }).toString();

before(async () => {
  mkdirSync(pictures, { recursive: true });
  program = GIVEN || built("flockworks");
  // the shipped files themselves, with fewer and shorter trials
  run("run", "studies/compositions/weights.toml", "--quick", "--trials", "1-3", "--out", `${scratch}/study`, "--set", "set.time.duration=80");
  run("run", "studies/evolution/flocks.toml", "--quick", "--set", "quick_generations=4", "--out", `${scratch}/evolution`);
  run("run", "studies/environments/table-7.2-corralling.toml", "--quick", "--set", "quick_attempts=24", "--set", "set.time.duration=50", "--set", "robustness.copies=1", "--set", "robustness.environments=1", "--out", `${scratch}/design`);
  run("run", "studies/environments/fig-7.10.toml", "--set", "axis.angle.cells=6", "--set", "axis.length.cells=3", "--set", "trials=2", "--out", `${scratch}/map`);
  run("run", "studies/environments/optimise-dirt.toml", "--quick", "--set", "quick_evaluations=20", "--set", "trials=2", "--set", "confirm_trials=6", "--set", "finalists=2", "--set", "control_trials=6", "--set", "lighten.trials=6", "--out", `${scratch}/optimisation`);
  run("run", "studies/formations/table-8.1.toml", "--set", "trials=1", "--set", "set.time.duration=60", "--out", `${scratch}/formation`);
  writeFileSync(`${scratch}/bend.toml`, run("new", "decomposition").replace("[scenario]\n", `[interval.bend]
about = "comes apart"
line = 1
from = 40
to = 60
behaviour.is.simple-split = {}
[vary]
angles = [0]
lengths = [1]
[scenario]
`));
  run("run", `${scratch}/bend.toml`, "--quick", "--out", `${scratch}/decomposition`, "--set", "offsets=2");
  run("run", "studies/tracks/sticklebacks.toml", "--out", `${scratch}/tracks`);
  run("run", "studies/tracks/corridor.toml", "--out", `${scratch}/corridor`);
  writeFileSync(`${scratch}/several.toml`, SEVERAL);
  run("run", `${scratch}/several.toml`, "--out", `${scratch}/several`);
  run("run", "studies/schooling.toml", "--quick", "--out", `${scratch}/run`);
  browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
});
after(() => browser?.close());

/** Sees to it that a page complains of nothing and asks nobody but `address`. */
async function watched(act, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, acceptDownloads: true, reducedMotion: "reduce", ...options });
  const page = await context.newPage();
  const complaints = [], requests = [];
  page.on("console", (message) => { if (!OF_THE_BROWSER.test(message.text())) complaints.push(`${message.type()}: ${message.text()}`); });
  page.on("pageerror", (error) => complaints.push(`error: ${error.stack}`));
  page.on("request", (request) => requests.push(request.url()));
  try {
    const address = await act(page, context);
    assert.deepEqual(complaints, []);
    assert.deepEqual(requests.filter((url) => !url.startsWith(address) && !/^(data|blob):/.test(url)), []);
  } finally { await context.close(); }
}

async function opened(given, act, options = {}) {
  const server = spawn(program, ["view", ...given], { cwd: root, stdio: ["ignore", "pipe", "inherit"] });
  try {
    const address = await new Promise((resolve, reject) => {
      server.stdout.once("data", (bytes) => resolve(bytes.toString().split("\n")[0]));
      server.once("exit", () => reject(new Error("the server ended")));
    });
    await watched(async (page) => { await page.goto(address + (options.hash ?? "")); await act(page); return address; }, options.context);
  } finally { server.kill(); }
}

/** How many colours a canvas shows. */
const coloursOf = (page, selector) => page.locator(selector).first().evaluate((canvas) => {
  const { width, height } = canvas;
  return new Set(new Uint32Array(canvas.getContext("2d").getImageData(0, 0, width, height).data.buffer)).size;
});
const playing = async (page) => { await page.locator(".time[data-step]").waitFor(); await page.locator("[data-do=forth]").click(); await page.waitForFunction(() => Number(document.querySelector(".time").dataset.step) >= 1); };
/** Sees to it that each button `Copy` gives an SVG with a title and rows of data. */
async function copies(page) {
  const buttons = page.locator("main button.copy:visible");
  const count = await buttons.count();
  assert.ok(count > 0, "nothing can be copied");
  for (let at = 0; at < count; at += 1) {
    await page.evaluate(() => { window.copied = null; Object.defineProperty(navigator, "clipboard", { configurable: true, value: { writeText: async (text) => { window.copied = text; } } }); });
    await buttons.nth(at).click();
    const svg = await page.waitForFunction(() => window.copied).then((handle) => handle.jsonValue());
    assert.match(svg, /^<svg[^>]*xmlns="http:\/\/www.w3.org\/2000\/svg"/);
    const rows = /<metadata>([^]*?)<\/metadata>/.exec(svg)?.[1].trim().split("\n") ?? [];
    assert.ok(rows.length > 1 && rows[0].includes(","), `no data in ${svg.slice(0, 200)}`);
    assert.ok((svg.match(/<(path|rect|circle)/g) ?? []).length > 1 && !/NaN|undefined/.test(svg.replace(/<metadata>[^]*<\/metadata>/, "")), "a drawing of nothing");
  }
  return count;
}
const overflow = (page) => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);

describe("searches", () => {
  test("a study: cells over factors, a trial that is watched has the seed it had", () => opened([`${scratch}/study`], async (page) => {
    await page.locator(".multiple").first().waitFor();
    assert.equal(await page.locator(".multiple").count(), 15);
    assert.ok(await coloursOf(page, ".multiple canvas") > 3);
    await page.locator(".multiple").nth(4).click();
    await page.locator(".trials button").first().waitFor();
    assert.equal(await page.locator(".trials button").count(), 3);
    await copies(page);
    await page.screenshot({ path: `${pictures}/view-study.png` });
    // what is shown is what the tables say
    run("export", `${scratch}/study`, "--to", "csv");
    const [names, ...rows] = readFileSync(`${scratch}/study/cells.csv`, "utf8").trim().split("\n").map((line) => line.split(","));
    const cell = Number(await page.locator(".multiple").nth(4).getAttribute("data-cell"));
    const mean = Number(rows[cell][names.indexOf("polarisation_mean")]);
    const shown = Number((await page.locator(".detail tbody tr").first().locator("td").innerText()).replace("\u2212", "-"));
    assert.ok(Math.abs(shown - mean) < 1e-4 * Math.abs(mean) + 1e-9, `${shown} for ${mean}`);
    await page.locator(".multiple").nth(4).focus();
    await page.keyboard.press("ArrowRight");
    assert.ok(await page.evaluate(() => document.activeElement.classList.contains("multiple")));
    const trial = page.locator(".trials button").first();
    const number = Number(await trial.getAttribute("data-trial"));
    await trial.click();
    await playing(page);
    assert.equal(await page.locator(".seed").inputValue(), String(1 + number));
    await page.locator("[data-do=overview]").click();
    await page.locator(".multiple[aria-pressed=true]").waitFor();
  }));

  test("an evolution: fitness and genes, and generation k", () => opened([`${scratch}/evolution`], async (page) => {
    await page.locator(".watch").waitFor();
    await page.locator(".detail .values").nth(1).waitFor();
    assert.ok(await coloursOf(page, ".searching figure canvas") > 8);
    assert.equal(await page.locator(".alleles figure").count(), 12);
    await page.locator(".generation").fill("2");
    await page.locator(".generation").press("Enter");
    await page.locator("h2", { hasText: "Generation 2" }).waitFor();
    assert.equal(await copies(page), 13);
    await page.screenshot({ path: `${pictures}/view-evolution.png` });
    await page.locator(".watch").click();
    await playing(page);
    assert.match(await page.locator("h1").innerText(), /generation 2/);
  }));

  test("a design: a wall of environments, how one came about, the group in it", () => opened([`${scratch}/design`], async (page) => {
    await page.locator(".tile").first().waitFor();
    await page.waitForFunction(() => { const canvas = document.querySelector(".tile canvas"); return canvas && new Set(new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size > 3; });
    await page.locator(".tile").first().focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Enter");
    const slider = page.locator(".derivation input");
    await slider.waitFor();
    const whole = await coloursOf(page, ".large");
    await copies(page);
    await page.screenshot({ path: `${pictures}/view-design.png` });
    await slider.fill("1");
    assert.match(await page.locator(".derivation output").innerText(), /step 1 of \d+/);
    assert.ok(whole > 3);
    await page.locator(".watch").first().click();
    await playing(page);
    assert.match(await page.locator("h1").innerText(), /candidate \d+/);
  }));

  test("a map: a point, its environment and its run", () => opened([`${scratch}/map`], async (page) => {
    const canvas = page.locator(".panels canvas").first();
    await canvas.waitFor();
    await canvas.click({ position: { x: 180, y: 120 } });
    await page.locator(".watch").waitFor();
    assert.ok(await coloursOf(page, ".large") > 3);
    await copies(page);
    await page.screenshot({ path: `${pictures}/view-map.png` });
    await canvas.focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Enter");
    await page.locator(".watch").waitFor();
    await page.locator(".watch").click();
    await playing(page);
  }));

  test("an optimisation: scores, the best constructs, the archive, the group in any of them", () => opened([`${scratch}/optimisation`], async (page) => {
    await page.locator(".best").nth(3).waitFor();
    assert.equal(await page.locator(".best").count(), 5, "four methods, and what was made lighter");
    assert.ok(await coloursOf(page, ".searching figure canvas") > 8);
    await page.waitForFunction(() => { const canvas = document.querySelector(".best canvas"); return new Set(new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size > 3; });
    const archive = page.locator(".searching figure canvas").nth(1);
    await archive.focus();
    await page.keyboard.press("Enter");
    await page.locator("h2", { hasText: /archive, run 1, kind \d+/ }).waitFor();
    const first = await page.locator("h2", { hasText: "kind" }).innerText();
    for (const key of ["ArrowRight", "ArrowLeft", "ArrowUp", "ArrowDown"]) {
      await page.keyboard.press(key);
      await page.waitForTimeout(150);
      if (await page.locator("h2", { hasText: "kind" }).innerText() !== first) break;
    }
    assert.notEqual(await page.locator("h2", { hasText: "kind" }).innerText(), first, "arrow keys go to another kind");
    await page.locator(".best").first().click();
    await page.locator("h2", { hasText: "uniform" }).waitFor();
    // what is shown is what the tables say
    run("export", `${scratch}/optimisation`, "--to", "csv");
    const [names, ...rows] = readFileSync(`${scratch}/optimisation/best.csv`, "utf8").trim().split("\n").map((line) => line.split(","));
    const shown = (await page.locator(".detail tr", { hasText: "successes" }).locator("td").first().innerText()).split(" of ").map(Number);
    const told = rows.filter((row) => row[names.indexOf("method")] === "uniform").map((row) => [Math.round(Number(row[names.indexOf("rate")]) * Number(row[names.indexOf("trials")])), Number(row[names.indexOf("trials")])]);
    assert.ok(told.some(([successes, trials]) => successes === shown[0] && trials === shown[1]), `${shown} is not among ${told}`);
    await copies(page);
    await page.locator(".rolls").evaluate((list) => { list.scrollTop = 0; });
    await page.screenshot({ path: `${pictures}/view-optimisation.png` });
    await page.locator(".watch").click();
    await playing(page);
    assert.match(await page.locator("h1").innerText(), /uniform, run \d, the best, trial 1/);
    await page.locator("[data-do=overview]").click();
    await page.locator(".best").first().waitFor();
  }));

  test("a decomposition: clusters on the construct, an approach with what was found, and its trial", () => opened([`${scratch}/decomposition`], async (page) => {
    await page.locator(".whole").waitFor();
    assert.ok(await coloursOf(page, ".whole") > 3);
    const clusters = page.locator("table", { hasText: "Clusters" }).first().locator("tbody tr");
    assert.ok(await clusters.count() > 1);
    await clusters.first().locator("button").click();
    await page.locator(".detail h2").waitFor();
    await page.waitForFunction(() => { const canvas = document.querySelector(".large"), pen = canvas.getContext("2d"); return new Set(new Uint32Array(pen.getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size > 4; });
    await copies(page);
    await page.screenshot({ path: `${pictures}/view-decomposition.png` });
    // what is shown of the approach is what the tables say
    run("export", `${scratch}/decomposition`, "--to", "csv");
    const [names, ...rows] = readFileSync(`${scratch}/decomposition/approaches.csv`, "utf8").trim().split("\n").map((line) => line.split(","));
    const turn = Number((await page.locator(".detail tr", { hasText: /^turn \(deg\)/ }).locator("td").first().innerText()).replace("\u2212", "-"));
    assert.ok(rows.some((row) => Math.abs(Number(row[names.indexOf("turn")]) - turn) <= 1e-3 * Math.abs(turn) + 1e-9), `${turn}`);
    await page.locator("label", { hasText: "Offset" }).locator("select").selectOption("0");
    await page.locator(".watch").click();
    await playing(page);
    assert.match(await page.locator("h1").innerText(), /approached at .* trial 1/);
    await page.locator("[data-do=overview]").click();
    await page.locator("table", { hasText: "bend: comes apart" }).locator("button").first().click();
    await page.locator("h2", { hasText: "bend" }).waitFor();
    assert.equal(await overflow(page), 0);
    await page.locator(".watch").click();
    await playing(page);
    assert.match(await page.locator("h1").innerText(), /bend, turned by 0/);
  }));

  test("a formation file runs live, and goes on when it is told to", () => opened(["studies/formations/comparison.toml"], async (page) => {
    await page.locator(".time[data-step='0']").waitFor();
    assert.equal(await page.locator("[data-do=go_on]").isVisible(), false, "the piloting that the page plays goes along by itself");
    await page.locator("[data-path=method] select").selectOption("formation_6");
    await page.locator("[data-do=go_on]").waitFor();
    assert.match(await page.locator("h1").innerText(), /task 1, formation_6, trial 1/);
    await playing(page);
    const step = await page.locator(".time").getAttribute("data-step");
    await page.locator("[data-do=go_on]").click();
    await page.locator("#events li", { hasText: "next formation" }).waitFor();
    await page.screenshot({ path: `${pictures}/view-formation-live.png` });
    await page.locator("input.agent").fill("1");
    await page.locator(".overlay .arrow.component").first().waitFor();
    const [saved] = await Promise.all([page.waitForEvent("download"), page.locator("[data-do=save]").click()]);
    await saved.saveAs(`${scratch}/told.toml`);
    const given = readFileSync(`${scratch}/told.toml`, "utf8");
    assert.equal(Number(/switch_at = \[([^\]]*)\]/.exec(given)[1]), Number((0.2 * Number(step)).toPrecision(12)));
  }));

  test("a formation: tasks by methods, and a trial with robots and walls", () => opened([`${scratch}/formation`], async (page) => {
    run("export", `${scratch}/formation`, "--to", "csv");
    const [names, ...rows] = readFileSync(`${scratch}/formation/trials.csv`, "utf8").trim().split("\n").map((line) => line.split(","));
    await page.locator(".multiple").first().waitFor();
    assert.equal(await page.locator(".multiple").count(), new Set(rows.map((row) => `${row[names.indexOf("task")]} ${row[names.indexOf("method")]}`)).size);
    assert.ok(await coloursOf(page, ".multiples .task") > 3);
    await page.locator(".multiple").first().focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Enter");
    await page.locator("h2", { hasText: "1, dynamic" }).waitFor();
    await copies(page);
    await page.screenshot({ path: `${pictures}/view-formation.png` });
    await page.locator(".watch").click();
    await page.waitForFunction(() => Number(document.querySelector(".scrub").max) > 10);
    assert.match(await page.locator("h1").innerText(), /task 1, dynamic, trial 1/);
    assert.match(await page.locator("#about .legend").innerText(), /shepherds/);
    // it is scrubbed through, to its end and back
    await page.locator("[data-do=last]").click();
    await page.waitForFunction(() => Number(document.querySelector(".time").dataset.step) === Number(document.querySelector(".scrub").max));
    await page.locator(".scrub").evaluate((input) => { input.value = "150"; input.dispatchEvent(new Event("input", { bubbles: true })); });
    await page.waitForFunction(() => document.querySelector(".time").dataset.step === "150");
    await page.screenshot({ path: `${pictures}/view-formation-trial.png` });
    await page.locator("[data-do=last]").click();
    await page.waitForFunction(() => Number(document.querySelector(".time").dataset.step) === Number(document.querySelector(".scrub").max));
    // the time at which it ended is the one in the table
    const row = rows.find((one) => one[names.indexOf("task")] === "1" && one[names.indexOf("method")] === "dynamic" && one[names.indexOf("trial")] === "1");
    const steps = Number(row[names.indexOf("steps")]);
    const shown = Number((await page.locator(".time").innerText()).replace(/^t = /, "").split(/\s/)[0]);
    const step = 60 / Math.round(60 / (shown / steps));
    assert.ok(Math.abs(shown - steps * step) < 1e-3 * shown, `${shown} after ${steps} steps`);
    await page.keyboard.press("Home");
    await page.waitForFunction(() => document.querySelector(".time").dataset.step === "0");
  }));

  test("each fits a phone, light and dark", async () => {
    for (const kind of ["study", "evolution", "design", "map", "optimisation", "decomposition", "formation"]) {
      await opened([`${scratch}/${kind}`], async (page) => {
        await page.locator(".searching canvas").first().waitFor();
        assert.equal(await overflow(page), 0, kind);
        await page.locator("[data-do=theme]").click();
      }, { context: { viewport: { width: 360, height: 740 } } });
    }
  });
});

describe("tracks", () => {
  const seen = (page) => page.waitForFunction(() => Number(document.querySelector(".scrub").max) > 10 && document.querySelector(".time").dataset.step !== undefined);

  test("individuals in colours, metrics along the time line, units of the table", () => opened([`${scratch}/tracks`], async (page) => {
    await seen(page);
    assert.equal(await page.locator("#about .legend li").count(), 5);
    assert.match(await page.locator(".scale").first().getAttribute("data-length"), /px/);
    assert.match(await page.locator(".time").innerText(), /frame 0 of 300/);
    assert.ok(await page.locator(".charts figure").count() > 5);
    // a click on a chart goes to that time
    await page.locator(".charts figure canvas").first().click({ position: { x: 160, y: 30 } });
    await page.waitForFunction(() => Number(document.querySelector(".time").dataset.step) > 20);
    await page.locator("input.agent").fill("2");
    await page.locator("#focal .tables", { hasText: "speed" }).waitFor();
    assert.match(await page.locator("#focal .who").innerText(), /recorded/);
    assert.match(await page.locator("#focal .tables").innerText(), /whole recording/);
    await copies(page);
    await page.screenshot({ path: `${pictures}/view-tracks.png` });
    await page.keyboard.press("Escape");
    await page.locator("[data-do=play]").click();
    const before = Number(await page.locator(".time").getAttribute("data-step"));
    await page.waitForFunction((before) => Number(document.querySelector(".time").dataset.step) > before + 3, before);
  }));

  test("people who come and go", () => opened([`${scratch}/corridor`], async (page) => {
    await seen(page);
    assert.match(await page.locator(".time").innerText(), /number 500/);
    await page.locator("[data-do=last]").click();
    await page.waitForFunction(() => Number(document.querySelector(".time").dataset.step) === Number(document.querySelector(".scrub").max));
    await page.screenshot({ path: `${pictures}/view-corridor.png` });
  }));

  test("several recordings of a folder can be chosen, and what was flagged is marked", () => opened([`${scratch}/several`], async (page) => {
    await page.locator(".screen").nth(1).waitFor();
    await seen(page);
    const choice = page.locator(".recordings select");
    assert.deepEqual((await choice.locator("option").allInnerTexts()).slice(1), ["shoal", "corridor", "in seconds"]);
    await choice.selectOption({ label: "in seconds" });
    await page.waitForFunction(() => document.querySelectorAll(".screen").length === 1);
    await page.locator("#events li.flag").first().waitFor();
    assert.ok(await page.locator(".event-marks .flag").count() > 0);
    const when = page.locator("#events li.flag button").first();
    await when.click();
    await page.waitForFunction(() => Number(document.querySelector(".time").dataset.step) > 0);
    // what was measured frame by frame over areas is among the charts
    assert.ok(await page.locator(".charts figure.own").count() > 0);
    await page.screenshot({ path: `${pictures}/view-flagged.png` });
    await choice.selectOption({ index: 0 });
    await page.locator(".screen").nth(1).waitFor();
  }));

  test("they fit a phone", () => opened([`${scratch}/tracks`], async (page) => {
    await seen(page);
    assert.equal(await overflow(page), 0);
  }, { context: { viewport: { width: 360, height: 740 } } }));
});

describe("drawing", () => {
  test("a wall that is drawn and saved is accepted, and obeyed", () => opened([], async (page) => {
    await page.locator(".stage").waitFor();
    const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.locator("[data-do=open]").click()]);
    await chooser.setFiles(`${root}studies/gallery/corral.toml`);
    await page.locator(".item.wall").nth(1).waitFor();
    // across the throat of the funnel, from edge to edge, by the keyboard alone
    const stage = page.locator(".stage");
    const at = (x, y) => page.evaluate(([x, y]) => {
      const box = document.querySelector(".stage").getBoundingClientRect(), edge = document.querySelector(".edge").getBBox();
      const others = [...document.querySelectorAll(".edge")].map((one) => one.getBBox());
      const [left, right] = [Math.min(...others.map((one) => one.x)), Math.max(...others.map((one) => one.x + one.width))];
      const [top, bottom] = [Math.min(...others.map((one) => one.y)), Math.max(...others.map((one) => one.y + one.height))];
      return [box.left + left + x / 140 * (right - left), box.top + bottom - y / 100 * (bottom - top), edge.width];
    }, [x, y]);
    await page.locator("[data-tool=wall]").click();
    const [x0, y0] = await at(80, 0), [x1, y1] = await at(80, 100);
    await page.mouse.click(x0, y0);
    await page.mouse.click(x1, y1);
    await page.keyboard.press("Escape");
    assert.equal(await page.locator(".item.wall").count(), 3);
    await stage.focus();
    await page.keyboard.press("Control+z");
    assert.equal(await page.locator(".item.wall").count(), 2);
    await page.keyboard.press("Control+y");
    assert.equal(await page.locator(".item.wall").count(), 3);
    await page.locator("[data-tool=region]").click();
    await page.mouse.click(...(await at(100, 40)).slice(0, 2));
    await page.mouse.click(...(await at(120, 60)).slice(0, 2));
    await page.locator(".item.region").waitFor();
    await page.screenshot({ path: `${pictures}/view-drawing.png` });
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator("[data-do=save-drawing]").click()]);
    const file = `${scratch}/drawn.toml`;
    await download.saveAs(file);
    run("check", file);
    const furthest = (text, folder) => {
      run("run", text, "--out", folder);
      run("export", folder, "--to", "csv");
      const [names, ...rows] = readFileSync(`${folder}/trajectory.csv`, "utf8").trim().split("\n").map((line) => line.split(","));
      const x = names.indexOf("x");
      return Math.max(...rows.map((row) => Number(row[x])));
    };
    assert.ok(furthest("studies/gallery/corral.toml", `${scratch}/corral`) > 91, "without the wall they go into the pen");
    const behind = furthest(file, `${scratch}/walled`);
    assert.ok(behind < 80.5, `with it they stay before it, and got to ${behind}`);
    const saves = async (as) => {
      await page.locator("label", { hasText: "Save as" }).locator("select").selectOption(as);
      const [download] = await Promise.all([page.waitForEvent("download"), page.locator("[data-do=save-drawing]").click()]);
      const path = `${scratch}/${download.suggestedFilename()}`;
      await download.saveAs(path);
      return readFileSync(path, "utf8");
    };
    assert.match(await saves("geojson"), /"role":"region","name":"region-1"/);
    assert.match(await saves("svg"), /<line class="workspace"/);
    assert.match(await saves("workspace"), /region\.region-1\.box/);
  }, { hash: "#draw" }));

  test("by the keyboard alone, and tried at once", () => opened([], async (page) => {
    await page.locator(".stage").waitFor();
    await page.locator(".stage").focus();
    await page.keyboard.press("2");
    await page.keyboard.press("Enter");
    for (const key of ["ArrowRight", "ArrowRight", "ArrowUp"]) await page.keyboard.press(key);
    await page.keyboard.press("Enter");
    await page.locator(".item.wall").waitFor();
    await page.locator("[data-do=try]").click();
    await playing(page);
  }, { hash: "#draw" }));

  test("what every tool draws is in the files, and comes back from them", () => opened([], async (page) => {
    await page.locator(".stage").waitFor();
    const box = await page.locator(".stage").boundingBox();
    const tools = {
      wall: [[0.38, 0.3], [0.45, 0.3]], disc: [[0.52, 0.35], [0.58, 0.35]], box: [[0.4, 0.6], [0.45, 0.7]], anchor: [[0.62, 0.5]],
      polygon: [[0.54, 0.6], [0.61, 0.6], [0.61, 0.72], [0.54, 0.6]], region: [[0.5, 0.45], [0.57, 0.55]], gate: [[0.48, 0.3], [0.48, 0.4]],
      boundary: [[0.35, 0.2], [0.65, 0.2], [0.65, 0.8], [0.35, 0.2]], start: [[0.4, 0.42], [0.46, 0.54]],
    };
    for (const [tool, points] of Object.entries(tools)) {
      await page.locator(`[data-tool=${tool}]`).click();
      for (const [u, v] of points) await page.mouse.click(box.x + u * box.width, box.y + v * box.height);
      await page.keyboard.press("Escape");
      assert.equal(await page.locator(`.item.${tool}`).count(), 1, tool);
    }
    const saves = async (as) => {
      await page.locator("label", { hasText: "Save as" }).locator("select").selectOption(as);
      const [download] = await Promise.all([page.waitForEvent("download"), page.locator("[data-do=save-drawing]").click()]);
      const path = `${scratch}/every-${as}-${download.suggestedFilename()}`;
      await download.saveAs(path);
      return path;
    };
    const scenario = await saves("file");
    run("check", scenario);
    const text = readFileSync(scenario, "utf8");
    for (const part of ["segment", "ball", "box", "polygon", "place"]) assert.ok(text.includes(part), part);
    assert.match(readFileSync(await saves("workspace"), "utf8"), /anchor\.|gate\./);
    const kept = { geojson: ["wall", "disc", "polygon", "anchor", "gate", "region", "boundary"], svg: ["wall", "disc", "polygon"] };
    for (const [as, items] of Object.entries(kept)) {
      const [chooser, path] = [page.waitForEvent("filechooser"), await saves(as)];
      await page.locator("[data-do=open]").click();
      await (await chooser).setFiles(path);
      await page.waitForFunction(() => document.querySelectorAll(".stage .item.start").length === 0);
      for (const item of items) assert.ok(await page.locator(`.stage .item.${item}`).count() > 0, `${item} from ${as}`);
    }
  }, { hash: "#draw" }));

  test("it fits a phone", () => opened([], async (page) => {
    await page.locator(".stage").waitFor();
    assert.equal(await overflow(page), 0);
  }, { hash: "#draw", context: { viewport: { width: 360, height: 740 } } }));
});

describe("what is sent", () => {
  /** Drops a file on the page. */
  const drop = (page, name, text) => page.evaluate(([name, text]) => {
    const data = new DataTransfer();
    data.items.add(new File([text], name));
    document.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  }, [name, text]);

  test("a file that is dropped on the page opens", () => opened([], async (page) => {
    await page.locator("#gallery .wall li").first().waitFor();
    await drop(page, "mill.toml", readFileSync(`${root}studies/gallery/mill.toml`, "utf8"));
    await playing(page);
    assert.equal(await page.locator("h1").innerText(), "A mill");
    await drop(page, "broken.toml", "kind = \"scenario\"\ntitel = 1\n");
    await page.locator("#notice", { hasText: "titel" }).waitFor();
  }));

  /** Drops files with their bytes, as a folder comes in. */
  const dropFiles = (page, files) => page.evaluate((files) => {
    const data = new DataTransfer();
    for (const [name, text] of files) data.items.add(new File([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))], name));
    document.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  }, files.map((path) => [path.split("/").at(-1), readFileSync(path).toString("base64")]));
  const filesOf = (folder) => readdirSync(folder, { withFileTypes: true }).filter((entry) => entry.isFile()).map(({ name }) => `${folder}/${name}`);

  test("folders, tables and pages that are dropped open as well", () => opened([], async (page) => {
    await page.locator("#gallery .wall li").first().waitFor();
    await dropFiles(page, filesOf(`${scratch}/run`));
    await page.waitForFunction(() => Number(document.querySelector(".scrub").max) === 60);
    await dropFiles(page, filesOf(`${scratch}/formation`));
    await page.locator(".multiple").first().waitFor();
    await dropFiles(page, [`${root}studies/tracks/sticklebacks.csv`]);
    await page.waitForFunction(() => Number(document.querySelector(".scrub").max) === 300);
    // nobody wrote down the frame rate: it is said, and not guessed
    await page.locator("#notice", { hasText: "--fps" }).waitFor();
    await dropFiles(page, [`${scratch}/run/trajectory.parquet`]);
    await page.waitForFunction(() => document.querySelector("#about .legend").childElementCount === 200);
    run("export", `${scratch}/run`, "--to", "html", "--out", scratch);
    await dropFiles(page, [`${scratch}/run.html`]);
    await page.waitForFunction(() => Number(document.querySelector(".scrub").max) === 60 && /Read out of/.test(document.querySelector("#about").textContent));
    await dropFiles(page, [`${scratch}/study/report.html`]);
    await page.locator("#notice", { hasText: "plays nothing" }).waitFor();
    await dropFiles(page, [`${scratch}/study/cells.parquet`]);
    await page.locator("#notice", { hasText: "cannot be opened" }).waitFor();
    await dropFiles(page, [`${scratch}/run/run.log`].filter((path) => existsSync(path)).concat(`${root}web/style.css`).slice(-1));
    await page.locator("#notice", { hasText: "What can be opened" }).waitFor();
  }));

  test("searches are sent with what tells most, and play from disk without a network", async () => {
    for (const kind of ["study", "evolution", "design", "map", "optimisation", "decomposition", "formation"]) {
      assert.match(run("export", `${scratch}/${kind}`, "--to", "html", "--out", scratch), new RegExp(`${kind}\\.html: .*to play`));
      await watched(async (page, context) => {
        await context.setOffline(true);
        const address = pathToFileURL(`${scratch}/${kind}.html`).href;
        await page.goto(address);
        const player = page.locator(".player").first();
        await player.locator(".scrub").waitFor();
        await page.waitForFunction(() => Number(document.querySelector(".player .scrub").max) > 5);
        await player.locator("[data-do=play]").first().click();
        await page.waitForFunction(() => Number(document.querySelector(".player .scrub").value) > 2);
        assert.ok(await page.locator("button", { hasText: "Copy" }).count() > 0);
        await page.screenshot({ path: `${pictures}/export-${kind}.png` });
        return address;
      });
    }
    assert.match(run("export", `${scratch}/formation`, "--to", "png", "--at", "task=0,method=2", "--out", scratch), /formation\.png: .*1 frame/);
    assert.match(run("export", `${scratch}/evolution`, "--to", "gltf", "--every", "20", "--out", scratch), /evolution\.glb: /);
  });

  test("an export plays from disk without a network", async () => {
    const told = run("export", `${scratch}/run`, "--to", "html", "--out", scratch);
    assert.match(told, /run\.html: \d/);
    await watched(async (page, context) => {
      await context.setOffline(true);
      const address = pathToFileURL(`${scratch}/run.html`).href;
      await page.goto(address);
      await page.locator(".player .scrub").waitFor();
      await page.waitForFunction(() => Number(document.querySelector(".player .scrub").max) > 10);
      await page.locator(".player [data-do=play]").first().click();
      await page.waitForFunction(() => Number(document.querySelector(".player .scrub").value) > 3);
      assert.ok(await coloursOf(page, ".player canvas") > 20);
      return address;
    });
  });

  test("every drawing of a report is copied as SVG with its data", async () => {
    for (const [kind, selector, heads] of [["run", "[data-chart='0']", /^time/], ["run", ".scenes .moment", /^group,x,y,z/], ["design", ".moment", /^what,number,x,y,radius/], ["map", ".moment", /^angle_low,angle_high,length_low/]]) {
      await watched(async (page) => {
        await page.addInitScript(() => { Object.defineProperty(navigator, "clipboard", { value: { writeText: async (text) => { window.copied = text; } } }); });
        const address = pathToFileURL(`${scratch}/${kind}/report.html`).href;
        await page.goto(address);
        await page.locator(`${selector} [data-do=copy-svg]`).first().click();
        await page.waitForFunction(() => typeof window.copied === "string");
        const { root, data, rows } = await page.evaluate(() => {
          const read = new DOMParser().parseFromString(window.copied, "image/svg+xml");
          const data = read.querySelector("metadata").textContent;
          return { root: read.documentElement.tagName, data, rows: data.trim().split("\n").length };
        });
        assert.equal(root, "svg");
        assert.match(data, heads, kind);
        assert.ok(rows > 2, `${kind}: ${rows}`);
        return address;
      });
    }
  });

  test("pictures are made without a browser, and look as they should", async () => {
    run("export", `${scratch}/run`, "--to", "png", "--out", scratch, "--frame", "30");
    run("export", `${scratch}/run`, "--to", "svg", "--out", scratch);
    run("export", `${scratch}/run`, "--to", "gif", "--out", scratch, "--frames", "0..9", "--width", "240");
    run("export", `${scratch}/run`, "--to", "gltf", "--out", scratch);
    await watched(async (page) => {
      const address = pathToFileURL(`${scratch}/`).href;
      for (const name of ["run.png", "run.svg", "run.gif"]) {
        await page.goto(address + name);
        const bytes = await page.screenshot();
        assert.ok(bytes.length > 5000, name);
      }
      return address;
    });
  });
});
