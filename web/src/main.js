// The report: puts the picture, the charts and the texts together and reacts to the reader.

import { chunkJson } from "./decode.js";
import { Run } from "./run.js";
import { View, contactKey } from "./view.js";
import { answeredStages, monitorTable, stagesTable, verdictsOf } from "./answer.js";
import { addChart, drawCharts, largestOf, moveTime, redrawCharts, save } from "./charts.js";
import { comparison } from "./compare.js";
import { colours, learn, number, quantities, readableUnit, ticks, withUnit, words } from "./quantities.js";
import { element, tableOf } from "./dom.js";
import { followPointer, followSize, matchPixels } from "./pointer.js";
import { showSection } from "./section.js";
import { cardsOf, energyOf, listOf, modelOf, stagesOf, warningsOf, worstSteps } from "./words.js";

const $ = (id) => document.getElementById(id);

const contactColumn = (key) => words.contact_columns.find((c) => c.key === key);

let runs = [], run = null, view = null;
let frameIndex = 0, playing = false, wanted = 0;
let against = "";    // what displacements are told against, a key of run.references() or "block:ID"
let history = null;  // the chart of what is selected
const times = [];    // of frames drawn while playing [ms], for the benchmark

async function start() {
  setTheme();
  const index = await chunkJson("index");
  learn(index.words);
  $("notices").textContent = document.getElementById("talus-notices").textContent.trim();
  if (index.section) {
    $("theme").addEventListener("change", setTheme);
    systemDark.addEventListener("change", setTheme);
    await showSection(index);
    return;
  }
  runs = index.runs.map((r) => new Run(r));
  $("made").textContent = `Made by ${index.program} from ${runs.map((r) => r.name).join(", ")}. Everything shown is in this file.`;
  view = new View($("canvas"), $("ground"));
  if (runs.length > 1) {
    $("run-choice").hidden = false;
    runs.forEach((r, i) => $("run").append(element("option", { value: String(i) }, r.name)));
  }
  listen();
  const table = comparison(runs, (i) => { $("run").value = String(i); return showRun(i); });
  section("compare", [table]);
  await showRun(0);
  offerClocks();
  await addMonitors();
  if (window.location.hash.length > 1) await goOnWhereWeWere();  // also the last page of a run that has ended
  if (index.reload > 0) reloading = setTimeout(reload, 1000 * index.reload);
  window.talus.ready = true;
}

// ---- a run that goes on ----

let reloading = 0;

// The page is loaded anew, and kept as the reader has left it, by what stands behind the # of its address.
function reload() {
  if (playing) {
    reloading = setTimeout(reload, 500);
    return;
  }
  const last = run.frames.length - 1, controls = {};
  for (const id of ["quantity", "range", "deformation", "clock-of", "answer-stage"]) if ($(id)) controls[id] = $(id).value;
  const kept = { frame: frameIndex === last ? "last" : frameIndex, centre: view.centre, scale: view.scale, fitted: view.fitted, selected: view.selected,
    show: view.show, against, controls, scroll: window.scrollY };
  window.history.replaceState(null, "", `#${encodeURIComponent(JSON.stringify(kept))}`);
  window.location.reload();
}

async function goOnWhereWeWere() {
  let kept;
  try {
    kept = JSON.parse(decodeURIComponent(window.location.hash.slice(1)));
  } catch {
    return;  // the first time
  }
  for (const [id, value] of Object.entries(kept.controls || {})) {
    const control = $(id);
    if (!control || (control.tagName === "SELECT" && ![...control.options].some((o) => o.value === value))) continue;
    control.value = value;
  }
  if ($("answer-stage")) showAnswer($("answer-stage").value);
  view.quantity = $("quantity").value;
  view.deformation = Number($("deformation").value) || view.deformation;
  Object.assign(view.show, kept.show);
  for (const key of Object.keys(view.show)) $(`show-${key}`).checked = view.show[key];
  against = kept.against || "";
  if ([...$("against").options].some((o) => o.value === against)) $("against").value = against;
  view.selected = kept.selected;
  if (!kept.fitted) view.centre = kept.centre, view.scale = kept.scale, view.fitted = false;
  if (run.frames.length) await showFrame(kept.frame === "last" ? run.frames.length - 1 : Math.min(kept.frame, run.frames.length - 1), kept.fitted);
  if (kept.controls["clock-of"]) await addMonitors();
  window.scrollTo(0, kept.scroll);
}

