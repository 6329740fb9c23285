#!/usr/bin/env bash
# Installs the Debian 12 packages that the project is built and tested with, as
# far as they are missing: as root, or through sudo. Otherwise prints the
# command to run. Does nothing, and asks nobody, when all are there.
set -euo pipefail

packages=(
  # Tools.
  g++ cmake ninja-build ccache git python3 python3-venv ca-certificates
  # Scores and reports.
  curl libjs-three p7zip-full python3-jinja2 python3-markdown python3-matplotlib
  python3-numpy python3-opencv python3-pydantic python3-scipy
  # COLMAP.
  libboost-filesystem-dev libboost-graph-dev libboost-program-options-dev
  libboost-system-dev libboost-test-dev libceres-dev libcgal-dev libeigen3-dev
  libflann-dev libfreeimage-dev libgflags-dev libglew-dev libgoogle-glog-dev
  liblz4-dev libmetis-dev libqt5opengl5-dev libsqlite3-dev libsuitesparse-dev
  qtbase5-dev
  # The engine, the tests and the benchmarks.
  libbenchmark-dev libboost-context-dev libgtest-dev libhwy-dev libopencv-contrib-dev libopencv-dev
)
# Come along when something is installed, but are not missed: povray renders scenes of
# examples/, and chromium looks at pages (their tests are skipped without them).
optional=(povray chromium)

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "WARNING: This is no Debian: see to it yourself that there is what" \
    "these packages hold: ${packages[*]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [[ $status == "install ok installed" ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  exit 0
fi

install=(apt-get install -y --no-install-recommends "${missing[@]}" "${optional[@]}")
if [[ $(id -u) -eq 0 ]]; then
  as_root=(env DEBIAN_FRONTEND=noninteractive)
elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [[ -t 0 ]]; }
then
  as_root=(sudo env DEBIAN_FRONTEND=noninteractive)
else
  echo "ERROR: Packages are missing. As root, run: apt-get update &&" \
    "${install[*]}" >&2
  exit 1
fi
echo "Installing ${#missing[@]} packages ..."
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { "${as_root[@]}" apt-get update && "${as_root[@]}" "${install[@]}"; } \
  >"$log" 2>&1; then
  tail -n 20 "$log" >&2
  echo "ERROR: Packages could not be installed (see above). As root, run:" \
    "apt-get update && ${install[*]}" >&2
  exit 1
fi
