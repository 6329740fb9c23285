#!/usr/bin/env bash
# Installs what is missing and builds the program, build/bin/colmap.
#
#   scripts/build.sh [CMAKE_OPTION]... [TARGET]...
#
# TARGET: what to build instead; all: the program, the tests and the benchmarks.
# BUILD_DIR names another folder than build/. Offline it works once the packages
# are installed and COLMAP's source has been fetched.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
build=$(realpath -m "${BUILD_DIR:-$root/build}")
log=$build/build.log
options=() targets=() packages=(build evaluation)
for word in "$@"; do
  if [[ $word == -* ]]; then options+=("$word"); else targets+=("$word"); fi
done
if [[ ${#targets[@]} -gt 0 ]]; then
  packages+=(tests)
else
  targets=(colmap_exe)
fi

fail() {
  grep -m 1 '^ERROR' "$log" >&2 ||
    grep -A 20 -m 1 -E 'CMake Error|error:|FAILED:' "$log" >&2 ||
    tail -n 20 "$log" >&2
  echo "ERROR: The build failed; all of its output is in $log." >&2
  exit 1
}

configure() {
  local generator=()
  if [[ ! -e $build/CMakeCache.txt ]] && command -v ninja >/dev/null; then
    generator=(-G Ninja)
  fi
  cmake -S "$root" -B "$build" "${generator[@]}" "${options[@]}" >>"$log" 2>&1
}

# What the build will take, if there is anything to build and it can be told.
announce() {
  local cores=$1 files minutes
  # The full name keeps ninja from making build.ninja anew, which ends a dry run.
  files=$(ninja -C "$build" -f "$build/build.ninja" -n "${targets[@]}" 2>/dev/null |
    grep -c '\] Building') || return 0
  minutes=$((files * seconds_per_file / cores / 60 + 1))
  echo "Building ${targets[*]}: $files files to compile on $cores cores, at low" \
    "priority; about $minutes minutes, less for what ccache knows." \
    "It takes up to 0.3 GB in $build, where $(df -h --output=avail "$build" |
      tail -n 1 | tr -d ' ') are free."
}

# Of CPU time, on average.
seconds_per_file=5

"$root/scripts/install_deps.sh" "${packages[@]}"
mkdir -p "$build"
: >"$log"
configure || fail
cores=$(nproc)
announce "$cores"
# As make tells it by itself.
export NINJA_STATUS='[%p] '
nice cmake --build "$build" --parallel "$cores" --target "${targets[@]}" 2>&1 |
  "$root/scripts/progress.sh" "Building" "$log" || fail
