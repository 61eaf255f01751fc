#!/usr/bin/env bash
# Runs the tests of the studio's page, or these files of them; `--but FILE` leaves one out. Without Node, Chromium, the built page or their packages it says so and is skipped (77):
# `./etendue test` installs and builds them.
set -euo pipefail
here=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
build=${ETENDUE_BUILD:-$here/../../build}

skip() {
  echo "skipped: $*"
  exit 77
}

command -v node >/dev/null || skip "there is no Node"
[[ -x ${ETENDUE_CHROMIUM:-/usr/bin/chromium} ]] || skip "there is no Chromium"
[[ -f ${ETENDUE_STUDIO_PAGE:-$build/studio/index.html} ]] || skip "the studio's page is not built"
[[ -d $here/node_modules/playwright-core && -d $here/node_modules/axe-core ]] || skip "the packages of the tests are not installed"
[[ -d $here/../../studio/node_modules/typescript ]] || skip "the packages of the page are not installed"
(cd "$here/../../studio" && node node_modules/typescript/bin/tsc && node build.mjs --tests --out "$build/studio")
# One after another: each has a browser and a render.
if [[ $# == 0 || $1 == --but ]]; then node --test "$build"/studio/tests/*.mjs; fi
for file in "$here"/*.test.mjs; do
  name=$(basename "$file")
  case ${1:-} in
    '') ;;
    --but) [[ $name != "$2" ]] || continue ;;
    *) [[ " $* " == *" $name "* ]] || continue ;;
  esac
  node --test "$file"
done
