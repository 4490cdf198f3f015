// Puts script, style and the notices of the software in it into the page:
// node inline.mjs PAGE SCRIPT STYLE PACKAGE_FOLDER... > report_page.html

import { readFileSync } from "node:fs";

const [page, script, style, ...packages] = process.argv.slice(2);
const text = (path) => readFileSync(path, "utf8");
const safe = (code) => code.replace(/<\/(script|style)/gi, "<\\/$1");
const at = (place, content, html) => {
  if (!html.includes(place)) throw new Error(`the page has no place "${place}"`);
  return html.replace(place, () => content);
};
const notices = packages.map((folder) => {
  const { name, version } = JSON.parse(text(`${folder}/package.json`));
  return `${name} ${version}\n\n${text(`${folder}/LICENSE`)}`;
});
let out = at("/* talus: style */", safe(text(style)), text(page));
out = at("/* talus: script */", safe(text(script)), out);
out = at("</footer>", `</footer>\n<script type="text/plain" id="talus-notices">${safe(notices.join("\n"))}</script>`, out);
process.stdout.write(out);
