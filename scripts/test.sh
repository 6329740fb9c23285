#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests. Arguments go to
# ctest, for example: scripts/test.sh -R correlation. BUILD_DIR names another
# folder than build/.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
"$here/build.sh"
cd "${BUILD_DIR:-$here/../build}"
exec ctest --output-on-failure --timeout 1800 "$@"
