# The documentation as a site: docs/build.sh. Sphinx, with pages in Markdown (MyST) as they stand here.
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
