#!/usr/bin/env bash
# Runs the tests of the studio's page. Without Node, Chromium, the built page or their packages it says so and is skipped (77):
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
node --test "$build"/studio/tests/*.mjs
# Two at a time, the longest first: each has a browser and a render, and waits for most of its time. xargs fails if one does.
# shellcheck disable=SC2012  # names without blanks
ls -S "$here"/*.test.mjs | xargs -n 1 -P 2 node --test