// ---- one run ----

async function showRun(i) {
  stop();
  run = runs[i];
  view.run = run;
  view.selected = null;
  against = "";
  $("title").textContent = run.title();
  document.title = `${run.title()} - talus report`;
  $("subtitle").textContent = run.title() === run.name ? "" : run.name;
  fill("warnings", warningsOf(run).map((w) => element("p", { class: "warning" }, w)));
  fill("cards", cardsOf(run).map(([title, value, note]) =>
    element("div", { class: "card" }, element("span", { class: "name" }, title), element("span", { class: "value" }, value), element("span", { class: "note" }, note))));
  showAnswer();
  offerQuantities();
  offerReferences();
  $("picture").hidden = run.frames.length === 0;
  matchPixels($("canvas"));
  if (run.frames.length) {
    $("slider").max = String(run.frames.length - 1);
    $("show-bolts").parentElement.hidden = !run.frames.some((f) => f.bolts && f.bolts.count);
    await showFrame(run.frames.length - 1, true);
    window.talus.firstPicture = performance.now();
  }
  showInspector();
  section("stages", [stagesOf(run)]);
  section("joints", [listOf("Joints that slipped, greatest first, at the end of the last stage", run.slips, ["stage", "time [s]"]),
    listOf("Bolts at the end of the last stage", run.bolts, ["stage", "t [s]"])]);
  section("model", modelOf(run));
  const steps = await run.table("steps");
  section("health", []);
  section("energy", [energyOf(run)]);
  if (steps) {
    addSteps(steps);
    $("health").append(worstSteps(steps, run.frames.length ? goToTime : null) || "");
  }
}

const kAllStages = "\u0000";  // no name of a stage

// What the run says, in words and as the table of a stage.
function showAnswer(stage) {
  const stages = answeredStages(run), chosen = stage || stages[stages.length - 1];
  const list = element("dl", { class: "verdicts" }, ...verdictsOf(run).flatMap(([name, text]) => [element("dt", {}, name), element("dd", { class: /NOT VALID|failed/.test(text) ? "bad" : undefined }, text)]));
  const choice = stages.length > 1 ? element("p", { class: "controls" }, element("label", {}, "stage ",
    element("select", { id: "answer-stage", onchange: (e) => { showAnswer(e.target.value); $("answer-stage").focus(); } },
      ...stages.map((name) => element("option", { value: name, selected: name === chosen }, name)),
      element("option", { value: kAllStages, selected: chosen === kAllStages }, "all, side by side")))) : "";
  const table = chosen === kAllStages ? stagesTable(run) : chosen ? monitorTable(run, chosen, run.frames.length ? goToTime : null) : null;
  fill("answer", [list, choice, table || ""].filter(Boolean));
}

function fill(id, children) {
  $(id).replaceChildren(...children);
}

function section(id, children) {
  const kept = children.filter(Boolean), place = $(id);
  const head = place.querySelector("h2");
  for (const chart of place.charts || []) chart.remove();
  place.charts = [];
  place.replaceChildren(head, ...kept);
  place.hidden = kept.length === 0;
}

function offerQuantities() {
  const select = $("quantity"), before = select.value || "displacement";
  const groups = [["what has moved", ["displacement", "displacement_x", "displacement_y", "velocity", "velocity_x", "velocity_y"]],
    ["stress (tension > 0)", ["stress_xx", "stress_yy", "stress_xy", "stress_major", "stress_minor", "shear_most"]]];
  select.replaceChildren(...groups.map(([label, keys]) =>
    element("optgroup", { label }, ...keys.map((k) => element("option", { value: k }, quantities[k].title)))));
  if (run.blocks) select.append(element("optgroup", { label: "what they are (joint states stand out)" },
    ...["material", "group", "kind"].map((k) => element("option", { value: k }, k))));
  select.value = [...select.options].some((o) => o.value === before) ? before : "displacement";
  view.quantity = select.value;
}

