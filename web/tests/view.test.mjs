// The viewer's page in a browser: what it shows, what it sends, and that nothing breaks it.
// The server is the mock beside this file. Where FLOCKWORKS_VIEW names the address of a program that shows a scenario
// (and FLOCKWORKS_VIEW_RUN one that shows a run), the tests that need no mock are made with it instead.

import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { startMock } from "./mock.mjs";

const SCENARIO = process.env.FLOCKWORKS_VIEW, RUN = process.env.FLOCKWORKS_VIEW_RUN;
const onlyMock = SCENARIO ? { skip: "needs the mock" } : {};
const folder = fileURLToPath(new URL("../../target/pages", import.meta.url));
// this browser says so of every page that draws with WebGL, when WebGL is computed by software
const OF_THE_BROWSER = /GPU stall due to ReadPixels/;

let browser;
before(async () => {
  mkdirSync(folder, { recursive: true });
  browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
});
after(() => browser?.close());

/** The text messages of a page's sockets, either way, with a promise of the next that is as wanted. */
function traffic(page) {
  const list = [], waiting = [];
  const take = (way) => ({ payload }) => {
    if (typeof payload !== "string") return;
    let message;
    try { message = JSON.parse(payload); } catch { return; }
    const entry = { way, ...message };
    list.push(entry);
    for (const one of waiting.filter(({ wanted }) => wanted(entry))) { waiting.splice(waiting.indexOf(one), 1); one.tell(entry); }
  };
  page.on("websocket", (socket) => { socket.on("framesent", take("sent")); socket.on("framereceived", take("received")); });
  const next = (wanted) => new Promise((tell) => { waiting.push({ wanted, tell }); });
  return {
    list,
    next,
    sent: (what) => list.filter((message) => message.way === "sent" && message.do === what),
    /** Does something and gives the message of this kind that it sends. */
    sends: async (what, act) => { const message = next((one) => one.way === "sent" && one.do === what); await act(); return message; },
    receives: async (what, act) => { const message = next((one) => one.way === "received" && one.is === what); await act(); return message; },
  };
}

/** Opens the page, does something with it, and sees to it that nothing was complained about and nothing else asked for. */
async function opened({ named = ["flat"], hash = "", real = null, allows = null, prepare = null, ...options }, act) {
  const mock = real ? null : await startMock({ named });
  const address = real ?? mock.address;
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, reducedMotion: "reduce", ...options });
  const page = await context.newPage();
  const complaints = [], requests = [];
  page.on("console", (message) => { if (!OF_THE_BROWSER.test(message.text()) && !allows?.test(message.text())) complaints.push(`${message.type()}: ${message.text()}`); });
  page.on("pageerror", (error) => complaints.push(`error: ${error.stack}`));
  page.on("request", (request) => requests.push(request.url()));
  if (prepare) await page.addInitScript(prepare);
  const messages = traffic(page);
  const use = { page, mock, messages, servers: [mock] };
  try {
    await page.goto(address + hash);
    await act(use);
    assert.deepEqual(complaints, []);
    assert.deepEqual(requests.filter((url) => !url.startsWith(address) && !/^(data|blob):/.test(url)), []);
  } finally {
    await context.close();
    for (const server of use.servers) await server?.stop();
  }
}

const shown = (page) => page.locator(".time[data-step]").waitFor();
const step = (page) => page.locator(".time").getAttribute("data-step").then(Number);
const atStep = (page, number) => page.locator(`.time[data-step='${number}']`).waitFor();
const overflow = (page) => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
/** How many colours a part of the page shows. */
async function coloursOf(page, selector) {
  const bytes = await page.locator(selector).first().screenshot();
  return page.evaluate(async (text) => {
    const picture = await createImageBitmap(new Blob([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))]));
    const pen = new OffscreenCanvas(picture.width, picture.height).getContext("2d");
    pen.drawImage(picture, 0, 0);
    return new Set(new Uint32Array(pen.getImageData(0, 0, picture.width, picture.height).data.buffer)).size;
  }, bytes.toString("base64"));
}
/** A number as the page writes it, read back. */
const read = (text) => Number(text.replace("\u2212", "-").replace("e\u2212", "e-").split("\u202f")[0]);
const rounded = (value) => Number(value.toPrecision(7));
/** Asks about an agent by its number, and gives what the server says of it. */
const ask = (page, messages, agent) => messages.receives("explain", () => page.locator(".agent").fill(String(agent))).then(({ explanation }) => explanation);

