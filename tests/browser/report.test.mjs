// Drives the report in a real browser, from a file, with the network watched: node report.test.mjs REPORT FOLDER MANY LIVE
// where FOLDER is the result folder of examples/bolted_slope that REPORT was made from, MANY a report of six runs,
// and LIVE the page of a run that goes on. Exit 77: no browser.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test, before, after } from "node:test";

const [report, folder, many, live] = process.argv.slice(2);
const browserPath = process.env.TALUS_BROWSER || "/usr/bin/chromium";
if (!existsSync(browserPath)) {
  console.log(`skipped: there is no browser at ${browserPath} (package chromium)`);
  process.exit(77);
}
const { chromium } = createRequire(`${process.env.NODE_PATH}/`)("playwright-core");

/** A table of numbers as {column: [values]}. */
function readCsv(path) {
  const [head, ...rows] = readFileSync(path, "utf8").trim().split("\n").map((line) => line.split(","));
  return Object.fromEntries(head.map((name, c) => [name, rows.map((row) => Number(row[c]))]));
}

let browser, page;
const errors = [], requests = [];

before(async () => {
  browser = await chromium.launch({ executablePath: browserPath, args: ["--no-sandbox"] });
  page = await browser.newPage({ viewport: { width: 1300, height: 900 }, acceptDownloads: true });
  page.on("pageerror", (e) => errors.push(String(e)));
  page.on("console", (m) => { if (m.type() === "error") errors.push(m.text()); });
  page.on("request", (r) => { if (!r.url().startsWith("blob:")) requests.push(r.url()); });
  await page.goto(`file://${report}`);
  await until("window.talus && window.talus.ready");
});

after(async () => { if (browser) await browser.close(); });

// not page.waitForFunction: it evaluates in the page, which the page's own policy forbids
async function until(expression) {
  for (const end = Date.now() + 30000; Date.now() < end;) {
    if (await page.evaluate(expression).catch(() => false)) return;  // a page that is being loaded anew knows nothing
    await new Promise((resolve) => setTimeout(resolve, 10));
  }
  assert.fail(`never came true: ${expression}`);
}

const state = () => page.evaluate("window.talus.state()");
const shown = (quantity) => page.locator(`#inspector [data-quantity="${quantity}"]`);

async function clickBlock(id) {
  const [x, y] = await page.evaluate((b) => window.talus.screenOf(b), id);
  const box = await page.locator("#canvas").boundingBox();
  await page.mouse.click(box.x + x, box.y + y);
}

test("opens with the last frame, the title and the cards", async () => {
  assert.equal(await page.title(), "Bolted slope - talus report");
  const s = await state();
  assert.equal(s.frame, Number(await page.locator("#slider").getAttribute("max")));
  assert.match(await page.locator("#cards").innerText(), /finished/);
  assert.match(await page.locator("#clock").innerText(), /t = /);
});

test("opens with the answer: what summary.json says of joints, bolts and monitors", async () => {
  const summary = JSON.parse(readFileSync(`${folder}/summary.json`, "utf8")), text = await page.locator("#answer").innerText();
  assert.ok((await page.locator("#answer").boundingBox()).y < (await page.locator("#picture").boundingBox()).y);
  assert.match(text, new RegExp(`result\\s+${summary.valid ? "valid" : "NOT VALID"}`));
  assert.ok(text.includes(`${summary.joints.slipped_joints} joint`), text);
  assert.match(text, /residual slip at most .* accumulated slip at most/);
  assert.match(text, /largest tension .*N in /);
  const stage = summary.stages.at(-1).name, told = summary.monitors.middle.stages[stage]["displacement_x [m]"];
  const peak = Math.abs(told.least) > Math.abs(told.greatest) ? told.least : told.greatest;
  const row = await page.locator("#answer tr", { hasText: "middle" }).filter({ hasText: "displacement x" }).locator("td").allInnerTexts();
  const factor = { m: 1, mm: 1e-3, "µm": 1e-6 }[row[5]];
  assert.ok(Math.abs(Number(row[2]) * factor - peak) <= 6e-3 * Math.abs(peak), `${row} of ${peak}`);
  const stages = await page.locator("#answer-stage option").allInnerTexts();
  await page.locator("#answer-stage").selectOption(stages[0]);
  assert.match(await page.locator("#answer caption").innerText(), new RegExp(stages[0]));
  // all stages side by side: the same numbers
  await page.locator("#answer-stage").selectOption({ label: "all, side by side" });
  const heads = await page.locator("#answer th").allInnerTexts(), all = await page.locator("#answer tr", { hasText: "middle" }).filter({ hasText: "displacement x" }).locator("td").allInnerTexts();
  const dynamic = summary.stages.at(-1).kind === "dynamic";
  const column = heads.indexOf(`${stage}: ${dynamic ? "peak" : "at its end"}`), value = dynamic ? peak : told.at_end;
  assert.ok(column > 1, heads.join());
  assert.ok(Math.abs(Number(all[column]) * { m: 1, mm: 1e-3, "µm": 1e-6 }[all.at(-1)] - value) <= 6e-3 * Math.abs(value), `${all} of ${value}`);
  await page.locator("#answer-stage").selectOption(stages[0]);
});

