// How fast the page and the real server of `flockworks view` are together, in a headless Chromium with software WebGL.
//
//     node benches/view.mjs FLOCKWORKS [AGENTS...]
//
// FLOCKWORKS is the release binary; `web/tests` holds the browser's driver (`npm install` there). A line of JSON comes out for each
// size. No test: the numbers depend on the machine; benches/README.md keeps them. What is wrong (a complaint of the page, an answer
// that does not come) ends it with exit code 1.

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { chromium } from "../web/tests/node_modules/playwright-core/index.mjs";

const SIZES = [5_000, 20_000, 100_000];
const TURNS = 11, WINDOWS = 10, LOADS = 5;
/** Steps per second that are asked for; 0 is as fast as possible. */
const PACE = 60, FASTEST = 0;

const [program, ...sizes] = process.argv.slice(2);
if (!program || sizes.some((size) => !(Number(size) > 0))) {
  console.error("usage: node benches/view.mjs FLOCKWORKS [AGENTS...]");
  process.exit(2);
}

/** Agents of the first model in a closed plane, four of them in a unit square. */
const scenario = (agents) => `kind = "scenario"
title = "${agents} agents"
seed = 1
precision = "f32"
time = { duration = 1000000 }
space = { dimensions = 2, edges = "periodic", size = ${Math.sqrt(agents / 4).toFixed(3)} }
group.swarm = { count = ${agents}, model = { vicsek_1995 = { noise_amplitude = 300 } } }
measure = { metrics = ["polarisation"] }
`;

const ranked = (values) => values.toSorted((a, b) => a - b);
const median = (values) => ranked(values)[Math.floor(values.length / 2)];
const rounded = (value) => Math.round(10 * value) / 10;
/** Median and greatest. */
const spread = (values) => [rounded(median(values)), rounded(Math.max(...values))];

/** In the page, before it begins: notes when pictures of new frames were drawn, and what was asked and answered. */
function watching() {
  const seen = { first: null, pictures: [], focused: null, explained: null, changed: null };
  const step = () => document.querySelector(".time").dataset.step;
  const button = () => document.querySelector("[data-do=play]").getAttribute("aria-label");
  // what a picture shows after something was done; `before` is the step that was shown then
  seen.shows = {
    arrows: () => seen.focused !== null && seen.explained === seen.focused && document.querySelector(".overlay [data-arrow]") !== null
      && document.querySelector(`.overlay .focal-ring[data-agent="${seen.focused}"]`) !== null,
    change: () => seen.changed !== null && Number(step()) > seen.changed,
    pause: () => button() === "Play",
    play: (before) => button() === "Pause" && step() !== before,
  };
  Object.assign(window, { seen });
  const send = WebSocket.prototype.send;
  const heard = new WeakSet();
  WebSocket.prototype.send = function watched(message) {
    if (!heard.has(this)) {
      heard.add(this);
      this.addEventListener("message", ({ data }) => {
        if (typeof data !== "string") return;
        const told = JSON.parse(data);
        if (told.is === "explain") seen.explained = told.explanation.agent;
        if (told.is === "event") seen.changed = told.step;
      });
    }
    const asked = JSON.parse(message);
    if (asked.do === "focus") Object.assign(seen, { focused: asked.agent, explained: null });
    if (asked.do === "set") seen.changed = null;
    send.call(this, message);
  };
  addEventListener("DOMContentLoaded", () => {
    const drawn = () => {
      // a picture is there when the one after it is begun
      requestAnimationFrame(() => { const now = performance.now(); seen.first ??= now; seen.pictures.push(now); });
    };
    new MutationObserver(drawn).observe(document.querySelector(".time"), { attributeFilter: ["data-step"] });
  });
}

/** Milliseconds from an event in the page to the picture that shows what comes of it. */
async function latency(page, event, what, act) {
  // the page listens before anything is done to it
  await page.evaluate(([event, what]) => {
    seen.passed = new Promise((tell, fail) => {
      const late = setTimeout(() => fail(new Error(`no ${what} within 5 s`)), 5000);
      addEventListener(event, ({ timeStamp }) => {
        const before = document.querySelector(".time").dataset.step;
        const look = () => {
          if (!seen.shows[what](before)) requestAnimationFrame(look);
          else requestAnimationFrame(() => { clearTimeout(late); tell(performance.now() - timeStamp); });
        };
        requestAnimationFrame(look);
      }, { once: true, capture: true });
    });
    seen.passed.catch(() => {});
  }, [event, what]);
  await act();
  return page.evaluate(() => seen.passed);
}

