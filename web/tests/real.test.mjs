// The viewer's page with the real server behind it: what the page shows is what the engine computed.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { built } from "./built.mjs";

const root = fileURLToPath(new URL("../..", import.meta.url));
const pictures = `${root}target/pages`;
const scratch = mkdtempSync(`${tmpdir()}/flockworks-view-`);
const run = `${scratch}/run`, mill = `${scratch}/mill`;

let browser, program;

before(async () => {
  mkdirSync(pictures, { recursive: true });
  program = built("flockworks");
  execFileSync(program, ["run", "studies/schooling.toml", "--quick", "--out", run], { cwd: root, stdio: "ignore" });
  execFileSync(program, ["run", "studies/gallery/mill.toml", "--quick", "--out", mill], { cwd: root, stdio: "ignore" });
  browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
      "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
});

after(() => browser?.close());

/** Serves something, opens the page, does something with it, and sees to it that nothing was complained about. */
async function opened(given, act, looks = {}) {
  const server = spawn(program, ["view", ...given], { cwd: root, stdio: ["ignore", "pipe", "inherit"] });
  try {
    const address = await new Promise((resolve, reject) => {
      server.stdout.once("data", (bytes) => resolve(bytes.toString().split("\n")[0]));
      server.once("exit", () => reject(new Error("the server ended")));
    });
    const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, acceptDownloads: true, reducedMotion: "reduce", ...looks });
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

/** What the command says of an agent in a frame of a run. */
const explained = (frame, agent, of = run) => JSON.parse(execFileSync(program, ["explain", of, "--frame", `${frame}`, "--agent", `${agent}`]));

const ring = (page, agent) => page.locator(`.overlay .focal-ring[data-agent="${agent}"]`);
const shownStep = (page) => page.locator(".time").getAttribute("data-step").then(Number);

/** The arrows over the picture: name and magnitude. */
const arrows = (page) => page.locator(".overlay .arrow.component").evaluateAll((list) =>
  list.map(({ dataset }) => [dataset.arrow, Number(dataset.magnitude)]));

/** The arrows that an explanation asks for: of components that are not zero. */
const asked = ({ components: parts }) => parts.filter((part) => part.magnitude > 0).map((part) => [part.name, part.magnitude]);

/** How many colours the picture of agents has. */
async function colours(page) {
  const bytes = await page.locator("canvas").first().screenshot();
  return page.evaluate(async (text) => {
    const picture = await createImageBitmap(new Blob([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))]));
    const pen = new OffscreenCanvas(picture.width, picture.height).getContext("2d");
    pen.drawImage(picture, 0, 0);
    return new Set(new Uint32Array(pen.getImageData(0, 0, picture.width, picture.height).data.buffer)).size;
  }, bytes.toString("base64"));
}

/** Chooses an agent by its number, lets it go, and clicks where it was; gives the one that was clicked. */
async function clicked(page, agent) {
  await page.locator("input.agent").fill(`${agent}`);
  await page.locator("input.agent").press("Enter");
  await ring(page, agent).waitFor();
  const place = await ring(page, agent).evaluate((circle) => [circle.cx.baseVal.value, circle.cy.baseVal.value]);
  await page.keyboard.press("Escape");
  await page.locator(".overlay .focal-ring").waitFor({ state: "detached" });
  const box = await page.locator("canvas").first().boundingBox();
  await page.mouse.click(box.x + place[0], box.y + place[1]);
  await page.locator(".overlay .arrow.component").first().waitFor();
  return Number(await page.locator(".overlay .focal-ring").getAttribute("data-agent"));
}