describe("a scenario", () => {
  test("opens, draws, and asks for nothing else", () => opened({ real: SCENARIO }, async ({ page, messages }) => {
    await shown(page);
    const scene = messages.list.find((message) => message.is === "scene");
    assert.equal(await page.locator("h1").innerText(), scene.title);
    assert.ok(await coloursOf(page, ".screen") > 30, "the canvas is not blank");
    assert.equal(await page.locator(".control").count(), scene.controls.length);
    assert.equal(await page.locator(".charts figure").count(), scene.metrics.length);
    assert.equal(await page.locator(".legend li").count(), scene.groups.length);
    assert.equal(await page.locator("html").getAttribute("data-connection"), "open");
    assert.equal(messages.sent("play").length, 0, "who wants no motion gets none unasked");
    await page.screenshot({ path: `${folder}/view-scene.png` });
  }));

  test("plays of itself where motion is welcome", () => opened({ reducedMotion: "no-preference", real: SCENARIO }, async ({ page, messages }) => {
    await shown(page);
    assert.equal(messages.sent("play").length, 1);
    await page.waitForFunction(() => Number(document.querySelector(".time").dataset.step) > 3);
    const numbers = messages.sent("seen").map(({ number }) => number);
    assert.deepEqual(numbers, [...new Set(numbers)], "each frame is answered once");
  }));

  test("plays, pauses, steps, and begins again", () => opened({ real: SCENARIO }, async ({ page, messages }) => {
    await shown(page);
    const play = page.locator("[data-do=play]"), start = await step(page);
    await page.locator("[data-do=forth]").click();
    await atStep(page, start + 1);
    await play.click();
    await page.locator("[data-do=play][aria-pressed=true]").waitFor();
    assert.equal(await play.getAttribute("aria-label"), "Pause");
    await page.waitForFunction((from) => Number(document.querySelector(".time").dataset.step) > from + 3, start);
    await play.click();
    await page.locator("[data-do=play][aria-pressed=false]").waitFor();
    assert.equal((await messages.sends("speed", () => page.locator(".speed").selectOption("0"))).rate, 0);
    await page.locator(".seed").fill("77");
    const again = await messages.sends("reset", () => page.locator(".seed").press("Enter"));
    assert.equal(again.seed, 77);
    await atStep(page, 0);
  }));

  test("a control sends its value, explains itself, and goes back", () => opened({}, async ({ page, messages }) => {
    await shown(page);
    const control = page.locator("[data-path='group.fish.model.speed']");
    const slid = await messages.sends("set", () => control.locator("[type=range]").fill("2.5"));
    assert.deepEqual([slid.path, slid.value], ["group.fish.model.speed", 2.5]);
    assert.equal(await control.locator("[type=number]").inputValue(), "2.5");
    assert.equal((await messages.sends("set", () => control.locator("[type=number]").fill("0.7"))).value, 0.7);
    assert.equal(await control.locator("[type=range]").inputValue(), "0.7");
    const before = messages.sent("set").length;
    await control.locator("[type=number]").fill("99");
    assert.equal(await control.locator("[type=number]").getAttribute("aria-invalid"), "true");
    await control.locator(".ask").click();
    assert.equal(await control.locator(".help").innerText(), "How fast an agent moves. From 0 to 3\u202fm/s. Default: 1\u202fm/s.");
    assert.equal(messages.sent("set").length, before, "what is out of range is not sent");
    assert.equal((await messages.sends("set", () => control.locator(".back").click())).value, 1);
    assert.equal((await messages.sends("set", () => page.locator("[data-path='group.fish.model.align'] [type=checkbox]").click())).value, false);
    assert.equal((await messages.sends("set", () => page.locator("[data-path='group.fish.model.rule'] select").selectOption("nearest"))).value, "nearest");
    await page.locator("#events li").nth(3).waitFor();
    for (const input of await page.locator(".control input, .control select").all()) assert.match(await input.getAttribute("title"), /Default/);
  }));

  test("a change comes after it was made within a tenth of a second", () => opened({}, async ({ page }) => {
    await shown(page);
    const delays = await page.evaluate(async () => {
      const send = WebSocket.prototype.send, slider = document.querySelector(".control [type=range]"), found = [];
      for (let turn = 0; turn < 9; turn += 1) {
        const begun = performance.now();
        found.push(await new Promise((tell) => {
          WebSocket.prototype.send = function later(text) { if (text.includes('"set"')) tell(performance.now() - begun); send.call(this, text); };
          slider.value = String(turn / 5);
          slider.dispatchEvent(new Event("input", { bubbles: true }));
        }));
      }
      return found.sort((a, b) => a - b);
    });
    assert.ok(delays[4] < 100, `the median of ${delays.map(Math.round)} ms`);
  }));

  test("is saved as it is", () => opened({ real: SCENARIO }, async ({ page, messages }) => {
    await shown(page);
    const answer = messages.next((message) => message.is === "file");
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator("[data-do=save]").click()]);
    assert.equal(readFileSync(await download.path(), "utf8"), (await answer).text);
    assert.match(download.suggestedFilename(), /^[a-z0-9-]+\.toml$/);
  }));

  test("space: it is drawn, and turns", () => opened({ named: ["space"] }, async ({ page, messages }) => {
    await shown(page);
    assert.ok(await coloursOf(page, ".screen") > 60);
    await ask(page, messages, 5);
    const ring = page.locator(".overlay .focal-ring");
    const before = await ring.getAttribute("cx");
    const box = await page.locator(".screen canvas").boundingBox();
    await page.mouse.move(box.x + 300, box.y + 200);
    await page.mouse.down();
    await page.mouse.move(box.x + 420, box.y + 240, { steps: 4 });
    await page.mouse.up();
    await page.waitForFunction((x) => document.querySelector(".overlay .focal-ring").getAttribute("cx") !== x, before);
    await page.screenshot({ path: `${folder}/view-space.png` });
  }));

  test("a line and an open plane are drawn too, and robots with rays", async () => {
    for (const named of ["line", "open", "scanner"]) {
      await opened({ named: [named] }, async ({ page, messages }) => {
        await shown(page);
        assert.ok(await coloursOf(page, ".screen") > 10, named);
        const explanation = await ask(page, messages, 3);
        await page.locator("#focal .who").waitFor();
        assert.equal(await page.locator(".inset .ray").count() > 0, explanation.rays.length > 0);
      });
    }
  });
});

