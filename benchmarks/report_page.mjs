// Times reports in a headless browser: size, first picture, frames a second while playing, time of one frame.
// Usage: NODE_PATH=BUILD/browser/node_modules node benchmarks/report_page.mjs [RUNS] REPORT.html...   (RUNS: 5)
// The modules are those of the test "report in a browser". Prints min, median and max of each figure.

import { statSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";

const { chromium } = createRequire(`${resolve(process.env.NODE_PATH)}/`)("playwright-core");
const args = process.argv.slice(2);
const repeats = /^\d+$/.test(args[0]) ? Number(args.shift()) : 5;

const spread = (list) => {
  const v = [...list].sort((a, b) => a - b);
  return [v[0], v[Math.floor(v.length / 2)], v[v.length - 1]].map((x) => x.toFixed(2)).join(" / ");
};

// the page's own policy forbids page.waitForFunction
async function until(page, expression) {
  while (!(await page.evaluate(expression))) await new Promise((resolve) => setTimeout(resolve, 5));
}

for (const report of args) {
  const first = [], rate = [], slowest = [], drawn = [], errors = [];
  let frames = 0;
  for (let k = 0; k < repeats; ++k) {
    const browser = await chromium.launch({ executablePath: process.env.TALUS_BROWSER || "/usr/bin/chromium", args: ["--no-sandbox"] });
    const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
    page.on("pageerror", (e) => errors.push(String(e)));
    page.on("request", (r) => { if (!r.url().startsWith("file:") && !r.url().startsWith("blob:")) errors.push(r.url()); });
    const begin = Date.now();
    await page.goto(`file://${resolve(report)}`, { waitUntil: "commit", timeout: 120000 });
    await until(page, "window.talus && window.talus.firstPicture > 0");
    first.push((Date.now() - begin) / 1000);
    await until(page, "window.talus.ready");
    const figures = await page.evaluate(async () => {
      document.getElementById("speed").value = "120";
      window.talus.times.length = 0;
      const start = performance.now();
      document.getElementById("play").click();
      await new Promise((done) => { const look = () => (window.talus.state().playing ? setTimeout(look, 50) : done()); setTimeout(look, 200); });
      const times = window.talus.times, wall = performance.now() - start;
      return { times: [...times], wall, draw: window.talus.state().drawTime };
    });
    frames = figures.times.length;
    rate.push((1000 * frames) / figures.times.reduce((a, b) => a + b, 0));
    slowest.push(Math.max(...figures.times));
    drawn.push(figures.draw);
    await browser.close();
  }
  console.log(`${report}: ${(statSync(report).size / 1e6).toFixed(1)} MB, ${frames} frames played, ${repeats} runs (min / median / max)`);
  console.log(`  first picture ${spread(first)} s; playing ${spread(rate)} frames/s, slowest frame ${spread(slowest)} ms; drawing one ${spread(drawn)} ms`);
  console.log(`  page errors and requests: ${errors.length ? errors.join("; ") : "none"}`);
}
