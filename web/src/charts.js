// Charts over time: monitors grouped by quantity, energies, solver. Zoom by dragging, values under the pointer,
// export as PNG and CSV.

import uPlot from "uplot";
import { number, readableUnit } from "./quantities.js";

// apart for colour-blind readers; with the dashes, apart in grey too
const kColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#7f6000", "#56b4e9", "#5e3c99", "#8c8c8c"];
// more curves than colours: further hues, none twice
const colourOf = (i) => (i < kColours.length ? kColours[i] : `hsl(${Math.round(i * 137.508) % 360}, 70%, ${30 + 8 * (Math.floor(i / 3) % 3)}%)`);
const kDashes = [[], [8, 4], [2, 3], [10, 3, 2, 3], [14, 4]];

const live = new Set();  // charts that are drawn

function css(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Puts several time axes on one: times, and each series with null where it has no value. */
function join(series) {
  const same = series.every((s) => s.time.length === series[0].time.length && s.time.every((t, i) => t === series[0].time[i]));
  if (same) return [series[0].time, ...series.map((s) => Array.from(s.value))];
  return uPlot.join(series.map((s) => [Array.from(s.time), Array.from(s.value)]));
}

/** The largest size of any value. */
export function largestOf(series) {
  let most = 0;
  for (const s of series) for (const v of s.value) if (Math.abs(v) > most) most = Math.abs(v);
  return most;
}

/**
 * A chart in `parent`. `spec`: {title, unit, series: [{label, time, value}], log, height, range, onTime(t)}; drawn in a
 * prefix of the unit that suits the largest value, saved without.
 * Drawn when it comes into sight.
 */
export function addChart(parent, spec) {
  const figure = document.createElement("figure");
  figure.className = "chart";
  figure.dataset.title = spec.title;
  const head = document.createElement("figcaption");
  head.textContent = spec.title;
  const tools = document.createElement("span");
  tools.className = "tools";
  const chart = { figure, spec, plot: null, data: null, scale: readableUnit(spec.largest || largestOf(spec.series), spec.log ? "" : spec.unit || "") };
  if (spec.log) chart.scale.unit = spec.unit || "";
  for (const [text, title, action] of [["Whole", "show the whole time again", () => whole(chart)],
    ["PNG", "save this chart as a picture", () => savePng(chart)],
    ["CSV", "save the numbers of this chart", () => saveCsv(chart)]]) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = text;
    button.title = title;
    button.setAttribute("aria-label", `${spec.title}: ${title}`);
    button.addEventListener("click", () => { draw(chart); action(); });
    tools.append(button);
  }
  head.append(tools);
  chart.box = document.createElement("div");
  chart.box.className = "plot";
  figure.append(head, chart.box);
  parent.append(figure);
  const seen = new IntersectionObserver((entries) => {
    if (!entries.some((e) => e.isIntersecting)) return;
    seen.disconnect();
    draw(chart);
  }, { rootMargin: "300px" });
  seen.observe(figure);
  live.add(chart);
  chart.remove = () => { live.delete(chart); if (chart.plot) chart.plot.destroy(); figure.remove(); };
  chart.draw = () => draw(chart);
  return chart;
}

function options(chart) {
  const { spec } = chart, ink = css("--ink"), grid = css("--grid");
  const axis = { stroke: ink, grid: { stroke: grid, width: 1 }, ticks: { stroke: grid, width: 1 }, font: "12px sans-serif", labelFont: "12px sans-serif" };
  const digits = (u, values) => values.map((v) => (v === null ? "" : spec.log ? v.toExponential(0) : number(v, 6)));
  return {
    width: Math.max(spec.height ? 160 : 280, chart.box.clientWidth), height: spec.height || 260,
    cursor: { drag: { x: true, y: false }, sync: { key: "time" } },
    scales: { x: { time: false }, y: { distr: spec.log ? 3 : 1, ...(spec.range ? { range: spec.range.map((v) => v / chart.scale.factor) } : {}) } },
    series: [{ label: "t [s]", value: (u, v) => (v === null ? "–" : number(v, 6)) }, ...spec.series.map((s, i) => ({
      label: s.label, stroke: colourOf(i), width: 1.6, spanGaps: true,
      dash: kDashes[Math.floor(i / kColours.length) % kDashes.length].length ? kDashes[Math.floor(i / kColours.length) % kDashes.length]
        : kDashes[i % kDashes.length],
      value: (u, v) => (v === null || v === undefined ? "–" : number(v, 6)),
      points: { show: s.time.length < 40 },
    }))],
    axes: [{ ...axis, label: spec.xLabel || "t [s]", values: (u, v) => v.map((x) => number(x, 6)) },
      { ...axis, label: `${spec.quantity || spec.title}${chart.scale.unit ? ` [${chart.scale.unit}]` : ""}`, values: digits,
        size: (u, values) => 26 + 7 * Math.max(4, ...(values || []).map((v) => v.length)), ...(spec.log ? { splits: decades } : {}) }],
    legend: { markers: { dash: (u, i) => (u.series[i].dash && u.series[i].dash.length ? "dashed" : "solid") } },
    hooks: { draw: [drawNow(chart)] },
  };
}

// marks of a logarithmic axis: powers of ten, not all where there are many
function decades(u, axis, least, most) {
  const from = Math.ceil(Math.log10(least) - 1e-9), to = Math.floor(Math.log10(most) + 1e-9), step = Math.max(1, Math.ceil((to - from) / 8)), out = [];
  for (let e = from; e <= to; e += step) out.push(10 ** e);
  return out;
}