describe("a formation", () => {
  test("goes on by a button and a key, and tells when", () => opened({ named: ["robots"] }, async ({ page, messages }) => {
    await shown(page);
    const button = page.locator("[data-do=go_on]");
    assert.equal(await button.innerText(), "Next formation");
    const { step: now } = await messages.receives("event", () => button.click());
    assert.equal(now, await step(page));
    await page.locator("[data-do=forth]").click();
    await atStep(page, now + 1);
    const later = await messages.receives("event", () => page.keyboard.press("g"));
    assert.equal(later.step, now + 1);
    assert.deepEqual(await page.locator("#events li").allInnerTexts().then((lines) => lines.map((line) => /next formation$/.test(line))), [true, true]);
    assert.match(await page.locator(".time").innerText(), /step 1 of/);
    await page.screenshot({ path: `${folder}/view-formation-live.png` });
  }));

  test("nothing else has that button, or the key", () => opened({}, async ({ page, messages }) => {
    await shown(page);
    assert.equal(await page.locator("[data-do=go_on]").isVisible(), false);
    await page.keyboard.press("g");
    assert.equal(messages.sent("go_on").length, 0);
  }));
});

describe("one agent", () => {
  test("a click shows what it perceives, selects and does, in the numbers of the explanation", () => opened({ real: SCENARIO }, async ({ page, messages }) => {
    await shown(page);
    await ask(page, messages, 7);
    const ring = page.locator(".overlay .focal-ring[data-agent='7']");
    await ring.waitFor();
    const [x, y] = [Number(await ring.getAttribute("cx")), Number(await ring.getAttribute("cy"))];
    assert.equal((await messages.sends("focus", () => page.locator(".agent").press("Escape"))).agent, null);
    await page.locator(".overlay > *").first().waitFor({ state: "detached" });
    const { explanation } = await messages.receives("explain", () => page.locator(".screen canvas").click({ position: { x, y } }));
    await page.locator(`.overlay .focal-ring[data-agent='${explanation.agent}']`).waitFor();
    await page.locator("#focal .components").waitFor();
    for (const place of [".overlay", ".inset"]) {
      const arrows = await page.locator(`${place} .arrow.component`).evaluateAll((list) => list.map(({ dataset }) => [dataset.arrow, Number(dataset.magnitude)]));
      const expected = explanation.components.filter(({ vector }) => Math.hypot(...vector) > 0).map(({ name, magnitude }) => [name, magnitude]);
      assert.deepEqual(arrows, expected, place);
      const members = await page.locator(`${place} .member[data-set]`).evaluateAll((list) => list.map(({ dataset }) => [dataset.set, Number(dataset.count)]));
      assert.deepEqual(members, explanation.sets.filter((set) => set.members.length > 0).map((set) => [set.name, set.members.length]), place);
    }
    const column = (name) => page.locator(`#focal .${name} td.number`).allInnerTexts();
    assert.deepEqual((await column("components")).map(read), explanation.components.map(({ magnitude }) => rounded(magnitude)));
    assert.deepEqual((await column("choice")).map(read), explanation.choice.map(({ probability }) => Number(probability.toPrecision(4))));
    const acts = await page.locator("#focal .sets tr.acts th").allInnerTexts();
    assert.deepEqual(acts, explanation.sets.filter((set) => set.acts).map(({ name }) => name));
    const told = await page.locator("#focal .stages tbody tr").evaluateAll((rows) => rows.map((row) => [...row.cells].slice(1).map((cell) => cell.textContent)));
    assert.equal(told.length, explanation.values.length);
    for (const { name, value, unit } of explanation.values) {
      const text = told.find(([quantity]) => quantity === name)[1];
      if (typeof value !== "number") { assert.equal(text, String(value)); continue; }
      assert.equal(read(text), rounded(value), name);
      if (unit && !["1", "-"].includes(unit)) assert.ok(text.endsWith(unit), text);
    }
    await page.screenshot({ path: `${folder}/view-agent.png` });
    await page.locator("[data-do=closer]").click();
    await page.locator(".overlay .label").first().waitFor();
    await page.screenshot({ path: `${folder}/view-agent-near.png` });
  }));

  test("it stays explained while it moves", () => opened({ real: SCENARIO }, async ({ page, messages }) => {
    await shown(page);
    await ask(page, messages, 3);
    const { explanation } = await messages.receives("explain", () => page.locator("[data-do=forth]").click());
    await atStep(page, explanation.step);
    await page.waitForFunction((magnitudes) => JSON.stringify([...document.querySelectorAll(".overlay .arrow.component")].map(({ dataset }) => Number(dataset.magnitude))) === magnitudes,
      JSON.stringify(explanation.components.filter(({ vector }) => Math.hypot(...vector) > 0).map(({ magnitude }) => magnitude)));
  }));

  test("a number that nobody has is refused", () => opened({}, async ({ page, messages }) => {
    await shown(page);
    assert.equal((await messages.sends("focus", () => page.locator(".agent").fill("100000"))).agent, null);
    assert.equal(await page.locator(".agent").getAttribute("aria-invalid"), "true");
  }));
});

