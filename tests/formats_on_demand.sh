#!/bin/sh
# The program (first argument) loads the library of importers, exporters and imitations for what needs it, and for nothing else.
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
cat >"$folder/imitation.etd" <<'END'
Job {
    renderer: PathTracer { max_depth: 3, samples: 4 }
    camera: PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 45 deg }
    image: ImageBuffer { width: 24, height: 16, filter: BoxFilter {} }
    scene: BruteForceScene { objects: [
        Sphere { radius: 1 m, shader: LossyPlastic {} }
        Sphere { radius: 0.5 m, transform: translate(0, 2 m, -1 m), emission: DiffuseEmission { radiance: 5 } } ] }
}
END
for needs in "classes" "render $folder/imitation.etd --size 8x6 --samples 1 --quiet -o $folder/imitation.npy" \
  "render $folder/triangle.obj --size 8x6 --samples 1 --quiet -o $folder/triangle.npy"; do
  # shellcheck disable=SC2086  # words
  if ! loads "$1" $needs; then
    echo "not loaded: $needs"
    exit 1
  fi
done
