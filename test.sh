#!/bin/bash
# Installs what is missing, builds, and runs the tests: optimised, then under the sanitizers, but for what ./test.sh long sanitized is for.
# Usage: ./test.sh [release|sanitize]    (default: both)
#        ./test.sh long [PART]           what is too long for every day, all parts or one (tests/long.sh)
set -eu
cd "$(dirname "$0")"
. tools/setup.sh
. tests/long.sh

which=${1:-both}
case "$which" in
  both | release | sanitize) [ $# -le 1 ] || { sed -n '2,4s/^# //p' "$0"; exit 2; } ;;
  long) long_known "${2:-}" || exit 2 ;;
  *) sed -n '2,4s/^# //p' "$0"; exit 2 ;;
esac

add_maps
add_report
add_browser
add_python
install_missing_packages

format_check() {
  command -v clang-format >/dev/null || { echo "format: skipped, clang-format is not installed"; return 0; }
  case "$(clang-format --version)" in *" 14."*) ;; *) echo "format: skipped, needs clang-format 14"; return 0 ;; esac
  find src app python examples tests benchmarks studies -name '*.h' -o -name '*.cpp' | xargs clang-format --dry-run --Werror
  echo "format: clean"
}

run_tests() {
  build "$1"
  local begun=$SECONDS
  ctest --preset "$1" -j 2 --no-tests=error --progress ${2:-} >"build/$1.test.log" 2>&1 || { tail -100 "build/$1.test.log"; return 1; }
  tail -4 "build/$1.test.log"
  echo "$1: built in $build_seconds s, tested in $((SECONDS - begun)) s"
}

if [ "$which" = long ]; then
  build release
  long_run "${2:-}"
  exit
fi
format_check
if [ "$which" != sanitize ]; then
  run_tests release
  echo
  echo "accuracy reached   | what                                                       |        computed |           exact |   error   |    pass | stretch |"
  grep -h '^residual' build/release/Testing/Temporary/LastTest.log | sort -u
  echo
fi
[ "$which" = release ] || run_tests sanitize
