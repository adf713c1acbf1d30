#!/usr/bin/env bash
# Shared by tools/run.sh and tools/test.sh: the one list of Debian packages, and functions to
# install them, configure and build. Only to be sourced; it does nothing by itself.

# To build and run Palpate. libboost-dev: OpenVDB's headers need it, but libopenvdb-dev does not
# depend on it. fonts-dejavu-core: the letters in pictures. mricron-data: the scanned head of
# data/scenes/head.yaml.
build_packages=(
  g++ cmake ninja-build ccache
  libopenvdb-dev libtbb-dev libboost-dev libnifti-dev libgdcm-dev zlib1g-dev libassimp-dev
  libglm-dev libyaml-cpp-dev
  libeigen3-dev libusb-1.0-0-dev libcli11-dev nlohmann-json3-dev pkg-config libcairo2-dev libwebp-dev fonts-dejavu-core
  mricron-data
)

# To test and measure it as well. NanoVDB: a rival in tests/bench. git: tells what changed.
# umockdev: stands in for input devices. Python, CGAL, ITK and OpenVDB's own tools: results are
# compared with theirs. invesalius-examples: a scanned head (CT). fish, zsh: completion is tested in
# them besides bash.
test_packages=(
  clang-format clang-tidy codespell doxygen git
  libgtest-dev umockdev libumockdev-dev libbenchmark-dev libnanovdb-dev libcgal-dev
  python3-nibabel python3-numpy python3-scipy python3-yaml python3-openvdb libopenvdb-tools
  libinsighttoolkit5-dev python3-pydicom python3-gdcm
  invesalius-examples fish zsh
)

# To fuzz the readers (tools/test.sh --all): the sanitizers and libFuzzer come with clang's runtime.
fuzz_packages=(clang-14 libclang-rt-14-dev)

# To test the page of `palpate view` (tools/test.sh --lane page).
page_packages=(chromium)

export LC_ALL=C.UTF-8

say() { printf '\n== %s\n' "$*"; }
fail() { printf 'error: %s\n' "$*" >&2; exit 1; }

# Seconds since the script began, for reports.
elapsed() { printf '%d s' "$SECONDS"; }

missing_packages() { # NAME...: those that are not installed, one a line
  local installed
  # dpkg-query fails for a name that it does not know, which only means that the package is missing.
  installed=$({ dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "$@" 2> /dev/null || true; } |
    sed -n 's/^installed //p')
  printf '%s\n' "$@" | grep --line-regexp --fixed-strings --invert-match "$installed" || true
}

install_packages() { # NAME...: installs what is missing, as root or through sudo
  if ! command -v dpkg-query > /dev/null; then
    echo "This is not Debian, so nothing is installed. Needed, by Debian's names: $*"
    return 0
  fi
  local missing
  mapfile -t missing < <(missing_packages "$@")
  [ ${#missing[@]} -gt 0 ] || return 0

  local as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo > /dev/null ||
      fail "missing packages, and neither root nor sudo to install them. As root: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  as_root+=(env DEBIAN_FRONTEND=noninteractive)
  local apt=("${as_root[@]}" apt-get --quiet --yes -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0)

  say "Installing ${#missing[@]} packages and what they need: ${missing[*]}"
  # An installation that was interrupted is finished first; apt refuses to go on otherwise.
  "${as_root[@]}" dpkg --configure -a || fail "dpkg --configure -a failed; see above"
  "${apt[@]}" update || fail "apt-get update failed; is a Debian mirror configured and reachable?"
  if ! "${apt[@]}" install --no-install-recommends "${missing[@]}"; then
    local name absent=()
    for name in "${missing[@]}"; do
      apt-cache show "$name" > /dev/null 2>&1 || absent+=("$name")
    done
    [ ${#absent[@]} = 0 ] ||
      fail "this system's package sources do not have: ${absent[*]}. Palpate is built on Debian 12 (bookworm)."
    fail "apt-get could not install: $(missing_packages "${missing[@]}" | paste --serial --delimiters=' '); see above"
  fi
}

install_npm() { # from Debian; not beside a Node from elsewhere, which excludes Debian's npm
  command -v npm > /dev/null || command -v node > /dev/null || (install_packages npm) || true
}

build_page() { # builds the page of `palpate view` if npm is installed; without it, the command says what is missing
  if ! command -v npm > /dev/null; then
    echo "There is no npm here, so the command gets no page for \`palpate view\`."
    return 0
  fi
  "$root/tools/page/build.sh" || echo "The page of \`palpate view\` could not be built; see above. All else works without it."
}

use_ccache() { # sources compiled once, here or in another clone of this project, are not compiled again
  if command -v ccache > /dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1
  fi
}

configure() { # PRESET [-D...]: runs only when there is something new to configure
  local dir=$root/build/$1 wanted="$*"
  if [ -f "$dir/build.ninja" ] && [ "$dir/build.ninja" -nt "$root/CMakePresets.json" ] &&
    [ "$(cat "$dir/.configured" 2> /dev/null)" = "$wanted" ]; then
    return 0 # ninja itself sees changes of CMakeLists.txt
  fi
  cmake --preset "$@" && printf '%s' "$wanted" > "$dir/.configured"
}
