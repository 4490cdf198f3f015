// The answer of a run: whether it is valid, what its joints, bolts and blocks did, and what every monitor came to.

import { element, tableOf } from "./dom.js";
import { number, readableUnit, withUnit, words } from "./quantities.js";
import { count } from "./words.js";

/** What is said first, a line each. */
export function verdictsOf(run) {
  const s = run.summary, j = s.joints || {}, out = [];
  out.push(validityOf(s));
  if (j.points > 0) {
    const slipped = j.slipped_joints ?? j.slipped;
    if (slipped > 0) {
      const at = j["residual_slip_largest_at"], open = j["residual_slip_largest_while_open [m]"] ?? 0;
      const left = j["residual_slip_largest [m]"] !== undefined
        ? `residual slip at most ${withUnit(j["residual_slip_largest [m]"], "m")}${number(j["residual_slip_largest [m]"] - open, 3) !== number(j["residual_slip_largest [m]"], 3) ? ` (${withUnit(open, "m")} of it while the joint was open)` : ""}${at ? ` between ${at.blocks.join(" and ")}${at.set ? ` along "${at.set}"` : ""}` : ""}, ` : "";
      out.push(["joints", `${count(slipped, "joint")} slipped: ${left}accumulated slip at most ${withUnit(j["slip_largest [m]"], "m")}`]);
    } else out.push(["joints", "no joint slipped"]);
    const broken = j["broken_length [m]"], open = j["opening_largest [m]"], more = [];
    if (broken > 0) more.push(`${withUnit(broken, "m")} of faces that were held together broke`);
    if (open > 0) more.push(`the widest open joint of blocks still near each other stands ${withUnit(open, "m")} open (wider gaps: \`crack\` monitors)`);
    if (more.length) out.push(["cracks", more.join("; ")]);
  }
  const bolts = boltsOf(run);
  if (bolts) out.push(["bolts", bolts]);
  const far = s.moved && s.moved.most_in_metres, most = s.moved && s.moved.most_for_its_size;
  const went = (m) => `${m.block}, ${withUnit(m["displacement [m]"], "m")} (${number(100 * m["share of its size"], 2)} % of its size)`;
  if (far && most && far.block !== most.block) out.push(["moved most, in metres", went(far)], ["moved most, for its size", went(most)]);
  else if (most) out.push(["moved most", went(most)]);
  if (s.moved && s.moved.blocks > 0)
    out.push(["moved", `${count(s.moved.blocks, "block")} moved by a tenth of their size or more, ${number(s.moved["area [m2]"], 3)} m² together`]);
  return out;
}

// The audit's word.
function validityOf(s) {
  if (s.status === "failed") return ["result", `the run failed: ${s.failure}`];
  if (s.status === "running") return ["result", "none yet: the run goes on, or was killed"];
  const how = s.status === "interrupted" ? ", interrupted" : "";
  if (s.valid === undefined || s.valid === null) return ["result", `not audited${how}: nothing says that the forces are right`];
  const defects = ((s.audit && s.audit.defects) || []).map((d) => d.kind.replace(/_/g, " "));
  if (!s.valid) return ["result", `NOT VALID${how}: ${defects.join(", ")}`];
  return ["result", `valid${how}${defects.length ? `, with warnings: ${defects.join(", ")}` : ""}`];
}

function boltsOf(run) {
  const t = run.bolts;
  if (!t || !t.rows.length) return "";
  const at = (quantity) => t.columns.findIndex((c) => c.quantity === quantity);
  const bolt = at("bolt"), state = at("state"), axial = at("axial_force");
  const names = new Set(), worst = new Map();
  let most = -Infinity, where = "";
  for (const row of t.rows) {
    names.add(row[bolt]);
    const rank = words.bolt_conditions.indexOf(row[state]);
    worst.set(row[bolt], Math.max(rank, worst.get(row[bolt]) ?? 0));
    if (Number(row[axial]) > most) most = Number(row[axial]), where = row[bolt];
  }
  const having = (k) => [...worst.values()].filter((v) => v === k).length, parts = [];
  words.bolt_conditions.forEach((name, k) => { if (k > 0 && having(k)) parts.push(`${having(k)} ${name}`); });
  const of = t.rows_there > t.rows.length ? ` (of the first ${t.rows.length} of ${t.rows_there} pieces)` : "";
  return `${parts.length ? parts.join(", ") : "none yielded"} of ${names.size}${of}; largest tension ${withUnit(most, "N")} in ${where}`;
}

