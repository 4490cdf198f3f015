#!/bin/bash
# Runs examples/bolted_slope, makes its report and drives it in a browser. Exit 77: there is no browser, driver or page.
# Usage: tests/browser/run.sh BUILD_DIR
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
out=$build/browser_test
if [ ! -e "$build/browser/node_modules/playwright-core" ]; then
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
NODE_PATH=$build/browser/node_modules exec node "$here/report.test.mjs" "$out/report.html" "$out/run"
