// The picture of the blocks: draws a frame, with joints, contact forces and bolts over it; moves and zooms; finds
// what lies under the pointer. Coordinates: world [m], y up; screen [css px], y down.

import { Painter } from "./gl.js";
import { bytesOf, Lines } from "./mesh.js";
import { colours, kClasses, quantities, words } from "./quantities.js";
import { RasterPainter } from "./raster.js";

const kOutline = 5;      // [px] blocks smaller than this have no outline
const kArrow = 40;       // [px] of the largest contact force
const kMargin = 16;      // [px]
const kDot = 5;          // [px] across a joint point that has no other end

export class View {
  /** @param canvas  for lines, marks and the pointer; @param ground  below it, for blocks and joints */
  constructor(canvas, ground) {
    this.canvas = canvas;
    this.ground = ground;
    this.painter = Painter.on(ground) || new RasterPainter(ground);
    this.still = true;  // whether pictures follow each other quickly, or one is looked at
    this.run = null;
    this.frame = null;
    this.contacts = null;
    this.bolts = null;
    this.quantity = "displacement";
    this.range = { low: 0, high: 1 };
    this.deformation = 1;
    this.show = { joints: true, forces: false, bolts: true, outlines: true };
    this.selected = null;  // {block} or {contact}
    this.centre = [0, 0];
    this.scale = 1;  // [px/m]
    this.drawTime = 0;  // [ms] of the last frame
    this.corner = { x: new Float32Array(0), y: new Float32Array(0) };
  }

  /** Places of all corners on the screen, and which blocks are in sight. */
  place() {
    const f = this.frame, s = f.shapes, e = this.deformation;
    if (this.corner.x.length !== s.x.length) this.corner = { x: new Float32Array(s.x.length), y: new Float32Array(s.x.length) };
    const { x: px, y: py } = this.corner, k = this.scale;
    const w = this.canvas.clientWidth, h = this.canvas.clientHeight;
    const x0 = w / 2 - k * this.centre[0], y0 = h / 2 + k * this.centre[1];
    if (!this.visible || this.visible.length !== s.n) this.visible = new Uint8Array(s.n);
    for (let i = 0; i < s.n; ++i) {
      this.visible[i] = 0;
      if (!f.present[i]) continue;
      // what is told against something moves with that; the rest of it is drawn e times
      const cx = x0 + k * (s.cx[i] + f.ux[i] + (e - 1) * f.dx[i]), cy = y0 - k * (s.cy[i] + f.uy[i] + (e - 1) * f.dy[i]);
      const axx = k * (1 + e * f.hxx[i]), axy = k * e * f.hxy[i];
      const ayx = k * e * f.hyx[i], ayy = k * (1 + e * f.hyy[i]);
      let left = Infinity, right = -Infinity, top = Infinity, bottom = -Infinity;
      for (let v = s.begin[i]; v < s.begin[i + 1]; ++v) {
        const X = s.x[v], Y = s.y[v];
        const qx = cx + axx * X + axy * Y, qy = cy - ayx * X - ayy * Y;
        px[v] = qx;
        py[v] = qy;
        if (qx < left) left = qx;
        if (qx > right) right = qx;
        if (qy < top) top = qy;
        if (qy > bottom) bottom = qy;
      }
      if (right < 0 || left > w || bottom < 0 || top > h) continue;
      this.visible[i] = right - left > kOutline || bottom - top > kOutline ? 2 : 1;
    }
  }

  /** The colour class of every block, and the colours. */
  classes_() {
    const f = this.frame, n = f.shapes.n, q = quantities[this.quantity], { palette } = words.colours;
    if (!this.class_ || this.class_.length !== n) this.class_ = new Uint8Array(n);
    if (!q) {
      const labels = new Map(), what = this.quantity;  // material, group, kind
      for (let i = 0; i < n; ++i) {
        const label = this.run.label(f.shapes.id[i], what);
        if (!labels.has(label)) labels.set(label, labels.size);
        this.class_[i] = labels.get(label) % palette.length;
      }
      this.labels = [...labels.keys()];
      return palette;
    }
    this.labels = null;
    const { low, high } = this.range, unit = high > low ? (kClasses - 1) / (high - low) : 0;
    for (let i = 0; i < n; ++i) {
      const c = Math.round((q.of(f, i) - low) * unit);
      this.class_[i] = c < 0 ? 0 : c >= kClasses ? kClasses - 1 : c || 0;
    }
    return colours(q.signed, this.range.side);
  }

