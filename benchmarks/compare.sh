#!/bin/bash
# Times talus and other programs on the same scenes, in turn on one machine; prints the ratios with the errors
# reached. Installs the other programs' packages where they are missing and builds their drivers.
# Usage: benchmarks/compare.sh BUILD_DIR OUT_DIR [--quick] [--scenes wall_1k,wall_7k] [--repetitions 5]
#          [--dt 1e-3] [--sweeps K] [--threads T]     the last two are talus's own
set -eu
here=$(cd "$(dirname "$0")" && pwd)
[ $# -ge 2 ] || { sed -n '2,5s/^# //p' "$0"; exit 2; }
build=$1 out=$2
shift 2

# install_missing_packages reads the list from this variable
. "$here/../tools/setup.sh"
talus_packages="libbox2d-dev chipmunk-dev libsiconos-numerics-dev python3"
install_missing_packages

# a second look at the system: the packages may be newer than the build directory
mkdir -p "$out"
{ cmake "$build" && cmake --build "$build"; } >"$out/build.log" 2>&1 ||
  { tail -40 "$out/build.log"; echo "the build failed; the whole log is in $out/build.log"; exit 1; }
exec python3 "$here/compare.py" run "$build" "$out" "$@"
