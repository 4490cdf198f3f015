// Drives the report in a real browser, from a file, with the network watched: node report.test.mjs REPORT FOLDER
// where FOLDER is the result folder of examples/bolted_slope that REPORT was made from. Exit 77: no browser.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test, before, after } from "node:test";

const [report, folder] = process.argv.slice(2);
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
    if (await page.evaluate(expression)) return;
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
  assert.equal(await page.locator(".controls").isVisible(), false);
  await page.emulateMedia({ media: "screen" });
  await page.setViewportSize({ width: 600, height: 900 });
  // canvas and charts follow a little after the window
  await until("document.documentElement.scrollWidth <= window.innerWidth");
});

test("no page error, no request", () => {
  assert.deepEqual(errors, []);
  assert.deepEqual(requests, [`file://${report}`]);
});