  draw() {
    if (!this.frame) return;
    const start = performance.now();
    const context = this.canvas.getContext("2d");
    const ratio = this.canvas.width / Math.max(1, this.canvas.clientWidth);
    const style = getComputedStyle(this.canvas);
    const ink = style.getPropertyValue("--ink").trim() || "#222", paper = style.getPropertyValue("--paper").trim() || "#fff";
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.place();
    const fills = this.classes_();
    context.clearRect(0, 0, this.canvas.clientWidth, this.canvas.clientHeight);
    this.paint_(fills, ink, paper);
    this.drawOver_(context);
    this.drawSelection_(context, ink);
    this.drawScaleBar_(context, ink, paper);
    this.drawTime = performance.now() - start;
  }

  // blocks and joints
  paint_(fills, ink, paper) {
    const s = this.frame.shapes, n = s.n, { x, y } = this.corner, tint = fills.map((c) => bytesOf(c));
    if (!this.places_ || this.places_.length !== 2 * x.length) this.places_ = new Float32Array(2 * x.length), this.tints_ = new Uint8Array(4 * x.length);
    const places = this.places_, tints = this.tints_;
    let large = 0, seen = 0;
    for (let i = 0; i < n; ++i) {
      const there = this.visible[i], c = tint[this.class_[i]];
      if (there) ++seen, large += there === 2;
      for (let v = s.begin[i]; v < s.begin[i + 1]; ++v) {
        // what is not there shrinks to a point out of sight
        places[2 * v] = there ? x[v] : -1e5, places[2 * v + 1] = there ? y[v] : -1e5;
        tints[4 * v] = c[0], tints[4 * v + 1] = c[1], tints[4 * v + 2] = c[2], tints[4 * v + 3] = 255;
      }
    }
    this.painter.begin(paper, this.still);
    this.painter.blocks(s, places, tints, this.show.outlines && 2 * large > seen ? [20, 20, 20, 115] : null);
    this.paintLines_();
    this.painter.end();
  }

  // over the blocks, by the canvas
  drawOver_(context) {
    if (this.show.bolts && this.bolts) this.drawBolts_(context);
    if (this.show.forces && this.contacts) this.drawForces_(context);
  }

  // joints, by the painter
  paintLines_() {
    if (!this.show.joints || !this.contacts) return;
    const lines = new Lines(), { slipped, open } = words.colours, orange = bytesOf(slipped), dark = bytesOf(open), least = words.least_drawn;
    this.eachJoint_((px, py, qx, qy, slip, opening) => {
      const alone = px === qx && py === qy, wide = 1 + 3 * slip;
      if (alone) {
        const half = 0.5 * Math.max(kDot, wide);
        if (slip > least || opening > least) lines.add(px - half, py, px + half, py, 2 * half, slip > least ? orange : dark);
        return;
      }
      if (slip > least) lines.add(px, py, qx, qy, wide, orange);
      if (opening > least) lines.addDashed(px, py, qx, qy, 2, dark);
    });
    this.painter.triangles(new Float32Array(lines.places), new Uint8Array(lines.tints));
  }

  /** A world point on the screen. */
  toScreen(x, y) {
    return [this.canvas.clientWidth / 2 + this.scale * (x - this.centre[0]),
      this.canvas.clientHeight / 2 - this.scale * (y - this.centre[1])];
  }

  toWorld(px, py) {
    return [this.centre[0] + (px - this.canvas.clientWidth / 2) / this.scale,
      this.centre[1] - (py - this.canvas.clientHeight / 2) / this.scale];
  }

  // Where contact point i is drawn: it moves with its block, so that it also fits a scaled deformation and, where
  // the points are of an earlier frame, this one.
  contactPlace(i) {
    const p = this.contacts, [ox, oy] = this.run.origin;
    return this.toScreen(ox + p.x[i] + this.shift_(p, i, "x"), oy + p.y[i] + this.shift_(p, i, "y"));
  }

  shift_(p, i, axis) {
    const f = this.frame, k = f.shapes.place.get(p.block_a[i]);
    if (k === undefined || this.deformation === 1) return 0;
    return (this.deformation - 1) * (axis === "x" ? f.dx[k] : f.dy[k]);
  }

