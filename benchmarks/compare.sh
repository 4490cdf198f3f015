#!/bin/bash
# Times talus and other programs on the same scenes, in turn on one machine; prints the ratios with the errors
# reached. Installs the other programs' packages where they are missing and builds their drivers; where
# TALUS_BOX2D2_SOURCE and TALUS_BOX2D3_SOURCE name folders with sources of Box2D, those too, and LMGC90 and ntdda where
# TALUS_LMGC90 and TALUS_NTDDA name them (rivals/README.md).
# Usage: benchmarks/compare.sh BUILD_DIR OUT_DIR [--quick] [--scenes wall_1k,wall_7k] [--repetitions 5]
#          [--dt 1e-3] [--sweeps 10] [--threads T]     the last two are talus's own
set -eu
here=$(cd "$(dirname "$0")" && pwd)
[ $# -ge 2 ] || { sed -n '2,7s/^# //p' "$0"; exit 2; }
build=$1 out=$2
shift 2

# install_missing_packages reads the list from this variable
. "$here/../tools/setup.sh"
talus_packages="libbox2d-dev chipmunk-dev libsiconos-numerics-dev python3${TALUS_LMGC90:+ python3-numpy}"
install_missing_packages

# a second look at the system: the packages may be newer than the build directory
mkdir -p "$out"
{ cmake ${TALUS_BOX2D2_SOURCE:+-DTALUS_BOX2D2_SOURCE="$TALUS_BOX2D2_SOURCE"} \
    ${TALUS_BOX2D3_SOURCE:+-DTALUS_BOX2D3_SOURCE="$TALUS_BOX2D3_SOURCE"} "$build" && cmake --build "$build"; } >"$out/build.log" 2>&1 ||
  { tail -40 "$out/build.log"; echo "the build failed; the whole log is in $out/build.log"; exit 1; }
exec python3 "$here/compare.py" run "$build" "$out" "$@"
