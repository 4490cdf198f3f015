#!/bin/bash
# Fuzzes every reader of talus, AT_ONCE at a time, from the seeds of tests/fuzz_seeds, under the address and
# undefined-behaviour sanitizers. Needs clang and libclang-rt. What breaks a reader stays in build/fuzz/found.
# It begins with the texts kept in fuzz/corpus; "keep" puts there the fewest that reach as much as all found so far.
# Usage: [AT_ONCE=2] fuzz/run.sh [SECONDS|keep [READER...]]     (default: 600 seconds each)
set -eu
cd "$(dirname "$0")/.."
readers='model msh dxf record history blocks vtk table replay csv series frame picture summary state geojson'
seconds=${1:-600} at_once=${AT_ONCE:-2}
[ $# = 0 ] || shift
[ -e build/fuzz/build.ninja ] || cmake --preset fuzz >/dev/null
cmake --build build/fuzz --target $(printf 'fuzz_%s ' $readers) | tail -1
mkdir -p build/fuzz/found
keep() {
  local least=build/fuzz/least/$1
  rm -rf "$least" && mkdir -p "$least" fuzz/corpus
  build/fuzz/fuzz/fuzz_$1 -merge=1 -timeout=60 -max_len=20000 "$least" "build/fuzz/corpus/$1" "tests/fuzz_seeds/$1" \
    >"build/fuzz/$1.log" 2>&1 || { echo "$1: FAILED, see build/fuzz/$1.log"; return 1; }
  tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner -C "$least" -c . | gzip -9n >"fuzz/corpus/$1.tar.gz"
  echo "$1: $(ls "$least" | wc -l) texts kept, $(stat -c %s "fuzz/corpus/$1.tar.gz") bytes"
}
one() {
  local corpus=build/fuzz/corpus/$1
  if [ ! -d "$corpus" ]; then
    mkdir -p "$corpus"
    [ ! -e "fuzz/corpus/$1.tar.gz" ] || tar -xzf "fuzz/corpus/$1.tar.gz" -C "$corpus"
  fi
  if [ "$seconds" = keep ]; then keep "$1"; return; fi
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
