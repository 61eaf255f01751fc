#!/bin/sh
# The program (first argument) loads the library of importers and exporters for what needs it, and for nothing else.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

loads() {
  LD_DEBUG=files "$@" >"$folder/output" 2>&1 || { cat "$folder/output"; exit 1; }
  grep -q 'libetendue_formats' "$folder/output"
}

if loads "$1" render scenes/cornell_box.etd --size 8x6 --samples 1 --quiet -o "$folder/picture.npy"; then
  echo "a description in our own language loaded the library of foreign formats"
  exit 1
fi
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$folder/triangle.obj"
for needs in "classes" "render $folder/triangle.obj --size 8x6 --samples 1 --quiet -o $folder/triangle.npy"; do
  # shellcheck disable=SC2086  # words
  if ! loads "$1" $needs; then
    echo "not loaded: $needs"
    exit 1
  fi
done
