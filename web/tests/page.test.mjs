// The report page in a browser: what it shows, what it answers to, and that it asks for nothing.
// The pages are made by the example `sample_page` of the crate `lab`; screenshots are left in target/pages.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { built } from "./built.mjs";

const root = fileURLToPath(new URL("../..", import.meta.url));
const folder = `${root}target/pages`;
const SAMPLE = `${folder}/sample.html`, STRANGE = `${folder}/strange.html`;
const THIN = "\u202f";

let browser;

before(async () => {
  mkdirSync(folder, { recursive: true });
  const sample = built("sample_page");
  for (const [file, kind] of [[SAMPLE, "sample"], [STRANGE, "strange"]]) {
    execFileSync(sample, [file, kind], { cwd: root, stdio: ["ignore", "inherit", "inherit"] });
  }
  browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"],
  });
});

after(() => browser?.close());

/** Opens a page, does something with it, and sees to it that nothing was complained about and nothing asked for. */
async function opened(file, options, act) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  const page = await context.newPage();
  const complaints = [], requests = [];
  page.on("console", (message) => complaints.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => complaints.push(`error: ${error.stack}`));
  page.on("request", (request) => requests.push(request.url()));
  const address = pathToFileURL(file).href;
  try {
    await page.goto(address);
    await act(page);
    assert.deepEqual(complaints, []);
    const asked = requests.filter((url) => url !== address && !/^(data|blob):/.test(url));
    assert.deepEqual(asked, []);
  } finally {
    await context.close();
  }
}

/** What the page carries. */
const data = (page) => page.evaluate(() => JSON.parse(document.querySelector("#figures").textContent));
const picture = (page, canvas) => canvas.evaluate((element) => element.toDataURL());
const colours = (canvas) => canvas.evaluate((element) => {
  const { data } = element.getContext("2d").getImageData(0, 0, element.width, element.height);
  const seen = new Set();
  for (let at = 0; at < data.length; at += 4) seen.add(`${data[at]},${data[at + 1]},${data[at + 2]}`);
  return seen.size;
});
const overflow = (page) => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);

