#!/usr/bin/env bash
# Builds the npm package web/gyre-physics: three WebAssembly modules (SIMD; SIMD and threads; plain) and one that reads glTF, with Debian's
# emscripten, the bindings, and the TypeScript around them, into web/gyre-physics/dist. `npm pack` in that folder then makes the package.
#
#   tools/build_web.sh [simd|threads|plain|typescript]...   only these parts; without any, all
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/setup.sh

need_packages emscripten binaryen cmake ninja-build python3 nlohmann-json3-dev zstd
for program in node npm; do
  command -v $program >/dev/null || { say "No $program: install Node.js 18 or newer."; exit 1; }
done
# Emscripten's optimiser is a Node program; a Node that is not Debian's does not look where Debian keeps its modules.
export NODE_PATH=${NODE_PATH:-/usr/share/nodejs}
# And each compilation starts Python: Debian's own has emscripten's programs compiled, and no manager of versions before it.
if [ -x /usr/bin/python3 ]; then export EMSDK_PYTHON=${EMSDK_PYTHON:-/usr/bin/python3}; fi

package=web/gyre-physics
parts=("$@")
[ ${#parts[@]} -gt 0 ] || parts=(simd threads plain typescript)

install_node_packages() {
  # npm leaves its own copy of the list behind; as long as that is newer, there is nothing to do.
  if [ ! -e $package/node_modules/.package-lock.json ] || [ $package/package-lock.json -nt $package/node_modules/.package-lock.json ]; then
    (cd $package && npm ci --no-audit --no-fund --loglevel=error) >&2
  fi
}

# Each build ends with an optimiser that keeps one core busy, so the builds run side by side.
waiting=()
for part in "${parts[@]}"; do
  case $part in
    simd | threads | plain)
      install_node_packages
      targets=(gyre_web)
      if [ "$part" != threads ]; then targets+=(gyre_import); fi
      build "web-$part" "${targets[@]}" &
      waiting+=($!) ;;
  esac
done
for one in "${waiting[@]}"; do wait "$one"; done

for part in "${parts[@]}"; do
  case $part in
    simd | threads | plain)
      node $package/tools/pack.mjs "$part" "build/web-$part/web" $package/dist/engine
      # The reader of glTF is one module for all builds: without SIMD if that is made, which then comes last.
      if [ "$part" != threads ]; then node $package/tools/pack.mjs gltf "build/web-$part/web" $package/dist/engine; fi
      ;;
    typescript)
      install_node_packages
      rm -f $package/dist/*.js $package/dist/*.d.ts  # what an earlier version left would be delivered, too
      python3 web/bindings/generate.py --typescript $package/src/generated.ts
      $package/node_modules/.bin/tsc -p $package
      cp LICENSE $package/LICENSE
      # Of fzstd only what unpacks all at once.
      unzstd=$(cd $package && echo "export { decompress } from 'fzstd';" | node_modules/.bin/esbuild --bundle --minify --format=esm --target=es2020)
      { echo '/*'; cat $package/node_modules/fzstd/LICENSE; echo '*/'; echo "$unzstd"; } > $package/dist/unzstd.js
      # A bundler wants every file that is named; a build that was not made, or of other headers, is an empty one, which load()
      # passes over.
      version=$(sed -n 's/^export const bindingsVersion = \([0-9]*\);$/\1/p' $package/src/generated.ts)
      for build in simd threads plain gltf; do
        if [ "$(head -n 1 $package/dist/engine/$build.js 2>/dev/null)" != "// bindings $version" ]; then
          node $package/tools/pack.mjs "$build" none $package/dist/engine
        fi
      done
      ;;
    *) say "Unknown part: $part"; exit 1 ;;
  esac
done
