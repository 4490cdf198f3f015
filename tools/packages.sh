#!/bin/bash
# Installs what is missing, builds talus with all its parts, makes Debian packages of it and has lintian look over them.
# Usage: tools/packages.sh [OUT]    (default: out/packages)
# docs/packages.md says what is in them; tests/packages/bare.sh tries them on a bare Debian 12.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
case "$#${1:-}" in 0 | 1[!-]*) ;; *) sed -n '2,4s/^# //p' "$0"; exit 2 ;; esac
out=${1:-out/packages}
fail() { echo "$*" >&2; exit 1; }

add_maps
add_report
add_python
talus_packages="$talus_packages dpkg-dev file lintian"
install_missing_packages
build release installation talus_vector talus_python
for part in share/talus/report_page.html modules/libtalus_vector.so tests/verification python/talus/_talus.*.so; do
  [ -e build/release/$part ] || fail "a package would lack $part, which was not built; the reason is in build/release.log"
done

# of the last commit, so that the same sources make the same packages
[ -n "${SOURCE_DATE_EPOCH:-}" ] || SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null) || SOURCE_DATE_EPOCH=$(date +%s)
export SOURCE_DATE_EPOCH
umask 022  # files in packages are for everyone
mkdir -p "$out"
rm -f "$out"/{talus,libtalus-dev,talus-maps,python3-talus}_*.deb
made=build/release/packages/made
rm -rf $made build/release/_CPack_Packages
cpack --config build/release/CPackConfig.cmake -B $made >build/packages.log 2>&1 ||
  { tail -20 build/packages.log; fail "cpack failed; the whole log is in build/packages.log"; }
cp $made/*.deb "$out"
rm -rf $made
lintian --allow-root --fail-on error,warning "$out"/*.deb || fail "lintian is not content with the packages (lintian-explain-tags TAG says why)"
(cd "$out" && ls -l *.deb) | awk '{ printf "%7.0f kB  %s\n", $5 / 1000, $NF }'
echo "packages: $out (docs/packages.md); apt-get install $(cd "$out" && pwd)/talus_*.deb"
