// The run in words and tables: what happened, how far to trust it, what the model is.

import { element, tableOf } from "./dom.js";
import { number, readableUnit, withUnit } from "./quantities.js";

export const count = (n, one, many = `${one}s`) => `${Number(n).toLocaleString("en")} ${n === 1 ? one : many}`;

function duration(s) {
  if (!(s >= 0)) return "?";
  if (s < 60) return `${number(s, 3)} s`;
  if (s < 3600) return `${Math.floor(s / 60)} min ${String(Math.round(s % 60)).padStart(2, "0")} s`;
  return `${Math.floor(s / 3600)} h ${String(Math.round((s % 3600) / 60)).padStart(2, "0")} min`;
}

/** What must be read before anything else; the worst first. */
export function warningsOf(run) {
  const s = run.summary, out = [];
  if (s.status === "running") out.push("The run has not ended, or was killed: its summary was never written.");
  if (s.status === "failed") out.push(`The run failed: ${s.failure}`);
  if (s.valid === false) out.push("The audit says that the results are not valid.");
  if (s.status === "interrupted") out.push("The run was interrupted; the results up to then are valid.");
  const solver = s.solver || {};
  if (solver.failed_steps > 0)
    out.push(`${count(solver.failed_steps, "step")} of ${count(solver.contact_solves, "step")} did not solve the contact equations; the worst by an error of ${withUnit(solver["contact_error_worst [m]"], "m")}.`);
  else if (solver.loose_steps > 0)
    out.push(`${count(solver.loose_steps, "step")} of ${count(solver.contact_solves, "step")} ${solver.loose_steps === 1 ? "is" : "are"} loose: above the contact tolerance, within solver.limit; the worst by an error of ${withUnit(solver["contact_error_worst [m]"], "m")}.`);
  if (s.energy_closure > 1e-2)
    out.push(`The energy ledger leaves ${number(100 * s.energy_closure, 3)} % of its largest term unexplained; above 1 % the run is not to be trusted.`);
  for (const stage of s.stages || []) {
    if (stage.kind === "static" && stage.at_rest === false) out.push(`Stage "${stage.name}" did not come to rest.`);
    if (stage.left_out) out.push(`Stage "${stage.name}" did not wait for what falls or slides: ${stage.left_out}.`);
    if (stage.blocks_clamped > 0)
      out.push(`Stage "${stage.name}": the moments of ${count(stage.blocks_clamped, "block")} were raised, up to ${number(stage.largest_clamp, 3)} times, to allow the time step.`);
  }
  for (const w of s.warnings || []) out.push(w);
  const thin = (name) => {
    const t = run.tables[name];
    if (t && t.rows < t.rows_there)
      out.push(`${name}.csv has ${count(t.rows_there, "row")}, of which ${count(t.rows, "row")} are shown here, evenly chosen.`);
  };
  thin("histories");
  thin("steps");
  if (run.frames.length < run.framesThere)
    out.push(`${run.frames.length} of ${run.framesThere} frames are in this page, ${run.framesReason}; all are in the folder fields/.`);
  return out;
}

/** Cards of the head: [title, value, note]. */
export function cardsOf(run) {
  const s = run.summary, b = s.blocks || {}, solver = s.solver || {};
  const end = (s.stages || []).reduce((t, stage) => Math.max(t, stage["end [s]"] || 0), 0);
  const cards = [];
  if (s.valid !== undefined) cards.push(validity(s));
  cards.push(["status", s.status, s.status === "finished" ? `in ${duration(s["wall_time [s]"])}` : ""]);
  if (b.all !== undefined) cards.push(["blocks", Number(b.all).toLocaleString("en"), kinds(b)]);
  cards.push(["time computed", `${number(end, 4)} s`, solver.contact_solves ? count(solver.contact_solves, "step") : ""]);
  if (solver["contact_error_worst [m]"] !== undefined)
    cards.push(["contact error, worst", withUnit(solver["contact_error_worst [m]"], "m"), `at t = ${number(solver["contact_error_time [s]"], 4)} s`]);
  if (s.energy_closure !== undefined)
    cards.push(["energy left over", number(s.energy_closure, 3), "of the largest term; good below 0.01"]);
  const j = s.joints;
  if (j && j.points > 0)
    cards.push(["joints slipped", Number(j.slipped_joints ?? j.slipped).toLocaleString("en"), j["slip_largest [m]"] > 0 ? `accumulated ${withUnit(j["slip_largest [m]"], "m")} at most` : ""]);
  return cards;
}

