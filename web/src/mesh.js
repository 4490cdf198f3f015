// Polygons of blocks as triangles and edges, and lines with a width as triangles: what either painter draws.

/** Corners of triangles and of edges, for all blocks. Polygons are simple, not always convex. */
export function meshOf(s) {
  const triangles = [], edges = [];
  for (let i = 0; i < s.n; ++i) {
    const ring = [];
    for (let v = s.begin[i]; v < s.begin[i + 1]; ++v) {
      ring.push(v);
      edges.push(v, v + 1 < s.begin[i + 1] ? v + 1 : s.begin[i]);
    }
    cutEars(s, ring, triangles);
  }
  return { triangles: Uint32Array.from(triangles), edges: Uint32Array.from(edges) };
}

function cross(s, a, b, c) {
  return (s.x[b] - s.x[a]) * (s.y[c] - s.y[a]) - (s.y[b] - s.y[a]) * (s.x[c] - s.x[a]);
}

function cutEars(s, ring, out) {
  while (ring.length > 3) {
    const n = ring.length;
    let ear = -1;
    for (let k = 0; k < n && ear < 0; ++k) {
      const a = ring[(k + n - 1) % n], b = ring[k], c = ring[(k + 1) % n];
      if (cross(s, a, b, c) <= 0) continue;  // corners run counter-clockwise
      const holds = ring.some((p) => p !== a && p !== b && p !== c && cross(s, a, b, p) >= 0 && cross(s, b, c, p) >= 0 && cross(s, c, a, p) >= 0);
      if (!holds) ear = k;
    }
    if (ear < 0) ear = 1;  // three corners in line
    out.push(ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]);
    ring.splice(ear, 1);
  }
  out.push(...ring);
}

/** "rgb(1,2,3)" or "#rrggbb" as four bytes. */
export function bytesOf(colour, alpha = 255) {
  if (colour[0] === "#" && colour.length === 4) return [1, 2, 3].map((i) => 17 * parseInt(colour[i], 16)).concat(alpha);
  if (colour[0] === "#") return [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16)).concat(alpha);
  return colour.match(/[\d.]+/g).slice(0, 3).map(Number).concat(alpha);
}

/** Collects lines with a width as triangles. */
export class Lines {
  constructor() {
    this.places = [];
    this.tints = [];
  }

  add(x0, y0, x1, y1, width, tint) {
    const dx = x1 - x0, dy = y1 - y0, length = Math.hypot(dx, dy);
    if (!(length > 0)) return;
    const nx = (-0.5 * width * dy) / length, ny = (0.5 * width * dx) / length;
    this.places.push(x0 + nx, y0 + ny, x0 - nx, y0 - ny, x1 + nx, y1 + ny, x1 + nx, y1 + ny, x0 - nx, y0 - ny, x1 - nx, y1 - ny);
    for (let k = 0; k < 6; ++k) this.tints.push(...tint);
  }

  /** Dashes of 4 px with gaps of 3. */
  addDashed(x0, y0, x1, y1, width, tint) {
    const length = Math.hypot(x1 - x0, y1 - y0), count = Math.min(2000, Math.max(1, Math.ceil(length / 7)));
    for (let k = 0; k < count; ++k) {
      const a = (k * 7) / length, b = Math.min(1, (k * 7 + 4) / length);
      this.add(x0 + a * (x1 - x0), y0 + a * (y1 - y0), x0 + b * (x1 - x0), y0 + b * (y1 - y0), width, tint);
    }
  }
}