// thin lines where stages begin, with their names as far as there is room
function drawStages(u, stages) {
  const { ctx } = u, ratio = window.devicePixelRatio || 1;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = css("--quiet");
  ctx.globalAlpha = 0.7;
  ctx.setLineDash([1, 3]);
  ctx.font = `${11 * ratio}px sans-serif`;
  ctx.textBaseline = "top";
  ctx.textAlign = "left";
  stages.forEach((stage, k) => {
    const { min, max } = u.scales.x, begin = Math.max(stage.begin, min), end = Math.min(k + 1 < stages.length ? stages[k + 1].begin : max, max);
    if (!(end > begin)) return;
    const x = u.valToPos(begin, "x", true), room = u.valToPos(end, "x", true) - x - 8 * ratio;
    if (stage.begin > min) {
      ctx.beginPath();
      ctx.moveTo(x, u.bbox.top);
      ctx.lineTo(x, u.bbox.top + u.bbox.height);
      ctx.stroke();
    }
    if (ctx.measureText(stage.name).width < room) ctx.fillText(stage.name, x + 4 * ratio, u.bbox.top + 3 * ratio);
  });
  ctx.restore();
}

// a line at the time of the picture
function drawNow(chart) {
  return (u) => {
    const stages = chart.spec.stages ? chart.spec.stages() : [];
    if (stages.length > 1) drawStages(u, stages);
    const t = chart.spec.timeNow ? chart.spec.timeNow() : NaN;
    if (!(t >= u.scales.x.min && t <= u.scales.x.max)) return;
    const x = u.valToPos(t, "x", true);
    u.ctx.save();
    u.ctx.strokeStyle = css("--ink");
    u.ctx.globalAlpha = 0.6;
    u.ctx.setLineDash([4, 4]);
    u.ctx.beginPath();
    u.ctx.moveTo(x, u.bbox.top);
    u.ctx.lineTo(x, u.bbox.top + u.bbox.height);
    u.ctx.stroke();
    u.ctx.restore();
  };
}

function draw(chart) {
  if (chart.plot) return;
  const { factor } = chart.scale;
  chart.data = join(factor === 1 ? chart.spec.series : chart.spec.series.map((s) => ({ ...s, value: Array.from(s.value, (v) => v / factor) })));
  if (chart.spec.log) chart.data = chart.data.map((v, k) => (k === 0 ? v : Array.from(v, (y) => (y > 0 ? y : null))));
  chart.plot = new uPlot(options(chart), chart.data, chart.box);
  if (chart.spec.onTime) chart.plot.over.addEventListener("dblclick", () => {
    const { left } = chart.plot.cursor;
    if (left >= 0) chart.spec.onTime(chart.plot.posToVal(left, "x"));
  });
}

function whole(chart) {
  const x = chart.data[0];
  chart.plot.setScale("x", { min: x[0], max: x[x.length - 1] });
}

/** Draws also the charts that were not in sight yet. */
export function drawCharts() {
  for (const chart of live) draw(chart);
}

/** Draws all charts anew: other colours, another width. */
export function redrawCharts() {
  for (const chart of live) {
    if (!chart.plot) continue;
    chart.plot.destroy();
    chart.plot = null;
    draw(chart);
  }
}

/** Moves the lines of the time shown. */
export function moveTime() {
  for (const chart of live) if (chart.plot) chart.plot.redraw(false, false);
}

export function save(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function fileName(title, ending) {
  return `${title.replace(/[^\w.-]+/g, "_")}.${ending}`;
}

export function csvOf(chart) {
  const cell = (text) => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
  const unit = chart.spec.unit ? ` [${chart.spec.unit}]` : "";
  const lines = [["t [s]", ...chart.spec.series.map((s) => cell(s.label + unit))].join(",")];
  const data = join(chart.spec.series);
  for (let i = 0; i < data[0].length; ++i)
    lines.push(data.map((v) => (v[i] === null || v[i] === undefined ? "" : String(v[i]))).join(","));
  return lines.join("\n") + "\n";
}

function saveCsv(chart) {
  save(fileName(chart.spec.title, "csv"), new Blob([csvOf(chart)], { type: "text/csv" }));
}

// The chart with its title and legend, on white.
function savePng(chart) {
  const source = chart.plot.ctx.canvas, ratio = source.width / source.clientWidth || 1;
  const entries = chart.spec.series.map((s, i) => ({ label: s.label, series: chart.plot.series[i + 1] }));
  const row = 20 * ratio, head = 30 * ratio, canvas = document.createElement("canvas");
  canvas.width = source.width;
  canvas.height = head + source.height + entries.length * row + 8 * ratio;
  const context = canvas.getContext("2d");
  context.fillStyle = css("--paper");
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(source, 0, head);
  context.fillStyle = css("--ink");
  context.font = `bold ${14 * ratio}px sans-serif`;
  context.textBaseline = "middle";
  context.fillText(chart.spec.title, 12 * ratio, head / 2);
  context.font = `${12 * ratio}px sans-serif`;
  entries.forEach(({ label, series }, i) => {
    const y = head + source.height + (i + 0.5) * row;
    context.strokeStyle = typeof series.stroke === "function" ? series.stroke(chart.plot, i + 1) : series.stroke;
    context.lineWidth = 2 * ratio;
    context.setLineDash((series.dash || []).map((d) => d * ratio));
    context.beginPath();
    context.moveTo(16 * ratio, y);
    context.lineTo(56 * ratio, y);
    context.stroke();
    context.fillText(label, 64 * ratio, y);
  });
  canvas.toBlob((blob) => save(fileName(chart.spec.title, "png"), blob));
}
