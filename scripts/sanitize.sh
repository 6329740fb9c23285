#!/usr/bin/env bash
# Builds our own code with sanitizers and runs the tests with it: whatever a sanitizer finds
# makes its test fail.
#
#   scripts/sanitize.sh address|thread [CTEST_OPTION]...
#
# address: memory that is not there, leaks, and undefined behaviour (ASan, UBSan); thread: data
# that threads share unguarded (TSan). COLMAP is taken as it was built in build/, which
# BUILD_DIR names otherwise, and libraries as they are; what these do is suppressed, one by one
# and with the reason, in tests/sanitizers/. Builds into build/sanitize_address or _thread.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")
build=$(realpath -m "${BUILD_DIR:-$root/build}")
kind=${1:-}
if [[ $kind != address && $kind != thread ]]; then
  echo "ERROR: usage: $(basename "$0") address|thread [CTEST_OPTION]..." >&2
  exit 1
fi
out=$build/sanitize_$kind

"$here/build.sh"
BUILD_DIR=$out "$here/build.sh" -DTAPA_SANITIZE="$kind" -DTAPA_COLMAP_BUILD="$build" \
  -DTAPA_WITH_CUDA=OFF -DTAPA_BUILD_BENCHMARKS=OFF \
  -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" all

# Left out: what starts no program of ours (evaluation., scripts that fetch and pack), what is
# loaded into Python, which is not instrumented, and what measures time or quality.
# Neither can a program with a sanitizer live in a small address space, or with another library
# before the sanitizer's.
left_out='^(evaluation\.|examples\.|packaging|colmap_source_test|python|scenes|fuzz|reliability)'
left_out+='|^end_to_end\.(quality|interchange|eth3d|evaluate|install|memory|security)'
# The emulated GPU runs the threads of a kernel in turns on one thread of the system, so that there
# is nothing to find in long estimations; and ThreadSanitizer, which cannot follow exceptions out of
# such turns, ends where thousands of kernels fail.
[[ $kind == address ]] ||
  left_out+='|^end_to_end\.(automatic|gui|emulated_gpu)|\.full_size$|^cuda_estimate_emulated|SurvivesAnyFailure|^gpu_benchmark_emulated'

suppressions=$root/tests/sanitizers
# A test asks for more memory than there can be, and for an answer to it. COLMAP's Poisson mesher
# frees with delete[] what it took with malloc.
export ASAN_OPTIONS="allocator_may_return_null=1:alloc_dealloc_mismatch=0:detect_stack_use_after_return=0:detect_leaks=1:exitcode=66"
export LSAN_OPTIONS="suppressions=$suppressions/leaks.txt:print_suppressions=0"
export UBSAN_OPTIONS="print_stacktrace=1"
# Tests with COLMAP's Poisson mesher skip where this is set: threads of OpenMP, whose library is not
# instrumented, meet there where ThreadSanitizer does not see it, thousands of times.
[[ $kind == address ]] ||
  export TSAN_OPTIONS="allocator_may_return_null=1:suppressions=$suppressions/threads.txt:halt_on_error=1:exitcode=66"
cd "$out"
ctest --parallel "$(nproc)" --timeout 1800 --output-on-failure \
  -LE '^(full_size|bare_root|fuzz)$' -E "$left_out" "${@:2}"
