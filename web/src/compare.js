// Runs side by side: a row each.

import { answeredStages, answersOf, verdictsOf } from "./answer.js";
import { element, tableOf } from "./dom.js";
import { number, readableUnit } from "./quantities.js";

const kMonitors = 6;  // columns of monitors at most

/** A table of runs and what they came to; null for a single run. */
export function comparison(runs, show) {
  if (runs.length < 2) return null;
  const lastStage = (run) => answeredStages(run).at(-1);
  const answers = runs.map((run) => (lastStage(run) ? answersOf(run, lastStage(run)) : []));
  const named = (a) => `${a.monitor}: ${a.quantity}`;
  const columns = [...new Map(answers.flat().map((a) => [named(a), a])).values()].slice(0, kMonitors);
  const units = columns.map((c) => readableUnit(Math.max(...answers.flat().filter((a) => named(a) === named(c)).map((a) => Math.abs(a.peak))), c.unit));
  const slip = (run) => (run.summary.joints || {})["residual_slip_largest [m]"] ?? 0, slipUnit = readableUnit(Math.max(...runs.map(slip)), "m");
  const rows = runs.map((run, i) => [
    element("button", { type: "button", class: "link", onclick: () => show(i) }, run.name), verdictsOf(run)[0][1],
    ...columns.flatMap((c, k) => {
      const a = answers[i].find((one) => named(one) === named(c)), text = (v) => (Number.isFinite(v) ? number(v / units[k].factor, 3) : "");
      return [a ? text(a.peak) : "", a ? text(a.left ?? a.end) : ""];
    }),
    number(slip(run) / slipUnit.factor, 3), String((run.summary.moved || {}).blocks ?? "")]);
  return tableOf("Of the last stage with monitors; a click on a name shows the run",
    ["run", "result", ...columns.flatMap((c, k) => [`${named(c)}, peak [${units[k].unit}]`, `residual [${units[k].unit}]`]), `largest residual slip [${slipUnit.unit}]`, "blocks moved"], rows);
}
