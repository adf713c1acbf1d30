#!/usr/bin/env bash
# Installs what is missing, builds the command palpate, and does the main job on real input: a probe presses on the
# skin of a scanned head (data/scenes/head.yaml), then goes through a burr hole into its thalamus and back.
# Prints what was felt; trace.csv and head.png go to build/first-light, and each run writes them anew.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

[ $# = 0 ] || { sed -n '2,4s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; [[ $1 == --help || $1 == -h ]] && exit 0; exit 2; }

cd "$root"
source tools/setup.sh
install_packages "${build_packages[@]}"
use_ccache

say "Building the page of palpate view (build/page)"
install_npm
build_page

say "Building palpate (build/release)"
# Without tests, which need more packages. If tools/test.sh has configured this folder, it stays as
# it is.
[ -f build/release/build.ninja ] || configure release -DPALPATE_TESTS=OFF -DPALPATE_BENCH=OFF
cmake --build build/release --target palpate_command

say "A probe touches a scanned head (data/scenes/head.yaml)"
cat << 'EOT'
First it presses 2 mm into the skin, 1.5 cm beside a burr hole: a wall of 600 N/m pushes back with 1.2 N. Then it goes through
the hole, where no wall is closed, and feels only the drag of tissue, brain and thalamus: 0.1 to 0.3 N.
EOT
out=build/first-light
mkdir -p $out
command=(build/release/bin/palpate touch data/scenes/head.yaml
  --insert -100,-55.6,53.7 -76.4,-49.2,39.7 -100,-55.6,53.7 -100,-42,60 -12,-18,8 -100,-42,60
  --trace $out/trace.csv --image $out/head.png --force)
printf '%s ' "${command[@]}"; printf '\n\n'
"${command[@]}"

say "To see and feel it yourself, in a browser"
echo "build/release/bin/palpate view data/scenes/head.yaml"