function offerReferences() {
  const groups = new Map();
  for (const r of run.references()) {
    if (!groups.has(r.group)) groups.set(r.group, []);
    groups.get(r.group).push(r);
  }
  $("against").replaceChildren(element("option", { value: "" }, "its place at the start"),
    ...[...groups].map(([label, list]) => element("optgroup", { label }, ...list.map((r) => element("option", { value: r.key }, r.title)))),
    element("option", { value: "selected" }, "the selected block"));
  $("against").value = "";
}

async function setAgainst() {
  const value = $("against").value;
  if (value === "selected") {
    if (!view.selected || view.selected.block === undefined) {
      $("against").value = "";
      $("joint-note").textContent = "Click a block first: displacements are then told against it.";
      against = "";
      return showFrame(frameIndex);
    }
    against = `block:${view.selected.block}`;
  } else against = value;
  if (history) history.chart.remove(), history = null;
  await showFrame(frameIndex);
}

const againstText = () => {
  if (!against) return "";
  const name = against.slice(against.indexOf(":") + 1);
  return ` relative to ${against.startsWith("block:") ? run.block(Number(name)).name : name}`;
};

const isMotion = (key) => /^(displacement|velocity)/.test(key);

// ---- frames ----

async function showFrame(i, fit = false) {
  wanted = i;
  const of = run;
  const [frame, contacts, bolts] = await Promise.all([run.frameAgainst(i, against), run.contactsAt(i), run.boltsAt(i)]);
  if (wanted !== i || of !== run) return;  // the reader has moved on
  const range = await rangeOf(i);
  if (wanted !== i || of !== run) return;
  frameIndex = i;
  view.frame = frame;
  view.contacts = contacts;
  view.bolts = bolts;
  if (fit) view.fit();
  if (range) view.range = range;
  view.draw();
  $("slider").value = String(i);
  const entry = run.frames[i], stage = (run.summary.stages || [])[entry.stage];
  $("clock").textContent = `t = ${entry.t.toFixed(timeDigits())} s · frame ${i + 1} of ${run.frames.length}${stage ? ` · ${stage.name}${stage["begin [s]"] > 0 ? `, its ${(entry.t - stage["begin [s]"]).toFixed(timeDigits())} s` : ""}` : ""}`;
  $("slider").setAttribute("aria-valuetext", $("clock").textContent);
  if (!playing) afterFrame();
  else legend();
}

function timeDigits() {
  const end = run.frames[run.frames.length - 1].t;
  return end > 0 ? Math.max(0, Math.min(9, 4 - Math.floor(Math.log10(end)))) : 3;
}

// what need not happen thirty times a second
function afterFrame() {
  legend();
  showInspector();
  moveTime();
}

// The range of the colours, null where they are those of names.
async function rangeOf(i) {
  const q = quantities[view.quantity];
  if (!q) return null;
  const mode = $("range").value, key = isMotion(q.key) ? against : "", n = run.frames.length;
  // against something every frame has to be decoded: some of a long run are enough for its colours
  const every = key ? Math.max(1, Math.ceil(n / 40)) : 1;
  const chosen = mode === "frame" ? [i] : [...Array(n).keys()].filter((k) => k % every === 0 || k === n - 1 || k === i);
  let least = Infinity, low = Infinity, high = -Infinity, most = -Infinity;
  for (const k of chosen) {
    const s = await run.span(k, key, q);
    least = Math.min(least, s[0]), low = Math.min(low, s[1]), high = Math.max(high, s[2]), most = Math.max(most, s[3]);
  }
  const trimmed = mode === "run";
  let from = trimmed ? low : least, to = trimmed ? high : most;
  if (!(to > from)) from = least, to = most;
  let side = 0;
  if (q.signed) {
    const size = Math.max(Math.abs(from), Math.abs(to));
    side = most <= 0 ? -1 : least >= 0 ? 1 : 0;
    from = side > 0 ? 0 : -size, to = side < 0 ? 0 : size;
  } else from = Math.min(0, from);
  return { low: from, high: to, least, most, side };
}