/** Saves by clicking, and reads what was saved. */
async function saved(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

describe("the sample page", () => {
  test("shows its parts and asks for nothing", () => opened(SAMPLE, {}, async (page) => {
    assert.equal(await page.locator("h1").innerText(), "Three schools among rocks, and a flock that closes on itself");
    const parts = await page.locator("h2").allInnerTexts();
    assert.deepEqual(parts, ["Summary", "Replay", "Measures", "Scenes", "Methods", "Data", "Make it again"]);
    assert.equal(await page.locator("figure").count(), 10);
    assert.equal(await page.locator(".facts tr").count(), 7);
    assert.equal(await page.locator(".moment").count(), 5);
    assert.equal(await page.locator("footer").innerText(), "Made by flockworks 0.1.0, seed 2026");
  }));

  test("forbids the network", () => opened(SAMPLE, {}, async (page) => {
    const refused = page.waitForEvent("console", (message) => /Content Security Policy/.test(message.text()));
    const answer = await page.evaluate(() => fetch("https://network.invalid/").then(() => "came", () => "refused"));
    assert.equal(answer, "refused");
    await refused;
  }).then(
    () => assert.fail("the policy must complain"),
    (error) => assert.match(error.message, /Content Security Policy/),
  ));

  test("charts, scenes and words need no JavaScript", () => opened(SAMPLE, { javaScriptEnabled: false }, async (page) => {
    assert.equal(await page.locator(".chart:visible").count(), 6);
    assert.equal(await page.locator(".scene:visible").count(), 5);
    assert.equal(await page.locator(".player:visible").count(), 0);
    assert.ok(await page.getByText("The player needs JavaScript").first().isVisible());
  }));

  test("pointing at a chart reads out the data", () => opened(SAMPLE, {}, async (page) => {
    const chart = (await data(page)).charts[0];
    const svg = page.locator("[data-chart='0'] .chart");
    await svg.scrollIntoViewIfNeeded();
    const box = await svg.boundingBox();
    const [left, right] = chart.plot, scale = box.width / 400;
    // the places are 0, 0.05, ... 60 s: this is number 800, at 40 s
    const across = left + (40 / 60) * (right - left);
    await page.mouse.move(box.x + across * scale, box.y + box.height / 2);
    const readout = page.locator("[data-chart='0'] .readout");
    await readout.waitFor({ state: "visible" });
    const caption = await readout.locator("caption").innerText();
    const at = Number(caption.replace("Time ", "").replace(`${THIN}s`, ""));
    const point = chart.places[0].findIndex((x) => Math.abs(x - at) < 1e-9);
    assert.ok(Math.abs(at - 40) < 0.2, caption);
    const values = await readout.locator("td").allInnerTexts();
    assert.deepEqual(values.map(Number), chart.lines.map((line) => Number(line.y[point].toPrecision(7))));
  }));

  test("a value that is missing is called missing, and one with a unit has it", () => opened(SAMPLE, {}, async (page) => {
    const read = async (chart, key, times) => {
      await page.locator(`[data-chart='${chart}'] .plot`).focus();
      for (let time = 0; time < times; time += 1) await page.keyboard.press(key);
      return page.locator(`[data-chart='${chart}'] .readout td`).allInnerTexts();
    };
    // the first press stands on the first point; 0.05 s times 10 with Shift
    const values = await read(0, "Shift+ArrowRight", 45);
    assert.equal(values[1], "missing");
    const speeds = await read(2, "End", 1);
    assert.ok(speeds.every((speed) => speed.endsWith(`${THIN}m/s`)), speeds.join());
    await page.keyboard.press("Escape");
    await page.locator("[data-chart='2'] .readout").waitFor({ state: "hidden" });
  }));

  test("touching a chart reads it out", () => opened(SAMPLE, { hasTouch: true }, async (page) => {
    const svg = page.locator("[data-chart='3'] .chart");
    await svg.tap();
    await page.locator("[data-chart='3'] .readout").waitFor({ state: "visible" });
    await page.locator("h1").tap();
    await page.locator("[data-chart='3'] .readout").waitFor({ state: "hidden" });
  }));

  test("the player draws, steps, scrubs and plays both ways", () => opened(SAMPLE, {}, async (page) => {
    for (const index of [0, 1]) {
      const player = page.locator(`[data-replay='${index}']`), canvas = player.locator("canvas");
      const time = player.locator(".time");
      const frame = () => player.locator(".scrub").inputValue().then(Number);
      assert.ok(await colours(canvas) > 20, "the canvas is not blank");
      const first = await picture(page, canvas);
      await canvas.focus();
      await page.keyboard.press("ArrowRight");
      assert.equal(await frame(), 1);
      assert.equal(await time.innerText(), `t = 0.25${THIN}s2 of 240`);
      assert.notEqual(await picture(page, canvas), first);
      await page.keyboard.press("ArrowLeft");
      assert.equal(await picture(page, canvas), first, "back is back");
      await page.keyboard.press("End");
      assert.equal(await frame(), 239);
      await page.keyboard.press("Home");
      assert.equal(await frame(), 0);
      await player.locator(".scrub").fill("120");
      assert.match(await time.innerText(), /^t = 30\u202fs/);
      const playing = (comparison) => page.waitForFunction(
        ([selector, what]) => {
          const value = Number(document.querySelector(selector).value);
          return what === "on" ? value > 125 && value < 240 : value < 120;
        },
        [`[data-replay='${index}'] .scrub`, comparison],
      );
      await canvas.focus();
      await page.keyboard.press("Space");
      await playing("on");
      assert.equal(await player.locator("[data-do=play]").getAttribute("aria-label"), "Pause");
      await page.keyboard.press("b");
      await playing("back");
      await page.keyboard.press("Space");
      assert.equal(await player.locator("[data-do=reverse]").getAttribute("aria-pressed"), "false");
      const stopped = await picture(page, canvas);
      await player.locator(".trails").uncheck();
      assert.notEqual(await picture(page, canvas), stopped, "without trails it looks different");
    }
  }));

  test("without a loop the player stops at the end", () => opened(SAMPLE, {}, async (page) => {
    const player = page.locator("[data-replay='1']");
    await player.locator(".loop").uncheck();
    await player.locator(".speed").selectOption("4");
    await player.locator(".scrub").fill("230");
    await player.locator("[data-do=play]").click();
    await player.locator("[data-do=play][aria-pressed=false]").waitFor();
    assert.equal(await player.locator(".scrub").inputValue(), "239");
  }));

  test("the view in space turns and zooms", () => opened(SAMPLE, {}, async (page) => {
    const player = page.locator("[data-replay='0']"), canvas = player.locator("canvas");
    await canvas.scrollIntoViewIfNeeded();
    const first = await picture(page, canvas);
    const box = await canvas.boundingBox();
    await page.mouse.move(box.x + 200, box.y + 200);
    await page.mouse.down();
    await page.mouse.move(box.x + 300, box.y + 230, { steps: 4 });
    await page.mouse.up();
    const turned = await picture(page, canvas);
    assert.notEqual(turned, first);
    await page.mouse.wheel(0, -200);
    await page.waitForFunction(([was]) => document.querySelector("[data-replay='0'] canvas").toDataURL() !== was, [turned]);
    await page.keyboard.press("0");
    assert.equal(await picture(page, canvas), first);
  }));

  test("positions in the player are those of the recording", () => opened(SAMPLE, {}, async (page) => {
    const replay = (await data(page)).replays[1];
    const bytes = Buffer.from(replay.packed, "base64");
    const agents = replay.groups.reduce((sum, [, members]) => sum + members, 0);
    assert.equal(bytes.length, replay.times.length * agents * 5);
    for (const axis of [0, 1]) {
      const [low, high] = replay.bounds[axis];
      assert.ok(low >= 0 && high <= 25 && high - low > 20);
    }
  }));

  test("the colours can be changed and are remembered", () => opened(SAMPLE, { colorScheme: "light" }, async (page) => {
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.equal(await ground(), "rgb(255, 255, 255)");
    const canvas = page.locator("[data-replay='0'] canvas");
    const light = await picture(page, canvas);
    await page.locator("#theme").click();
    assert.equal(await ground(), "rgb(20, 23, 26)");
    assert.notEqual(await picture(page, canvas), light);
    await page.reload();
    assert.equal(await ground(), "rgb(20, 23, 26)");
    assert.equal(await page.locator("#theme").getAttribute("aria-pressed"), "true");
    await page.emulateMedia({ media: "print" });
    assert.equal(await ground(), "rgb(255, 255, 255)", "paper is white");
  }));

  test("the system's dark colours are followed", () => opened(SAMPLE, { colorScheme: "dark" }, async (page) => {
    assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), "rgb(20, 23, 26)");
    await page.screenshot({ path: `${folder}/dark.png`, fullPage: true });
  }));

  test("what is saved is the data", () => opened(SAMPLE, {}, async (page) => {
    const { charts, tables } = await data(page);
    const csv = await saved(page, page.locator("[data-chart='0'] [data-do=csv]"));
    assert.equal(csv.name, "polarisation.csv");
    const rows = csv.bytes.toString().trimEnd().split("\n").map((row) => row.split(","));
    assert.deepEqual(rows[0], ["Time (s)", "herring", "sprat", "mackerel"]);
    assert.equal(rows.length, 1202);
    const at = (row) => rows[row + 1].map((text) => (text === "" ? null : Number(text)));
    for (const row of [0, 450, 1200]) {
      assert.deepEqual(at(row), [charts[0].places[0][row], ...charts[0].lines.map((line) => line.y[row])]);
    }
    assert.equal(at(450)[2], null, "a gap is empty");
    const table = await saved(page, page.locator("[data-table='1'] [data-do=table]"));
    assert.equal(table.name, "events.csv");
    assert.equal(table.bytes.toString(), tables[1].csv);
    await page.locator("[data-table='1'] summary").click();
    assert.deepEqual(await page.locator("[data-table='1'] td").allInnerTexts(), ["3.0", "contact, rock 1", "6.0", 'said "hello"']);
    const picture = await saved(page, page.locator("[data-replay='1'] [data-do=picture]"));
    assert.equal(picture.bytes.subarray(1, 4).toString(), "PNG");
  }));

  test("a drawing that is saved stands for itself", () => opened(SAMPLE, { colorScheme: "dark" }, async (page) => {
    for (const [button, name, least] of [["[data-chart='0'] [data-do=svg]", "polarisation.svg", 4], [".moment [data-do=svg]", "the-tank-at-two-moments-1.svg", 6]]) {
      const svg = await saved(page, page.locator(button).first());
      assert.equal(svg.name, name);
      const text = svg.bytes.toString();
      assert.ok(!text.includes("var(") && !text.includes("class="), "looks are written out");
      const looks = await page.evaluate((text) => {
        const drawing = new DOMParser().parseFromString(text, "image/svg+xml");
        const strokes = [...drawing.querySelectorAll("path,circle,rect")].flatMap((part) => [part.getAttribute("stroke"), part.getAttribute("fill")]);
        return { fault: drawing.querySelector("parsererror")?.textContent ?? null, colours: new Set(strokes).size, ground: drawing.querySelector("rect").getAttribute("fill") };
      }, text);
      assert.equal(looks.fault, null);
      assert.ok(looks.colours >= least, `${looks.colours} colours`);
      assert.equal(looks.ground, "#ffffff");
    }
  }));

  test("the command is copied", () => opened(SAMPLE, { permissions: ["clipboard-read", "clipboard-write"] }, async (page) => {
    const button = page.locator("[data-copy=command]");
    await button.click();
    await page.waitForFunction(() => document.querySelector("[data-copy=command]").textContent !== "Copy");
    const text = await page.locator("#command").innerText();
    if (await button.innerText() === "Copied") {
      assert.equal(await page.evaluate(() => navigator.clipboard.readText()), text);
    } else {
      assert.equal(await page.evaluate(() => getSelection().toString().trim()), text);
    }
  }));

  test("everything that can be used has a name", () => opened(SAMPLE, {}, async (page) => {
    const nameless = await page.evaluate(() => [...document.querySelectorAll("button,select,input,canvas,svg[role=img],[tabindex='0']")]
      .filter((part) => !(part.getAttribute("aria-label") ?? part.closest("label")?.textContent ?? part.textContent).trim())
      .map((part) => part.outerHTML.slice(0, 80)));
    assert.deepEqual(nameless, []);
    const levels = await page.evaluate(() => [...document.querySelectorAll("h1,h2,h3")].map((part) => Number(part.tagName[1])));
    assert.equal(levels[0], 1);
    levels.forEach((level, at) => assert.ok(at === 0 || level - levels[at - 1] <= 1, "no level is left out"));
  }));

  for (const width of [360, 480, 800, 1280]) {
    test(`${width} px are enough`, () => opened(SAMPLE, { viewport: { width, height: 740 }, colorScheme: "light" }, async (page) => {
      assert.ok(await overflow(page) <= 0, "nothing reaches out of the page");
      for (const summary of await page.locator("summary").all()) await summary.click();
      await page.locator("[data-chart='5'] .plot").focus();
      await page.keyboard.press("End");
      assert.ok(await overflow(page) <= 0, "nor with everything opened");
      await page.keyboard.press("Escape");
      const name = { 360: "phone", 1280: "light" }[width];
      if (name) await page.screenshot({ path: `${folder}/${name}.png`, fullPage: true });
    }));
  }
});