describe("the real server", () => {
  test("the gallery shows every scenario", () => opened([], async (page) => {
    await page.locator("#gallery .wall li").nth(8).waitFor();
    assert.equal(await page.locator("#gallery .wall li").count(), 9);
    await page.setViewportSize({ width: 1280, height: 1100 });
    await page.waitForFunction(() => [...document.querySelectorAll(".card")].every(({ dataset }) => Number(dataset.step) > 0));
    await page.waitForTimeout(1000);
    await page.screenshot({ path: `${pictures}/watch-gallery.png` });
  }));

  const steps = (page) => page.locator(".card[data-step]").evaluateAll((cards) => cards.map(({ dataset }) => Number(dataset.step)));

  test("every card in view plays, and none elsewhere", () => opened([], async (page) => {
    await page.waitForFunction(() => document.querySelectorAll(".card[data-step]").length === 9);
    const first = await steps(page);
    await page.waitForFunction((first) => [...document.querySelectorAll(".card[data-step]")].every(({ dataset }, at) => Number(dataset.step) > first[at]), first);
    await page.setViewportSize({ width: 500, height: 300 });
    const last = page.locator(".card[data-step]").last();
    let still = null;
    for (let tries = 0; await last.getAttribute("data-step") !== still; tries += 1) {
      assert.ok(tries < 20, "a card out of view goes on");
      still = await last.getAttribute("data-step");
      await page.waitForTimeout(600);
    }
    await last.scrollIntoViewIfNeeded();
    await page.waitForFunction((still) => [...document.querySelectorAll(".card[data-step]")].at(-1).dataset.step !== still, still);
  }, { reducedMotion: "no-preference", viewport: { width: 1280, height: 2400 } }));

  test("cards stand still where nothing shall move", () => opened([], async (page) => {
    await page.waitForFunction(() => document.querySelector(".card[data-step='120']") !== null);
    await page.waitForTimeout(400);
    const [first] = await steps(page);
    await page.waitForTimeout(400);
    assert.deepEqual([first, (await steps(page))[0]], [120, 120]);
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

  test("a run folder is drawn, plays and scrubs, and a click shows the arrows of the command", () => opened([mill], async (page) => {
    await page.locator(".time[data-step]").waitFor();
    assert.ok(await colours(page) > 10);
    const first = await shownStep(page);
    await page.keyboard.press("Space");
    await page.waitForFunction((first) => Number(document.querySelector(".time").dataset.step) > first, first);
    await page.keyboard.press("Space");
    await page.locator(".scrub").evaluate((input) => { input.value = "20"; input.dispatchEvent(new Event("input", { bubbles: true })); });
    await page.locator(`.time[data-step="${explained(20, 0, mill).step}"]`).waitFor();
    const agent = await clicked(page, 7);
    const expected = explained(20, agent, mill);
    assert.ok(asked(expected).length > 0);
    assert.deepEqual(await arrows(page), asked(expected));
    same(await components(page), expected.components);
    await page.screenshot({ path: `${pictures}/watch-run.png` });
  }));

  test("the scene and the figure of an agent are copied as drawings with their data", () => opened([mill], async (page) => {
    await page.locator(".time[data-step]").waitFor();
    await clicked(page, 7);
    await page.evaluate(() => { Object.defineProperty(navigator, "clipboard", { configurable: true, value: { writeText: async (text) => { window.copied = text; } } }); });
    const copied = async (button) => {
      await page.evaluate(() => { window.copied = null; });
      await button.click();
      await page.waitForFunction(() => window.copied !== null);
      return page.evaluate(() => {
        const root = new DOMParser().parseFromString(window.copied, "image/svg+xml").documentElement;
        return { name: root.localName, paths: root.querySelectorAll("path").length, rows: root.querySelector("metadata").textContent.trim().split("\n"), text: window.copied };
      });
    };
    const scene = await copied(page.locator("#about .copy")), figure = await copied(page.locator("#focal .copy"));
    const { position, components: parts } = explained(0, 7, mill);
    assert.deepEqual([scene.name, scene.rows.length, scene.rows[0]], ["svg", 61, "agent,group,x,y,heading_x,heading_y"]);
    const place = scene.rows[8].split(",");
    assert.deepEqual(place.slice(0, 2), ["7", "fish"]);
    position.forEach((value, axis) => assert.ok(Math.abs(Number(place[2 + axis]) - value) < 1e-5 * Math.max(1, Math.abs(value))));
    assert.ok(scene.paths >= 1 && figure.paths > 3);
    for (const part of parts) assert.ok(figure.rows.some((row) => row.startsWith(`component,${part.name},`)), part.name);
    for (const [name, { text }] of Object.entries({ scene, figure })) writeFileSync(`${pictures}/copied-${name}.svg`, text);
  }));

  test("a click in a simulation shows the arrows of the same moment of its record", () => opened(["studies/gallery/mill.toml"], async (page) => {
    await page.locator(".time[data-step='0']").waitFor();
    await page.locator("canvas").first().focus();
    const { step } = explained(1, 0, mill);
    for (let now = 0; now < step; now += 1) await page.keyboard.press("ArrowRight");
    await page.locator(`.time[data-step='${step}']`).waitFor();
    const agent = await clicked(page, 7);
    assert.deepEqual(await arrows(page), asked(explained(1, agent, mill)));
    await page.screenshot({ path: `${pictures}/watch-live.png` });
  }));

  test("a changed parameter changes the run", () => opened(["studies/gallery/mill.toml"], async (page) => {
    await page.locator(".time[data-step='0']").waitFor();
    const slider = page.locator("#parameters input[type=range]").first();
    await slider.evaluate((input) => { input.value = "3"; input.dispatchEvent(new Event("input", { bubbles: true })); });
    await page.locator("#events li").first().waitFor();
    await page.locator("canvas").first().focus();
    const { step, position } = explained(1, 7, mill);
    for (let now = 0; now < step; now += 1) await page.keyboard.press("ArrowRight");
    await page.locator(`.time[data-step='${step}']`).waitFor();
    await page.locator("input.agent").fill("7");
    await page.locator("input.agent").press("Enter");
    await page.locator(".overlay .arrow.component").first().waitFor();
    const [saved] = await Promise.all([page.waitForEvent("download"), page.locator("[data-do=save]").click()]);
    const file = `${scratch}/changed.toml`, out = `${scratch}/changed`;
    await saved.saveAs(file);
    execFileSync(program, ["run", file, "--quick", "--out", out], { stdio: "ignore" });
    // what the page shows is what the saved file computes, and not what the old one does
    const changed = explained(1, 7, out);
    assert.notDeepEqual(changed.position, position);
    assert.deepEqual(await arrows(page), asked(changed));
  }));

  test("live and recorded, the same moment is explained alike", () => opened(["studies/schooling.toml"], async (page) => {
    await page.locator("#parameters input[type=range]").first().waitFor();
    await page.locator("input.agent").fill("5");
    await page.locator("input.agent").press("Enter");
    await page.waitForFunction(() => /Agent 5/.test(document.querySelector("#focal .tables").textContent));
    same(await components(page), explained(0, 5).components);
  }));
});
