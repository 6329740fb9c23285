#!/usr/bin/env bash
# Installs what is missing, builds everything, runs the tests, several at a time,
# and tells which took longest. Arguments go to ctest: scripts/test.sh -R correlation.
# Tests that are long only because their images are large (label full_size), and those
# that make whole Debian roots (bare_root) or make up files for a long time (fuzz), are left
# out unless an argument names the label: scripts/test.sh -L full_size. BUILD_DIR names another folder than build/.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
"$here/build.sh" all
cd "${BUILD_DIR:-$here/../build}"

[[ "$*" == *full_size* || "$*" == *bare_root* || "$*" == *"-L fuzz"* ]] ||
  set -- -LE '^(full_size|bare_root|fuzz)$' "$@"
rm -f tests.xml
status=0
ctest --parallel "$(nproc)" --timeout 1800 --output-on-failure \
  --output-junit "$PWD/tests.xml" "$@" || status=$?
if [[ -e tests.xml ]]; then
  # Of each: <testcase name="..." classname="..." time="seconds" ...
  awk -F '"' '/^\t<testcase /{ print $6, $2 }' tests.xml | LC_ALL=C sort -gr |
    LC_ALL=C awk '
      NR == 1 { print "\nThe slowest tests:" }
      NR <= 10 { printf "%8.1f s  %s\n", $1, substr($0, length($1) + 2) }
      { sum += $1 }
      END { if (NR) printf "%8.1f s  all %d, one after the other\n", sum, NR }'
fi
exit "$status"
