#!/usr/bin/env bash
# The Debian package has what it should have.
#
#   package_test.sh SOURCE_DIR BUILD_DIR SCRATCH
set -euo pipefail

build=$2 scratch=$3
for tool in dpkg-deb dpkg-shlibdeps file; do
  command -v "$tool" >/dev/null ||
    { echo "SKIPPED: there is no $tool"; exit 77; }
done
rm -rf "$scratch"
mkdir -p "$scratch"
cpack --config "$build/CPackConfig.cmake" -B "$scratch" >"$scratch/log" 2>&1 ||
  { tail -n 20 "$scratch/log"; exit 1; }
package=$(echo "$scratch"/colmap-tapa_*.deb)

# expect WHAT TEXT PATTERN
expect() {
  grep -q -E -e "$3" <<<"$2" ||
    { echo "FAIL: $1: nothing is like $3 in: $2" >&2; exit 1; }
  echo "PASS: $1: $3"
}

control=$(dpkg-deb -f "$package")
expect control "$control" '^Package: colmap-tapa$'
expect control "$control" '^Conflicts: colmap$'
expect control "$control" '^Provides: colmap \(= 3\.8\)$'
# Of the libraries that it links to, found by dpkg-shlibdeps.
for library in libc6 libqt5widgets5 libopencv-contrib406 libhwy1; do
  expect control "$control" "^Depends:.* $library \\(>= [^)]+\\)"
done
files=$(dpkg-deb -c "$package")
expect files "$files" '^-rwxr-xr-x root/root .* \./usr/bin/colmap$'
for name in applications/COLMAP.desktop doc/colmap-tapa/copyright \
  doc/colmap-tapa/copyright.{colmap,LSD,PBA,PoissonRecon,SiftGPU,VLFeat}; do
  expect files "$files" "^-rw-r--r-- root/root .* \\./usr/share/$name\$"
done
# Nothing else.
others=$(grep -v -E '/$|/usr/bin/colmap$|COLMAP.desktop$|/doc/colmap-tapa/copyright' \
  <<<"$files" || true)
[[ -z $others ]] || { echo "FAIL: there is more: $others" >&2; exit 1; }

dpkg-deb -x "$package" "$scratch/root"
said=$("$scratch/root/usr/bin/colmap" patch_match_stereo --help)
expect program "$said" PatchMatchStereo.num_threads