/** Stages that monitors tell of, in order. */
export function answeredStages(run) {
  const names = new Set();
  for (const m of Object.values(run.summary.monitors || {})) for (const name of Object.keys(m.stages || {})) names.add(name);
  return (run.summary.stages || []).map((s) => s.name).filter((name) => names.has(name));
}

/** [{monitor, quantity, unit, peak, when, left, end}] of a stage, in the order of the model. */
export function answersOf(run, stage) {
  const out = [];
  for (const [monitor, m] of Object.entries(run.summary.monitors || {}))
    for (const [title, a] of Object.entries((m.stages || {})[stage] || {})) {
      const { quantity, unit } = run.aboutColumn(monitor, title);
      const low = Math.abs(a.least) > Math.abs(a.greatest);
      out.push({ monitor, quantity: quantity.replace(/_/g, " "), unit, peak: low ? a.least : a.greatest,
        when: low ? a["time_of_least [s]"] : a["time_of_greatest [s]"], left: a.residual, end: a.at_end });
    }
  return out;
}

/** The table of a stage; times also from its beginning. */
export function monitorTable(run, stage, onTime) {
  const about = (run.summary.stages || []).find((s) => s.name === stage) || {}, begin = about["begin [s]"] || 0;
  const dynamic = about.kind === "dynamic";
  const rows = answersOf(run, stage).map((a) => {
    const r = readableUnit(Math.max(Math.abs(a.peak), Math.abs(a.left ?? 0)), a.unit);
    const text = (v) => (v === null || v === undefined || !Number.isFinite(v) ? "" : number(v / r.factor, 3));
    const when = begin > 0 ? `${number(a.when, 4)} (${number(a.when - begin, 4)})` : number(a.when, 4);
    const link = onTime ? element("button", { type: "button", class: "link", onclick: () => onTime(a.when) }, when) : when;
    return [a.monitor, a.quantity, text(a.peak), link, text(dynamic ? a.left : a.end), r.unit];
  });
  if (!rows.length) return null;
  return tableOf(`Monitors in stage "${stage}"`, ["monitor", "quantity", "peak", begin > 0 ? "at t [s] (of the stage)" : "at t [s]",
    dynamic ? "residual (mean of the last tenth)" : "at its end", "unit"], rows);
}

/** The table of all stages side by side: what monitors come to at the end of static ones, peak and residual of dynamic ones. */
export function stagesTable(run) {
  const names = answeredStages(run), columns = [], rows = new Map();
  for (const name of names) {
    const dynamic = ((run.summary.stages || []).find((s) => s.name === name) || {}).kind === "dynamic";
    const parts = dynamic ? [[`${name}: peak`, (a) => a.peak], [`${name}: residual`, (a) => a.left]] : [[`${name}: at its end`, (a) => a.end]];
    for (const a of answersOf(run, name)) {
      const key = `${a.monitor} ${a.quantity}`;
      if (!rows.has(key)) rows.set(key, { ...a, values: new Map() });
      for (const [title, of] of parts) rows.get(key).values.set(title, of(a));
    }
    columns.push(...parts.map(([title]) => title));
  }
  const body = [...rows.values()].map((row) => {
    const r = readableUnit(Math.max(...[...row.values.values()].map((v) => Math.abs(v ?? 0))), row.unit);
    return [row.monitor, row.quantity, ...columns.map((c) => { const v = row.values.get(c); return Number.isFinite(v) ? number(v / r.factor, 3) : ""; }), r.unit];
  });
  return body.length ? tableOf("Monitors in all stages", ["monitor", "quantity", ...columns, "unit"], body) : null;
}
