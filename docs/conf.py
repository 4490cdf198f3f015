# The documentation as a site: docs/build.sh. Sphinx, with pages in Markdown (MyST) as they stand here.
from docutils import nodes

project = "talus"
author = "the authors of talus"
extensions = ["myst_parser"]
html_theme = "furo"
html_title = "talus"
myst_enable_extensions = ["deflist", "dollarmath"]
myst_heading_anchors = 4
# pages link to files outside docs/, which a reader of the repository follows
suppress_warnings = ["myst.ref", "myst.header", "ref.myst"]
html_copy_source = False

# Equations: the page holds the TeX, and KaTeX, whose files build.sh puts beside it, draws it when the page is opened.
# Sphinx's own way asks a server on the network for its script.
html_math_renderer = "katex"
MATH_SCRIPT = r"""document.addEventListener("DOMContentLoaded", () => {
  for (const e of document.querySelectorAll("span.math, div.math"))
    katex.render(e.textContent.replaceAll("\\qquad", "\\qquad\\allowbreak"), e, {displayMode: e.tagName === "DIV", throwOnError: false});
});"""
# where the page is narrow an equation breaks, at its signs and between its parts; its number has room
# at the right, or follows it there
MATH_STYLE = """<style>
div.math .katex-display > .katex { white-space: normal; }
div.math .katex-display > .katex > .katex-html { padding-right: 3.5em; }
div.math .katex-display > .katex > .katex-html > .tag { top: 50%; transform: translateY(-50%); }
div.math .katex-display .base { margin-top: 0.2em; margin-bottom: 0.2em; }
@media (max-width: 46em) {
  div.math .katex-display > .katex { text-align: left; }
  div.math .katex-display > .katex > .katex-html { padding-right: 0; }
  div.math .katex-display > .katex > .katex-html > .tag { position: static; transform: none; margin-left: 2em; }
}
</style>"""


def tag_of_math(name):
    def visit(self, node):
        self.body.append(self.starttag(node, name, "", CLASS="math notranslate") + self.encode(node.astext()) + f"</{name}>")
        raise nodes.SkipNode

    return visit, None


def head_of_page(app, page, template, context, tree):
    head = '<link rel="icon" href="data:,">'  # else browsers ask the server for one
    if app.env.get_domain("math").has_equations(page):
        app.add_css_file("katex/katex.min.css")
        app.add_js_file("katex/katex.min.js")
        app.add_js_file(None, body=MATH_SCRIPT)
        head += MATH_STYLE
    context["metatags"] = context.get("metatags", "") + head


def setup(app):
    app.add_html_math_renderer("katex", tag_of_math("span"), tag_of_math("div"))
    app.connect("html-page-context", head_of_page)
