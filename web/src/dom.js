// Small helpers to make elements.

/** element("p", {class: "x"}, "text", other) */
export function element(tag, attributes = {}, ...children) {
  const e = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith("on")) e.addEventListener(key.slice(2), value);
    else e.setAttribute(key, value === true ? "" : value);
  }
  e.append(...children.filter((c) => c !== undefined && c !== null && c !== ""));
  return e;
}

/** A table with a head; cells are texts or elements, numbers stand right. */
export function tableOf(caption, columns, rows) {
  const right = columns.map((_, k) => rows.length > 0 && rows.every((row) => row[k] === "" || isNumber(row[k])) && rows.some((row) => row[k] !== ""));
  const cell = (tag, c, k) => element(tag, { class: right[k] ? "number" : undefined, scope: tag === "th" ? "col" : undefined }, c);
  return element("div", { class: "scroll" }, element("table", {},
    caption ? element("caption", {}, caption) : "",
    element("thead", {}, element("tr", {}, ...columns.map((c, k) => cell("th", c, k)))),
    element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map((c, k) => cell("td", c, k)))))));
}

function isNumber(c) {
  return typeof c === "string" && c !== "" && Number.isFinite(Number(c.split(" ")[0]));
}