test("the slider seeks", async () => {
  await page.locator("#slider").fill("0");
  await until("window.talus.state().frame === 0");
  assert.equal((await state()).time, 0);
});

test("play runs through the frames and stops at the end", async () => {
  await page.locator("#play").click();
  await until("window.talus.state().playing && window.talus.state().frame > 0");
  const last = Number(await page.locator("#slider").getAttribute("max"));
  await until(`!window.talus.state().playing && window.talus.state().frame === ${last}`);
});

test("keys move through time and zoom", async () => {
  await page.locator("#canvas").focus();
  await page.keyboard.press("Home");
  await until("window.talus.state().frame === 0");
  await page.keyboard.press("ArrowRight");
  await until("window.talus.state().frame === 1");
  const before = await page.evaluate("window.talus.screenOf(1)");
  await page.keyboard.press("+");
  assert.notDeepEqual(await page.evaluate("window.talus.screenOf(1)"), before);
  await page.keyboard.press("0");
  await page.keyboard.press("End");
});

test("a clicked block shows the displacement that histories.csv has", async () => {
  const last = Number(await page.locator("#slider").getAttribute("max"));
  await until(`window.talus.state().frame === ${last}`);
  await clickBlock(2);
  assert.match(await page.locator("#inspector").innerText(), /slab\[1,0\]/);
  const csv = readCsv(`${folder}/histories.csv`), column = csv["middle.displacement_x [m]"];
  assert.ok(column, `columns: ${Object.keys(csv)}`);
  const expected = column[column.length - 1], value = Number(await shown("displacement_x").getAttribute("data-value"));
  // the page holds displacements with 15 bits of mantissa, half of the last one is 2^-17; twice that for the centroid
  assert.ok(Math.abs(value - expected) <= 2e-5 * Math.abs(expected), `${value} in the page, ${expected} in the table`);
});

test("the history of the block is drawn", async () => {
  await page.locator("#show-history").click();
  await page.locator("#inspector .chart canvas").waitFor();
});

test("a clicked contact shows its forces", async () => {
  await page.locator("#show-forces").check();
  const point = await page.evaluate("window.talus.contactPlaces().find((c) => c.key.startsWith('0:'))");
  const box = await page.locator("#canvas").boundingBox();
  await page.mouse.click(box.x + point.at[0], box.y + point.at[1]);
  assert.match(await page.locator("#inspector").innerText(), /normal force/i);
  assert.ok(Number(await shown("normal_force").getAttribute("data-value")) > 0);
  await page.locator("#show-forces").uncheck();
});

test("a block is found by its name", async () => {
  await page.locator("#inspector input[name=name]").fill("slab[2,0]");
  await page.locator("#inspector form button").click();
  assert.deepEqual((await state()).selected, { block: 3 });
});

test("every colouring and range draws", async () => {
  const choices = await page.locator("#quantity option").evaluateAll((list) => list.map((o) => o.value));
  assert.ok(choices.length >= 15);
  for (const choice of choices) {
    await page.locator("#quantity").selectOption(choice);
    assert.ok((await page.locator("#legend").innerText()).length > 0, choice);
  }
  await page.locator("#quantity").selectOption("displacement");
  for (const range of ["full", "frame", "run"]) await page.locator("#range").selectOption(range);
  await page.locator("#deformation").fill("50");
  await page.locator("#deformation").fill("1");
});

