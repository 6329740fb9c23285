#!/usr/bin/env bash
# Makes up damaged and hostile files for every reader of files, and looks for what they do:
# crashes, undefined behaviour, memory or time without bounds, and whatever else is no refusal
# of one line. What is found is kept, and its exit status is 1.
#
#   scripts/fuzz.sh [-r RUNS] [SECONDS_PER_READER [READER]...]
#
# Readers in C++ are built with clang, libFuzzer, ASan and UBSan into build/fuzz; those of the
# evaluation run with atheris, of the Python package index. Each is fuzzed for so many seconds
# (60), or, with -r, until it has seen so many inputs in all calls together, however long that
# takes. What inputs have reached new code is kept in build/fuzz/corpus, and the next call goes
# on from there. A line per reader tells how many inputs there were.
#
# BUILD_DIR names another folder than build/, which has to hold the built program. Exit status
# 77: what it needs is not there, and cannot be installed.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")
build=$(realpath -m "${BUILD_DIR:-$root/build}")
out=$build/fuzz
source "$here/python_environment.sh"

fail() {
  echo "ERROR: $*" >&2
  exit 1
}

skip() {
  echo "SKIPPED: $*"
  exit 77
}

runs=
if [[ ${1:-} == -r ]]; then
  runs=${2:-}
  shift 2 || fail "-r needs a number of inputs"
  [[ $runs =~ ^[1-9][0-9]*$ ]] || fail "$runs is no number of inputs"
fi
seconds=${1:-60}
[[ $seconds =~ ^[1-9][0-9]*$ ]] || fail "$seconds is no number of seconds"
chosen=("${@:2}")

cpp_readers=() python_readers=()
for file in "$root"/tests/fuzz/*_fuzz.cc; do
  cpp_readers+=("$(basename "$file" _fuzz.cc)")
done
while read -r name; do
  python_readers+=("$name")
done < <(sed -n '/^_READERS/,/^}/s/^    "\([a-z_]*\)":.*/\1/p' "$root/tests/fuzz/readers_fuzz.py")

is_one_of() {
  local word=$1
  shift
  [[ " $* " == *" $word "* ]]
}

is_chosen() { [[ ${#chosen[@]} -eq 0 ]] || is_one_of "$1" "${chosen[@]}"; }

for name in "${chosen[@]}"; do
  is_one_of "$name" "${cpp_readers[@]}" "${python_readers[@]}" ||
    fail "there is no reader $name; there are ${cpp_readers[*]} ${python_readers[*]}"
done

# Debian's packages of clang, without which nothing here can be built.
find_clang() {
  clang++ -fsanitize=fuzzer,address -x c++ - -o /dev/null 2>/dev/null <<<\
    'extern "C" int LLVMFuzzerTestOneInput(const char*, long) { return 0; }' && return
  [[ $(id -u) -eq 0 ]] && command -v apt-get >/dev/null &&
    apt-get install -y --no-install-recommends clang libclang-rt-14-dev libomp-14-dev \
      >"$out/packages.log" 2>&1
}

build_readers() {
  [[ -e $build/bin/colmap ]] || "$here/build.sh"
  find_clang || skip "there is no clang with libFuzzer; as root, run:" \
    "apt-get install clang libclang-rt-14-dev libomp-14-dev"
  # COLMAP is taken as it was built there, by another compiler.
  nice cmake -S "$root" -B "$out/build" -G Ninja -DCMAKE_C_COMPILER=clang \
    -DCMAKE_CXX_COMPILER=clang++ -DTAPA_SANITIZE=fuzzer -DTAPA_COLMAP_BUILD="$build" \
    -DTAPA_WITH_CUDA=OFF -DTAPA_BUILD_BENCHMARKS=OFF >"$out/build.log" 2>&1 &&
    nice cmake --build "$out/build" --parallel "$(nproc)" --target tapa_fuzzers \
      >>"$out/build.log" 2>&1 || fail "the readers cannot be built; see $out/build.log"
}

install_atheris() {
  [[ -x $out/python/bin/python ]] && "$out/python/bin/python" -c "import atheris" 2>/dev/null &&
    return
  rm -rf "$out/python"
  # The readers run on Debian's packages of Python.
  /usr/bin/python3 -m venv --system-site-packages "$out/python" >"$out/python.log" 2>&1 || return
  download_packages "$out/python" "$out/wheels" "$out/python.log" atheris
  install_packages "$out/python" "$out/wheels" "$out/python.log" atheris
}

# count_before READER: inputs of earlier calls.
count_before() { cat "$out/counts/$1" 2>/dev/null || echo 0; }

# fuzz READER COMMAND...: adds to the counts, and to the status.
status=0
fuzz() {
  local reader=$1 log=$out/logs/$1.log corpus=$out/corpus/$1 limit count before
  shift
  before=$(count_before "$reader")
  limit=(-max_total_time="$seconds")
  if [[ -n $runs ]]; then
    [[ $before -lt $runs ]] || { echo "$reader: $before inputs in all"; return; }
    limit=(-runs=$((runs - before)))
  fi
  mkdir -p "$corpus" "$out/findings/$reader"
  local code=0
  nice -n 10 "$@" "$corpus" "$out/seeds/$reader" "${limit[@]}" -dict="$root/tests/fuzz/words.dict" \
    -max_len=4096 -timeout=20 -rss_limit_mb=2048 -malloc_limit_mb=512 -print_final_stats=1 \
    -artifact_prefix="$out/findings/$reader/" >"$log" 2>&1 || code=$?
  count=$(sed -n 's/^stat::number_of_executed_units: *//p; s/^Done \([0-9]*\) runs.*/\1/p' "$log" |
    tail -n 1)
  echo $((before + ${count:-0})) >"$out/counts/$reader"
  if [[ $code -ne 0 ]]; then
    status=1
    echo "$reader: FOUND $(grep -m 1 -E '^(FOUND|==[0-9]+== *ERROR|.*runtime error|[A-Za-z.]*Error: )' \
      "$log"); see $log and $out/findings/$reader"
  else
    echo "$reader: ${count:-0} inputs, $((before + ${count:-0})) in all, nothing found"
  fi
}

mkdir -p "$out"/{counts,logs,corpus}
/usr/bin/python3 "$root/tests/fuzz/seeds.py" "$out/seeds"
for name in "${cpp_readers[@]}"; do
  is_chosen "$name" || continue
  [[ -n ${built:-} ]] || { build_readers; built=1; }
  fuzz "$name" "$out/build/fuzzers/${name}_fuzz"
done
for name in "${python_readers[@]}"; do
  is_chosen "$name" || continue
  [[ -n ${installed:-} ]] || { install_atheris || skip "atheris is not to be had; see $out/python.log"; installed=1; }
  fuzz "$name" "$out/python/bin/python" -B "$root/tests/fuzz/readers_fuzz.py" "$name"
done
exit "$status"
