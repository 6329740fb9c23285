#!/usr/bin/env bash
# Installs the Debian 12 packages that the project needs, as far as they are missing:
# as root, or through sudo. Otherwise prints the command to run. Does nothing, and
# asks nobody, when all are there.
#
#   scripts/install_deps.sh [GROUP]...
#
# GROUP: build (to build the program and pack it), evaluation (to run scripts/evaluate
# and the demo), tests (to build all the rest), cluster (Slurm, with which scripts/cluster
# is tested); if none is named, the first two.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
build=(
  # Tools.
  g++ cmake ninja-build ccache dpkg-dev file git python3 python3-venv ca-certificates
  # COLMAP.
  libboost-filesystem-dev libboost-graph-dev libboost-program-options-dev
  libboost-system-dev libboost-test-dev libceres-dev libcgal-dev libeigen3-dev
  libflann-dev libfreeimage-dev libgflags-dev libglew-dev libgoogle-glog-dev
  liblz4-dev libmetis-dev libqt5opengl5-dev libsqlite3-dev libsuitesparse-dev
  qtbase5-dev
  # The engine.
  libhwy-dev libopencv-contrib-dev libopencv-dev
)
evaluation=(
  curl libjs-three p7zip-full python3 python3-jinja2 python3-markdown
  python3-matplotlib python3-numpy python3-opencv python3-pydantic python3-scipy
)
tests=(
  libbenchmark-dev libboost-context-dev libgtest-dev
  pybind11-dev python3-dev python3-setuptools  # The Python package.
)
cluster=(munge slurm-client slurmctld slurmd)
# Come along with what else of the tests is installed, but are not missed: povray renders
# scenes of examples/, and chromium looks at pages (their tests are skipped without them).
optional=()

[[ $# -gt 0 ]] || set -- build evaluation
packages=()
for group in "$@"; do
  case $group in
    build) packages+=("${build[@]}") ;;
    tests) packages+=("${tests[@]}") optional=(povray chromium) ;;
    evaluation) packages+=("${evaluation[@]}") ;;
    cluster) packages+=("${cluster[@]}") ;;
    *)
      echo "ERROR: there is no group $group; usage:" \
        "$(basename "$0") [build|evaluation|tests|cluster]..." >&2
      exit 1
      ;;
  esac
done

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "WARNING: This is no Debian: see to it yourself that there is what" \
    "these packages hold: ${packages[*]}" >&2
  exit 0
fi

missing=()
for name in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${Status}' "$name" 2>/dev/null || true)
  [[ $status == "install ok installed" ]] || missing+=("$name")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  exit 0
fi

install=(apt-get install --no-install-recommends "${missing[@]}" "${optional[@]}")
as_root=(env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8)
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null || ! { sudo -n true 2>/dev/null || [[ -t 0 ]]; }
  then
    echo "ERROR: Packages are missing. As root, run: apt-get update &&" \
      "${install[*]}" >&2
    exit 1
  fi
  as_root=(sudo "${as_root[@]}")
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
# Runs a command of apt's. Its lines for programs, such as "pmstatus:g++:45.5:...",
# tell how far it is. They need a descriptor of their own, which sudo would close.
step() {
  local what=$1
  shift
  "${as_root[@]}" sh -c 'exec "$@" -o APT::Status-Fd=3 3>&1 2>&1' - "$@" |
    sed -u -E 's/^(dl|pm)status:.*:([0-9]+)\.[0-9]+:/[\2%] &/' |
    "$here/progress.sh" "$what" "$log"
}
install() {
  step "Reading the lists of packages" apt-get update || return
  # What it takes, in apt's words.
  "${as_root[@]}" "${install[@]}" --assume-no 2>/dev/null |
    grep -E '^(Need to get|After this operation)'
  step "Downloading packages" "${install[@]}" -y --download-only &&
    step "Installing packages" "${install[@]}" -y
}
echo "Installing ${#missing[@]} packages and what they need ..."
if ! install; then
  tail -n 20 "$log" >&2
  echo "ERROR: Packages could not be installed (see above). As root, run:" \
    "apt-get update && ${install[*]}" >&2
  exit 1
fi
