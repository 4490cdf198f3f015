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
      return {
        index: i, time: entry.t, shapes, present: u.bytes(n),
        ux: u.shortFloats(n), uy: u.shortFloats(n),
        hxx: u.plainHalves(n), hxy: u.plainHalves(n), hyx: u.plainHalves(n), hyy: u.plainHalves(n),
        vx: u.halves(n), vy: u.halves(n), sxx: u.halves(n), syy: u.halves(n), sxy: u.halves(n),
      };
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