  // Joints in sight that slipped or stand open: ends, share of the largest slip and of the largest opening.
  eachJoint_(draw) {
    const p = this.contacts, w = this.canvas.clientWidth, h = this.canvas.clientHeight;
    const slipOf = (i) => (p.state[i] === 1 || p.state[i] === 2 ? p.slip[i] : 0), openOf = (i) => (p.state[i] === 2 ? p.opening[i] : 0);
    let slip = 0, opening = 0;
    for (const list of [p.lines, p.alone]) for (const i of list) slip = Math.max(slip, slipOf(i)), opening = Math.max(opening, openOf(i));
    this.largestSlip = slip, this.largestOpening = opening;
    this.largestAccumulated = 0;
    for (const list of [p.lines, p.alone]) for (const i of list) if (p.state[i] === 1 || p.state[i] === 2) this.largestAccumulated = Math.max(this.largestAccumulated, p.accumulated_slip[i]);
    const one = (i, j) => {
      const s = Math.max(slipOf(i), slipOf(j)), o = Math.max(openOf(i), openOf(j));
      if (s === 0 && o === 0) return;
      const [px, py] = this.contactPlace(i), [qx, qy] = this.contactPlace(j);
      if (Math.max(px, qx) < 0 || Math.max(py, qy) < 0 || Math.min(px, qx) > w || Math.min(py, qy) > h) return;
      draw(px, py, qx, qy, slip > 0 ? s / slip : 0, opening > 0 ? o / opening : 0);
    };
    for (let k = 0; k < p.lines.length; k += 2) one(p.lines[k], p.lines[k + 1]);
    for (const i of p.alone) one(i, i);
  }

  drawForces_(context) {
    const p = this.contacts;
    let most = 0;
    for (let i = 0; i < p.n; ++i) most = Math.max(most, Math.hypot(p.fx[i], p.fy[i]));
    this.largestForce = most;
    if (most === 0) return;
    context.strokeStyle = context.fillStyle = words.colours.force;
    context.lineWidth = 1.2;
    context.beginPath();
    for (let i = 0; i < p.n; ++i) {
      const size = Math.hypot(p.fx[i], p.fy[i]), length = (kArrow * size) / most;
      if (length < 1) continue;
      const [x, y] = this.contactPlace(i);
      if (x < -kArrow || y < -kArrow || x > this.canvas.clientWidth + kArrow || y > this.canvas.clientHeight + kArrow) continue;
      const dx = p.fx[i] / size, dy = -p.fy[i] / size, head = Math.min(5, 0.4 * length);
      // points from where it acts into the first block
      context.moveTo(x, y);
      context.lineTo(x + dx * length, y + dy * length);
      context.moveTo(x + dx * length - head * (dx + 0.5 * dy), y + dy * length - head * (dy - 0.5 * dx));
      context.lineTo(x + dx * length, y + dy * length);
      context.lineTo(x + dx * length - head * (dx - 0.5 * dy), y + dy * length - head * (dy + 0.5 * dx));
    }
    context.stroke();
  }

  drawBolts_(context) {
    const b = this.bolts, [ox, oy] = this.run.origin, colour = words.colours;
    const pale = bytesOf(colour.bolt_pale).slice(0, 3), dark = bytesOf(colour.bolt_dark).slice(0, 3);
    let most = 0;
    for (let i = 0; i < b.n; ++i) most = Math.max(most, b.axial[i]);
    this.largestTension = most;
    for (let i = 0; i < b.n; ++i) {
      const share = most > 0 ? b.axial[i] / most : 0;
      context.strokeStyle = b.condition[i] === 2 ? colour.bolt_ruptured : share < 0 ? colour.bolt_pressed : `rgb(${pale.map((v, c) => v + share * (dark[c] - v)).join(",")})`;
      context.lineWidth = 1.2 + 2.4 * Math.max(0, share);
      context.beginPath();
      context.moveTo(...this.toScreen(ox + b.x0[i], oy + b.y0[i]));
      context.lineTo(...this.toScreen(ox + b.x1[i], oy + b.y1[i]));
      context.stroke();
    }
  }

  drawSelection_(context, ink) {
    if (!this.selected) return;
    context.strokeStyle = ink;
    context.lineWidth = 2.5;
    context.setLineDash([]);
    context.beginPath();
    if (this.selected.block !== undefined) {
      const s = this.frame.shapes, i = s.place.get(this.selected.block), { x, y } = this.corner;
      if (i === undefined || !this.frame.present[i]) return;
      let v = s.begin[i];
      context.moveTo(x[v], y[v]);
      for (++v; v < s.begin[i + 1]; ++v) context.lineTo(x[v], y[v]);
      context.closePath();
    } else {
      const i = this.findContact(this.selected.contact);
      if (i < 0) return;
      const [px, py] = this.contactPlace(i);
      context.arc(px, py, 7, 0, 2 * Math.PI);
    }
    context.stroke();
  }

