// What blocks are coloured by, what is told of contacts, and colours: titles, units, names and colours come with the
// data (report/page.cpp); how a value follows from a frame is here.

import { bytesOf } from "./mesh.js";

/** Key -> {title, unit, signed, of(frame, i)}, contact columns, colours: filled by learn(). */
export const quantities = {};
export const words = { contact_columns: [], bolt_conditions: [], colours: {}, least_drawn: 0 };

const formulas = {
  displacement: (f, i) => Math.hypot(f.dx[i], f.dy[i]),
  displacement_x: (f, i) => f.dx[i],
  displacement_y: (f, i) => f.dy[i],
  velocity: (f, i) => Math.hypot(f.dvx[i], f.dvy[i]),
  velocity_x: (f, i) => f.dvx[i],
  velocity_y: (f, i) => f.dvy[i],
  stress_xx: (f, i) => f.sxx[i],
  stress_yy: (f, i) => f.syy[i],
  stress_xy: (f, i) => f.sxy[i],
  stress_major: (f, i) => mean(f, i) + radius(f, i),
  stress_minor: (f, i) => mean(f, i) - radius(f, i),
  shear_most: radius,
};

/** Takes what the data say of results in general. */
export function learn(told) {
  Object.assign(words, told);
  told.quantities.forEach((q, index) => { if (formulas[q.key]) quantities[q.key] = { ...q, index, of: formulas[q.key] }; });
}

function mean(f, i) {
  return 0.5 * (f.sxx[i] + f.syy[i]);
}

function radius(f, i) {
  return Math.hypot(0.5 * (f.sxx[i] - f.syy[i]), f.sxy[i]);
}

export const kClasses = 32;

/** kClasses colours. @param side  of two-sided ones: -1 for negative values alone, 1 for positive ones, 0: both */
export function colours(signed, side = 0) {
  const { one_sided: one, two_sided: two } = words.colours, out = [];
  const anchors = (!signed ? one : side < 0 ? two.slice(0, 5) : side > 0 ? two.slice(4) : two).map((c) => bytesOf(c));
  for (let k = 0; k < kClasses; ++k) {
    const s = (k / (kClasses - 1)) * (anchors.length - 1), i = Math.min(Math.floor(s), anchors.length - 2);
    const mix = anchors[i].slice(0, 3).map((v, c) => Math.round(v + (s - i) * (anchors[i + 1][c] - v)));
    out.push(`rgb(${mix.join(",")})`);
  }
  return out;
}

const prefixes = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];

/** A prefix that suits the largest value: {factor, unit}, value / factor is in the unit. Kilograms etc. stay. */
export function readableUnit(most, unit) {
  if (!["m", "Pa", "N", "J", "m/s"].includes(unit) || !(most > 0)) return { factor: 1, unit: unit.replace(/([a-z])([23])\b/g, (_, u, n) => u + (n === "2" ? "²" : "³")) };
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

/** A few round values from low to high. */
export function ticks(low, high, most = 5) {
  const span = high - low;
  if (!(span > 0)) return [];
  const decade = 10 ** Math.floor(Math.log10(span / most)), step = [1, 2, 2.5, 5, 10].map((f) => f * decade).find((v) => span / v <= most);
  const out = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * span; ++k) out.push(k * step);
  return out;
}

/** Few digits, no trailing noise. */
export function number(value, digits = 4) {
  if (!Number.isFinite(value)) return "not a number";
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e6 || size < 1e-4 ? Number(value.toPrecision(digits)).toExponential() : String(Number(value.toPrecision(digits)));
}