function legend() {
  const q = quantities[view.quantity];
  if (!q) {
    fill("legend", (view.labels || []).map((label, i) =>
      element("span", { class: "swatch" }, element("i", { style: `background:${words.colours.palette[i % words.colours.palette.length]}` }), label || "none")));
  } else {
    const { low, high, least, most } = view.range, unit = readableUnit(Math.max(Math.abs(low), Math.abs(high)), q.unit);
    const text = (v) => number(v / unit.factor, 3);
    const marks = ticks(low / unit.factor, high / unit.factor).map((v) => {
      const share = (100 * (v * unit.factor - low)) / (high - low);
      return element("span", { class: "tick", style: `left:${share.toFixed(2)}%` }, number(v, 3));
    });
    const beyond = [least < low ? `least ${text(least)}` : "", most > high ? `largest ${text(most)}` : ""].filter(Boolean).join(", ");
    fill("legend", [element("span", { class: "legend-title" }, `${q.title}${isMotion(q.key) ? againstText() : ""} [${unit.unit}]`),
      element("span", { class: "scale" },
        element("span", { class: "bar", style: `background:linear-gradient(90deg,${colours(q.signed, view.range.side).join(",")})`, role: "img", "aria-label": `colours from ${text(low)} to ${text(high)} ${unit.unit}` }), ...marks),
      element("span", { class: "note" }, beyond ? `beyond the colours: ${beyond}` : "")]);
  }
  const notes = [], c = view.contacts;
  if (c && (view.show.joints || view.show.forces)) {
    if (view.show.joints && c.lines.length + c.alone.length) notes.push(view.largestSlip > 0 ? `${c.residual ? "Residual" : "Accumulated"} slip of joints orange, the wider the more, at most ${withUnit(view.largestSlip, "m")}${c.residual && view.largestAccumulated > 0 ? ` (accumulated, to and fro: ${withUnit(view.largestAccumulated, "m")})` : ""}.` : "No joint has slipped.");
    if (view.show.joints && view.largestOpening > 0) notes.push(`Open joints of blocks still near each other dashed, at most ${withUnit(view.largestOpening, "m")}.`);
    if (view.show.forces && view.largestForce > 0) notes.push(`Longest arrow: ${withUnit(view.largestForce, "N")}, on the first of the two blocks.`);
    if (!c.exact) notes.push(`Contacts are those of t = ${number(c.time, 5)} s: this page has them for ${run.contacts.length} frames.`);
  }
  if (against) notes.push(view.frame.lost ? `What displacements are told${againstText()} is not there at this time: they are absolute.` : `Displacements and velocities${againstText()}.`);
  if (view.bolts && view.show.bolts) notes.push(`Bolts: tension, dark green ${withUnit(view.largestTension, "N")}, grey in compression, black ruptured.`);
  $("joint-note").textContent = notes.join(" ");
}

function goTo(i) {
  stop();
  return showFrame(Math.max(0, Math.min(run.frames.length - 1, i)));
}

function goToTime(t) {
  let best = 0;
  run.frames.forEach((f, i) => { if (Math.abs(f.t - t) < Math.abs(run.frames[best].t - t)) best = i; });
  $("picture").scrollIntoView({ block: "nearest" });
  return goTo(best);
}

async function play() {
  if (playing || run.frames.length < 2) return stop();
  playing = true;
  view.still = false;
  $("play").textContent = "❚❚";
  $("play").setAttribute("aria-label", "pause");
  let show = frameIndex === run.frames.length - 1 ? 0 : frameIndex + 1, next = performance.now();
  for (; playing && show < run.frames.length; ++show) {
    const begin = performance.now();
    await showFrame(show);
    if (show + 1 < run.frames.length) run.frameAgainst(show + 1, against);  // decoded while this one is looked at
    next = Math.max(next + 1000 / Math.max(1, Number($("speed").value) || 30), performance.now() - 100);
    await new Promise((resolve) => {
      const look = () => (performance.now() + 2 >= next || !playing ? resolve() : requestAnimationFrame(look));
      requestAnimationFrame(look);
    });
    times.push(performance.now() - begin);
  }
  stop();
}

function stop() {
  if (!playing) return;
  playing = false;
  view.still = true;
  view.draw();
  $("play").textContent = "▶";
  $("play").setAttribute("aria-label", "play");
  afterFrame();
}

// ---- numbers of a block or contact ----

