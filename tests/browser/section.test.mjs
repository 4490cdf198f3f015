// Drives the page of `talus cut --open` in a real browser: node section.test.mjs SECTION MODEL, where SECTION is the
// page of MODEL, tests/fixtures/section.toml, in which every place is known by hand. Exit 77: no browser.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test, before, after } from "node:test";

const [file, model] = process.argv.slice(2);
const browserPath = process.env.TALUS_BROWSER || "/usr/bin/chromium";
if (!existsSync(browserPath)) process.exit(77);  // told by report.test.mjs
const { chromium } = createRequire(`${process.env.NODE_PATH}/`)("playwright-core");

const lines = readFileSync(model, "utf8").split("\n");
/** Number of the line that opens the section with this name. */
function lineOf(head, name) {
  const named = lines.findIndex((l) => l === `name = "${name}"`);
  const found = head.startsWith("[[") ? lines.lastIndexOf(head, named) : lines.indexOf(head);
  assert.ok(found >= 0, `${head} ${name}`);
  return found + 1;
}

/** The line that opens the section of a line. */
function headOf(line) {
  let k = line;
  while (k > 0 && !lines[k - 1].startsWith("[")) --k;
  return k;
}

let browser, page;
const errors = [], requests = [];

before(async () => {
  browser = await chromium.launch({ executablePath: browserPath, args: ["--no-sandbox"] });
  page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
  page.on("pageerror", (e) => errors.push(String(e)));
  page.on("console", (m) => { if (m.type() === "error") errors.push(m.text()); });
  page.on("request", (r) => { if (!r.url().startsWith("blob:")) requests.push(r.url()); });
  await page.goto(`file://${file}`);
  await until("window.talus && window.talus.ready");
});

after(async () => { if (browser) await browser.close(); });

async function until(expression) {
  for (const end = Date.now() + 30000; Date.now() < end;) {
    if (await page.evaluate(expression).catch(() => false)) return;
    await new Promise((resolve) => setTimeout(resolve, 10));
  }
  assert.fail(`never came true: ${expression}`);
}

async function click(x, y, dx = 0, dy = 0) {
  await page.locator("#section-canvas").scrollIntoViewIfNeeded();
  const [px, py] = await page.evaluate(([a, b]) => window.talus.section.screenOfPoint(a, b), [x, y]);
  const box = await page.locator("#section-canvas").boundingBox();
  await page.mouse.click(box.x + px + dx, box.y + py + dy);
}

const facts = () => page.locator("#section-facts").innerText();
const exactLine = () => page.evaluate("Number((document.querySelector('#section-file .exact') || { dataset: {} }).dataset.line || 0)");

/** The rows of the table of what is picked, as {name: value}. */
async function rows() {
  const cells = await page.locator("#section-facts tbody tr").evaluateAll((list) => list.map((r) => [...r.cells].map((c) => c.innerText)));
  return Object.fromEntries(cells);
}

test("a block tells its numbers and the section of the file that made it", async () => {
  await click(5, 4);
  assert.match(await facts(), /^rock\[0\]/);
  const told = await rows();
  assert.equal(told.area, "120 m²");  // 10 m by 12 m
  assert.equal(told.material, "stone");
  assert.equal(told.kind, "deformable");
  assert.equal(await exactLine(), lineOf("[[region]]", "rock"));
  const picked = await page.locator("#section-file .picked").allInnerTexts();
  assert.deepEqual(picked.map((l) => l.trim()), lines.slice(lineOf("[[region]]", "rock") - 1, lineOf("[[fault]]", "crack") - 2));
});

test("a joint tells what made it, its law and the two blocks", async () => {
  await click(10, 3);
  let told = await rows();
  assert.equal(told["comes from"], "fault crack");
  assert.equal(told.joint, "weak");
  assert.deepEqual(told.between.split(" and ").sort(), ["rock[0]", "rock[1]"]);
  assert.equal(told["length of this side"], "12 m");
  assert.equal(told["angle from +x"], "90°");
  assert.equal(await exactLine(), lineOf("[[fault]]", "crack"));
  await page.locator("#section-facts button", { hasText: "joint weak" }).click();
  assert.equal(await exactLine(), lineOf("[joint.weak]"));
  // where nothing is given for the pair, the joint of [contact] rules
  await click(5, 0);
  told = await rows();
  assert.equal(told.joint, "rough");
  assert.deepEqual(told.between.split(" and ").sort(), ["floor", "rock[0]"]);
  for (const [x, pad, law] of [[4, "left_pad", "weak"], [16, "right_pad", "rough"]]) {
    await click(x, -2);
    told = await rows();
    assert.equal(told.joint, law);
    assert.deepEqual(told.between.split(" and ").sort(), ["floor", pad]);
  }
  // nothing on its other side
  await click(15, 12);
  told = await rows();
  assert.match(told.between, /^rock\[1\] and nothing/);
  assert.equal(told.joint, undefined);
});

