#!/bin/bash
# Writes the schema tables into docs/file_format.md, docs/many_runs.md and docs/talus.schema.json. Usage: tools/update_reference.sh build/release
set -eu
cd "$(dirname "$0")/.."
talus=$1/app/talus page=docs/file_format.md
{ sed '/begin of `talus schema`/q' $page; echo; "$talus" schema; sed -n '/end of `talus schema`/,$p' $page; } >$page.new
mv $page.new $page
"$talus" schema --json >docs/talus.schema.json
page=docs/many_runs.md
{ sed '/begin of `talus schema --study`/q' $page; echo; "$talus" schema --study; sed -n '/end of `talus schema --study`/,$p' $page; } >$page.new
mv $page.new $page