test("displacements are told against a block, a group, a support", async () => {
  await clickBlock(2);
  const value = async (key) => Number(await shown(key).getAttribute("data-value"));
  const own = await value("displacement_x");
  assert.ok(Math.abs(own) > 0);
  await page.locator("#against").selectOption("selected");
  await until("document.querySelector('#legend').innerText.includes('relative to slab[1,0]')");
  assert.equal(await value("displacement_x"), 0);
  await clickBlock(3);
  const other = await value("displacement_x");
  // the history of a stress, which is absolute, leaves the frame in sight as it is told
  await page.locator("#inspector .history select").selectOption("stress_xx");
  await page.locator("#show-history").click();
  await page.locator("#inspector .chart canvas").waitFor();
  assert.equal(await value("displacement_x"), other);
  await page.locator("#against").selectOption("");
  await until("!document.querySelector('#legend').innerText.includes('relative to')");
  const absolute = await value("displacement_x");
  assert.ok(Math.abs(absolute - own - other) <= 1e-5 * Math.abs(absolute) + 1e-12, `${absolute} - ${own} is ${other}`);
  const choices = await page.locator("#against option").evaluateAll((list) => list.map((o) => o.value));
  assert.ok(choices.some((c) => c.startsWith("group:")), choices.join());
  for (const choice of choices.slice(1, -1)) {
    await page.locator("#against").selectOption(choice);
    await until("document.querySelector('#legend').innerText.includes('relative to')");
  }
  await page.locator("#against").selectOption("");
  await until("!document.querySelector('#legend').innerText.includes('relative to')");
});

