#!/usr/bin/env bash
# Packs the tests and the benchmark of the CUDA backend into one folder that runs
# on a machine with an NVIDIA driver and nothing else, and tries it here.
#
#   scripts/gpu_bundle.sh [FOLDER]
#
# FOLDER is build/gpu_bundle if it is not named. On the machine with the GPU:
#
#   FOLDER/run.sh          # tests, then a table of speeds
#
# BUILD_DIR names another build folder than build/. It must have been built with
# CUDA (scripts/build.sh finds nvcc by itself).
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
build=${BUILD_DIR:-$root/build}
out=${1:-$build/gpu_bundle}
max_megabytes=60

cmake --build "$build" --target cuda_device_test gpu_benchmark
# What nvcc said about the kernels.
if [[ ! -e $build/src/mvs/kernel_resources.txt ]]; then
  echo "ERROR: $build was built without CUDA; is there nvcc 12 or newer?" >&2
  exit 1
fi

rm -rf "$out"
mkdir -p "$out/lib"
for program in cuda_device_test gpu_benchmark; do
  cp "$build/bin/$program" "$out/"
  strip "$out/$program"
  # What is not part of the C library comes along.
  ldd "$out/$program" | awk '$2 == "=>" && $3 != "" { print $1, $3 }' |
    while read -r name path; do
      case $name in
        libc.so.* | libm.so.* | libdl.so.* | librt.so.* | libpthread.so.*) ;;
        *) cp -L "$path" "$out/lib/$name" ;;
      esac
    done
done

cat >"$out/run.sh" <<'RUN'
#!/bin/sh
# Tests the CUDA backend on this machine's GPU and measures its speed. Exits
# with 77 where there is no GPU.
here=$(cd "$(dirname "$0")" && pwd)
export LD_LIBRARY_PATH="$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
tests=0
"$here/cuda_device_test" || tests=$?
"$here/gpu_benchmark" "$@" || exit
# Comes with CUDA's toolkit; slow.
if [ "$tests" -eq 0 ] && command -v compute-sanitizer >/dev/null; then
  for tool in memcheck racecheck synccheck initcheck; do
    compute-sanitizer --tool "$tool" --error-exitcode 1 "$here/cuda_device_test" \
      --gtest_filter='*ReportsConsistentViews' || tests=$?
  done
fi
exit "$tests"
RUN
chmod +x "$out/run.sh"

megabytes=$(du -sm "$out" | cut -f1)
if [[ $megabytes -gt $max_megabytes ]]; then
  echo "ERROR: $out has $megabytes MB, more than $max_megabytes." >&2
  exit 1
fi
echo "$out: $megabytes MB"
status=0
"$out/run.sh" || status=$?
if [[ $status -ne 0 && $status -ne 77 ]]; then
  exit "$status"
fi
