// Draws blocks and joints without a graphics card, pixel by pixel: where WebGL is missing or done by software, which
// is several times slower. Same interface as gl.js. A picture that stands still is drawn twice as fine.

import { bytesOf, meshOf } from "./mesh.js";

const kFine = 2;

export class RasterPainter {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: false });
    this.shapes_ = null;
  }

  begin(background, still) {
    const { canvas } = this, ratio = (window.devicePixelRatio || 1) * (still ? kFine : 1);
    const w = Math.max(1, Math.round(canvas.clientWidth * ratio)), h = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== w || canvas.height !== h || !this.pixels_ || this.pixels_.length !== w * h) {
      canvas.width = w, canvas.height = h;
      this.image_ = this.context.createImageData(w, h);
      this.pixels_ = new Uint32Array(this.image_.data.buffer);
    }
    this.w = w, this.h = h, this.ratio = ratio;
    this.pixels_.fill(packed(...bytesOf(background)));
  }

  blocks(shapes, places, tints, outline) {
    if (this.shapes_ !== shapes) this.shapes_ = shapes, this.mesh_ = meshOf(shapes);
    const { triangles, edges } = this.mesh_, colours = new Uint32Array(tints.buffer, tints.byteOffset, tints.length / 4);
    for (let k = 0; k < triangles.length; k += 3) {
      const a = triangles[k], b = triangles[k + 1], c = triangles[k + 2];
      this.fill_(places[2 * a], places[2 * a + 1], places[2 * b], places[2 * b + 1], places[2 * c], places[2 * c + 1], colours[a]);
    }
    if (!outline) return;
    for (let k = 0; k < edges.length; k += 2) {
      const a = edges[k], b = edges[k + 1];
      this.line_(places[2 * a], places[2 * a + 1], places[2 * b], places[2 * b + 1], outline);
    }
  }

  triangles(places, tints) {
    const colours = new Uint32Array(tints.buffer, tints.byteOffset, tints.length / 4);
    for (let k = 0; k < colours.length; k += 3)
      this.fill_(places[2 * k], places[2 * k + 1], places[2 * k + 2], places[2 * k + 3], places[2 * k + 4], places[2 * k + 5], colours[k]);
  }

  end() {
    this.context.putImageData(this.image_, 0, 0);
  }

  // pixels whose middle lies inside
  fill_(x0, y0, x1, y1, x2, y2, colour) {
    const { w, h, ratio, pixels_: pixels } = this;
    x0 *= ratio, y0 *= ratio, x1 *= ratio, y1 *= ratio, x2 *= ratio, y2 *= ratio;
    let t;
    if (y0 > y1) t = x0, x0 = x1, x1 = t, t = y0, y0 = y1, y1 = t;
    if (y1 > y2) t = x1, x1 = x2, x2 = t, t = y1, y1 = y2, y2 = t;
    if (y0 > y1) t = x0, x0 = x1, x1 = t, t = y0, y0 = y1, y1 = t;
    const first = Math.max(0, Math.ceil(y0 - 0.5)), last = Math.min(h - 1, Math.ceil(y2 - 0.5) - 1);
    if (first > last) return;
    const whole = (x2 - x0) / (y2 - y0), upper = y1 > y0 ? (x1 - x0) / (y1 - y0) : 0, lower = y2 > y1 ? (x2 - x1) / (y2 - y1) : 0;
    for (let y = first; y <= last; ++y) {
      const m = y + 0.5, p = x0 + (m - y0) * whole, q = m < y1 ? x0 + (m - y0) * upper : x1 + (m - y1) * lower;
      let from = Math.ceil((p < q ? p : q) - 0.5), to = Math.ceil((p < q ? q : p) - 0.5);
      if (from < 0) from = 0;
      if (to > w) to = w;
      if (to - from > 24) pixels.fill(colour, y * w + from, y * w + to);
      else for (let i = y * w + from, end = y * w + to; i < end; ++i) pixels[i] = colour;
    }
  }

  // a thin line of [r, g, b, opacity] over what is there
  line_(x0, y0, x1, y1, [r, g, b, opacity]) {
    const { w, h, ratio, pixels_: pixels } = this;
    x0 *= ratio, y0 *= ratio, x1 *= ratio, y1 *= ratio;
    if (Math.max(x0, x1) < 0 || Math.max(y0, y1) < 0 || Math.min(x0, x1) >= w || Math.min(y0, y1) >= h) return;
    const steps = Math.min(20000, Math.max(1, Math.ceil(Math.max(Math.abs(x1 - x0), Math.abs(y1 - y0)))));
    const dx = (x1 - x0) / steps, dy = (y1 - y0) / steps, keep = 256 - opacity;
    for (let k = 0; k < steps; ++k) {
      const x = (x0 + k * dx) | 0, y = (y0 + k * dy) | 0;
      if (x < 0 || y < 0 || x >= w || y >= h) continue;
      const i = y * w + x, v = pixels[i];
      pixels[i] = packed(((v & 255) * keep + r * opacity) >> 8, (((v >> 8) & 255) * keep + g * opacity) >> 8, (((v >> 16) & 255) * keep + b * opacity) >> 8);
    }
  }
}

function packed(r, g, b) {
  return (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;
}
