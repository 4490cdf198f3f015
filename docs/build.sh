#!/bin/bash
# Builds the documentation as a site in build/site (needs the Debian packages python3-sphinx, python3-myst-parser,
# furo and, for the equations, libjs-katex). Usage: docs/build.sh
set -eu
cd "$(dirname "$0")/.."
python=/usr/bin/python3
katex=/usr/share/javascript/katex
{ $python -c 'import sphinx, myst_parser, furo' 2>/dev/null && [ -e $katex/katex.min.js ]; } || {
  echo "the site needs: apt-get install -y --no-install-recommends python3-sphinx python3-myst-parser furo libjs-katex"
  exit 1
}
$python -m sphinx -q -W --keep-going -b html docs build/site

static=build/site/_static
mkdir -p $static/katex/fonts
cp $katex/katex.min.js $katex/katex.min.css $static/katex
cp $katex/fonts/*.woff2 $static/katex/fonts

# Three repairs of Debian's furo. Its style sheet imports another one from the root of the server, where Debian's web server
# keeps it and no other does: a copy lies beside it here. Its script imports gumshoe, which only a module may, and the page
# loads it as a plain script (a page opened as a file may not load modules): the two become one script. Its sheet lost the rule
# that a browser set to dark gets the dark colours unless the reader chose light, though code blocks keep to it: it comes back.
if grep -q 'url(/javascript/normalize.css/' $static/styles/furo.css; then
  cp /usr/share/javascript/normalize.css/normalize.css $static/styles
  sed -i 's|url(/javascript/normalize.css/|url(|' $static/styles/furo.css
fi
if grep -q '^import Gumshoe ' $static/scripts/furo.js; then
  sed '/^import Gumshoe /d' $static/scripts/furo.js | cat $static/scripts/gumshoe-patched.js - >$static/scripts/joined.js
  mv $static/scripts/joined.js $static/scripts/furo.js
fi
if ! grep -q 'prefers-color-scheme: dark' $static/styles/furo.css; then
  sed -n '/^@media not print {/,/^$/p' $static/styles/furo.css |
    sed 's/^@media not print/@media screen and (prefers-color-scheme: dark)/; s/\[data-theme="dark"\]/:not([data-theme="light"])/' \
      >$static/styles/dark.css
  cat $static/styles/dark.css >>$static/styles/furo.css
  rm $static/styles/dark.css
fi
echo "build/site/index.html"
