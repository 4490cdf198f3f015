// The section before any run: blocks, joints, what holds and loads them; a click finds the section of the model file
// that each comes from, and a click on a line of the file what it makes. Data: report/section_page.cpp.

import { chunk, Unpacker } from "./decode.js";
import { element, tableOf } from "./dom.js";
import { followPointer, followSize, matchPixels } from "./pointer.js";
import { colours, kClasses, number, readableUnit, withUnit } from "./quantities.js";
import { View } from "./view.js";

const $ = (id) => document.getElementById(id);

const kNoPair = -2;      // as Layout::kNoPair
const kNear = 7;         // [px] from a symbol, line or marker that is meant by a click
const kSymbol = 9;       // [px] of pins and rollers
const kMark = "#d4006f"; // what was picked

const numbersOfBlocks = {
  area: { title: "area", unit: "m2" },
  width: { title: "least width", unit: "m" },
  aspect: { title: "length / width", unit: "" },
  step: { title: "stable step of the block alone", unit: "s" },
};

/** The data of the section, decoded. */
class Section {
  static async of(data) {
    const s = new Section(), { blocks: n, corners } = data.shapes;
    Object.assign(s, data);
    let u = new Unpacker(await chunk(data.shapes.data));
    const id = u.integers(n), count = u.integers(n), cx = u.doubles(n), cy = u.doubles(n), x = u.floats(corners), y = u.floats(corners);
    const begin = new Int32Array(n + 1), place = new Map();
    for (let i = 0; i < n; ++i) begin[i + 1] = begin[i] + count[i], place.set(i, i);
    s.shapes = { n, id, begin, cx, cy, x, y, place };
    u = new Unpacker(await chunk(data.blocks.data));
    s.kind = u.integers(n), s.material = u.integers(n), s.group = u.integers(n);
    for (const key of Object.keys(numbersOfBlocks)) s[key] = u.floats(n);
    u = new Unpacker(await chunk(data.edges));
    s.edgeOrigin = u.integers(corners), s.edgeJoint = u.integers(corners);
    for (const list of [s.dead_ends, s.merged]) {
      u = new Unpacker(await chunk(list.data));
      list.ends = [u.floats(list.count), u.floats(list.count), u.floats(list.count), u.floats(list.count)];
    }
    // blocks that were not cut have the last layer, whose origins are none
    s.layerOf = new Map();
    s.layers.forEach((layer, k) => { layer.shown = true; layer.origins.forEach((o) => s.layerOf.set(o, k)); });
    s.written = s.layers.findIndex((layer) => !layer.origins.length);
    const still = new Float32Array(n);
    s.frame = { shapes: s.shapes, present: new Uint8Array(n).fill(1), ux: still, uy: still, dx: still, dy: still, hxx: still, hxy: still, hyx: still, hyy: still };
    s.lines = data.text.split("\n");
    s.pairJoint = new Map(data.pairs.map(([a, b, joint]) => [`${a} ${b}`, joint]));
    return s;
  }

