#!/usr/bin/env bash
# Builds the guide and the course as a site into build/guide: open build/guide/index.html, also without a server or a network.
#
#   tools/build_guide.sh           with the live scenes, if the package for JavaScript is there or can be built (tools/build_web.sh)
#   tools/build_guide.sh --text    does not build the live scenes; they are in the site if they were built before
#
# It needs Debian's Sphinx, Furo, MyST and KaTeX, and installs them. docs/decisions/guide-site.md tells why these tools.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/setup.sh

need_packages python3 python3-sphinx furo python3-myst-parser libjs-katex
# Sphinx is a package of Debian's own Python, whatever other Python comes first.
python=/usr/bin/python3
[ -x $python ] || python=python3

if [ "${1-}" != --text ]; then
  if ! compgen -G 'web/gyre-physics/dist/engine/simd.js' >/dev/null; then tools/build_web.sh simd typescript; fi
  viewer=web/viewer
  if [ ! -e $viewer/node_modules/.package-lock.json ] || [ $viewer/package-lock.json -nt $viewer/node_modules/.package-lock.json ]; then
    (cd $viewer && npm ci --no-audit --no-fund --loglevel=error) >&2
  fi
  live=web/course/dist/live.js
  if [ ! -e $live ] || [ -n "$(find web/course/src $viewer/src $viewer/vite.course.config.ts web/gyre-physics/dist -type f -newer $live -print -quit)" ]; then
    (cd $viewer && node_modules/.bin/tsc --noEmit -p ../course && node_modules/.bin/vite build --logLevel error -c vite.course.config.ts) >&2
  fi
fi

mkdir -p build
stubs=build/guide-stubs.pyi
$python capi/generate.py --stubs $stubs
PYTHONPATH=tools/guide $python tools/guide/stage.py build/guide-source build/guide $stubs
$python -m sphinx -q -b html -j auto -c docs/site build/guide-source build/guide
say "The guide is in build/guide/index.html."
