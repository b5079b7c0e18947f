#!/usr/bin/env bash
# Builds the viewer into web/viewer/dist: the engine's package (tools/build_web.sh), the page around it, the scenes beside it.
#
#   tools/build_viewer.sh [simd|threads|plain]...   with these builds of the engine made anew; without any, with those that are
#                                                   there, or simd if there are none. "all" makes all three.
#                                                   The script with the live scenes of the course is made along (web/course/dist).
#   tools/build_viewer.sh recordings                without the engine, into web/viewer/dist-recordings: a page that plays
#                                                   recordings which `gyre view` decodes. It needs Node.js and npm, no emscripten.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/setup.sh

for program in node npm; do
  command -v $program >/dev/null || { say "No $program: install Node.js 20.19 or newer."; exit 1; }
done

builds=("$@")
what=build
if [ "${builds[*]-}" = recordings ]; then what=build:recordings; fi
if [ "${builds[*]-}" = all ]; then builds=(simd threads plain); fi
if [ $what = build ] && [ ${#builds[@]} -eq 0 ] && ! compgen -G 'web/gyre-physics/dist/engine/*.js' >/dev/null; then builds=(simd); fi
if [ $what = build ] && [ ${#builds[@]} -gt 0 ]; then tools/build_web.sh "${builds[@]}" typescript; fi

viewer=web/viewer
# npm leaves its own copy of the list behind; as long as that is newer, there is nothing to do.
if [ ! -e $viewer/node_modules/.package-lock.json ] || [ $viewer/package-lock.json -nt $viewer/node_modules/.package-lock.json ]; then
  (cd $viewer && npm ci --no-audit --no-fund --loglevel=error) >&2
fi
(cd $viewer && npm run --silent $what) >&2
# The live scenes of the course are made of the viewer, too.
if [ $what = build ]; then
  (cd $viewer && node_modules/.bin/tsc --noEmit -p ../course && node_modules/.bin/vite build --logLevel error -c vite.course.config.ts) >&2
fi
