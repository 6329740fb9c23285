#!/usr/bin/env bash
# Installs the Python package and today's COLMAP with pip, and goes from photographs to
# points with python/example.py.
#
#   example_test.sh SOURCE_DIR PHOTOS OUT
#
# Everything but the downloads, in OUT/wheels, is made anew. Exit status: 0 all well, 1 a
# check failed, 77 the packages could not be had. BUILD_DIR: where the program is built.
set -euo pipefail

root=$1 photos=$2 out=$3
size=360  # Of the photographs, which is enough for poses and fast.
source "$root/scripts/python_environment.sh"

skip() {
  echo "SKIPPED: $*"
  exit 77
}

fail() {
  tail -n 15 "$log" >&2
  echo "FAIL: $*" >&2
  exit 1
}

rm -rf "$out"/{environment,photos,reconstruction}
mkdir -p "$out/wheels"
environment=$out/environment
trap 'rm -rf "$environment"' EXIT
log=$out/pip.log
make_environment "$environment" "$log" ||
  skip "python3 cannot make virtual environments here (the package python3-venv is missing)"
download_packages "$environment" "$out/wheels" "$log" pycolmap numpy setuptools wheel pybind11
install_packages "$environment" "$out/wheels" "$log" pycolmap numpy ||
  skip "PyPI cannot be reached, or has no pycolmap for this machine ($log)"
install_packages "$environment" "$out/wheels" "$log" "$root/python" || fail "pip could not install it"

python=$environment/bin/python
log=$out/example.log
# Elsewhere, so that nothing is found by chance.
cd "$out"
"$python" "$root/scripts/interchange/today.py" shrink "$photos" "$out/photos" "$size" \
  >"$log" 2>&1 || fail "photographs could not be made smaller"
"$python" "$root/python/example.py" "$out/photos" "$out/reconstruction" >"$log" 2>&1 ||
  fail "the example ended with an error"
depths=$(tr '\r' '\n' <"$log" | grep -c ': depth at [1-9]' || true)
points=$(sed -n '/^element vertex/{s/.* //p;q}' "$out/reconstruction/dense/fused.ply" ||
  true)
[[ $depths -ge 6 ]] || fail "only $depths photographs have depth"
[[ ${points:-0} -ge 5000 ]] || fail "there are ${points:-no} points"
echo "PASS: $depths photographs with depth, $points points," \
  "$("$python" -c 'import pycolmap; print("pycolmap", pycolmap.__version__)')"
