#!/bin/bash
# Builds the documentation as a site in build/site (needs the Debian packages python3-sphinx, python3-myst-parser
# and furo). Usage: docs/build.sh
set -eu
cd "$(dirname "$0")/.."
python=/usr/bin/python3
$python -c 'import sphinx, myst_parser, furo' 2>/dev/null || {
  echo "the site needs: apt-get install -y --no-install-recommends python3-sphinx python3-myst-parser furo"
  exit 1
}
$python -m sphinx -q -W --keep-going -b html docs build/site
echo "build/site/index.html"