function showInspector() {
  const place = $("inspector"), chosen = view.selected;
  if (history && (!chosen || history.key !== JSON.stringify(chosen))) {
    history.chart.remove();
    history = null;
  }
  const finder = element("form", { class: "finder", onsubmit: (e) => { e.preventDefault(); find(e.target.elements.name.value); } },
    element("label", {}, "block ", element("input", { name: "name", list: "block-names", placeholder: "name or number", size: "14" })), element("button", { type: "submit" }, "show"));
  if (!run.frames.length) return place.replaceChildren();
  if (!chosen) return place.replaceChildren(element("p", { class: "hint" }, "Click a block, or a contact that is drawn, for its numbers and history."), finder);
  const table = chosen.block !== undefined ? blockNumbers(chosen.block) : contactNumbers(chosen.contact);
  place.replaceChildren(table, finder);
  if (history) place.append(history.chart.figure);
  else place.append(historyButtons(chosen));
}

function blockNumbers(id) {
  const f = view.frame, i = f.shapes.place.get(id), b = run.block(id);
  const rows = [];
  if (b.kind) rows.push(["kind", b.kind], ["material", b.material], ["group", b.group], ["area", `${number(b.area, 5)} m²`]);
  rows.push(["number", String(id)]);
  if (i === undefined || !f.present[i]) rows.push(["", "not there at this time: dug out"]);
  else {
    rows.push(["place", `(${number(f.shapes.cx[i] + f.ux[i], 6)}, ${number(f.shapes.cy[i] + f.uy[i], 6)}) m`]);
    rows.push(["rotation", `${number((Math.atan2(f.hyx[i] - f.hxy[i], 2 + f.hxx[i] + f.hyy[i]) * 180) / Math.PI, 2)}°`]);
    for (const key of Object.keys(quantities)) {
      const q = quantities[key];
      rows.push([q.title + (isMotion(key) ? againstText() : ""), element("span", { "data-quantity": key, "data-value": String(q.of(f, i)) }, withUnit(q.of(f, i), q.unit, 3))]);
    }
  }
  return tableOf(b.name, ["at the centroid", `t = ${number(f.time, 5)} s`], rows);
}

function contactNumbers(key) {
  const p = view.contacts, i = view.findContact(key), [kind, a, corner, b, edge] = key.split(":").map(Number);
  const name = (id) => (id < 0 ? "the ground" : run.block(id).name);
  const rows = [["between", `${name(a)} and ${name(b)}`]];
  if (kind === 0) rows.push(["corner on edge", `${corner} of the first on ${edge} of the second`]);
  if (i < 0) rows.push(["", "carries nothing at this time"]);
  else {
    const state = contactColumn("state").names[p.state[i]];
    if (state) rows.push(["state", state]);
    for (const c of words.contact_columns.filter((one) => one.shown && p[one.key]))
      rows.push([c.title, element("span", { "data-quantity": c.key, "data-value": String(p[c.key][i]) }, withUnit(p[c.key][i], c.unit))]);
    rows.push(["force on the first", `(${withUnit(p.fx[i], "N")}, ${withUnit(p.fy[i], "N")})`]);
  }
  return tableOf(contactColumn("kind").names[kind] || "contact", ["per the model's thickness", p ? `t = ${number(p.time, 5)} s` : ""], rows);
}

function historyButtons(chosen) {
  const box = element("p", { class: "history" }, "history of ");
  const offers = chosen.block !== undefined ? Object.entries(quantities).map(([k, q]) => [k, q.title]) : words.contact_columns.filter((c) => c.shown && view.contacts && view.contacts[c.key]).map((c) => [c.key, c.title]);
  const select = element("select", { "aria-label": "history of" }, ...offers.map(([k, t]) => element("option", { value: k }, t)));
  if (chosen.block !== undefined && quantities[view.quantity]) select.value = view.quantity;
  box.append(select, element("button", { type: "button", id: "show-history", onclick: () => drawHistory(chosen, select.value) }, "draw"));
  return box;
}

