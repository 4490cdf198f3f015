// One run of the report: shapes, frames, contact points, bolts and tables, decoded when they are wanted.

import { chunk, Unpacker } from "./decode.js";
import { words } from "./quantities.js";

const kCacheBytes = 300e6;  // of decoded frames

export class Run {
  constructor(data) {
    this.name = data.name;
    this.summary = data.summary;
    this.model = data.model;
    this.tables = { histories: data.histories, steps: data.steps };
    this.slips = data.slips;
    this.bolts = data.bolts;
    this.blocks = data.blocks;
    this.frames = data.frames.blocks;
    this.framesThere = data.frames.there;
    this.framesReason = data.frames.reason || "";
    this.contacts = data.frames.contacts;
    this.shapesList = data.frames.shapes;
    this.origin = data.frames.origin || [0, 0];
    this.decoded_ = new Map();  // promises, by kind and number
    this.used_ = 0;
    this.place_ = new Map();
    if (this.blocks) this.blocks.id.forEach((id, k) => this.place_.set(Number(id), k));
  }

  title() {
    return this.summary.title || this.name;
  }

  /** A row of blocks.csv as {name, kind, material, group, area}; an old run has only numbers. */
  block(id) {
    const k = this.place_.get(id);
    if (k === undefined) return { id, name: `block ${id}` };
    const b = this.blocks;
    return {
      id, name: b.name[k], kind: b.kind[k], material: b.material[k], group: b.group[k], area: Number(b["area [m2]"][k]),
    };
  }

  /** Names of materials and groups by block id, for colours. */
  label(id, what) {
    const k = this.place_.get(id);
    return k === undefined ? "" : this.blocks[what][k];
  }

  /** What is known of a column of a monitor, by its title in summary.json: {quantity, unit}. */
  aboutColumn(monitor, title) {
    const { columns } = this.tables.histories || { columns: [] };
    return columns.find((c) => c.title === `${monitor}.${title}`) || { quantity: title, unit: "" };
  }

  once_(key, make) {
    if (!this.decoded_.has(key)) this.decoded_.set(key, make());
    return this.decoded_.get(key);
  }

  /** Blocks at zero displacement: id[n], begin[n + 1], centre x, y [n], arms x, y [corners]. */
  shapes(k) {
    return this.once_(`shapes ${k}`, async () => {
      const { blocks, corners, data } = this.shapesList[k];
      const u = new Unpacker(await chunk(data));
      const id = u.integers(blocks), count = u.integers(blocks);
      const cx = u.doubles(blocks), cy = u.doubles(blocks);
      const x = u.floats(corners), y = u.floats(corners);
      const begin = new Int32Array(blocks + 1);
      for (let i = 0; i < blocks; ++i) begin[i + 1] = begin[i] + count[i];
      const place = new Map();
      id.forEach((b, i) => place.set(b, i));
      return { n: blocks, id, begin, cx, cy, x, y, place };
    });
  }

  /** How blocks have moved in frame i, with its shapes. */
  frame(i) {
    const key = `frame ${i}`;
    if (!this.decoded_.has(key)) {
      const n = this.shapesList[this.frames[i].shapes].blocks;
      this.used_ += 45 * n;
      if (this.used_ > kCacheBytes) this.forgetFrames_();
    }
    return this.once_(key, async () => {
      const entry = this.frames[i], n = this.shapesList[entry.shapes].blocks;
      const shapes = await this.shapes(entry.shapes);
      const u = new Unpacker(await chunk(entry.data));
      const frame = {
        index: i, time: entry.t, shapes, present: u.bytes(n),
        ux: u.shortFloats(n), uy: u.shortFloats(n),
        hxx: u.plainHalves(n), hxy: u.plainHalves(n), hyx: u.plainHalves(n), hyy: u.plainHalves(n),
        vx: u.halves(n), vy: u.halves(n), sxx: u.halves(n), syy: u.halves(n), sxy: u.halves(n),
      };
      return absolute(frame);
    });
  }

  /** What displacements may be told against: [{key, title, group}]. */
  references() {
    const out = [], grounds = (this.frames[0] && this.frames[0].grounds) || [];
    for (const g of grounds) out.push({ key: `ground:${g.name}`, title: g.name, group: g.heights > 1 ? "free field at the same height" : "support" });
    if (this.blocks) for (const name of new Set(this.blocks.group)) if (name) out.push({ key: `group:${name}`, title: name, group: "mean of a group" });
    return out;
  }

  /** Frame i with displacements and velocities (dx, dy, dvx, dvy) told against a reference, "": absolute. */
  async frameAgainst(i, key) {
    const f = await this.frame(i);
    if (f.against === key) return f;
    if (!key) return absolute(f);
    const of = await this.motion_(f, key), n = f.shapes.n;
    f.against = key, f.lost = false;
    if (!of) return Object.assign(absolute(f), { against: key, lost: true });  // what it is told against is not there
    for (const name of ["dx", "dy", "dvx", "dvy"]) f[name] = new Float32Array(n);
    for (let b = 0; b < n; ++b) {
      const m = of(f.shapes.cy[b]);
      f.dx[b] = f.ux[b] - m[0], f.dy[b] = f.uy[b] - m[1], f.dvx[b] = f.vx[b] - m[2], f.dvy[b] = f.vy[b] - m[3];
    }
    return f;
  }