describe("a run", () => {
  const frame = (page) => page.locator(".scrub").inputValue().then(Number);
  test("is scrubbed, stepped and played both ways", () => opened({ named: ["run"], real: RUN }, async ({ page, messages }) => {
    await shown(page);
    const scene = messages.list.find((message) => message.is === "scene");
    const stepOf = (index) => scene.from_step + index * scene.every_steps;
    const last = scene.frames - 1, middle = Math.floor(last / 2);
    await page.locator(".scrub").fill(String(middle));
    await atStep(page, stepOf(middle));
    await page.locator("[data-do=back]").click();
    await atStep(page, stepOf(middle - 1));
    await page.locator(".screen canvas").focus();
    await page.keyboard.press("ArrowRight");
    await atStep(page, stepOf(middle));
    await page.keyboard.press("b");
    await page.waitForFunction((from) => Number(document.querySelector(".time").dataset.step) < from, stepOf(middle - 2));
    assert.equal(await page.locator("[data-do=reverse]").getAttribute("aria-label"), "Pause");
    await messages.receives("status", () => page.keyboard.press("b"));
    await page.locator("[data-do=reverse][aria-pressed=false]").waitFor();
    await page.keyboard.press("b");
    await page.locator("[data-do=reverse][aria-pressed=true]").waitFor();
    // Space pauses whichever way time goes
    await page.keyboard.press(" ");
    await page.locator("[data-do=reverse][aria-pressed=false]").waitFor();
    await page.locator("[data-do=play][aria-pressed=false]").waitFor();
    await page.keyboard.press("End");
    await atStep(page, stepOf(last));
    await page.keyboard.press("Home");
    await atStep(page, stepOf(0));
    assert.equal(await frame(page), 0);
    assert.equal((await messages.sends("loop", () => page.keyboard.press("l"))).on, true);
    const explanation = await ask(page, messages, 2);
    assert.equal(explanation.step, stepOf(0));
    await page.locator("#focal .who").waitFor();
    const box = await page.locator(".charts canvas").first().boundingBox();
    await page.mouse.click(box.x + box.width * 0.6, box.y + box.height / 2);
    await page.waitForFunction(() => Number(document.querySelector(".time").dataset.step) > 0);
    await page.screenshot({ path: `${folder}/view-run.png` });
  }));

  test("two of them share a clock", () => opened({ named: ["run", "other"] }, async ({ page, messages }) => {
    await page.locator(".screen").nth(1).waitFor();
    await shown(page);
    await page.locator("[data-do=play]").click();
    await page.waitForFunction(() => Number(document.querySelector(".time").dataset.step) > 20);
    await page.locator("[data-do=play]").click();
    await page.locator("[data-do=play][aria-pressed=false]").waitFor();
    await page.locator(".scrub").fill("80");
    await atStep(page, 160);
    assert.equal(messages.sent("play").length, 0, "the page is the clock");
    const seeks = messages.sent("seek").map((message) => message.frame);
    for (const index of new Set(seeks)) assert.equal(seeks.filter((other) => other === index).length % 2, 0, `both are at frame ${index}`);
    await page.locator("[data-do=back]").click();
    await atStep(page, 158);
    await page.screenshot({ path: `${folder}/view-pair.png` });
  }));
});

