#!/bin/bash
# Makes a report of examples/bolted_slope and others, and the page of a section, and drives them in a browser. Exit 77: there is no browser, driver or page.
# Usage: tests/browser/run.sh BUILD_DIR
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
out=$build/browser_test

# Debian 12 has Node.js 18: a newer one on the developer's machine must not hide a package that wants more
oldest=18
for lock in "$here/package-lock.json" "$here/../../web/package-lock.json"; do
  wanted=$(grep -o '"node": ".*' "$lock" | grep -o '>= *[0-9]*' | grep -o '[0-9]*' | sort -n | tail -1)
  [ "${wanted:-0}" -le "$oldest" ] || { echo "failed: a package of $lock needs Node.js $wanted, Debian 12 has $oldest"; exit 1; }
done
found=$(node --version 2>/dev/null | sed 's/^v\([0-9]*\).*/\1/')
[ "${found:-0}" -ge "$oldest" ] || {
  echo "failed: this test needs Node.js $oldest or newer, found: $(command -v node || echo none) ${found:+version $found}"
  exit 1
}

if ! cmp -s "$here/package-lock.json" "$build/browser/package-lock.json" || [ ! -e "$build/browser/node_modules/playwright-core" ]; then
  rm -rf "$build/browser"
  mkdir -p "$build/browser"
  cp "$here/package.json" "$here/package-lock.json" "$here/.npmrc" "$build/browser"
  (cd "$build/browser" && npm ci --ignore-scripts --loglevel=error) || {
    echo "skipped: the driver of the browser (npm, playwright-core) could not be fetched"
    exit 77
  }
fi
if [ ! -e "$build/share/talus/report_page.html" ]; then
  echo "skipped: the page of the report was not built"
  exit 77
fi
rm -rf "$out"
mkdir -p "$out"
{
  cat "$here/../../examples/bolted_slope/bolted_slope.toml"
  printf '\n[[monitor]]\nname = "middle"\npoint = [3, 0.75]\n'
} >"$out/model.toml"
"$build/app/talus" run "$out/model.toml" -o "$out/run" --quiet --set output.field_interval=0.02
"$build/app/talus" report "$out/run" -o "$out/report.html"
# the section before any run
"$build/app/talus" cut "$here/../fixtures/section.toml" -o "$out/section" --open >/dev/null
# several runs on one page: of a column that a support drives
runs=()
for k in 1 2 3 4 5 6; do
  "$build/app/talus" run "$here/../../examples/wave_column/wave_column.toml" -o "$out/wave_$k" --quiet
  runs+=("$out/wave_$k")
done
"$build/app/talus" report "${runs[@]}" -o "$out/many.html"
export NODE_PATH=$build/browser/node_modules
node "$here/section.test.mjs" "$out/section/section.html" "$here/../fixtures/section.toml" || { [ $? -eq 77 ] || exit 1; }
# a run that goes on, and its page
"$build/app/talus" run "$here/../../examples/shaken_slope/shaken_slope.toml" -o "$out/live" --watch --quiet --set output.field_interval=0.25 &
watched=$!
trap 'kill $watched 2>/dev/null || true' EXIT
node "$here/report.test.mjs" "$out/report.html" "$out/run" "$out/many.html" "$out/live/live.html"
