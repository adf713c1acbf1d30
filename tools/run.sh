#!/usr/bin/env bash
# Installs what is missing, builds the command palpate, and does the main job on real input: a probe goes
# through the ports of a scanned head (data/scenes/head.yaml) and back.
#   tools/run.sh [FOLDER]     where trace.csv and cut.png go; default build/first-light
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
source tools/setup.sh

case ${1:-} in
  -h | --help) sed -n '2,4s/^# \{0,1\}//p' "$0"; exit 0 ;;
  -*) printf 'error: unknown option %s; tools/run.sh [FOLDER]\n' "$1" >&2; exit 2 ;;
esac
out=${1:-$root/build/first-light}

install_packages "${build_packages[@]}"
use_ccache

say "Building palpate (build/release)"
# Tests are left out unless tools/test.sh has configured this folder with them already.
[ -f build/release/build.ninja ] || configure release -DPALPATE_TESTS=OFF -DPALPATE_BENCH=OFF
cmake --build build/release --target palpate_command