test("support, load, bolt and monitor show their sections", async () => {
  const cases = [["support", "corner", 0, 12, -4, -4], ["load", "push", 20, 6, 12, 0], ["bolt", "nail", 11.5, 7.5, 0, 0], ["monitor", "middle", 5, 8, 0, 0]];
  for (const [kind, name, x, y, dx, dy] of cases) {
    // load arrows stand some way apart: the nearest one is at most half that away
    for (let k = 0; k < (kind === "load" ? 24 : 1); ++k) {
      await click(x, y, dx, dy + k);
      if (headOf(await exactLine()) === lineOf(`[[${kind}]]`, name)) break;
    }
    assert.equal(headOf(await exactLine()), lineOf(`[[${kind}]]`, name), `${kind} ${name}`);
  }
});

/** Pixels of the canvas in the colour of what is picked. */
const marked = () => page.evaluate(`(() => {
  const c = document.getElementById("section-canvas"), { data } = c.getContext("2d").getImageData(0, 0, c.width, c.height);
  let n = 0;
  for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200 && data[i] > 200 && data[i + 1] < 30 && data[i + 2] > 100 && data[i + 2] < 125) ++n;
  return n;
})()`);

test("a line of the file shows what its section makes", async () => {
  await page.locator("#section-canvas").focus();
  await page.keyboard.press("Escape");
  assert.equal(await marked(), 0);
  for (const [head, name] of [["[[bolt]]", "nail"], ["[[fault]]", "crack"], ["[[region]]", "rock"], ["[joint.weak]"], ["[material.stone]"], ["[[load]]", "push"], ["[[monitor]]", "middle"]]) {
    await page.locator(`#section-file [data-line="${lineOf(head, name) + 1}"]`).click();
    assert.equal(headOf((await page.evaluate("window.talus.section.picked()")).line), lineOf(head, name), head);
    assert.ok((await marked()) > 20, `${head}: ${await marked()} pixels`);
  }
  // what is no part of the picture says so
  await page.locator(`#section-file [data-line="${lineOf("[[stage]]", "go")}"]`).click();
  assert.match(await facts(), /makes nothing that the picture shows/);
  assert.equal(await marked(), 0);
});

test("the least stable step is told, and fixed blocks have none", async () => {
  await click(5, -1.5);
  assert.match((await rows())["stable step of the block alone"], /does not deform/);
  await page.locator("#section-colour").selectOption("step");
  assert.match(await page.locator("#section-scale").innerText(), /stable step of the block alone \[s\]/);
  await page.locator("#section-colour").selectOption("material");
});

test("a block is found by its name, and one that is not there is said", async () => {
  await page.locator("#section-block").fill("rock[1]");
  await page.keyboard.press("Enter");
  assert.match(await facts(), /^rock\[1\]/);
  await page.locator("#section-block").fill("rok[1]");
  await page.keyboard.press("Enter");
  assert.match(await facts(), /There is no block "rok\[1\]"/);
});

test("zoom, pan and fit, by buttons and keys", async () => {
  const scale = () => page.evaluate("window.talus.section.scale()"), whole = await scale();
  await page.locator("#section-in").click();
  assert.ok(Math.abs((await scale()) / whole - 1.5) < 1e-9);
  await page.locator("#section-canvas").focus();
  await page.keyboard.press("-");
  assert.ok(Math.abs((await scale()) / whole - 1) < 1e-9);
  const at = () => page.evaluate("window.talus.section.screenOfPoint(0, 0)"), before = await at();
  await page.keyboard.press("ArrowLeft");
  assert.ok(Math.abs((await at())[0] - before[0] - 60) < 1e-9);
  await page.keyboard.press("0");
  const again = await at();
  assert.ok(Math.hypot(again[0] - before[0], again[1] - before[1]) < 1e-6, `${again} and ${before}`);
});

test("lines of one origin can be left out", async () => {
  await page.locator("#section-legend label", { hasText: "crack" }).locator("input").uncheck();
  await click(10, 3);
  assert.doesNotMatch(await facts(), /fault crack/);
  await page.locator("#section-legend label", { hasText: "crack" }).locator("input").check();
});

test("narrow, dark, print, and keys alone", async () => {
  for (const width of [1400, 800, 400]) {
    await page.setViewportSize({ width, height: 900 });
    await until("document.documentElement.scrollWidth <= window.innerWidth");
    for (const id of ["section-colour", "section-thing", "section-block", "section-canvas", "section-file"]) {
      const box = await page.locator(`#${id}`).boundingBox();
      assert.ok(box.x >= 0 && box.x + box.width <= width, `${id} at ${width} px: ${JSON.stringify(box)}`);
    }
  }
  await page.setViewportSize({ width: 1400, height: 900 });
  await page.locator("#section-thing").focus();
  await page.keyboard.type("nail");
  assert.equal(await exactLine(), lineOf("[[bolt]]", "nail"));
  await page.locator("#theme").selectOption("dark");
  const dark = await page.evaluate("getComputedStyle(document.body).backgroundColor");
  await page.locator("#theme").selectOption("light");
  assert.notEqual(await page.evaluate("getComputedStyle(document.body).backgroundColor"), dark);
  await page.emulateMedia({ media: "print" });
  assert.equal(await page.locator("#section .controls").isVisible(), false);
  assert.equal(await page.locator("#picture").isVisible(), false);
  await page.emulateMedia({ media: "screen" });
});

test("no page error, no request", () => {
  assert.deepEqual(errors, []);
  assert.deepEqual([...new Set(requests.map((r) => r.split("#")[0]))], [`file://${file}`]);
});
