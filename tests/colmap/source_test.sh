#!/usr/bin/env bash
# Checks the scripts that get and patch COLMAP's source, without a network.
#
#   source_test.sh REPOSITORY
set -euo pipefail

scripts=$1/scripts
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
failures=0

# expect_error PATTERN COMMAND...: it fails with one line that matches.
expect_error() {
  local pattern=$1 status=0
  shift
  "$@" >"$tmp/out" 2>&1 || status=$?
  if [[ $status == 0 || $(wc -l <"$tmp/out") != 1 ]] ||
    ! grep -qE "^ERROR: .*$pattern" "$tmp/out"; then
    echo "FAILED: expected an error like '$pattern' from: $*"
    echo "status $status:"
    cat "$tmp/out"
    failures=$((failures + 1))
  fi
}

expect() {
  if ! "$@"; then
    echo "FAILED: $*"
    failures=$((failures + 1))
  fi
}

# A stand-in for COLMAP's source, and a series for it.
source=$tmp/source
mkdir -p "$source"/{cmake,doc,lib,src/util} "$tmp/patches"
echo 'set(COLMAP_VERSION "3.8")' >"$source/CMakeLists.txt"
touch "$source"/{COPYING.txt,doc/COLMAP.desktop,cmake/x,lib/y}
printf 'one\ntwo\nthree\n' >"$source/src/a.txt"
printf 'same\n' >"$source/src/b.txt"
write_patch() {
  printf -- '--- a/src/a.txt\n+++ b/src/a.txt\n@@ -2 +2 @@\n-two\n+%s\n' "$1" \
    >"$tmp/patches/first.patch"
}
write_patch TWO
printf '# A comment.\nfirst.patch\n' >"$tmp/patches/series"
export PATCHES_DIR=$tmp/patches
prepare() {
  COLMAP_SOURCE_DIR=$source "$scripts/prepare_colmap.sh" "$tmp/dest"
}

# The patch arrives; doing it again changes nothing, not even times.
expect prepare
expect grep -q TWO "$tmp/dest/src/a.txt"
touch -d '2001-01-01' "$tmp/dest/src/a.txt" "$tmp/dest/src/b.txt"
mkdir -p "$tmp/dest/src/util"
echo made >"$tmp/dest/src/util/version.h"
expect prepare
expect test "$(date -r "$tmp/dest/src/a.txt" +%Y)" = 2001

# A changed patch is applied by itself, and only its files are touched.
write_patch 2
expect prepare
expect test "$(cat "$tmp/dest/src/a.txt")" = $'one\n2\nthree'
expect test "$(date -r "$tmp/dest/src/a.txt" +%Y)" != 2001
expect test "$(date -r "$tmp/dest/src/b.txt" +%Y)" = 2001
expect test -e "$tmp/dest/src/util/version.h"

# A patch that is dropped is undone; files that are gone go.
echo '# Nothing.' >"$tmp/patches/series"
touch "$tmp/dest/src/stray.txt"
expect prepare
expect grep -q two "$tmp/dest/src/a.txt"
expect test ! -e "$tmp/dest/src/stray.txt"

# What can be wrong with patches and sources.
echo 'missing.patch' >"$tmp/patches/series"
expect_error 'missing.patch, which is missing' prepare
echo 'first.patch' >"$tmp/patches/series"
printf 'other\n' >"$source/src/a.txt"
expect_error 'first.patch does not apply' prepare
echo 'set(COLMAP_VERSION "3.7")' >"$source/CMakeLists.txt"
expect_error 'is not the source of COLMAP 3.8' prepare
source=$tmp/nowhere
expect_error 'there is no folder' prepare

# What can be wrong with the archives.
export TAPA_CACHE_DIR=$tmp/cache
mkdir "$TAPA_CACHE_DIR"
TAPA_OFFLINE=1 expect_error 'is not in .* TAPA_OFFLINE' \
  "$scripts/fetch_colmap.sh" "$tmp/fetched"
echo broken >"$TAPA_CACHE_DIR/colmap_3.8.orig.tar.gz"
expect_error 'does not have the expected SHA-256 sum' \
  "$scripts/fetch_colmap.sh" "$tmp/fetched"
expect test ! -e "$tmp/fetched"

[[ $failures == 0 ]] && echo "All passed."
