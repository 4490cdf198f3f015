#!/bin/bash
# Makes the Python package of a build known to a virtual environment, which is made when there is none.
# Usage: tools/python_venv.sh BUILD_DIR VENV
set -eu
package=$(cd "$1/python" && pwd) venv=$2
if [ ! -e "$venv/bin/python" ]; then
  [ ! -e "$venv" ] || [ -z "$(ls -A "$venv")" ] || { echo "$venv is there, and no virtual environment: give another folder"; exit 4; }
  /usr/bin/python3 -m venv --system-site-packages "$venv"  # with Debian's NumPy
fi
site=$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_paths()["purelib"])')
echo "$package" >"$site/talus.pth"
"$venv/bin/python" -c 'import talus' || { rm "$site/talus.pth"; exit 4; }
echo "$venv/bin/python imports talus of $package"