async function drawHistory(chosen, what) {
  const of = run, time = [], value = [], place = $("inspector"), key = against;
  const note = element("p", { class: "hint" });
  place.append(note);
  let title, unit;
  if (chosen.block !== undefined) {
    const q = quantities[what];
    title = `${run.block(chosen.block).name}: ${q.title}${isMotion(what) ? againstText() : ""}`, unit = q.unit;
    for (let k = 0; k < run.frames.length; ++k) {
      const f = isMotion(what) ? await run.frameAgainst(k, key) : await run.frame(k), i = f.shapes.place.get(chosen.block);
      if (of !== run) return;
      if (i === undefined || !f.present[i]) continue;
      time.push(f.time), value.push(q.of(f, i));
      if (k % 10 === 0) note.textContent = `reading frame ${k + 1} of ${run.frames.length}`;
    }
  } else {
    const column = contactColumn(what);
    title = `contact: ${column.title}`, unit = column.unit;
    for (let k = 0; k < run.contacts.length; ++k) {
      const p = await run.contactFrame(k);
      for (let i = 0; i < p.n; ++i) if (p[what] && contactKey(p, i) === chosen.contact) time.push(p.time), value.push(p[what][i]);
    }
  }
  note.remove();
  if (JSON.stringify(view.selected) !== JSON.stringify(chosen)) return;
  const chart = addChart(place, { title, unit, quantity: title.split(": ")[1], series: [{ label: title, time, value }], timeNow: () => run.frames[frameIndex].t, onTime: goToTime });
  history = { key: JSON.stringify(chosen), chart };
  chart.draw();
  showInspector();
}

function select(chosen) {
  view.selected = chosen;
  view.draw();
  showInspector();
}

function find(text) {
  const wantedName = text.trim(), ids = view.frame.shapes.id;
  for (const id of ids) if (String(id) === wantedName || run.block(id).name === wantedName) return select({ block: id });
  $("inspector").append(element("p", { class: "hint" }, `There is no block "${wantedName}".`));
}

// ---- charts ----

// Stages by which the times of charts may count, those that all runs have.
function offerClocks() {
  const names = (runs[0].summary.stages || []).map((s) => s.name).filter((name) => runs.every((r) => (r.summary.stages || []).some((s) => s.name === name)));
  $("clock-of").replaceChildren(element("option", { value: "" }, "of the run"), ...names.map((name) => element("option", { value: name }, `of stage "${name}", from its beginning`)));
}

const kManyRuns = 4;  // more than these have a small chart each

// A chart for each quantity, with all monitors of all runs; of many runs one for each, side by side.
async function addMonitors() {
  const place = $("charts"), stage = $("clock-of").value;
  for (const chart of place.charts || []) chart.remove();
  for (const old of place.querySelectorAll(".multiples, .none")) old.remove();
  place.charts = [];
  const tables = await Promise.all(runs.map((r) => r.table("histories"))), groups = new Map();
  tables.forEach((table, r) => {
    if (!table) return;
    const rows = rowsOf(table.values[0], runs[r], stage);
    table.about.forEach(({ monitor, quantity: name, unit }, c) => {
      if (!monitor) return;  // clocks
      const quantity = name.replace(/_/g, " "), key = `${quantity} [${unit}]`;
      if (!groups.has(key)) groups.set(key, { quantity, unit, series: [] });
      const part = (v) => (rows ? v.slice(rows.from, rows.to) : v);
      const time = rows ? part(table.values[0]).map((t) => t - rows.begin) : table.values[0];
      groups.get(key).series.push({ run: r, monitor, label: runs.length > 1 ? `${runs[r].name}: ${monitor}` : monitor, time, value: part(table.values[c]) });
    });
  });
  if (!groups.size) {
    place.append(element("p", { class: "none" }, "The model has no monitors: give it [[monitor]] to see histories here."));
    return;
  }
  const common = stage ? { xLabel: `t of stage "${stage}" [s]` } : { timeNow, stages: stagesNow, onTime: goToTime };
  for (const { quantity, unit, series } of groups.values()) {
    if (runs.length <= kManyRuns) {
      place.charts.push(addChart(place, { title: quantity, quantity, unit, series, ...common }));
      continue;
    }
    // one small chart for each run, all with the same axes
    let low = Infinity, high = -Infinity;
    for (const s of series) for (const v of s.value) low = Math.min(low, v), high = Math.max(high, v);
    const room = 0.05 * (high - low) || 1, grid = element("div", { class: "multiples" }, element("h3", {}, quantity));
    place.append(grid);
    runs.forEach((r, k) => {
      const own = series.filter((s) => s.run === k).map((s) => ({ ...s, label: s.monitor }));
      if (own.length) place.charts.push(addChart(grid, { title: r.name, quantity, unit, series: own, height: 170, largest: largestOf(series), range: [low - room, high + room], ...common, onTime: undefined, timeNow: undefined }));
    });
  }
}

