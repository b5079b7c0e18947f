# Shared by ./run, ./test and .ci/run (sourced, bash): Debian packages and build folders.
#
#   need_packages package...   installs those that are missing, or says what to do and exits
#   want_packages package...   the same, but returns false instead of exiting
#   configure preset           makes build/<preset> ready, doing nothing when it is
#   build preset [target...]   builds it on all cores
#
# With gyre_unity set, every preset compiles folder by folder (docs/decisions/unity.md).

gyre_cores=$(nproc 2>/dev/null || getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)

say() { printf '%s\n' "$*" >&2; }

# Is what the package is for already here? Tools may come from elsewhere than a package, so those are looked up by name.
package_present() {
  case $1 in
    g++ | cmake | ccache | python3 | clang) command -v "$1" >/dev/null 2>&1 ;;
    ninja-build) command -v ninja >/dev/null 2>&1 ;;
    pkg-config) command -v pkg-config >/dev/null 2>&1 ;;
    qemu-user) command -v qemu-aarch64 >/dev/null 2>&1 ;;
    g++-aarch64-linux-gnu) command -v aarch64-linux-gnu-g++ >/dev/null 2>&1 ;;
    nlohmann-json3-dev) [ -e /usr/include/nlohmann/json.hpp ] ;;
    libcli11-dev) [ -e /usr/include/CLI/CLI.hpp ] ;;
    libgtest-dev) [ -e /usr/include/gtest/gtest.h ] ;;
    libbenchmark-dev) [ -e /usr/include/benchmark/benchmark.h ] ;;
    zlib1g-dev) [ -e /usr/include/zlib.h ] ;;
    libcpp-httplib-dev) [ -e /usr/include/httplib.h ] ;;
    emscripten) command -v emcc >/dev/null 2>&1 ;;
    libclang-rt-dev) ls /usr/lib/llvm-*/lib/clang/*/lib/linux/libclang_rt.fuzzer-*.a >/dev/null 2>&1 ;;
    *) dpkg-query -W -f='${db:Status-Abbrev}' "$1" 2>/dev/null | grep -q '^ii' ;;
  esac
}

want_packages() {
  local missing=() package as_root=()
  for package in "$@"; do
    package_present "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0

  if ! command -v apt-get >/dev/null 2>&1; then
    say "Missing: ${missing[*]} (Debian's names). This system has no apt-get; install their equivalents, then run this again."
    return 1
  fi
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then
      say "Missing: ${missing[*]}. You are not root and there is no sudo. Have somebody run, as root:"
      say "  apt-get install --no-install-recommends ${missing[*]}"
      return 1
    fi
    as_root=(sudo)
  fi
  say "Installing: ${missing[*]}"
  as_root+=(env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0)
  # The package lists are refreshed only when the ones on this machine do not do.
  gyre_installed=yes
  if "${as_root[@]}" install -y --no-install-recommends "${missing[@]}" >/dev/null 2>&1; then return 0; fi
  "${as_root[@]}" update >&2
  if "${as_root[@]}" install -y --no-install-recommends "${missing[@]}" >&2; then return 0; fi
  say "Could not install: ${missing[*]}"
  return 1
}

need_packages() { want_packages "$@" || exit 1; }

configure() {
  local folder=build/$1
  # A folder that was made for another place (a moved or copied checkout) cannot be reused.
  if [ -e "$folder/CMakeCache.txt" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" "$folder/CMakeCache.txt"; then
    say "Making $folder anew: it belongs to another checkout."
    rm -rf "$folder"
  fi
  # Ninja itself notices changed CMake files, but neither changed presets nor new libraries.
  if [ ! -e "$folder/build.ninja" ] || [ CMakePresets.json -nt "$folder/build.ninja" ] || [ "${gyre_installed-}" = yes ]; then
    say "Configuring $folder"
    cmake --preset "$1" ${gyre_unity:+-DCMAKE_UNITY_BUILD=ON} >"build/configure-$1.log" 2>&1 || {
      cat "build/configure-$1.log" >&2
      return 1
    }
  fi
}

build() {
  local preset=$1
  shift
  mkdir -p build
  configure "$preset" || return 1
  cmake --build "build/$preset" --parallel "$gyre_cores" ${1+--target "$@"} >&2
}

# For the gyre program, and for everything else.
gyre_run_packages=(g++ cmake ninja-build pkg-config nlohmann-json3-dev libcli11-dev)
gyre_build_packages=("${gyre_run_packages[@]}" ccache zlib1g-dev libgtest-dev libbenchmark-dev)

# For gyre render, which is left out where they are missing: the libraries it is built with, and OpenGL without a graphics card.
gyre_render_packages=(libepoxy-dev libegl-dev libpng-dev libgif-dev libegl1 libgl1 libgl1-mesa-dri)

# For gyre view, which is left out where it is missing: the server.
gyre_view_packages=(libcpp-httplib-dev)

# For robots in URDF and MJCF, which are left out where it is missing: the XML parser.
gyre_format_packages=(libtinyxml2-dev)
