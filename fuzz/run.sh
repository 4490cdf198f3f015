#!/bin/bash
# Fuzzes every reader of talus, AT_ONCE at a time, from the seeds of tests/fuzz_seeds, under the address and
# undefined-behaviour sanitizers. Needs clang and libclang-rt. What breaks a reader stays in build/fuzz/found.
# Usage: [AT_ONCE=2] fuzz/run.sh [SECONDS [READER...]]     (default: 600 seconds each)
set -eu
cd "$(dirname "$0")/.."
readers='model msh dxf record history blocks vtk table replay csv series frame picture summary state geojson'
seconds=${1:-600} at_once=${AT_ONCE:-2}
[ $# = 0 ] || shift
[ -e build/fuzz/build.ninja ] || cmake --preset fuzz >/dev/null
cmake --build build/fuzz --target $(printf 'fuzz_%s ' $readers) | tail -1
mkdir -p build/fuzz/found
one() {
  local corpus=build/fuzz/corpus/$1
  mkdir -p "$corpus"
  build/fuzz/fuzz/fuzz_$1 -max_total_time="$seconds" -timeout=10 -rss_limit_mb=4096 -max_len=20000 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/found/$1-" "$corpus" "tests/fuzz_seeds/$1" >"build/fuzz/$1.log" 2>&1 &&
    echo "$1: $(grep -h number_of_executed_units "build/fuzz/$1.log" | grep -o '[0-9]*$') texts, nothing found" ||
    { echo "$1: FAILED, see build/fuzz/$1.log"; return 1; }
}
failed=0
for reader in ${@:-$readers}; do
  one "$reader" &
  while [ "$(jobs -rp | wc -l)" -ge "$at_once" ]; do wait -n || failed=1; done
done
while [ "$(jobs -rp | wc -l)" -gt 0 ]; do wait -n || failed=1; done
exit $failed