  drawScaleBar_(context, ink, paper) {
    const h = this.canvas.clientHeight, wanted = 120 / this.scale;
    const decade = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].map((f) => f * decade).find((l) => l <= wanted);
    const text = length >= 1e-2 ? `${Number(length.toPrecision(1))} m` : `${Number((1e3 * length).toPrecision(1))} mm`;
    context.font = "13px sans-serif";
    const width = length * this.scale, room = width + context.measureText(text).width + 22;
    context.globalAlpha = 0.8;
    context.fillStyle = paper;
    context.fillRect(8, h - 30, room, 22);
    context.globalAlpha = 1;
    context.fillStyle = ink;
    context.fillRect(14, h - 20, width, 3);
    context.textBaseline = "middle";
    context.fillText(text, 14 + width + 7, h - 18);
  }

  /** Where the centroid of block i of the frame is drawn. */
  blockPlace(i) {
    const f = this.frame, s = f.shapes, more = this.deformation - 1;
    return this.toScreen(s.cx[i] + f.ux[i] + more * f.dx[i], s.cy[i] + f.uy[i] + more * f.dy[i]);
  }

  /** Brings all blocks of the frame into sight, as they are drawn. */
  fit() {
    const f = this.frame;
    if (!f) return;
    const s = f.shapes;
    let left = Infinity, right = -Infinity, low = Infinity, high = -Infinity;
    for (let i = 0; i < s.n; ++i) {
      if (!f.present[i]) continue;
      for (let v = s.begin[i]; v < s.begin[i + 1]; ++v) {
        const e = this.deformation, x = s.cx[i] + s.x[v] + f.ux[i] + (e - 1) * f.dx[i], y = s.cy[i] + s.y[v] + f.uy[i] + (e - 1) * f.dy[i];
        left = Math.min(left, x), right = Math.max(right, x), low = Math.min(low, y), high = Math.max(high, y);
      }
    }
    if (!(right > left)) return;
    this.centre = [(left + right) / 2, (low + high) / 2];
    this.fitted = true;
    this.scale = Math.min((this.canvas.clientWidth - 2 * kMargin) / (right - left),
      (this.canvas.clientHeight - 2 * kMargin) / Math.max(high - low, 1e-9));
  }

  /** Zooms by `factor` and keeps what is under (px, py). */
  zoom(factor, px = this.canvas.clientWidth / 2, py = this.canvas.clientHeight / 2) {
    const [x, y] = this.toWorld(px, py);
    this.fitted = false;
    this.scale *= factor;
    const [nx, ny] = this.toWorld(px, py);
    this.centre = [this.centre[0] + x - nx, this.centre[1] + y - ny];
  }

  pan(dx, dy) {
    this.fitted = false;
    this.centre = [this.centre[0] - dx / this.scale, this.centre[1] + dy / this.scale];
  }

  /** Id of the block at a place of the screen, -1: none. */
  blockAt(px, py) {
    if (!this.frame) return -1;
    this.place();
    const s = this.frame.shapes, { x, y } = this.corner;
    for (let i = s.n - 1; i >= 0; --i) {
      if (!this.visible[i]) continue;
      let inside = false;
      for (let a = s.begin[i], b = s.begin[i + 1] - 1; a < s.begin[i + 1]; b = a++)
        if ((y[a] > py) !== (y[b] > py) && px < ((x[b] - x[a]) * (py - y[a])) / (y[b] - y[a]) + x[a]) inside = !inside;
      if (inside) return s.id[i];
    }
    return -1;
  }

  /** Numbers of the contact point nearest to a place of the screen, null: none within 8 px, or none drawn. */
  contactAt(px, py) {
    if (!this.contacts || !(this.show.forces || this.show.joints)) return null;
    const p = this.contacts;
    let best = 8, found = -1;
    for (let i = 0; i < p.n; ++i) {
      if (!this.show.forces && p.state[i] !== 1 && p.state[i] !== 2) continue;
      const [x, y] = this.contactPlace(i), d = Math.hypot(x - px, y - py);
      if (d < best) best = d, found = i;
    }
    return found < 0 ? null : contactKey(p, found);
  }

  /** Index of a contact point among those of now, -1: it carries nothing. */
  findContact(key) {
    const p = this.contacts;
    if (!p) return -1;
    for (let i = 0; i < p.n; ++i) if (contactKey(p, i) === key) return i;
    return -1;
  }
}

/** What tells a contact point from the others, the same in all frames. */
export function contactKey(p, i) {
  return `${p.kind[i]}:${p.block_a[i]}:${p.corner[i]}:${p.block_b[i]}:${p.edge[i]}`;
}