// The audit's word on the run: [title, value, note].
function validity(s) {
  if (s.valid === null) return ["audit", "none", "nothing says that the forces are right"];
  const defects = (s.audit && s.audit.defects) || [], share = s.audit ? s.audit.unexplained_overlap_share : 0;
  if (!s.valid) return ["audit", "NOT VALID", defects.filter((d) => !d.valid).map((d) => d.kind.replace(/_/g, " ")).join(", ")];
  if (defects.length) return ["audit", "valid, with warnings", defects.map((d) => d.kind.replace(/_/g, " ")).join(", ")];
  return ["audit", "valid", `unexplained overlap ${number(share, 2)} of a block at most`];
}

function kinds(b) {
  return ["deformable", "rigid", "fixed", "driven"].filter((k) => b[k] > 0).map((k) => `${b[k].toLocaleString("en")} ${k}`).join(", ");
}

/** The model as paragraphs and tables. */
export function modelOf(run) {
  const s = run.summary, m = s.model, out = [];
  if (!m) {
    out.push(element("p", {}, "This run was made by an older talus, which kept no summary of the model. The model file says it all:"));
  } else {
    const g = m["gravity [m/s2]"] || [0, 0], parts = [];
    parts.push(`${count(s.blocks.all, "block")} (${kinds(s.blocks)}) in plane ${m.plane}, ${withUnit(m["thickness [m]"], "m")} thick, ${g[0] === 0 && g[1] === 0 ? "without gravity" : `under a gravity of (${number(g[0])}, ${number(g[1])}) m/s²`}.`);
    if (m.in_situ_stress) parts.push("The ground is under stress from the beginning.");
    if (m.boundaries.length) parts.push(`Boundaries: ${m.boundaries.map((x) => `${x.name} (${x.kind}${x.velocity_in_x || x.velocity_in_y ? `, motion "${[x.velocity_in_x, x.velocity_in_y].filter(Boolean).join('", "')}" comes in` : ""})`).join("; ")}.`);
    if (m.loads.length) parts.push(`Loads: ${m.loads.map((x) => `${x.name || x.kind} (${x.kind})`).join("; ")}.`);
    if (m.supports > 0) parts.push(`${count(m.supports, "support")}.`);
    parts.push(`${count(m.monitors, "monitor")}. The contact equations are solved to ${withUnit(m["contact_tolerance [m]"], "m")}.`);
    out.push(element("p", {}, parts.join(" ")));
    out.push(tableOf("Materials", ["name", "density [kg/m³]", "Young's modulus", "Poisson's ratio", "blocks"],
      m.materials.map((x) => [x.name, number(x["density [kg/m3]"], 6), x["young [Pa]"] === undefined ? "rigid" : withUnit(x["young [Pa]"], "Pa"), x.poisson === undefined ? "" : number(x.poisson), String(x.blocks)])));
    if (m.joints.length) out.push(tableOf("Joints (in brackets: once slipped or open)", ["name", "friction angle", "cohesion", "tensile strength", "normal stiffness", "shear stiffness"],
      m.joints.map(jointRow)));
    if (m.bolts.length) out.push(tableOf("Bolts", ["type", "kind", "count", "diameter", "Young's modulus", "spacing", "pretension", "yield"],
      m.bolts.map((x) => [x.name, x.kind, String(x.count), withUnit(x["diameter [m]"], "m"), withUnit(x["young [Pa]"], "Pa"), `${number(x["spacing [m]"])} m`, withUnit(x["pretension [N]"], "N"), x["yield_force [N]"] === undefined ? "none" : withUnit(x["yield_force [N]"], "N")])));
  }
  if (run.model) out.push(element("details", {}, element("summary", {}, `The model file, ${s.model_file || "model.toml"}`), element("pre", {}, run.model)));
  if ((s.overrides || []).length) out.push(element("p", {}, `Set on the command line: ${s.overrides.join(", ")}`));
  return out;
}