describe("the gallery", () => {
  test("shows stills, opens a scenario, and is found again", () => opened({ named: [] }, async ({ page }) => {
    await page.locator(".card").nth(5).waitFor();
    await page.waitForFunction(() => Number(document.querySelector(".card").dataset.step) > 0);
    assert.ok(await coloursOf(page, ".card canvas") > 10);
    await page.screenshot({ path: `${folder}/view-gallery.png` });
    await page.locator(".card .open").nth(1).focus();
    await page.keyboard.press("Enter");
    await shown(page);
    assert.equal(await page.locator("h1").innerText(), "A school in space");
    await page.keyboard.press("m");
    await page.locator(".card").first().waitFor();
    await page.goBack();
    await shown(page);
  }));
});

describe("what goes wrong", () => {
  test("a dead server is told, and what was open comes back", onlyMock, () => opened({ allows: /WebSocket connection to .* failed/ }, async (use) => {
    const { page, mock, messages } = use;
    await shown(page);
    await messages.sends("set", () => page.locator("[data-path='group.fish.model.speed'] [type=number]").fill("2"));
    await ask(page, messages, 4);
    await mock.stop();
    await page.locator("#lost").waitFor();
    assert.equal(await page.locator("#state").innerText(), "Connection lost");
    assert.ok(await coloursOf(page, ".screen") > 30, "the last picture stays");
    const before = messages.list.length;
    use.servers[0] = await startMock({ port: mock.port, named: ["flat"] });
    await page.locator("#lost").waitFor({ state: "hidden" });
    await page.waitForFunction(() => document.documentElement.dataset.connection === "open");
    await page.locator(".overlay .focal-ring[data-agent='4']").waitFor();
    await messages.receives("explain", () => page.locator("[data-do=forth]").click());
    const sent = messages.list.slice(before).filter((message) => message.way === "sent");
    assert.ok(sent.some((message) => message.do === "open" && message.given === 0));
    assert.ok(sent.some((message) => message.do === "set" && message.value === 2), "what was changed is changed again");
  }));

  test("what cannot be read is told, and the page goes on", onlyMock, () => opened({}, async ({ page, mock, messages }) => {
    await shown(page);
    await ask(page, messages, 4);
    const strange = ["", "{", "null", "[]", "7", '{"is":7}', '{"is":"unheard of"}', '{"is":"scene"}', '{"is":"scene","dimensions":4}', '{"is":"explain"}',
      '{"is":"explain","explanation":{"agent":4,"position":"here"}}', '{"is":"explain","explanation":{"agent":4,"step":0,"position":[1,2],"sets":[null,{"members":7}],"components":"none"}}',
      '{"is":"obstacles","list":[{"ball":7},null,{"polygon":[[1]]}]}', '{"is":"obstacles","list":7}', '{"is":"items","places":[["a"]]}', '{"is":"metrics","rows":7}',
      '{"is":"metrics","t":1,"rows":[{}]}', '{"is":"metrics_all","t":7}', '{"is":"status","rate":"fast","step":null}', '{"is":"event"}', '{"is":"hello","given":7}',
      Buffer.alloc(3), Buffer.alloc(24), Buffer.alloc(24, 255), Buffer.concat([Buffer.alloc(16), Buffer.from([1, 0, 0, 0, 3, 0, 0, 0]), Buffer.alloc(24)])];
    for (const content of strange) mock.inject(content);
    await page.locator("#notice").waitFor();
    await page.keyboard.press("Escape");
    const before = await step(page);
    await page.locator("[data-do=forth]").click();
    await atStep(page, before + 1);
    await page.locator(".agent").fill("5");
    await page.locator(".overlay .focal-ring[data-agent='5']").waitFor();
    assert.equal(await page.locator("h1").innerText(), "Zones in the plane");
  }));

  test("what is not there, and nobody", onlyMock, async () => {
    await opened({ hash: "#gallery=nowhere" }, async ({ page }) => {
      await page.getByText("there is no scenario nowhere").waitFor();
      await page.getByText("This could not be opened.").waitFor();
    });
    await opened({ named: ["nobody"] }, async ({ page }) => { await page.getByText("Nobody is in this scene.").waitFor(); });
  });

  test("a browser without WebGL still explains", () => opened({
    prepare: () => {
      const context = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function without(kind, ...rest) { return kind === "webgl2" ? null : context.call(this, kind, ...rest); };
    },
  }, async ({ page, messages }) => {
    await page.getByText("does not draw with WebGL 2").waitFor();
    await ask(page, messages, 3);
    await page.locator(".inset .focal").waitFor();
  }));
});