// The rows of a stage: after its beginning, whose row counts displacements from before they were reset.
function rowsOf(time, of, name) {
  const stage = (of.summary.stages || []).find((s) => s.name === name);
  if (!stage) return null;
  const begin = stage["begin [s]"], end = stage["end [s]"], first = time.findIndex((t) => t > begin), after = time.findIndex((t) => t > end);
  return { begin, from: first < 0 ? time.length : first, to: after < 0 ? time.length : after };
}

// of the run that is shown
function stagesNow() {
  return (run.summary.stages || []).map((s) => ({ name: s.name, begin: s["begin [s]"] }));
}

function timeNow() {
  return run.frames.length ? run.frames[frameIndex].t : NaN;
}

function addSteps(steps) {
  const series = (name, label = name) => {
    const c = steps.columns.indexOf(name);
    return c < 0 ? null : { label, time: steps.values[0], value: steps.values[c] };
  };
  const chart = (id, spec) => {
    const list = spec.series.filter(Boolean).filter((s) => s.value.some((v) => v !== 0));
    if (!list.length) return;
    $(id).hidden = false;
    $(id).charts.push(addChart($(id), { ...spec, series: list, timeNow, stages: stagesNow, onTime: goToTime }));
  };
  const energies = steps.columns.filter((c) => /(energy|work) \[J\]$/.test(c) && c !== "energy left over [J]");
  chart("energy", { title: "energies and work", quantity: "energy, work", unit: "J", series: energies.map((c) => series(c, c.replace(" [J]", ""))) });
  chart("energy", { title: "energy left over", unit: "J", series: [series("energy left over [J]", "left over")] });
  chart("health", { title: "contact error", unit: "m", log: true, series: [series("contact error [m]", "contact error")] });
  chart("health", { title: "iterations a step", series: [series("iterations")] });
  chart("health", { title: "contacts", series: [series("contacts", "points followed"), series("closed contacts", "closed")] });
}

// ---- the reader ----

async function redraw() {
  if (!view.frame) return;
  const range = await rangeOf(frameIndex);
  if (range) view.range = range;
  view.draw();
  if (!playing) legend();
}

const systemDark = matchMedia("(prefers-color-scheme: dark)");

function setTheme() {
  const chosen = $("theme").value;
  document.documentElement.dataset.theme = chosen !== "auto" ? chosen : systemDark.matches ? "dark" : "light";
}

function applyTheme() {
  setTheme();
  redraw();
  redrawCharts();
}