async function repeated(times, measure) {
  const values = [];
  for (let turn = 0; turn < times; turn += 1) values.push(await measure(turn));
  return values;
}

async function measured(browser, address, agents, started) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
  const page = await context.newPage();
  const complaints = [];
  let size = 0;
  page.on("console", (message) => { if (!/GPU stall due to ReadPixels/.test(message.text())) complaints.push(`${message.type()}: ${message.text()}`); });
  page.on("pageerror", (error) => complaints.push(`error: ${error.stack}`));
  page.on("crash", () => complaints.push("the page crashed"));
  page.on("response", (response) => { size += Number(response.headers()["content-length"] ?? 0); });
  await page.addInitScript(watching);
  const first = await repeated(LOADS, async () => {
    size = 0;
    await page.goto(address);
    await page.waitForFunction(() => seen.first !== null, undefined, { polling: "raf" });
    return page.evaluate(() => seen.first);
  });

  /** Pictures of new frames in each second at a pace, and the pace that was reached. */
  const played = async (pace) => {
    await page.locator("select.speed").selectOption(String(pace));
    await page.waitForTimeout(500);
    const from = await page.evaluate(() => performance.now());
    await page.waitForTimeout(1000 * WINDOWS + 100);
    const [pictures, reached] = await page.evaluate(() => [seen.pictures, document.querySelector(".pace").textContent]);
    const each = Array.from({ length: WINDOWS }, (_, k) => pictures.filter((at) => at >= from + 1000 * k && at < from + 1000 * (k + 1)).length);
    return [median(each), Math.min(...each), reached.split(",")[0]];
  };
  const fastest = await played(FASTEST), paced = await played(PACE);

  const box = await page.locator("canvas").first().boundingBox();
  const click = await repeated(TURNS, (turn) => latency(page, "pointerup", "arrows", () =>
    page.mouse.click(box.x + box.width * (0.3 + 0.02 * turn), box.y + box.height * (0.7 - 0.02 * turn))));
  await page.keyboard.press("Escape");
  const slider = page.locator("#parameters input[type=range]").first();
  const change = await repeated(TURNS, (turn) => latency(page, "input", "change", () => slider.evaluate((input, share) => {
    input.value = Number(input.min) + (Number(input.max) - Number(input.min)) * share;
    input.dispatchEvent(new Event("input", { bubbles: true }));
  }, 0.1 + 0.03 * turn)));
  await page.locator("canvas").first().focus();
  const pause = [], play = [];
  await repeated(TURNS, async () => {
    pause.push(await latency(page, "keydown", "pause", () => page.keyboard.press("Space")));
    play.push(await latency(page, "keydown", "play", () => page.keyboard.press("Space")));
  });
  await context.close();
  if (complaints.length > 0) throw new Error(complaints.join("\n"));
  return {
    agents, server_ready_ms: rounded(started), page_bytes: size, first_frame_ms: spread(first), pictures_per_s: paced,
    pictures_per_s_at_full_speed: fastest,
    click_ms: spread(click), change_ms: spread(change), pause_ms: spread(pause), play_ms: spread(play),
  };
}

async function served(scratch, agents) {
  const file = `${scratch}/${agents}.toml`;
  writeFileSync(file, scenario(agents));
  const began = performance.now();
  const server = spawn(program, ["view", file], { stdio: ["ignore", "pipe", "inherit"] });
  const ready = new Promise((resolve, reject) => {
    server.stdout.once("data", (bytes) => resolve([bytes.toString().split("\n")[0], performance.now() - began]));
    server.once("exit", () => reject(new Error("the server ended")));
  });
  const browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
      "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  try {
    const [address, after] = await ready;
    console.log(JSON.stringify(await measured(browser, address, agents, after)));
  } finally {
    await browser.close();
    server.kill();
  }
}

const scratch = mkdtempSync(`${tmpdir()}/flockworks-view-`);
try {
  for (const agents of sizes.length ? sizes.map(Number) : SIZES) await served(scratch, agents);
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
} finally {
  rmSync(scratch, { recursive: true });
}