  // the motion of a reference in a frame, by height: [ux, uy, vx, vy]; null where the frame does not have it
  async motion_(f, key) {
    const name = key.slice(key.indexOf(":") + 1);
    if (key.startsWith("ground:")) {
      const entry = (this.frames[f.index].grounds || []).find((g) => g.name === name);
      if (!entry) return null;
      const u = new Unpacker(await chunk(entry.data)), n = entry.heights, [h, ...rest] = Array.from({ length: 5 }, () => u.floats(n));
      return (y) => {
        let k = 0;
        while (k + 1 < n && h[k + 1] <= y) ++k;
        const last = k + 1 >= n || y <= h[k], share = last ? 0 : (y - h[k]) / (h[k + 1] - h[k]);
        return rest.map((v) => v[k] + (last ? 0 : share * (v[k + 1] - v[k])));
      };
    }
    const sum = [0, 0, 0, 0];
    let weight = 0;
    for (let b = 0; b < f.shapes.n; ++b) {
      if (!f.present[b]) continue;
      const about = this.block(f.shapes.id[b]), here = key.startsWith("group:") ? about.group === name : String(about.id) === name;
      if (!here) continue;
      const w = about.area || 1;
      weight += w;
      [f.ux[b], f.uy[b], f.vx[b], f.vy[b]].forEach((v, c) => { sum[c] += w * v; });
    }
    if (!(weight > 0)) return null;
    const mean = sum.map((v) => v / weight);
    return () => mean;
  }

  /** [least, low, high, most] of a quantity in frame i against a reference, as report/page.cpp has them of absolute ones. */
  async span(i, key, q) {
    if (!key) return this.frames[i].spans.slice(4 * q.index, 4 * q.index + 4);
    return this.once_(`span ${i} ${key} ${q.key}`, async () => {
      const f = await this.frameAgainst(i, key), values = [];
      for (let b = 0; b < f.shapes.n; ++b) if (f.present[b]) values.push(q.of(f, b));
      const v = Float64Array.from(values).sort(), cut = Math.floor(v.length / 50);
      return v.length ? [v[0], v[cut], v[v.length - 1 - cut], v[v.length - 1]] : [0, 0, 0, 0];
    });
  }

  forgetFrames_() {
    for (const key of [...this.decoded_.keys()]) if (key.startsWith("frame ")) this.decoded_.delete(key);
    this.used_ = 0;
  }

  /** Contact points at or before frame i; null when there are none. `exact`: they are of this frame. */
  async contactsAt(i) {
    let entry = -1;
    this.contacts.forEach((c, k) => { if (c.frame <= i) entry = k; });
    if (entry < 0) return null;
    return { ...(await this.contactFrame(entry)), exact: this.contacts[entry].frame === i };
  }

  contactFrame(k) {
    return this.once_(`contacts ${k}`, async () => {
      const { count: n, data, frame, columns } = this.contacts[k];
      const u = new Unpacker(await chunk(data));
      const points = { n, frame, time: this.frames[frame].t };
      // null: an older talus did not write it
      for (const c of words.contact_columns) points[c.key] = columns.includes(c.key) ? u[c.by](n) : null;
      points.x = u.shortFloats(n), points.y = u.shortFloats(n);
      const direction = u.shortIntegers(n);
      points.fx = new Float32Array(n), points.fy = new Float32Array(n);
      for (let i = 0; i < n; ++i) {
        const size = Math.hypot(points.normal_force[i], points.shear_force[i]), angle = (direction[i] / 32767) * Math.PI;
        points.fx[i] = size * Math.cos(angle), points.fy[i] = size * Math.sin(angle);
      }
      const lines = [];
      for (let i = 0; i < n; ++i) if (points.partner[i] > i) lines.push(i, points.partner[i]);
      points.lines = Int32Array.from(lines);
      // points that have no other end
      points.alone = Int32Array.from([...Array(n).keys()].filter((i) => points.partner[i] < 0 && (points.state[i] === 1 || points.state[i] === 2)));
      points.residual = points.residual_slip !== null;
      points.slip = points.residual ? points.residual_slip.map(Math.abs) : points.accumulated_slip;
      return points;
    });
  }

  /** Pieces of bolts in frame i; null when there are none. */
  async boltsAt(i) {
    const entry = this.frames[i].bolts;
    if (!entry || !entry.count) return null;
    return this.once_(`bolts ${i}`, async () => {
      const n = entry.count, u = new Unpacker(await chunk(entry.data));
      return {
        n, condition: u.bytes(n), crossing: u.bytes(n), x0: u.floats(n), y0: u.floats(n), x1: u.floats(n),
        y1: u.floats(n), axial: u.floats(n), shear: u.floats(n), elongation: u.floats(n),
      };
    });
  }

  /** Columns of a table as arrays, with their titles. */
  table(name) {
    const t = this.tables[name];
    if (!t) return Promise.resolve(null);
    return this.once_(`table ${name}`, async () => {
      const values = await Promise.all(t.data.map(async (id) => new Unpacker(await chunk(id)).doubles(t.rows)));
      return { columns: t.columns.map((c) => c.title), about: t.columns, values, rows: t.rows, rowsThere: t.rows_there };
    });
  }
}

function absolute(f) {
  f.dx = f.ux, f.dy = f.uy, f.dvx = f.vx, f.dvy = f.vy, f.against = "", f.lost = false;
  return f;
}