  /** The lines of the section of the file that holds a line, counted from one: [first, behind the last]. */
  range(line) {
    if (!(line > 0)) return [0, 0];
    const isHead = (k) => /^\s*\[/.test(this.lines[k - 1] || "") && !/^\s*\[[^\]]*,/.test(this.lines[k - 1]);
    let first = line, last = line + 1;
    while (first > 1 && !isHead(first)) --first;
    while (last <= this.lines.length && !isHead(last)) ++last;
    while (last > line + 1 && /^\s*(#.*)?$/.test(this.lines[last - 2])) --last;  // what stands before the next head
    return [first, last];
  }

  /** Why a block has its colour, by name. */
  label(i, what) {
    if (what === "group") return this.groups[this.group[i]].name;
    if (what === "kind") return this.kinds[this.kind[i]];
    if (this.kinds[this.kind[i]] === "fixed") return "fixed";
    const group = this.groups[this.group[i]].name;
    if (this.origins.some((o) => o.kind === "opening" && o.name === group)) return "kept in openings";
    return this.material[i] < 0 ? "" : `material ${this.materials[this.material[i]].name}`;
  }

  /** Index of the joint between two blocks where they meet, as Layout::joint_at; -1: hard and frictionless. */
  jointAt(a, cornerA, b, cornerB) {
    const [low, high] = [this.group[a], this.group[b]].sort((p, q) => p - q), pair = this.pairJoint.get(`${low} ${high}`);
    if (pair !== undefined) return pair;
    const ofA = this.edgeJoint[cornerA], ofB = this.edgeJoint[cornerB];
    if (ofA !== kNoPair && (ofB === kNoPair || a < b)) return ofA;
    return ofB !== kNoPair ? ofB : this.default_joint;
  }
}

class SectionView extends View {
  constructor(canvas, ground, section) {
    super(canvas, ground);
    this.section = section;
    this.frame = section.frame;
    this.quantity = "material";
    this.picked = null;  // {line, block, edge}
  }

  classes_() {
    const s = this.section, n = s.shapes.n, q = numbersOfBlocks[this.quantity];
    if (!this.class_) this.class_ = new Uint8Array(n);
    if (q) {
      // by the logarithm: a sliver is a thousandth of its neighbours
      const values = s[this.quantity], present = values.filter((v) => v > 0).sort();
      this.low = present.length ? present[0] : 1, this.high = present.length ? present[present.length - 1] : 1, this.median = present.length ? present[present.length >> 1] : 1;
      const from = Math.log(this.low), span = Math.log(this.high) - from || 1;
      for (let i = 0; i < n; ++i) this.class_[i] = values[i] > 0 ? Math.round(((kClasses - 1) * (Math.log(values[i]) - from)) / span) : kClasses;
      this.labels = null;
      return [...colours(false), "#bdbdbd"];
    }
    const labels = new Map();
    for (let i = 0; i < n; ++i) {
      const label = s.label(i, this.quantity);
      if (!labels.has(label)) labels.set(label, labels.size);
      this.class_[i] = labels.get(label) % 256;
    }
    this.labels = [...labels.keys()];
    const pale = ["#f9f4e7", "#e2edf7", "#e3f2e0", "#f7e6e3", "#ece6f5", "#ededed"];
    this.fills = this.labels.map((label, k) => (this.quantity === "material" && s.tints[label]) || pale[k % pale.length]);
    return this.fills;
  }

  paintLines_() {}  // all lines go over the blocks

  drawOver_(context) {
    const s = this.section;
    this.zoomed_ = this.scale / (this.wholeScale || this.scale);
    context.lineCap = "round";
    for (const { ends, count, pen } of [s.dead_ends]) if (count) this.drawSegments_(context, ends, pen);
    for (let k = s.layers.length - 1; k >= 0; --k) {
      if (!s.layers[k].shown) continue;
      const { colour, width, dashed } = s.layers[k];
      context.strokeStyle = colour, context.lineWidth = this.width_(width);
      context.setLineDash(dashed ? [4, 3] : []);
      context.beginPath();
      this.eachEdge_((layer) => layer === k, (x0, y0, x1, y1) => { context.moveTo(x0, y0); context.lineTo(x1, y1); });
      context.stroke();
    }
    context.setLineDash([]);
    if (s.merged.count) this.drawSegments_(context, s.merged.ends, s.merged.pen);
    for (const c of s.conditions) for (const mark of c.marks) this.drawMark_(context, c, mark);
    for (const m of s.monitors) this.drawMonitor_(context, m);
  }

  // lines of a dense section are thin until one looks closer
  width_(width) {
    return Math.min(width * Math.max(1, this.zoomed_), Math.max(width, 1.6));
  }

  drawSegments_(context, [x0, y0, x1, y1], { colour, width }) {
    const [ox, oy] = this.section.origin;
    context.strokeStyle = colour, context.lineWidth = this.width_(width);
    context.beginPath();
    for (let i = 0; i < x0.length; ++i) context.moveTo(...this.toScreen(ox + x0[i], oy + y0[i])), context.lineTo(...this.toScreen(ox + x1[i], oy + y1[i]));
    context.stroke();
  }

  // edges of blocks in sight that `wanted` (its layer, index of its first corner, block) lets through; both sides of a
  // joint run the same way, so that their dashes fall together
  eachEdge_(wanted, draw) {
    const s = this.section, { begin, n } = s.shapes, { x, y } = this.corner;
    for (let i = 0; i < n; ++i) {
      if (!this.visible[i]) continue;
      for (let v = begin[i]; v < begin[i + 1]; ++v) {
        const layer = s.layerOf.has(s.edgeOrigin[v]) ? s.layerOf.get(s.edgeOrigin[v]) : s.written;
        if (!wanted(layer, v, i)) continue;
        const w = v + 1 < begin[i + 1] ? v + 1 : begin[i], turned = x[v] > x[w] || (x[v] === x[w] && y[v] > y[w]);
        const [from, to] = turned ? [w, v] : [v, w];
        draw(x[from], y[from], x[to], y[to], v, i, layer);
      }
    }
  }

  // Where a symbol runs on the screen: from, to.
  ends_(condition, [mx, my, dx, dy, length]) {
    const [x, y] = this.toScreen(mx, my);
    switch (condition.symbol) {
      case "arrow": return [x - length * dx, y - length * dy, x, y];
      case "two_way": return [x - 0.5 * length * dx, y - 0.5 * length * dy, x + 0.5 * length * dx, y + 0.5 * length * dy];
      case "bar": return [x, y, x + this.scale * length * dx, y + this.scale * length * dy];
      case "band": return [x - 3 * dy, y + 3 * dx, x - 3 * dy + this.scale * length * dx, y + 3 * dx + this.scale * length * dy];
      default: return [x, y, x + kSymbol * dx, y + kSymbol * dy];
    }
  }

  drawMark_(context, condition, mark, colour = condition.colour) {
    const [x0, y0, x1, y1] = this.ends_(condition, mark), [, , dx, dy] = mark;
    if (Math.max(x0, x1) < -30 || Math.max(y0, y1) < -30 || Math.min(x0, x1) > this.canvas.clientWidth + 30 || Math.min(y0, y1) > this.canvas.clientHeight + 30) return;
    drawSymbol(context, condition.symbol, [x0, y0, x1, y1], [dx, dy], colour, colour === condition.colour ? 0 : 1.5);
  }

  drawMonitor_(context, monitor, colour = "#1b1b1b") {
    const [x, y] = this.toScreen(...monitor.at);
    context.fillStyle = colour, context.strokeStyle = "#fff", context.lineWidth = 1.5;
    context.beginPath();
    context.arc(x, y, 4, 0, 2 * Math.PI);
    context.fill(), context.stroke();
  }

  drawSelection_(context) {
    if (!this.picked) return;
    const s = this.section, { block, edge, line } = this.picked, range = s.range(line), isHere = (l) => l >= range[0] && l < range[1];
    context.setLineDash([]);
    context.strokeStyle = kMark, context.lineWidth = 3;
    context.beginPath();
    const alone = block !== undefined || edge !== undefined;  // else everything that the section of the file makes
    this.eachEdge_((layer, v, i) => {
      if (alone) return i === block || v === edge;
      const origin = s.origins[s.edgeOrigin[v]], inside = origin && origin.kind !== "side", law = s.joints[s.edgeJoint[v]], material = s.materials[s.material[i]];
      return isHere(s.groups[s.group[i]].line) || (material && isHere(material.line)) || (inside && (isHere(origin.line) || (law && isHere(law.line))));
    }, (x0, y0, x1, y1) => { context.moveTo(x0, y0); context.lineTo(x1, y1); });
    context.stroke();
    if (alone) return;
    for (const c of s.conditions) for (const mark of c.marks) if (isHere(mark[5])) this.drawMark_(context, c, mark, kMark);
    for (const m of s.monitors) if (isHere(m.line)) this.drawMonitor_(context, m, kMark);
  }

  fit() {
    super.fit();
    this.wholeScale = this.scale;
  }

  /** What lies at a place of the screen: {line} of a symbol, {edge, block} of a joint, {block}; null: nothing. */
  at(px, py) {
    const s = this.section;
    this.place();
    for (const m of s.monitors) {
      const [x, y] = this.toScreen(...m.at);
      if (Math.hypot(x - px, y - py) < kNear) return { line: m.line, name: `monitor ${m.name}` };
    }
    let best = kNear, found = null;
    for (const c of s.conditions) for (const mark of c.marks) {
      const d = distance(px, py, ...this.ends_(c, mark));
      if (d < best) best = d, found = { line: mark[5], name: c.label };
    }
    if (found) return found;
    best = 5;
    this.eachEdge_((layer) => s.layers[layer] && s.layers[layer].shown, (x0, y0, x1, y1, v, i, layer) => {
      const d = distance(px, py, x0, y0, x1, y1);
      if (d < best) best = d, found = { edge: v, block: i, layer };
    });
    if (found) return found;
    const block = this.blockAt(px, py);
    return block < 0 ? null : { block };
  }

  /** The block on the other side of an edge where it is nearest to a place of the screen, and its edge there. */
  across({ edge, block }, px, py) {
    const { begin } = this.section.shapes, { x, y } = this.corner, next = edge + 1 < begin[block + 1] ? edge + 1 : begin[block];
    const ex = x[next] - x[edge], ey = y[next] - y[edge], length = Math.hypot(ex, ey) || 1;
    const share = Math.min(0.999, Math.max(0.001, ((px - x[edge]) * ex + (py - y[edge]) * ey) / (length * length)));
    // corners run counter-clockwise, y points down: outside is to the left of the edge on the screen
    const step = 1e-3 * length, qx = x[edge] + share * ex - (step * ey) / length, qy = y[edge] + share * ey + (step * ex) / length;
    const other = this.blockAt(qx, qy);
    if (other < 0 || other === block) return null;
    let best = Infinity, corner = -1;
    for (let v = begin[other]; v < begin[other + 1]; ++v) {
      const w = v + 1 < begin[other + 1] ? v + 1 : begin[other], d = distance(qx, qy, x[v], y[v], x[w], y[w]);
      if (d < best) best = d, corner = v;
    }
    return { block: other, edge: corner };
  }
}

// `thick`: so much wider than usual
function drawSymbol(context, symbol, [x0, y0, x1, y1], [dx, dy], colour, thick = 0) {
  const line = (width, tint) => {
    context.strokeStyle = tint, context.lineWidth = width;
    context.beginPath();
    context.moveTo(x0, y0), context.lineTo(x1, y1);
    context.stroke();
  };
  const head = (x, y, way) => {
    context.fillStyle = colour;
    context.beginPath();
    context.moveTo(x, y);
    for (const side of [3, -3]) context.lineTo(x - way * 6 * dx + side * dy, y - way * 6 * dy - side * dx);
    context.fill();
  };
  switch (symbol) {
    case "arrow":
    case "two_way":
      line(4 + thick, "#fff"), line(1.6 + thick, colour), head(x1, y1, 1);
      if (symbol === "two_way") head(x0, y0, -1);
      break;
    case "bar":
      line(3 + thick, "#fff"), line(1.4 + thick, colour);
      break;
    case "band":
      line(3.2 + thick, colour);
      break;
    default:
      context.strokeStyle = colour, context.fillStyle = "#fff", context.lineWidth = 1.1 + thick;
      context.beginPath();
      if (symbol === "roller") context.arc(0.5 * (x0 + x1), 0.5 * (y0 + y1), 4, 0, 2 * Math.PI);
      else context.moveTo(x0, y0), context.lineTo(x1 - 4.5 * dy, y1 + 4.5 * dx), context.lineTo(x1 + 4.5 * dy, y1 - 4.5 * dx), context.closePath();
      context.fill(), context.stroke();
  }
}

function distance(px, py, x0, y0, x1, y1) {
  const dx = x1 - x0, dy = y1 - y0, length = dx * dx + dy * dy;
  const t = length > 0 ? Math.min(1, Math.max(0, ((px - x0) * dx + (py - y0) * dy) / length)) : 0;
  return Math.hypot(px - x0 - t * dx, py - y0 - t * dy);
}

let section = null, view = null;

/** Shows the page of a section. */
export async function showSection(index) {
  section = await Section.of(index.section);
  document.documentElement.dataset.page = "section";
  $("title").textContent = section.title;
  document.title = `${section.title} - talus section`;
  $("subtitle").textContent = section.file;
  $("made").textContent = `Made by ${index.program} from ${section.file}, before any run. Everything shown is in this file.`;
  $("section").hidden = false;
  $("section-report").hidden = !section.report;
  $("section-report").querySelector("pre").textContent = section.report;
  $("section-colour").replaceChildren(
    element("optgroup", { label: "what blocks are" }, ...["material", "group", "kind"].map((k) => element("option", { value: k }, k))),
    element("optgroup", { label: "numbers, by their logarithm" }, ...Object.entries(numbersOfBlocks).map(([k, q]) => element("option", { value: k }, q.title))));
  offerThings();
  view = new SectionView($("section-canvas"), $("section-ground"), section);
  matchPixels($("section-canvas"));
  view.fit();
  view.draw();
  scale();
  legend();
  pick(null);
  listen();
  window.talus.firstPicture = performance.now();
  window.talus.section = { screenOf: (i) => view.blockPlace(i), screenOfPoint: (x, y) => view.toScreen(x, y), name: (i) => section.blocks.names[i], picked: () => view.picked, scale: () => view.scale };
  window.talus.ready = true;
}

function offerThings() {
  const kinds = new Map();
  section.things.forEach((t, k) => {
    if (!kinds.has(t.kind)) kinds.set(t.kind, []);
    kinds.get(t.kind).push(element("option", { value: String(k) }, t.name));
  });
  $("section-thing").replaceChildren(element("option", { value: "" }, "a section of the file"), ...[...kinds].map(([label, list]) => element("optgroup", { label }, ...list)));
}

// ---- what was picked ----

function pick(picked, px = 0, py = 0) {
  view.picked = picked;
  const facts = [];
  if (!picked) facts.push(element("p", { class: "hint" }, `${section.shapes.n.toLocaleString("en")} ${section.shapes.n === 1 ? "block" : "blocks"}. Nothing is picked.`));
  else if (picked.edge !== undefined) facts.push(...factsOfEdge(picked, px, py));
  else if (picked.block !== undefined) facts.push(...factsOfBlock(picked));
  else facts.push(element("h3", {}, picked.name || ""), ...linesOf([["section", picked.line]]));
  $("section-facts").replaceChildren(...facts);
  view.draw();
  showFile(picked ? picked.line : 0);
}

function factsOfBlock(picked) {
  const i = picked.block, s = section, group = s.groups[s.group[i]], material = s.materials[s.material[i]];
  picked.line = group.line;
  const rows = [["kind", s.kinds[s.kind[i]]], ["of", group.name], ["material", material ? material.name : "none"],
    ...Object.entries(numbersOfBlocks).map(([key, q]) => [q.title, s[key][i] > 0 ? shown(s[key][i], q.unit) : "none: it does not deform"])];
  return [tableOf(s.blocks.names[i], ["", ""], rows), ...linesOf([[group.name, group.line], material && [`material ${material.name}`, material.line]])];
}

function factsOfEdge(picked, px, py) {
  const s = section, origin = s.origins[s.edgeOrigin[picked.edge]], other = view.across(picked, px, py);
  const { begin, x, y } = s.shapes, next = picked.edge + 1 < begin[picked.block + 1] ? picked.edge + 1 : begin[picked.block];
  const dx = x[next] - x[picked.edge], dy = y[next] - y[picked.edge], names = s.blocks.names;
  const joint = other ? s.jointAt(picked.block, picked.edge, other.block, other.edge) : -1, law = s.joints[joint];
  const group = s.groups[s.group[picked.block]];
  picked.line = origin ? origin.line : group.line;
  picked.block = undefined;
  const turn = ((Math.atan2(dy, dx) * 180) / Math.PI + 180) % 180;
  const rows = [["comes from", origin ? `${origin.kind} ${origin.name}` : `the outline of ${group.name}`],
    ["between", other ? `${names[blockOf(picked.edge)]} and ${names[other.block]}` : `${names[blockOf(picked.edge)]} and nothing: a free side`]];
  if (other) rows.push(["joint", law ? law.name : "none: hard and frictionless"]);
  rows.push(["length of this side", shown(Math.hypot(dx, dy), "m")], ["angle from +x", `${number(turn, 4)}°`]);
  return [tableOf(other ? "joint" : "side", ["", ""], rows), ...linesOf([origin ? [`${origin.kind} ${origin.name}`, origin.line] : [group.name, group.line], law && [`joint ${law.name}`, law.line]])];
}

function blockOf(corner) {
  const { begin, n } = section.shapes;
  let low = 0, high = n;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (begin[middle] <= corner) low = middle;
    else high = middle;
  }
  return low;
}

const shown = (value, unit) => (unit === "s" ? `${number(value, 3)} s` : unit === "m2" ? `${number(value, 4)} m²` : withUnit(value, unit, 4));

function linesOf(list) {
  const buttons = list.filter((one) => one && one[1] > 0).map(([name, line]) => element("li", {}, element("button", { type: "button", class: "link", onclick: () => showFile(line) }, `${name}: line ${line}`)));
  return buttons.length ? [element("ul", { class: "lines" }, ...buttons)] : [element("p", { class: "hint" }, "No line of the file: it was given on the command line.")];
}

// ---- the file ----

const kFileLines = 3000;  // shown at once; of a longer file those around what was picked

function showFile(line) {
  const file = $("section-file"), range = section.range(line), all = section.lines.length;
  const from = all <= kFileLines ? 1 : Math.max(1, Math.min(all - kFileLines + 1, (line || 1) - kFileLines / 2)), to = Math.min(all, from + kFileLines - 1);
  if (file.from !== from || !file.childElementCount) {
    file.from = from;
    file.replaceChildren(...section.lines.slice(from - 1, to).map((text, k) => element("span", { "data-line": String(from + k) }, `${text}\n`)));
  }
  for (const old of file.querySelectorAll(".picked")) old.classList.remove("picked", "exact");
  for (let l = range[0]; l < range[1]; ++l) if (file.children[l - from]) file.children[l - from].classList.add("picked");
  const exact = file.children[line - from];
  if (!exact) return;
  exact.classList.add("exact");
  // within the panel alone: the page stays where it is
  const first = file.children[Math.max(range[0], from) - from];
  file.scrollTop = first.offsetTop - file.offsetTop - 30;
  if (exact.offsetTop - file.offsetTop > file.scrollTop + file.clientHeight - 30) file.scrollTop = exact.offsetTop - file.offsetTop - 0.5 * file.clientHeight;
}

function pickLine(line) {
  const [first, end] = section.range(line), thing = section.things.find((t) => t.line >= first && t.line < end);
  if (thing) return pick({ line: thing.line, name: `${thing.kind} ${thing.name}` });
  pick({ line, name: "This section makes nothing that the picture shows." });
}

// ---- the legend ----

function scale() {
  const q = numbersOfBlocks[view.quantity];
  if (!q) {
    $("section-scale").replaceChildren(...view.labels.slice(0, 40).map((label, k) => element("span", { class: "swatch" }, element("i", { style: `background:${view.fills[k]}` }), label || "none")),
      view.labels.length > 40 ? `and ${view.labels.length - 40} more` : "");
    return;
  }
  const unit = readableUnit(view.high, q.unit), text = (v) => number(v / unit.factor, 3);
  $("section-scale").replaceChildren(element("span", { class: "legend-title" }, `${q.title}${unit.unit ? ` [${unit.unit}]` : ""}`), text(view.low),
    element("span", { class: "bar", style: `background:linear-gradient(90deg,${colours(false).join(",")})`, role: "img", "aria-label": `colours from ${text(view.low)} to ${text(view.high)}` }), text(view.high),
    element("span", { class: "note" }, `median ${text(view.median)}${view.quantity === "step" ? "; grey does not deform; the least sets the step of the whole model" : ""}`));
}

function legend() {
  const lines = section.layers.map((layer) => {
    const box = element("input", { type: "checkbox", checked: true, onchange: (e) => { layer.shown = e.target.checked; view.draw(); } });
    return element("label", {}, box, sample(layer), layer.label);
  });
  for (const { count, pen } of [section.dead_ends, section.merged]) if (count) lines.push(element("span", {}, sample(pen), pen.label));
  const symbols = section.conditions.map((c) => element("span", {}, symbolOf(c), c.label));
  $("section-legend").replaceChildren(...lines, ...symbols);
}

// a symbol as it stands in the picture
function symbolOf({ symbol, colour, sample: [dx, dy] }) {
  const ratio = window.devicePixelRatio || 1, canvas = element("canvas", { class: "symbol", width: String(28 * ratio), height: String(18 * ratio), "aria-hidden": "true" });
  const context = canvas.getContext("2d"), half = symbol === "bar" || symbol === "band" || Math.abs(dx) > 0.7 ? 12 : 8;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  if (symbol === "pin" || symbol === "roller") drawSymbol(context, symbol, [14, 4, 14, 4 + kSymbol], [0, 1], colour);
  else if (symbol === "bar" || symbol === "band") drawSymbol(context, symbol, [2, 9, 26, 9], [1, 0], colour);
  else drawSymbol(context, symbol, [14 - half * dx, 9 - half * dy, 14 + half * dx, 9 + half * dy], [dx, dy], colour);
  return canvas;
}

function sample({ colour, width, dashed }) {
  return element("i", { class: "line", style: `border-top:${Math.max(1.5, width)}px ${dashed ? "dashed" : "solid"} ${colour}` });
}

// ---- the reader ----

function listen() {
  const canvas = $("section-canvas"), zoom = (factor) => { view.zoom(factor); view.draw(); }, fit = () => { view.fit(); view.draw(); };
  followPointer(canvas, view, (x, y) => pick(view.at(x, y), x, y));
  followSize(canvas, view, () => view.draw());
  $("section-colour").addEventListener("change", (e) => { view.quantity = e.target.value; view.draw(); scale(); });
  $("section-thing").addEventListener("change", (e) => {
    const thing = section.things[Number(e.target.value)];
    pick(e.target.value !== "" ? { line: thing.line, name: `${thing.kind} ${thing.name}` } : null);
  });
  $("section-block").addEventListener("change", (e) => {
    const name = e.target.value.trim(), i = section.blocks.names.indexOf(name);
    if (i >= 0) return pick({ block: i });
    if (name) $("section-facts").append(element("p", { class: "hint" }, `There is no block "${name}".`));
  });
  $("section-fit").addEventListener("click", fit);
  $("section-in").addEventListener("click", () => zoom(1.5));
  $("section-out").addEventListener("click", () => zoom(1 / 1.5));
  $("section-file").addEventListener("click", (e) => {
    const line = e.target.closest("[data-line]");
    if (line && String(window.getSelection()) === "") pickLine(Number(line.dataset.line));
  });
  document.addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || /^(INPUT|SELECT|TEXTAREA|BUTTON|SUMMARY|PRE)$/.test(e.target.tagName)) return;
    const move = (dx, dy) => { view.pan(dx, dy); view.draw(); };
    const act = { "+": () => zoom(1.5), "-": () => zoom(1 / 1.5), 0: fit, Escape: () => pick(null),
      ArrowLeft: () => move(60, 0), ArrowRight: () => move(-60, 0), ArrowUp: () => move(0, 60), ArrowDown: () => move(0, -60) }[e.key];
    if (!act) return;
    e.preventDefault();
    act();
  });
}
