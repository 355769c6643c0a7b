// The viewer's page with the real server behind it: what the page shows is what the engine computed.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { built } from "./built.mjs";

const root = fileURLToPath(new URL("../..", import.meta.url));
const pictures = `${root}target/pages`;
const scratch = mkdtempSync(`${tmpdir()}/flockworks-view-`);
const run = `${scratch}/run`;

let browser, program;

before(async () => {
  mkdirSync(pictures, { recursive: true });
  program = built("flockworks");
  execFileSync(program, ["run", "studies/schooling.toml", "--quick", "--out", run], { cwd: root, stdio: "ignore" });
  browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
      "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
});

after(() => browser?.close());

/** Serves something, opens the page, does something with it, and sees to it that nothing was complained about. */
async function opened(given, act) {
  const server = spawn(program, ["view", ...given], { cwd: root, stdio: ["ignore", "pipe", "inherit"] });
  try {
    const address = await new Promise((resolve, reject) => {
      server.stdout.once("data", (bytes) => resolve(bytes.toString().split("\n")[0]));
      server.once("exit", () => reject(new Error("the server ended")));
    });
    const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, acceptDownloads: true, reducedMotion: "reduce" });
    const page = await context.newPage();
    const complaints = [], requests = [];
    // this browser says so of every page that draws with WebGL, when WebGL is computed by software
    page.on("console", (message) => { if (!/GPU stall due to ReadPixels/.test(message.text())) complaints.push(`${message.type()}: ${message.text()}`); });
    page.on("pageerror", (error) => complaints.push(`error: ${error.stack}`));
    page.on("request", (request) => requests.push(request.url()));
    await page.goto(address);
    await act(page);
    assert.deepEqual(complaints, []);
    assert.deepEqual(requests.filter((url) => !url.startsWith(address) && !/^(data|blob):/.test(url)), []);
    await context.close();
  } finally {
    server.kill();
  }
}

/** A number as the page writes it. */
const read = (text) => Number(text.replace("\u2212", "-").split("\u202f")[0]);

/** The components that the page shows: name and magnitude. */
const components = (page) => page.locator("table.components tbody tr").evaluateAll((rows) =>
  rows.map((row) => [row.querySelector("th").textContent, row.querySelector("td.number").textContent]));

function same(shown, explained) {
  assert.deepEqual(shown.map(([name]) => name), explained.map((part) => part.name));
  for (const [at, [name, text]] of shown.entries()) {
    const { magnitude } = explained[at];
    assert.ok(Math.abs(read(text) - magnitude) <= 2e-3 * Math.abs(magnitude) + 1e-9, `${name}: ${text} for ${magnitude}`);
  }
}

/** What the command says of an agent in a frame of the run. */
const explained = (frame, agent) => JSON.parse(execFileSync(program, ["explain", run, "--frame", `${frame}`, "--agent", `${agent}`]));

describe("the real server", () => {
  test("the gallery shows every scenario", () => opened([], async (page) => {
    await page.locator("#gallery .wall li").nth(8).waitFor();
    assert.equal(await page.locator("#gallery .wall li").count(), 9);
  }));

  test("a simulation plays, and a changed parameter is in the saved file", () => opened(["studies/gallery/mill.toml"], async (page) => {
    await page.locator("#parameters input[type=range]").first().waitFor();
    await page.keyboard.press("Space");
    await page.waitForFunction(() => /step\s\d{2,}/.test(document.querySelector(".time").textContent));
    const slider = page.locator("#parameters input[type=range]").first();
    await slider.evaluate((input) => { input.value = "3"; input.dispatchEvent(new Event("input", { bubbles: true })); });
    await page.locator("#events li").first().waitFor();
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator("[data-do=save]").click()]);
    const file = `${scratch}/saved.toml`;
    await download.saveAs(file);
    assert.match(readFileSync(file, "utf8"), /repulsion_radius = 3/);
    execFileSync(program, ["check", file], { stdio: "ignore" });
    await page.screenshot({ path: `${pictures}/view-live.png` });
  }));

  test("the focal agent of a recorded frame is what the command explains", () => opened([run], async (page) => {
    await page.locator(".scrub").waitFor();
    await page.waitForFunction(() => Number(document.querySelector(".scrub").max) === 60);
    await page.locator(".scrub").evaluate((input) => { input.value = "37"; input.dispatchEvent(new Event("input", { bubbles: true })); });
    await page.locator("input.agent").fill("11");
    await page.locator("input.agent").press("Enter");
    await page.waitForFunction(() => /Agent 11/.test(document.querySelector("#focal .tables").textContent));
    await page.waitForFunction(() => /37/.test(document.querySelector(".time").textContent));
    const expected = explained(37, 11);
    await page.waitForFunction((step) => document.querySelector(".time").textContent.includes(`${step}`), expected.step);
    same(await components(page), expected.components);
    await page.screenshot({ path: `${pictures}/view-explained.png` });
  }));

  test("live and recorded, the same moment is explained alike", () => opened(["studies/schooling.toml"], async (page) => {
    await page.locator("#parameters input[type=range]").first().waitFor();
    await page.locator("input.agent").fill("5");
    await page.locator("input.agent").press("Enter");
    await page.waitForFunction(() => /Agent 5/.test(document.querySelector("#focal .tables").textContent));
    same(await components(page), explained(0, 5).components);
  }));
});