test("the note under the picture calls slip by its name", async () => {
  assert.match(await page.locator("#joint-note").innerText(), /^Residual slip of joints orange, the wider the more, at most [0-9.]+ .?m \(accumulated, to and fro: /);
});

test("the colour bar has round marks at their places", async () => {
  const marks = await page.locator("#legend .tick").evaluateAll((list) => list.map((t) => [Number(t.textContent), parseFloat(t.style.left)]));
  assert.ok(marks.length >= 3, marks.join());
  const slope = (marks.at(-1)[0] - marks[0][0]) / (marks.at(-1)[1] - marks[0][1]);
  for (const [v, left] of marks) assert.ok(Math.abs(v - marks[0][0] - slope * (left - marks[0][1])) < 1e-2 * Math.abs(marks.at(-1)[0]), marks.join());
});

test("charts count the time of a stage", async () => {
  const stage = (await page.locator("#clock-of option").evaluateAll((list) => list.map((o) => o.value))).at(-1);
  await page.locator("#clock-of").selectOption(stage);
  const chart = page.locator('#charts figure.chart[data-title="displacement x"]').first();
  await chart.scrollIntoViewIfNeeded();
  const [download] = await Promise.all([page.waitForEvent("download"), chart.getByText("CSV").click()]);
  const summary = JSON.parse(readFileSync(`${folder}/summary.json`, "utf8")), begin = summary.stages.find((s) => s.name === stage)["begin [s]"];
  const saved = readCsv(await download.path()), csv = readCsv(`${folder}/histories.csv`);
  const t = csv["t [s]"].filter((v) => v > begin);
  assert.deepEqual(saved["t [s]"], t.map((v) => v - begin));
  await page.locator("#clock-of").selectOption("");
});

test("a chart saves the numbers of histories.csv", async () => {
  const chart = page.locator('figure.chart[data-title="displacement x"]').first();
  await chart.scrollIntoViewIfNeeded();
  const [download] = await Promise.all([page.waitForEvent("download"), chart.getByText("CSV").click()]);
  const saved = readCsv(await download.path()), csv = readCsv(`${folder}/histories.csv`);
  assert.deepEqual(saved["t [s]"], csv["t [s]"]);
  assert.deepEqual(saved["middle [m]"], csv["middle.displacement_x [m]"]);
});

test("a chart and the picture save as PNG", async () => {
  const chart = page.locator('figure.chart[data-title="displacement x"]').first();
  for (const button of [chart.getByText("PNG"), page.locator("#save-picture")]) {
    const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
    const bytes = readFileSync(await download.path());
    assert.equal(bytes.subarray(1, 4).toString(), "PNG");
    assert.ok(bytes.length > 3000, `${bytes.length} bytes`);
  }
});

test("tables of stages, joints, energy, solver and model are there", async () => {
  for (const [id, text] of [["stages", /rest/], ["joints", /bedding|toe/], ["energy", /kinetic|strain/], ["health", /Worst steps/], ["model", /Materials/]])
    assert.match(await page.locator(`#${id}`).innerText(), text);
});

test("dark, print and narrow", async () => {
  await page.locator("#theme").selectOption("dark");
  const dark = await page.evaluate("getComputedStyle(document.body).backgroundColor");
  await page.locator("#theme").selectOption("light");
  assert.notEqual(await page.evaluate("getComputedStyle(document.body).backgroundColor"), dark);
  await page.emulateMedia({ media: "print" });
  assert.equal(await page.locator("#picture .controls").isVisible(), false);
  await page.emulateMedia({ media: "screen" });
  for (const width of [1400, 800, 400]) {
    await page.setViewportSize({ width, height: 900 });
    // canvas and charts follow a little after the window
    await until("document.documentElement.scrollWidth <= window.innerWidth");
    for (const id of ["against", "clock-of", "answer-stage"]) {
      const box = await page.locator(`#${id}`).boundingBox();
      assert.ok(box.x >= 0 && box.x + box.width <= width, `${id} at ${width} px: ${JSON.stringify(box)}`);
    }
  }
  // every new control is reached and used by keys alone
  for (const id of ["against", "clock-of", "answer-stage"]) {
    await page.locator(`#${id}`).focus();
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("ArrowUp");
    assert.equal(await page.evaluate("document.activeElement.id"), id);
  }
});

test("six runs: a row and a small chart each, in colours of their own; told against a support", async () => {
  await page.setViewportSize({ width: 1300, height: 900 });
  await page.goto(`file://${many}`);
  await until("window.talus && window.talus.ready");
  assert.equal(await page.locator("#compare tbody tr").count(), 6);
  await page.locator("#compare tbody button").nth(4).click();
  await until("document.title && document.querySelector('#subtitle').textContent.endsWith('wave_5')");
  const grid = page.locator("#charts .multiples").first();
  assert.equal(await grid.locator("figure.chart").count(), 6);
  await grid.scrollIntoViewIfNeeded();
  await grid.locator("canvas").first().waitFor();
  const tints = await grid.locator("figure.chart").first().locator(".u-marker").evaluateAll((list) => list.map((m) => m.style.borderColor || m.style.borderTopColor).filter(Boolean));
  assert.ok(tints.length >= 2, `${tints.length} colours`);
  assert.equal(new Set(tints).size, tints.length, tints.join());
  const ground = await page.locator('#against option[value^="ground:"]').first().getAttribute("value");
  await page.locator("#against").selectOption(ground);
  await until("document.querySelector('#legend').innerText.includes('relative to')");
});

test("the page of a run that goes on loads itself anew and keeps frame, colours, selection and zoom", async () => {
  for (const end = Date.now() + 60000; !existsSync(live) && Date.now() < end;) await new Promise((resolve) => setTimeout(resolve, 100));
  await page.goto(`file://${live}`);
  await until("window.talus && window.talus.ready");
  const first = await page.evaluate("performance.timeOrigin");
  await page.locator("#quantity").selectOption("velocity");
  await page.locator("#slider").fill("1");
  await until("window.talus.state().frame === 1");
  await page.locator("#zoom-in").click();
  await page.locator("#inspector input[name=name]").fill("1");
  await page.locator("#inspector form button").click();
  const before = await page.evaluate("window.talus.screenOf(1)");
  await until(`performance.timeOrigin !== ${first} && window.talus && window.talus.ready`);
  assert.equal((await state()).frame, 1);
  assert.deepEqual((await state()).selected, { block: 1 });
  assert.equal(await page.locator("#quantity").inputValue(), "velocity");
  const after = await page.evaluate("window.talus.screenOf(1)");
  assert.ok(Math.hypot(after[0] - before[0], after[1] - before[1]) < 1, `${before} and ${after}`);
});

test("no page error, no request", () => {
  assert.deepEqual(errors, []);
  assert.deepEqual([...new Set(requests.map((r) => r.split("#")[0]))], [`file://${report}`, `file://${many}`, `file://${live}`]);
});