function listen() {
  const canvas = $("canvas");
  $("run").addEventListener("change", () => showRun(Number($("run").value)));
  $("theme").addEventListener("change", applyTheme);
  systemDark.addEventListener("change", applyTheme);
  $("quantity").addEventListener("change", () => { view.quantity = $("quantity").value; redraw(); });
  $("range").addEventListener("change", redraw);
  $("against").addEventListener("change", setAgainst);
  $("clock-of").addEventListener("change", addMonitors);
  $("deformation").addEventListener("input", () => {
    const v = Number($("deformation").value);
    if (!Number.isFinite(v) || v < 0) return;
    view.deformation = v;
    if (view.fitted) view.fit();
    redraw();
  });
  for (const key of ["joints", "forces", "bolts", "outlines"])
    $(`show-${key}`).addEventListener("change", (e) => { view.show[key] = e.target.checked; redraw(); });
  $("fit").addEventListener("click", () => { view.fit(); redraw(); });
  $("zoom-in").addEventListener("click", () => { view.zoom(1.5); redraw(); });
  $("zoom-out").addEventListener("click", () => { view.zoom(1 / 1.5); redraw(); });
  $("save-picture").addEventListener("click", savePicture);
  $("play").addEventListener("click", play);
  $("back").addEventListener("click", () => goTo(frameIndex - 1));
  $("forth").addEventListener("click", () => goTo(frameIndex + 1));
  $("slider").addEventListener("input", () => goTo(Number($("slider").value)));

  followPointer(canvas, view, (x, y) => {
    const contact = view.contactAt(x, y), block = view.blockAt(x, y);
    select(contact ? { contact } : block >= 0 ? { block } : null);
  });
  document.addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || /^(INPUT|SELECT|TEXTAREA|BUTTON|SUMMARY)$/.test(e.target.tagName) || !run.frames.length) return;
    const act = {
      " ": play, ArrowLeft: () => goTo(frameIndex - 1), ArrowRight: () => goTo(frameIndex + 1), Home: () => goTo(0), End: () => goTo(run.frames.length - 1),
      "+": () => { view.zoom(1.5); redraw(); }, "-": () => { view.zoom(1 / 1.5); redraw(); }, 0: () => { view.fit(); redraw(); }, Escape: () => select(null),
    }[e.key];
    if (!act) return;
    e.preventDefault();
    act();
  });
  followSize(canvas, view, redraw);
  let width = window.innerWidth;
  window.addEventListener("resize", () => { if (window.innerWidth !== width) width = window.innerWidth, redrawCharts(); });
  window.addEventListener("beforeprint", () => { drawCharts(); document.querySelectorAll("details").forEach((d) => { d.open = false; }); });
}

// The picture with what its legend says.
function savePicture() {
  const source = $("canvas"), ratio = source.width / source.clientWidth, canvas = document.createElement("canvas");
  const q = quantities[view.quantity], foot = 46 * ratio;
  canvas.width = source.width;
  canvas.height = source.height + foot;
  const context = canvas.getContext("2d"), style = getComputedStyle(source);
  context.fillStyle = style.getPropertyValue("--paper");
  context.fillRect(0, 0, canvas.width, canvas.height);
  view.draw();  // the ground can be read only in the task that drew it
  context.drawImage($("ground"), 0, 0, source.width, source.height);
  context.drawImage(source, 0, 0);
  context.fillStyle = style.getPropertyValue("--ink");
  context.font = `${13 * ratio}px sans-serif`;
  context.textBaseline = "middle";
  const y = source.height + 14 * ratio;
  context.fillText(`${run.title()}: ${$("clock").textContent}`, 10 * ratio, y + 20 * ratio);
  if (q) {
    const unit = readableUnit(Math.max(Math.abs(view.range.low), Math.abs(view.range.high)), q.unit);
    const head = `${q.title}${isMotion(q.key) ? againstText() : ""} [${unit.unit}]   ${number(view.range.low / unit.factor, 3)} `;
    context.fillText(head, 10 * ratio, y);
    const from = 10 * ratio + context.measureText(head).width, list = colours(q.signed, view.range.side), step = (200 * ratio) / list.length;
    list.forEach((colour, k) => { context.fillStyle = colour; context.fillRect(from + k * step, y - 7 * ratio, step + 1, 14 * ratio); });
    context.fillStyle = style.getPropertyValue("--ink");
    context.fillText(number(view.range.high / unit.factor, 3), from + 206 * ratio, y);
  }
  canvas.toBlob((blob) => save(`${run.name}_t_${run.frames[frameIndex].t.toPrecision(5)}.png`.replace(/[^\w.-]+/g, "_"), blob));
}

// for tests and the benchmark
window.talus = {
  ready: false, firstPicture: NaN, times,
  state: () => ({ frame: frameIndex, time: run.frames[frameIndex].t, playing, selected: view.selected, drawTime: view.drawTime }),
  screenOf: (id) => {
    return view.blockPlace(view.frame.shapes.place.get(id));
  },
  contactPlaces: () => Array.from({ length: view.contacts ? view.contacts.n : 0 }, (_, i) => ({ key: contactKey(view.contacts, i), at: view.contactPlace(i) })),
};

start().catch((error) => {
  $("warnings").append(element("p", { class: "warning" }, `The report cannot be shown: ${error.message}`));
  throw error;
});