function jointRow(x) {
  const after = (now, then, text) => (now === then || then === undefined ? text(now) : `${text(now)} (${text(then)})`);
  const pressure = (v) => (v > 0 ? withUnit(v, "Pa") : "0");
  const stiffness = (v) => (v > 0 ? `${withUnit(v, "Pa")}/m` : "hard");
  if (x.bonded) return [x.name, "glued: never opens or slides", "", "", stiffness(x["normal_stiffness [Pa/m]"]), stiffness(x["shear_stiffness [Pa/m]"])];
  return [x.name, after(x["friction_angle [deg]"], x["friction_angle_after [deg]"], (v) => `${number(v)}°`),
    after(x["cohesion [Pa]"], x["cohesion [Pa]"] > 0 ? x["cohesion_after [Pa]"] : undefined, pressure),
    after(x["tensile_strength [Pa]"], x["tensile_strength [Pa]"] > 0 ? x["tensile_strength_after [Pa]"] : undefined, pressure),
    stiffness(x["normal_stiffness [Pa/m]"]), stiffness(x["shear_stiffness [Pa/m]"])];
}

export function stagesOf(run) {
  const s = run.summary, model = (s.model && s.model.stages) || [];
  const damping = (x) => (x ? [["mass", x["damping_mass [1/s]"], "1/s"], ["stiffness", x["damping_stiffness [s]"], "s"], ["local", x.damping_local, ""]]
    .filter(([, v]) => v > 0).map(([name, v, unit]) => `${name} ${number(v)} ${unit}`.trim()).join(", ") || "none" : "");
  return tableOf("", ["stage", "kind", "from [s]", "to [s]", "lasts [s]", "steps", "step [s]", "damping", "dug out", "at its end"],
    (s.stages || []).map((x, i) => [x.name, x.kind, number(x["begin [s]"], 6), number(x["end [s]"], 6), number(x["end [s]"] - x["begin [s]"], 4), String(x.steps), number(x["dt [s]"], 4), damping(model[i]),
      model[i] ? (model[i].excavate || []).join(", ") : "", x.kind === "static" ? (x.at_rest ? `at rest, unbalanced ${number(x.unbalanced, 2)}` : "not at rest") : ""]));
}

export function energyOf(run) {
  const e = run.summary["energy [J]"];
  if (!e) return null;
  const rows = Object.entries(e).filter(([, v]) => v !== 0).map(([k, v]) => [k.replace(/_/g, " "), withUnit(v, "J", 4)]);
  return tableOf("Energy at the end (work > 0: given to the blocks)", ["term", "value"], rows);
}

/** The steps with the largest contact errors and the most iterations, of steps.csv. */
export function worstSteps(table, onTime) {
  if (!table) return null;
  const at = (name) => table.columns.indexOf(name);
  const error = at("contact error [m]"), iterations = at("iterations"), drift = at("drift [m]"), failed = at("failed steps"), loose = at("loose steps");
  if (error < 0) return null;
  const order = [...Array(table.rows).keys()].sort((i, j) => table.values[error][j] - table.values[error][i] || table.values[iterations][j] - table.values[iterations][i]);
  const rows = order.slice(0, 10).map((i) => [
    onTime ? element("button", { type: "button", class: "link", onclick: () => onTime(table.values[0][i]) }, `${number(table.values[0][i], 6)} s`) : `${number(table.values[0][i], 6)} s`,
    withUnit(table.values[error][i], "m"), String(table.values[iterations][i]),
    drift < 0 ? "" : withUnit(table.values[drift][i], "m"), failed < 0 ? "" : String(table.values[failed][i]), loose < 0 ? "" : String(table.values[loose][i])]);
  return tableOf("Worst steps, by the contact error (each row of steps.csv keeps the worst since the row before)", ["time", "contact error", "iterations", "drift", "steps not solved", "loose steps"], rows);
}

/** A table of texts, numbers with fewer digits; columns of one unit in a prefix that suits the largest. */
export function listOf(caption, table, leaveOut = []) {
  if (!table || !table.rows.length) return null;
  const kept = table.columns.map((c, i) => i).filter((i) => !leaveOut.includes(table.columns[i].title));
  const units = table.columns.map((c, k) => {
    const most = Math.max(0, ...table.rows.map((row) => Math.abs(Number(row[k])) || 0));
    return c.unit ? readableUnit(most, c.unit) : { factor: 1, unit: "" };
  });
  const short = (text, k) => (text !== "" && (table.columns[k].unit || /[.e]/.test(text)) && Number.isFinite(Number(text))
    ? number(Number(text) / units[k].factor, 4) : text);
  const more = table.rows_there > table.rows.length ? ` (the first ${table.rows.length} of ${table.rows_there})` : "";
  const title = (k) => table.columns[k].quantity.replace(/_/g, " ") + (units[k].unit ? ` [${units[k].unit}]` : "");
  return tableOf(caption + more, kept.map(title), table.rows.map((row) => kept.map((i) => short(row[i], i))));
}
