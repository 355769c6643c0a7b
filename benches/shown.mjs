// How fast large searches open and scroll, and how large an export is, with the release binary and a headless Chromium.
//
//     node benches/shown.mjs FLOCKWORKS [study|wall|export...]
//
// `web/tests` holds the browser's driver (`npm install` there). A line of JSON comes out for each part. The study has the 281 cells of
// studies/behaviour-selection/all.toml and 100 trials of each, with all its readings, filled with trials of three steps in place of
// 6,000: what is opened has the same size, and takes minutes to make in place of hours. The wall has 1,000 feasible
// environments. No test: the numbers depend on the machine; benches/README.md keeps them. A complaint of the page ends it with exit
// code 1.

import { execFileSync, spawn } from "node:child_process";
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { fileURLToPath } from "node:url";
import { chromium } from "../web/tests/node_modules/playwright-core/index.mjs";

const root = fileURLToPath(new URL("..", import.meta.url));
const [program, ...wanted] = process.argv.slice(2);
if (!program) {
  console.error("usage: node benches/shown.mjs FLOCKWORKS [study|wall|export...]");
  process.exit(2);
}
// what was made is kept where one names a place for it
const kept = process.env.FLOCKWORKS_SHOWN;
const scratch = kept ?? mkdtempSync(`${tmpdir()}/flockworks-shown-`);
mkdirSync(scratch, { recursive: true });
const run = (...words) => execFileSync(program, words, { cwd: root, stdio: ["ignore", "pipe", "inherit"], maxBuffer: 1 << 26 }).toString();
const ranked = (values) => values.toSorted((a, b) => a - b);
const median = (values) => ranked(values)[Math.floor(values.length / 2)];
const rounded = (value) => Math.round(10 * value) / 10;
const LOADS = 5;

async function opened(folder, act) {
  const began = performance.now();
  const server = spawn(program, ["view", folder], { cwd: root, stdio: ["ignore", "pipe", "inherit"] });
  const browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  try {
    const [address, ready] = await new Promise((resolve, reject) => {
      server.stdout.once("data", (bytes) => resolve([bytes.toString().split("\n")[0], performance.now() - began]));
      server.once("exit", () => reject(new Error("the server ended")));
    });
    const page = await (await browser.newContext({ viewport: { width: 1280, height: 720 } })).newPage();
    const complaints = [];
    page.on("console", (message) => { if (!/GPU stall due to ReadPixels/.test(message.text())) complaints.push(`${message.type()}: ${message.text()}`); });
    page.on("pageerror", (error) => complaints.push(`error: ${error.stack}`));
    const found = await act(page, address);
    if (complaints.length > 0) throw new Error(complaints.join("\n"));
    return { server_ready_ms: rounded(ready), ...found };
  } finally {
    await browser.close();
    server.kill();
  }
}

/** Milliseconds from the address to the picture on which all cells stand. */
async function loads(page, address, ready) {
  const times = [];
  for (let turn = 0; turn < LOADS; turn += 1) {
    await page.goto("about:blank");
    const began = performance.now();
    await page.goto(address);
    await page.waitForFunction(ready, undefined, { polling: "raf" });
    times.push(performance.now() - began);
  }
  return [rounded(median(times)), rounded(Math.max(...times))];
}

async function study() {
  const folder = `${scratch}/study`;
  if (!existsSync(`${folder}/report.html`)) {
    // what all experiments share, with three steps in place of 6,000
    cpSync(`${root}studies/behaviour-selection`, `${scratch}/behaviour-selection`, { recursive: true });
    const common = `${scratch}/behaviour-selection/common.toml`;
    const shorter = [["duration = 600", "duration = 0.3"], ["from = 481\ninterval = 1", "from = 0.1\ninterval = 0.1"], ["[scenario.record]\ninterval = 1", "[scenario.record]\ninterval = 0.1"], ["cells = 10, from = 1", "cells = 10, from = 0.1"]];
    writeFileSync(common, shorter.reduce((text, [from, to]) => { if (!text.includes(from)) throw new Error(`${common} lacks ${from}`); return text.replace(from, to); }, readFileSync(common, "utf8")));
    run("run", `${scratch}/behaviour-selection/all.toml`, "--out", folder);
  }
  return opened(folder, async (page, address) => {
    const first = await loads(page, address, () => document.querySelectorAll(".multiple[data-cell]").length > 0 && document.querySelector("#searched .state").textContent === "");
    const cells = await page.locator(".multiple[data-cell]").count();
    const overview = await (await page.request.get(`${address}search/0`)).json();
    return { part: "study", cells: overview.levels.length, trials: overview.trials, readings: overview.readings.length, cells_of_the_first_part: cells, opens_ms: first, folder_mb: rounded(statSync(`${folder}/trials.log`).size / 1e6) };
  });
}

async function wall() {
  const folder = `${scratch}/wall`;
  if (!existsSync(`${folder}/report.html`)) {
    const text = readFileSync(`${root}studies/environments/table-7.2-corralling.toml`, "utf8").split("# as figure 7.7")[0].replaceAll('"field.toml"', `"${root}studies/environments/field.toml"`).replaceAll('"grammars/', `"${root}studies/environments/grammars/`);
    writeFileSync(`${scratch}/wall.toml`, text);
    run("run", `${scratch}/wall.toml`, "--set", "attempts=6000", "--set", "feasible=1000", "--set", "trials=1", "--set", "set.time.duration=1", "--out", folder);
  }
  return opened(folder, async (page, address) => {
    const first = await loads(page, address, () => document.querySelectorAll(".tile").length > 8);
    // scrolls from the first to the last environment, a little with each picture
    const [pictures, seconds, tiles] = await page.evaluate(async () => {
      const list = document.querySelector(".tiles");
      const last = list.scrollHeight - list.clientHeight, times = [];
      const began = performance.now();
      for (let now = began; now - began < 8000; now = await new Promise((tell) => { requestAnimationFrame(() => tell(performance.now())); })) {
        list.scrollTop = last * Math.min(1, (now - began) / 7500);
        times.push(now);
      }
      return [times.length, (times.at(-1) - began) / 1000, document.querySelectorAll(".tile").length];
    });
    const overview = await (await page.request.get(`${address}search/0`)).json();
    return { part: "wall", environments: overview.environments.length, opens_ms: first, pictures_per_s_while_scrolling: rounded(pictures / seconds), tiles_on_the_page: tiles };
  });
}

async function exported() {
  const folder = `${scratch}/long`;
  if (!existsSync(`${folder}/report.html`)) run("run", "studies/schooling.toml", "--set", "time.duration=600", "--set", "record.interval=0.1", "--out", folder);
  const began = performance.now();
  const told = run("export", folder, "--to", "html", "--every", "1", "--out", scratch).trim();
  return { part: "export", told: told.replace(`${scratch}/`, ""), bytes: statSync(`${scratch}/long.html`).size, seconds: rounded((performance.now() - began) / 1000) };
}

try {
  for (const [name, measure] of Object.entries({ study, wall, export: exported })) {
    if (wanted.length === 0 || wanted.includes(name)) console.log(JSON.stringify(await measure()));
  }
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
} finally {
  if (!kept) rmSync(scratch, { recursive: true });
}
