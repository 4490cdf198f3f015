// What blocks are coloured by: how it follows from a frame, its unit, its colours.

const stress = { unit: "Pa", signed: true };

/** Key -> {title, unit, signed, of(frame, i)}; keys as report/frames.h has them. */
export const quantities = {
  displacement: { title: "displacement", unit: "m", of: (f, i) => Math.hypot(f.ux[i], f.uy[i]) },
  displacement_x: { title: "displacement x", unit: "m", signed: true, of: (f, i) => f.ux[i] },
  displacement_y: { title: "displacement y", unit: "m", signed: true, of: (f, i) => f.uy[i] },
  velocity: { title: "velocity", unit: "m/s", of: (f, i) => Math.hypot(f.vx[i], f.vy[i]) },
  velocity_x: { title: "velocity x", unit: "m/s", signed: true, of: (f, i) => f.vx[i] },
  velocity_y: { title: "velocity y", unit: "m/s", signed: true, of: (f, i) => f.vy[i] },
  stress_xx: { ...stress, title: "stress xx", of: (f, i) => f.sxx[i] },
  stress_yy: { ...stress, title: "stress yy", of: (f, i) => f.syy[i] },
  stress_xy: { ...stress, title: "stress xy", of: (f, i) => f.sxy[i] },
  stress_major: { ...stress, title: "largest principal stress", of: (f, i) => mean(f, i) + radius(f, i) },
  stress_minor: { ...stress, title: "least principal stress", of: (f, i) => mean(f, i) - radius(f, i) },
  shear_most: { title: "largest shear stress", unit: "Pa", of: radius },
};

function mean(f, i) {
  return 0.5 * (f.sxx[i] + f.syy[i]);
}

function radius(f, i) {
  return Math.hypot(0.5 * (f.sxx[i] - f.syy[i]), f.sxy[i]);
}

// Anchors of the colour maps. One-sided: cividis from light to dark, whose lightness falls evenly, so that grey
// print keeps the order. Two-sided: blue, nearly white, orange-red, told apart by colour-blind readers.
const one = [[255, 240, 150], [236, 214, 92], [196, 182, 108], [166, 157, 117], [138, 134, 120], [112, 113, 115],
  [87, 93, 109], [57, 72, 107], [0, 32, 77]];
const two = [[5, 48, 97], [33, 102, 172], [67, 147, 195], [146, 197, 222], [236, 236, 236], [253, 197, 130],
  [241, 130, 55], [200, 70, 10], [127, 39, 4]];

export const kClasses = 32;

/** kClasses colours. @param side  of two-sided ones: -1 for negative values alone, 1 for positive ones, 0: both */
export function colours(signed, side = 0) {
  const anchors = !signed ? one : side < 0 ? two.slice(0, 5) : side > 0 ? two.slice(4) : two, out = [];
  for (let k = 0; k < kClasses; ++k) {
    const s = (k / (kClasses - 1)) * (anchors.length - 1), i = Math.min(Math.floor(s), anchors.length - 2);
    const mix = anchors[i].map((v, c) => Math.round(v + (s - i) * (anchors[i + 1][c] - v)));
    out.push(`rgb(${mix.join(",")})`);
  }
  return out;
}

/** Colours of kinds, materials and groups: apart for colour-blind readers, pale enough for lines above. */
export const palette = ["#9ecae1", "#f0d9a8", "#b5d8b0", "#d8b9d4", "#c9c9c9", "#f2b8a0", "#a9d6d2", "#d9d98b"];

const prefixes = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];

/** A prefix that suits the largest value: {factor, unit}, value / factor is in the unit. Kilograms etc. stay. */
export function readableUnit(most, unit) {
  if (!["m", "Pa", "N", "J", "m/s"].includes(unit) || !(most > 0)) return { factor: 1, unit };
  const usable = unit === "m" ? prefixes.slice(3) : unit === "m/s" ? prefixes.slice(3) : prefixes;
  const found = usable.find(([factor]) => most >= factor) || usable[usable.length - 1];
  return { factor: found[0], unit: found[1] + unit };
}

/** "12.3 mm": a value with three digits and a readable unit. */
export function withUnit(value, unit, digits = 3) {
  if (!Number.isFinite(value)) return "not a number";
  const r = readableUnit(Math.abs(value), unit);
  return `${number(value / r.factor, digits)} ${r.unit}`.trim();
}

/** Few digits, no trailing noise. */
export function number(value, digits = 4) {
  if (!Number.isFinite(value)) return "not a number";
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e6 || size < 1e-4 ? Number(value.toPrecision(digits)).toExponential() : String(Number(value.toPrecision(digits)));
}
