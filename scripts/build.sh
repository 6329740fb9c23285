#!/usr/bin/env bash
# Installs what is missing and builds everything into build/: the program stands
# at build/bin/colmap.
#
#   scripts/build.sh [CMAKE_OPTION]...
#
# BUILD_DIR names another folder than build/. Offline it works once the packages
# are installed and COLMAP's source has been fetched.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
build=${BUILD_DIR:-$root/build}

"$root/scripts/install_deps.sh"

generator=()
if [[ ! -e $build/CMakeCache.txt ]] && command -v ninja >/dev/null; then
  generator=(-G Ninja)
fi

log=$build/build.log
mkdir -p "$build"
run() {
  if ! "$@" >>"$log" 2>&1; then
    grep -m 1 '^ERROR' "$log" >&2 ||
      grep -A 20 -m 1 -E 'CMake Error|error:|FAILED:' "$log" >&2 ||
      tail -n 20 "$log" >&2
    echo "ERROR: The build failed; all of its output is in $log." >&2
    exit 1
  fi
}
: >"$log"
echo "Building into $build (the first time takes 16 minutes of CPU time) ..."
run cmake -S "$root" -B "$build" "${generator[@]}" "$@"
run nice cmake --build "$build" --parallel "$(nproc)"
