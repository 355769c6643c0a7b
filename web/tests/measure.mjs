// How fast the page and the real server are together, in software WebGL at 1280 x 720. No test: what it prints depends on the
// machine. `node measure.mjs PROGRAM [AGENTS...]` (a release build) prints one line of JSON for each size; benches/README.md keeps them.

import { spawn } from "node:child_process";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { chromium } from "playwright-core";

const program = process.argv[2];
if (!program) {
  console.error("usage: node measure.mjs PROGRAM [AGENTS...]");
  process.exit(2);
}
const scratch = mkdtempSync(`${tmpdir()}/flockworks-measure-`);

/** Agents of the first model in a closed plane, four of them in a unit square. */
const scenario = (agents) => `kind = "scenario"
title = "${agents} agents"
seed = 1
precision = "f32"
time = { duration = 1000000 }
space = { dimensions = 2, edges = "periodic", size = ${Math.sqrt(agents / 4).toFixed(3)} }
group.swarm = { count = ${agents}, model = { vicsek_1995 = { noise_amplitude = 60 } } }
measure = { metrics = ["polarisation"] }
`;

const median = (values) => values.filter((value) => value !== null).sort((a, b) => a - b)[Math.floor(values.length / 2)] ?? null;
const rounded = (value) => (value === null ? null : Math.round(10 * value) / 10);

/** Listens to the socket: what was asked for last, and whether its answer has come. */
const listening = () => {
  window.answered = { agent: undefined, change: 0 };
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function listened(message) {
    if (!this.isHeard) {
      this.isHeard = true;
      this.addEventListener("message", ({ data }) => {
        if (typeof data !== "string") return;
        const { is, explanation } = JSON.parse(data);
        if (is === "explain") window.answered.agent = explanation.agent;
        if (is === "event") window.answered.change += 1;
      });
    }
    const asked = JSON.parse(message);
    if (asked.do === "focus") [window.focused, window.answered.agent] = [asked.agent, undefined];
    send.call(this, message);
  };
};

/** Milliseconds, in the page, from an event until the picture after something holds; none where it does not come to that. */
const until = async (page, event, holds, act) => {
  const passed = page.evaluate(([event, holds]) => new Promise((tell) => {
    const is = new Function("before", `return ${holds}`);
    addEventListener(event, () => {
      const began = performance.now(), before = { ...window.answered, step: document.querySelector(".time").dataset.step };
      const look = () => {
        if (performance.now() - began > 3000) tell(null);
        else if (is(before)) requestAnimationFrame(() => tell(performance.now() - began));
        else requestAnimationFrame(look);
      };
      requestAnimationFrame(look);
    }, { once: true, capture: true });
  }), [event, holds]);
  await act();
  return passed;
};

const ARROWS = "window.focused !== null && window.answered.agent === window.focused";
const CHANGED = "window.answered.change > before.change && document.querySelector('.time').dataset.step !== before.step";

async function measure(agents) {
  const file = `${scratch}/${agents}.toml`;
  writeFileSync(file, scenario(agents));
  const started = performance.now();
  const server = spawn(program, ["view", file], { stdio: ["ignore", "pipe", "inherit"] });
  const browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
      "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  try {
    const address = await new Promise((resolve, reject) => {
      server.stdout.once("data", (bytes) => resolve({ url: bytes.toString().split("\n")[0], after: performance.now() - started }));
      server.once("exit", () => reject(new Error("the server ended")));
    });
    const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
    await page.addInitScript(listening);
    const asked = performance.now();
    await page.goto(address.url);
    await page.waitForFunction(() => document.querySelector(".time").dataset.step !== undefined, undefined, { polling: "raf" });
    const first = performance.now() - asked;
    await page.locator("select.speed").selectOption("0");
    await page.locator("[data-do=play]").click();
    await page.waitForFunction(() => Number(document.querySelector(".time").dataset.step) > 3);
    const pictures = [], reached = [];
    for (let second = 0; second < 10; second += 1) {
      await page.waitForTimeout(1000);
      const pace = await page.locator(".pace").evaluate((place) => [place.dataset.pictures, place.textContent]);
      pictures.push(Number(pace[0]));
      reached.push(pace[1]);
    }
    await page.locator("select.speed").selectOption("20");
    const clicks = [], changes = [];
    const box = await page.locator("canvas").first().boundingBox();
    for (let turn = 0; turn < 11; turn += 1) {
      const [x, y] = [box.x + box.width * (0.4 + 0.02 * turn), box.y + box.height * (0.6 - 0.02 * turn)];
      clicks.push(await until(page, "pointerup", ARROWS, () => page.mouse.click(x, y)));
    }
    await page.keyboard.press("Escape");
    const slider = page.locator("#parameters input[type=range]").first();
    for (let turn = 0; turn < 11; turn += 1) {
      changes.push(await until(page, "input", CHANGED, () => slider.evaluate((input, share) => {
        input.value = Number(input.min) + (Number(input.max) - Number(input.min)) * share;
        input.dispatchEvent(new Event("input", { bubbles: true }));
      }, 0.1 + 0.07 * turn)));
    }
    console.log(JSON.stringify({
      agents,
      server_ready_ms: rounded(address.after),
      first_frame_ms: rounded(first),
      pictures_per_s: median(pictures),
      reached: reached.at(-1),
      click_to_arrows_ms: rounded(median(clicks)),
      change_to_frame_ms: rounded(median(changes)),
    }));
  } finally {
    await browser.close();
    server.kill();
  }
}

const sizes = process.argv.slice(3).map(Number);
for (const agents of sizes.length ? sizes : [5_000, 20_000, 100_000]) await measure(agents);
