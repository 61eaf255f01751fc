#!/bin/sh
# The program (first argument) loads the library of importers, exporters and imitations for what needs it, and for nothing else; and
# it renders without the libraries of its other commands, of the laboratory and of the studio.
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
if grep -E 'libetendue_(commands|laboratory|studio)' "$folder/output"; then
  echo "a render loaded these libraries"
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

# Without that library a misspelt class of the program is told, and what might be a class of the library is told as such.
mkdir "$folder/alone"
cp "$1" "$folder/alone/etendue"
for library in 'libetendue\.so' 'libetendue_app\.so'; do
  ldd "$1" | awk "/$library/ { print \$3, \"$folder/alone/\" \$1 }" | xargs cp -L
done
tells() {  # a class, and what is told of it
  printf 'ball = %s {}\n' "$1" >"$folder/misspelt.etd"
  LD_LIBRARY_PATH="$folder/alone" "$folder/alone/etendue" render "$folder/misspelt.etd" >"$folder/output" 2>&1 || true
  if ! grep -q "$2" "$folder/output"; then
    echo "of $1 this is told, without '$2':"
    cat "$folder/output"
    exit 1
  fi
}
tells Sphre "there is no class 'Sphre' (did you mean 'Sphere'?)"
tells Qwertyuiop 'cannot be loaded'

# Other commands than `render` are told to be missing, not to be unknown.
LD_LIBRARY_PATH="$folder/alone" "$folder/alone/etendue" check "$folder/misspelt.etd" >"$folder/output" 2>&1 && status=0 || status=$?
if [ "$status" != 1 ]; then
  echo "without the library of commands the status is $status"
  exit 1
fi
if ! grep -q "the library of commands ('./etendue build' builds it) cannot be loaded" "$folder/output"; then
  echo "without the library of commands this is told:"
  cat "$folder/output"
  exit 1
fi
