#!/usr/bin/env bash
# What scripts/interchange.sh says where it cannot or must not run.
#
#   interchange_test.sh SOURCE_DIR BIN_DIR SCRATCH
set -euo pipefail

script=$1/scripts/interchange.sh
photos=$1/examples/room/images
export TAPA_BIN_DIR=$2
scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch/mine"
echo precious >"$scratch/mine/photos"

# expect STATUS TEXT ARGUMENT...: one line with the text, and that exit status.
expect() {
  local status=$1 text=$2 got=0 said
  shift 2
  said=$("$script" "$@" 2>&1) || got=$?
  if [[ $got != "$status" || $said != *"$text"* || $said == *$'\n'* ]]; then
    echo "FAIL: $* exited with $got and said: $said" >&2
    exit 1
  fi
  echo "PASS: $said"
}

expect 1 "there is no folder" "$scratch/nowhere" "$scratch/out"
expect 1 "is not empty" "$photos" "$scratch/mine"
[[ $(cat "$scratch/mine/photos") == precious ]]
MAX_IMAGE_SIZE=big expect 1 "MAX_IMAGE_SIZE" "$photos" "$scratch/out"
TAPA_BIN_DIR=$scratch expect 1 "has no colmap" "$photos" "$scratch/out"
# An index that is not there, and nothing kept from an earlier run.
PIP_INDEX_URL=file://$scratch/index PIP_FIND_LINKS='' PIP_EXTRA_INDEX_URL='' \
  expect 77 "SKIPPED: PyPI cannot be reached" "$photos" "$scratch/out"
[[ -z $(compgen -G "$scratch/out/environment.*") ]]