describe("manners", () => {
  test("the keyboard is enough", () => opened({}, async ({ page, messages }) => {
    await shown(page);
    await page.keyboard.press("?");
    await page.locator("#keys[open]").waitFor();
    await page.keyboard.press("Escape");
    await page.locator("#keys:not([open])").waitFor({ state: "attached" });
    // everything that can be used is reached by Tab, and has a name
    const reached = new Set();
    await page.evaluate(() => document.activeElement.blur());
    for (let times = 0; times < 60; times += 1) {
      await page.keyboard.press("Tab");
      reached.add(await page.evaluate(() => {
        const { activeElement: one } = document;
        return one.dataset.do ?? (one.matches("canvas") ? "canvas" : one.className || one.tagName.toLowerCase());
      }));
    }
    for (const name of ["gallery", "keys", "theme", "canvas", "reset", "play", "forth", "speed", "seed", "trails", "camera", "fit", "save", "agent", "previous", "next", "closer", "nobody"]) assert.ok(reached.has(name), name);
    await page.locator(".screen canvas").focus();
    assert.equal((await messages.sends("focus", () => page.keyboard.press("n"))).agent, 0);
    assert.equal((await messages.sends("focus", () => page.keyboard.press("p"))).agent, 239);
    await page.locator(".overlay .arrow").first().waitFor();
    await page.keyboard.press("f");
    assert.equal(await page.locator(".camera").inputValue(), "agent");
    await messages.sends("step", () => page.keyboard.press("ArrowRight"));
    await messages.sends("play", () => page.keyboard.press("Space"));
    await page.locator("[data-do=play][aria-pressed=true]").waitFor();
    await messages.sends("pause", () => page.keyboard.press("Space"));
    await page.keyboard.press("t");
    assert.equal(await page.locator(".trails").isChecked(), false);
    await messages.sends("reset", () => page.keyboard.press("r"));
    await page.keyboard.press("a");
    assert.ok(await page.locator(".agent").evaluate((field) => field === document.activeElement));
    assert.equal((await messages.sends("focus", () => page.keyboard.press("Escape"))).agent, null);
    await page.locator(".charts figure").first().focus();
    await page.keyboard.press("Home");
    await page.getByText(/^t = /).first().waitFor();
  }));

  test("a chart is copied as SVG with its data", () => opened({ named: ["run"], prepare: () => { Object.defineProperty(navigator, "clipboard", { value: { writeText: async (text) => { window.copied = text; } } }); } }, async ({ page }) => {
    await shown(page);
    await page.locator(".charts .copy").first().click();
    await page.waitForFunction(() => typeof window.copied === "string");
    const rows = await page.evaluate(() => new DOMParser().parseFromString(window.copied, "image/svg+xml").querySelector("metadata").textContent.trim().split("\n"));
    assert.match(rows[0], /^line,/);
    assert.ok(rows.length > 50 && rows.slice(1).every((row) => Number.isFinite(Number(row.split(",")[1]))));
  }));

  test("every button and field has a name and a word of help", () => opened({}, async ({ page }) => {
    await shown(page);
    const bare = await page.locator("#laboratory button, #laboratory input, #laboratory select, header button").evaluateAll((list) => list
      .filter((one) => !(one.title || one.closest("label")?.title) || !(one.textContent.trim() || one.ariaLabel || one.labels?.length)).map((one) => one.outerHTML));
    assert.deepEqual(bare, []);
  }));

  test("a phone shows all of it", () => opened({ viewport: { width: 360, height: 740 }, hasTouch: true }, async ({ page, messages }) => {
    await shown(page);
    await ask(page, messages, 9);
    await page.locator("#focal .stages").waitFor();
    assert.ok(await overflow(page) <= 0, "nothing is wider than the screen");
    await page.screenshot({ path: `${folder}/view-phone.png`, fullPage: true });
    await page.locator("[data-do=gallery]").click();
    await page.locator(".card").first().waitFor();
    assert.ok(await overflow(page) <= 0);
  }));

  test("light and dark", () => opened({ colorScheme: "dark" }, async ({ page, messages }) => {
    await shown(page);
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    await ask(page, messages, 9);
    await page.locator("#focal .stages").waitFor();
    await page.screenshot({ path: `${folder}/view-dark.png` });
    assert.equal(await ground(), "rgb(20, 23, 26)");
    await page.keyboard.press("Escape");
    await page.locator("[data-do=theme]").click();
    assert.equal(await ground(), "rgb(255, 255, 255)");
    await page.reload();
    await shown(page);
    assert.equal(await ground(), "rgb(255, 255, 255)");
  }));

  test("colours by label, camera with the flock", () => opened({}, async ({ page }) => {
    await shown(page);
    await page.locator(".colour").selectOption("label");
    assert.deepEqual(await page.locator(".legend li").allInnerTexts(), ["explore", "follow", "rest"]);
    await page.locator(".camera").selectOption("flock");
    await page.locator("[data-do=fit]").click();
    assert.equal(await page.locator(".camera").inputValue(), "still");
  }));

  test("a hundred thousand agents are accepted", () => opened({ named: ["crowd"] }, async ({ page }) => {
    await shown(page);
    assert.ok(await coloursOf(page, ".screen") > 20);
  }));

  // where WebGL is computed by software thousands of agents are painted pixel by pixel
  for (const [dimensions, radius] of [[2, 0], [2, 4], [3, 0.5]]) {
    test(`agents of radius ${radius} in ${dimensions}-D are painted as the shader draws them`, () => opened({}, async ({ page }) => {
      await shown(page);
      const seen = await page.evaluate(async ([D, radius]) => {
        const [{ Drawing }, { readScene, readFrame }, { colours }] = await Promise.all(["/draw.js", "/frame.js", "/words.js"].map((name) => import(name)));
        const agents = 2500, wide = 700, tall = 500, half = agents / 2, sides = (value) => Array(D).fill(value);
        const group = (name, first) => ({ name, model: "model", first, count: half, radius: first ? radius : radius / 2 });
        const scene = readScene({
          is: "scene", kind: "live", title: "Two groups", dimensions: D, groups: [group("one", 0), group("two", half)],
          space: { edges: sides("walls"), low: sides(0), high: sides(100) }, step: 1, steps: 1,
        });
        const buffer = new ArrayBuffer(24 + 8 * agents * D), head = new DataView(buffer);
        head.setUint32(16, agents, true);
        head.setUint8(20, D);
        const places = new Float32Array(buffer, 24, agents * D), headings = new Float32Array(buffer, 24 + 4 * agents * D, agents * D);
        let state = 7;
        const random = () => { state = (Math.imul(state, 1664525) + 1013904223) >>> 0; return state / 4294967296; };
        for (let agent = 0; agent < agents; agent += 1) {
          const way = sides(0).map(() => random() - 0.5), long = agent % 17 === 0 ? Infinity : Math.hypot(...way);
          way.forEach((part, axis) => { places[agent * D + axis] = 100 * random(); headings[agent * D + axis] = part / long; });
          if (agent % 101 === 0) places[agent * D] = NaN;
        }
        const drawn = (painted) => {
          const drawing = new Drawing(document.createElement("canvas")), { gl, painter } = drawing;
          const could = painter.paints(agents);
          painter.isWanted &&= painted;
          drawing.setColours(colours());
          drawing.resize(wide, tall);
          drawing.setScene(scene, false);
          drawing.setFrame(readFrame(buffer));
          drawing.draw();
          const pixels = new Uint8Array(4 * gl.canvas.width * gl.canvas.height);
          gl.readPixels(0, 0, gl.canvas.width, gl.canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
          gl.getExtension("WEBGL_lose_context")?.loseContext();
          return { pixels, could, paints: painter.paints(agents) };
        };
        const [painted, shaded] = [drawn(true), drawn(false)];
        const ground = painted.pixels.slice(0, 3);
        let apart = 0, shifted = 0, far = 0, inked = 0;
        painted.pixels.forEach((value, at) => {
          const by = Math.abs(value - shaded.pixels[at]);
          apart += by;
          shifted += Math.abs(value - (shaded.pixels[at + 4] ?? value));
          if (by > 60) far += 1;
          if (Math.abs(value - ground[at % 4]) > 60) inked += 1;
        });
        return { could: painted.could, paints: [painted.paints, shaded.paints], share: apart / shifted, far: far / inked, inked };
      }, [dimensions, radius]);
      assert.deepEqual([seen.could, seen.paints], [true, [true, false]]);
      assert.ok(seen.inked > 5000, `${seen.inked} parts of pixels`);
      // directions are rounded by 1.4 degrees, places by an eighth of a pixel; in space the order of overlapping agents differs
      assert.ok(seen.share < 0.25 && seen.far < 0.06, `${seen.share} of what a pixel aside makes, ${seen.far} far apart`);
    }));
  }
});
