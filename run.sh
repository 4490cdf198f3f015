#!/bin/bash
# Installs what is missing, builds talus and runs the main example: a block strikes a bar.
# Usage: ./run.sh
set -eu
cd "$(dirname "$0")"
. tools/setup.sh
install_missing_packages
build release
examples/impact_bar/run.sh build/release out/impact_bar
