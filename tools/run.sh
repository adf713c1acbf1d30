#!/usr/bin/env bash
# Installs what is missing, builds the command palpate, and does the main job on real input: a probe goes
# through a scanned head (data/scenes/head.yaml) into its thalamus and back.
# Prints what was felt; trace.csv and head.png go to build/first-light, which each run writes anew.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

[ $# = 0 ] || { sed -n '2,4s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; [[ $1 == --help || $1 == -h ]] && exit 0; exit 2; }

cd "$root"
source tools/setup.sh
install_packages "${build_packages[@]}"
use_ccache

say "Building palpate (build/release)"
# Without tests, which need more packages; if tools/test.sh has configured this folder, it stays as it is.
[ -f build/release/build.ninja ] || configure release -DPALPATE_TESTS=OFF -DPALPATE_BENCH=OFF
cmake --build build/release --target palpate_command

say "A probe goes into a scanned head (data/scenes/head.yaml)"
out=build/first-light
mkdir -p $out
command=(build/release/bin/palpate touch data/scenes/head.yaml
  --insert -100,-42,60 -12,-18,8 --back
  --trace $out/trace.csv --image $out/head.png --force)
printf '%s ' "${command[@]}"; printf '\n\n'
"${command[@]}"
