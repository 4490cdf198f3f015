# Sourced by run.sh and test.sh: installs the missing Debian packages, configures and builds.
# Quick when nothing has changed: one look at the package database, one look of the build tool at the sources.

talus_packages="g++ cmake ninja-build pkgconf python3-minimal libeigen3-dev libgeos-dev libtomlplusplus-dev libcli11-dev libfmt-dev
  libmuparser-dev libcairo2-dev libhdf5-dev zlib1g-dev nlohmann-json3-dev doctest-dev fonts-dejavu-core"

# What the module that reads maps needs; a build without the module is configured anew.
talus_maps=no
add_maps() {
  talus_packages="$talus_packages libgdal-dev"
  talus_maps=yes
}

# What the page of talus report is bundled with, unless a Node.js of 18 or newer is here already.
add_report() {
  local version
  version=$(node --version 2>/dev/null | sed 's/^v\([0-9]*\).*/\1/')
  [ "${version:-0}" -ge 18 ] && command -v npm >/dev/null || talus_packages="$talus_packages nodejs npm"
  talus_report=yes
}
talus_report=no

# What its tests drive.
add_browser() { command -v chromium >/dev/null || talus_packages="$talus_packages chromium"; }

# What the Python package is built with; a build without it is configured anew.
talus_python=no
add_python_package() {
  talus_packages="$talus_packages pybind11-dev python3-dev python3-numpy"
  talus_python=yes
}

# And what its tests look with.
add_python() {
  add_python_package
  talus_packages="$talus_packages python3-matplotlib mypy python3-venv python3-pip python3-setuptools python3-wheel"
}

install_missing_packages() {
  local missing="" p
  for p in $talus_packages; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$p" 2>/dev/null)" = installed ] || missing="$missing $p"
  done
  [ -n "$missing" ] || return 0
  local as_root=""
  if [ "$(id -u)" != 0 ]; then
    if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
      as_root="sudo"
    elif command -v sudo >/dev/null && [ -t 0 ]; then
      as_root="sudo"
    else
      echo "talus needs packages that only root can install. Have this line run once, then start again:"
      echo "  apt-get update && apt-get install -y --no-install-recommends$missing"
      exit 1
    fi
  fi
  echo "installing:$missing"
  # an old package list is the usual reason of a first failure
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends --no-remove $missing >/dev/null 2>&1 ||
    { $as_root apt-get update -q >/dev/null &&
      $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends --no-remove $missing >/dev/null; }
}

# What ninja says, as one line: rewritten on a terminal, otherwise one now and then.
show_progress() {
  local line last=$SECONDS at=""
  while IFS= read -r line; do
    case "$line" in \[[0-9]*/[0-9]*\]*) ;; *) continue ;; esac
    line=${line%%\]*}
    at="building: ${line#\[}"
    at="${at%/*} of ${at#*/}"
    if [ -t 1 ]; then
      printf '\r\033[K%s' "$at"
    elif [ $((SECONDS - last)) -ge 30 ]; then
      echo "$at"
      last=$SECONDS
    fi
  done
  [ ! -t 1 ] || [ -z "$at" ] || printf '\r\033[K'
}

# build PRESET [TARGET...]: configures once and builds what has changed, all or the targets; the log is shown when it fails.
build() {
  local preset=$1 log="build/$1.log" begun=$SECONDS
  shift
  mkdir -p build
  [ -e "build/$preset/build.ninja" ] || echo "building ($preset); the first time takes some minutes"
  local configure=no
  [ -e "build/$preset/build.ninja" ] || configure=yes
  [ "$talus_report" = no ] || [ -e "build/$preset/share/talus/report_page.html" ] || configure=yes
  [ "$talus_maps" = no ] || [ -e "build/$preset/modules/libtalus_vector.so" ] || configure=yes
  [ "$talus_python" = no ] || ls "build/$preset/python/talus/"_talus*.so >/dev/null 2>&1 || configure=yes
  (
    set -o pipefail
    export NINJA_STATUS="[%f/%t] "
    { { [ $configure = no ] || cmake --preset "$preset"; } && cmake --build --preset "$preset" ${1:+--target "$@"}; } 2>&1 |
      tee "$log" | show_progress
  ) || { tail -40 "$log"; echo "the build failed; the whole log is in $log"; exit 1; }
  build_seconds=$((SECONDS - begun))
  [ "$talus_report" = no ] || [ -e "build/$preset/share/talus/report_page.html" ] ||
    echo "note: the page of talus report was not built; the reason is in $log"
}
