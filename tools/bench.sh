#!/usr/bin/env bash
# Renews the figures that the documents give on grids, measured on this machine:
#   tools/docs/accuracy.md (its table), accuracy.svg, and the rows of 1 mm in README.md, by `palpate accuracy`
#   data/bench/CPU.json, named after the processor: sampling beside OpenVDB's and NanoVDB's samplers, in one run
#   data/bench/CPU-baking.json: baking beside OpenVDB's tools, in one run
# A quiet machine is best; the shortest times count.
#   tools/bench.sh [MESH]   MESH: a closed mesh in mm (.stl .obj .ply) to sample as a third shape, a bone for one
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

mesh=()
case ${1:-} in
  -h | --help) sed -n '2,7s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" && exit 0 ;;
  -*) echo "error: unknown option $1; --help says what there is" >&2 && exit 2 ;;
  ?*) mesh=("--mesh=$(realpath "$1")") ;;
esac
[ $# -le 1 ] || { echo "error: one mesh at most" >&2; exit 2; }

# Prints which part is running, and since when; each part prints its own progress.
parts=4
part=0
tell() { # WHAT
  part=$((part + 1))
  printf '== %d of %d, after %d s: %s\n' "$part" "$parts" "$SECONDS" "$1" >&2
}

cd "$root"
source tools/setup.sh
install_packages "${build_packages[@]}" "${test_packages[@]}"
use_ccache
[ -f build/release/build.ninja ] || configure release -DPALPATE_TESTS=OFF
tell 'building'
cmake --build build/release --target palpate_command palpate_sampler_bench palpate_bake_bench

# The table between the two comments of a page: a row for each sampler and voxel size, or this size only.
write_table() { # CSV PAGE [MM]
  local table
  table=$(awk -F, -v only="${3:-}" 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    $at["near_edges"] == 1 || (only != "" && 1e3 * $at["voxel_m"] != only) { next }
    { printf "| %g | %s | %.2g | %.2g | %.2g | %.2g | %.3g | %.0f | %.0f | %.1f | %.1f |\n", 1e3 * $at["voxel_m"],
      $at["sampler"], 1e3 * $at["value_rms_m"], 1e3 * $at["value_max_m"], $at["normal_rms_degrees"],
      $at["normal_max_degrees"], $at["jitter_max"] / $at["true_jitter_max"], $at["independent_ns"],
      $at["dependent_ns"], $at["cold_ns"] / 1e3, $at["memory_bytes"] / 1e6 }' "$1")
  awk -v table="$table" '/<!-- accuracy: end -->/ { skip = 0 } !skip { print }
    /<!-- accuracy: begin/ { skip = 1
      print "| voxel mm | sampler | distance mm, RMS | max | normal degree, RMS | max | jitter / true | ns | ns, dependent | us, cold | MB |"
      print "|---|---|---|---|---|---|---|---|---|---|---|"
      print table }' "$2" > "$2.tmp"
  mv "$2.tmp" "$2"
}

csv=$(mktemp --suffix=.csv)
trap 'rm -f "$csv"' EXIT
tell 'accuracy of samplers, some 60 s'
build/release/bin/palpate accuracy data/scenes/reference.yaml --field torus --ladder 2,1,0.5,0.25 \
  --repeat 30 --svg tools/docs/accuracy.svg --csv "$csv" --force
write_table "$csv" tools/docs/accuracy.md
write_table "$csv" README.md 1

mkdir -p data/bench
tell 'times of samplers, some 60 s, told at the end'
build/release/bin/palpate_sampler_bench --benchmark_enable_random_interleaving=true \
  --write=data/bench "${mesh[@]}"
tell 'baking, some 120 s'
build/release/bin/palpate_bake_bench --benchmark_repetitions=3 --benchmark_min_time=0.2 \
  --benchmark_counters_tabular=true --write=data/bench
printf '== done, after %d s\n' "$SECONDS" >&2
