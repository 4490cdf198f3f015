#!/bin/bash
# Writes the schema tables into docs/file_format.md, docs/many_runs.md and docs/talus.schema.json,
# and, where the Python package is built, docs/python_api.md. Usage: tools/update_reference.sh build/release
set -eu
cd "$(dirname "$0")/.."
talus=$1/app/talus page=docs/file_format.md
{ sed '/begin of `talus schema`/q' $page; echo; "$talus" schema; sed -n '/end of `talus schema`/,$p' $page; } >$page.new
mv $page.new $page
"$talus" schema --json >docs/talus.schema.json
page=docs/many_runs.md
{ sed '/begin of `talus schema --study`/q' $page; echo; "$talus" schema --study; sed -n '/end of `talus schema --study`/,$p' $page; } >$page.new
mv $page.new $page
[ ! -d "$1/python/talus" ] || PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$1/python /usr/bin/python3 tools/python_api.py
