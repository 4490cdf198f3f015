#!/bin/bash
# Installs the packages on a bare Debian 12, in a folder of its own (chroot), and tries them one after the other: the program,
# maps, the library from outside, Python. Then takes them away and looks whether anything is left. Prints what it does.
# Usage: tests/packages/bare.sh PACKAGES [BASE]    (as root)
#   PACKAGES  the folder that tools/packages.sh has filled
#   BASE      a folder with a bare Debian 12, which is copied; without it debootstrap makes one, from the mirror of this machine
set -eu
here=$(cd "$(dirname "$0")" && pwd)
fail() { echo "FAILED: $*" >&2; exit 1; }
[ $# = 1 ] || [ $# = 2 ] || { sed -n '2,6s/^# //p' "$0"; exit 2; }
[ "$(id -u)" = 0 ] || fail "only root may make a chroot: sudo $0 $*"
packages=$(cd "$1" && pwd)
for name in talus libtalus-dev talus-maps python3-talus; do
  [ "$(find "$packages" -name "${name}_*.deb" | wc -l)" = 1 ] || fail "$packages has not one package $name; tools/packages.sh makes them"
done

work=$(mktemp -d)
root=$work/root
clean_up() {
  local place
  for place in proc dev; do
    ! mountpoint -q "$root/$place" || umount "$root/$place" || { echo "left, as $root/$place is in use: $work"; return; }
  done
  rm -rf --one-file-system "$work"
}
trap clean_up EXIT
mkdir "$root"

# the bare system, with this machine's way to Debian's packages
if [ $# = 2 ]; then
  cp -a "$2/." "$root/"
else
  command -v debootstrap >/dev/null || fail "debootstrap is missing: apt-get install debootstrap"
  mirror=$(sed -n 's/^URIs: *\([^ ]*\/debian\/*\)$/\1/p' /etc/apt/sources.list.d/*.sources 2>/dev/null | head -1)
  [ -n "$mirror" ] ||
    mirror=$(sed -n 's/^deb \(\[.*\] \)*\([^ ]*\/debian\/*\) .*/\2/p' /etc/apt/sources.list /etc/apt/sources.list.d/*.list 2>/dev/null | head -1)
  [ -n "$mirror" ] || fail "no mirror of Debian is named in /etc/apt; give a folder with a bare Debian 12 as second argument"
  echo "debootstrap: a bare Debian 12"
  debootstrap --variant=minbase bookworm "$root" "$mirror" >"$work/debootstrap.log" 2>&1 || { tail -5 "$work/debootstrap.log"; fail "debootstrap"; }
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/debian*.sources; do
    [ ! -e "$file" ] || cp "$file" "$root$file"
  done
fi
for file in /etc/resolv.conf /etc/hosts /etc/apt/apt.conf.d/99*; do
  [ ! -e "$file" ] || cp "$file" "$root$file"
done
mkdir -p "$root/etc/ssl/certs"
cp -a /etc/ssl/certs/. "$root/etc/ssl/certs/" 2>/dev/null || true
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"
home=/home/user
chroot "$root" useradd -m -d $home user
mkdir "$root/packages"
cp "$packages"/*.deb "$root/packages"
cp "$here/../outside/CMakeLists.txt" "$here/../outside/fall.cpp" "$root$home"

inside() { # USER COMMAND
  chroot --userspec="$1:$1" "$root" env -i HOME=$home PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 TERM=dumb \
    DEBIAN_FRONTEND=noninteractive $(env | grep -iE '^(https?_proxy|no_proxy)=') bash -c "cd $home && $2"
}
# try COMMAND [TEXT]: as an ordinary user; shows what it says, which has to contain TEXT
try() {
  echo "\$ $1"
  inside user "$1" >"$work/said" 2>&1 || { cat "$work/said"; fail "$1"; }
  shorten
  [ -z "${2:-}" ] || grep -q -- "$2" "$work/said" || fail "$1 does not say: $2"
}
# refused CODE TEXT COMMAND: the same for what has to end with this code and words
refused() {
  echo "\$ $3"
  local code=0
  inside user "$3" >"$work/said" 2>&1 || code=$?
  shorten
  [ $code = "$1" ] || fail "$3: exit code $code, not $1"
  grep -q -- "$2" "$work/said" || fail "$3 does not say: $2"
}
shorten() {
  awk '{ line[NR] = $0 } END { for (i = 1; i <= NR; ++i) if (NR <= 14 || i <= 10 || i > NR - 2) print line[i]; else if (i == 11) print "..." }' "$work/said" |
    cut -c1-180 | sed 's/^/    /'
}
install() {
  echo "# apt-get install $*"
  inside root "apt-get install -y --no-install-recommends $*" >"$work/apt" 2>&1 || { tail -20 "$work/apt"; fail "apt-get install $*"; }
  grep -E 'newly installed|^After this operation' "$work/apt" | sed 's/^/    /'
}
package() { (cd "$packages" && echo "/packages/$(echo "$1"_*.deb)"); }

inside root "apt-get update" >"$work/apt" 2>&1 || { tail -5 "$work/apt"; fail "apt-get update"; }

echo
echo "== the program"
install "$(package talus)"
try "talus --version"
try "talus new bar --from impact_bar"
try "talus run bar.toml -o bar -q && ls bar"
try "talus report bar && grep -q talus-notices bar/report.html"
try "talus plot bar && ls bar/plots" "\.png"
try "cp /usr/share/talus/examples/incline/incline.toml . && talus check incline.toml"
try "talus verify A1" "every one within what is allowed"
try "talus verify 'example incline'" "every one within what is allowed"
try "talus verify 'unstructured mesh'" "every one within what is allowed"
try ". /usr/share/bash-completion/completions/talus && complete -p talus" "talus"
install man-db
try "man talus | head -5" "TALUS(1)"
try "head -20 /usr/share/doc/talus/copyright"
try "grep -A2 uplot /usr/share/doc/talus/copyright" "Leon Sorokin"

echo
echo "== maps"
refused 3 "install the package talus-maps" "talus cut /usr/share/talus/examples/outcrop/outcrop.toml -o outcrop"
install "$(package talus-maps)"
try "talus cut /usr/share/talus/examples/outcrop/outcrop.toml -o outcrop && talus check outcrop/model.toml" "blocks"

echo
echo "== the library, from outside"
install "$(package libtalus-dev)" g++ cmake ninja-build pkgconf
try "cmake -G Ninja -S . -B by_cmake -DCMAKE_BUILD_TYPE=Release && cmake --build by_cmake"
try "pkg-config --cflags --libs talus"
try "g++ -O1 fall.cpp -o by_pkg_config \$(pkg-config --cflags --libs talus)"
steps=$(sed -n 's/.*"contact_solves": \([0-9]*\).*/\1/p' "$root$home/bar/summary.json")
try "by_cmake/fall bar.toml" "^$steps steps"
try "./by_pkg_config bar.toml" "^$steps steps"

echo
echo "== Python"
install "$(package python3-talus)"
try "python3 -c 'import talus; print(talus.__file__)'" "^/usr/lib/python3/dist-packages/talus/"
try "python3 -c 'import talus; r = talus.Model(\"bar.toml\").run(\"by_python\"); print(r)'"
try "sed -n 's/.*\"contact_solves\": \([0-9]*\).*/\1/p' by_python/summary.json" "^$steps$"
try "python3 -c 'import talus; print(talus.Cut(\"/usr/share/talus/examples/outcrop/outcrop.toml\"))'" "[0-9] blocks"
try "python3 -c 'import talus; print(talus.Study({\"talus_study\": 1, \"model\": \"bar.toml\", \"vary\": [{\"key\": \"block.striker.velocity\", \"values\": [[1, 0], [2, 0]]}]}).run(\"study\"))'" "2 runs"

echo
echo "== away"
echo "# apt-get purge talus (and what depends on it)"
inside root "apt-get purge -y talus" >"$work/apt" 2>&1 || { tail -20 "$work/apt"; fail "apt-get purge"; }
grep '^ ' "$work/apt" | sed 's/^/  /'
inside root "dpkg-query -W -f='\${db:Status-Abbrev}\${Package}\n' '*talus*'" 2>/dev/null | grep -v '^un' && fail "packages are left"
inside root "find / -xdev \\( -path $home -o -path /packages -o -path /proc -o -path /dev -o -path /var/lib/apt -o -path /var/cache/apt \
  -o -path /var/log \\) -prune -o -name '*talus*' -print" | grep . && fail "files are left"
inside root "ldconfig -p" | grep talus && fail "the linker still knows the library"
refused 127 "not found" "talus --version"
echo
echo "installed, tried, taken away: nothing is left"
