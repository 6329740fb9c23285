#!/usr/bin/env bash
# Builds the program and packs it into a .deb, for the Debian that it is built on:
#
#   scripts/package.sh [CMAKE_OPTION]...
#
# BUILD_DIR names another folder than build/. The package goes there.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
build=$(realpath -m "${BUILD_DIR:-$here/../build}")

"$here/build.sh" "$@"
for tool in dpkg-shlibdeps file; do
  command -v "$tool" >/dev/null || { echo "ERROR: there is no $tool" >&2; exit 1; }
done
rm -f "$build"/colmap-tapa_*.deb
if ! cpack --config "$build/CPackConfig.cmake" -B "$build" >"$build/package.log" 2>&1
then
  tail -n 20 "$build/package.log" >&2
  echo "ERROR: The package failed; all output is in $build/package.log." >&2
  exit 1
fi
ls "$build"/colmap-tapa_*.deb