describe("a page of strange input", () => {
  for (const width of [360, 1280]) {
    test(`is a sane page at ${width} px`, () => opened(STRANGE, { viewport: { width, height: 740 } }, async (page) => {
      assert.ok(await overflow(page) <= 0);
      assert.equal(await page.evaluate(() => globalThis.escaped), undefined, "no text of the user runs");
      assert.match(await page.locator("h1").innerText(), /<\/script><script>/);
      const texts = await page.locator("svg").evaluateAll((all) => all.map((svg) => svg.outerHTML).join(""));
      assert.ok(!/NaN|Infinity|undefined/.test(texts));
      assert.ok(!/NaN|undefined/.test(await page.locator("main").innerText()));
      for (const plot of await page.locator(".plot").all()) {
        await plot.focus();
        for (const key of ["ArrowRight", "ArrowRight", "End", "Home", "PageDown"]) await page.keyboard.press(key);
      }
      for (const canvas of await page.locator("canvas").all()) {
        await canvas.focus();
        for (const key of ["ArrowRight", "End", "Space", "Space", "Home"]) await page.keyboard.press(key);
        assert.ok(await colours(canvas) >= 1);
      }
      await page.screenshot({ path: `${folder}/strange-${width}.png`, fullPage: true });
    }));
  }
});
