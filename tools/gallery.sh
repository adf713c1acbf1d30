#!/usr/bin/env bash
# Writes tools/docs/gallery.md and its pictures: each example scene as it feels, with the commands
# that draw it.
#   tools/gallery.sh [PALPATE]   PALPATE: the command, build/release/bin/palpate if not given
# The head scenes need Debian's mricron-data. Takes some minutes on two cores.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
palpate=${1:-build/release/bin/palpate}
page=tools/docs/gallery.md
pictures=tools/docs/gallery
most=3000000 # [bytes] of all pictures
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$pictures"
rm -f "$pictures"/*.png "$pictures"/*.webp

# Runs a command, and shows it on the page with the file names that a reader would use.
run() { # WORD...
  local shown="$*"
  "$palpate" "${@//@/$work/}" --force --quiet > "$work/said" 2>&1 || { cat "$work/said" >&2; return 1; }
  printf 'palpate %s\n' "${shown//@/}" >> "$page"
}

# Draws a scene after it was touched (MOTION: options of touch; empty: not touched).
scene() { # NAME TITLE NOTICE MOTION LOOK [PICTURE]
  local name=$1 title=$2 notice=$3 motion=$4 look=$5 picture=${6:-$1.png}
  local file=data/scenes/$name.yaml
  printf '## %s\n\n![%s](gallery/%s)\n\n%s\n\n```sh\n' "$title" "$title" "$picture" "$notice" >> "$page"
  local trace=()
  # Options are split at blanks; none of them contains a blank.
  # shellcheck disable=SC2086
  if [ -n "$motion" ]; then
    run touch $file $motion --trace "@${picture%.*}.csv"
    trace=(--trace "@${picture%.*}.csv")
  fi
  # shellcheck disable=SC2086
  run render $file "${trace[@]}" $look --size 960x600 -o "@$picture"
  printf '```\n\n' >> "$page"
  cp "$work/$picture" "$pictures/"
}

cat > "$page" <<'END'
# Gallery

Each example scene of `data/scenes`, with the commands that draw it and what to notice. `tools/gallery.sh` writes this page and
its pictures. On the left most scenes are cut along a plane, on the right they stand in
space with their front cut away. The blue line is the tip, the dashed orange one the hand where a wall holds the tip back, and red arrows
are the force on the hand; `tools/README.md` says what the other colors and lines mean.

END

scene container "A container with a port" \
  "The bowl of glass is hard from outside and from within. Through its flat mouth the tip dips into syrup, which only drags, and rests on the bottom while the hand goes on: there the red arrows point up." \
  "--insert 20,0,45 0,0,-44 --back" "--plane y=0"
scene container "What a hand at rest would feel" \
  "Each arrow is the force on a hand that was led to its tail from the nearest place outside, and rests there: the glass pushes it back out. Where that way leads through the mouth there is none. The lines are 5 mm from one another." \
  "" "--plane y=0 --iso 5 --forces 28" container_forces.png
scene cup "A cup of wine" \
  "The wall of 3 mm is felt on both sides and on its rim. The wine has a surface (dashed) that is free to cross: only the drag says where it lies. The arrows point back where the tip came from, on the way in and on the way out." \
  "--insert 0,0,50 0,0,-28 --back" "--plane y=0"
scene composite_tube "Ports in an order" \
  "Three fillings, each thicker than the one before. The ports open in their order only; the fourth leads out." \
  "--insert -70,0,0 70,0,0" "--plane y=0"
scene valve_tube "A valve" \
  "The tip goes in on the left and comes out on the right. On the way back the right end is shut: the hand comes back to 30 mm, the tip stays at 40 mm, and the red arrow is what pushes the hand out again." \
  "--insert -60,0,0 60,0,0 30,0,0" "--plane y=0"
scene metaballs "Metaballs" \
  "Two to five balls blended into one smooth surface each. No triangles: each pixel has the normal of the field itself." \
  "" "--plane y=0"
scene heart "A heart" \
  "Taubin's sextic, with a dimple in which the gradient is zero. The hand strokes over both lobes a little below the surface; the tip stays on it." \
  "--insert -36,0,30 -25,0,27 -13,0,31.5 -5,0,29 0,0,25 5,0,29 13,0,31.5 25,0,27 36,0,30" "--plane y=0"
scene csg "Union, intersection, difference" \
  "An ellipsoid and a cube, combined in three ways. Edges stay sharp, because the operands are combined where they are felt." \
  "" "--plane y=0"
scene csg_part "A machined part" \
  "A dish, a slot and a drilled hole in a block. The hole is a port: behind it is a chamber full of grease, green at its mouth." \
  "" "--plane y=0"
scene csg_part "The part from all sides" \
  "No mesh is drawn: each pixel is shaded by the gradient of the field that is felt, so that edges are sharp and curves round at any size." \
  "" "--view corner --turn 36" csg_part_turn.webp
scene fields "A table of shapes" \
  "One of each kind of field on a table. The cut goes through the back row: a torus, a cone, Taubin's heart, metaballs, a pill." \
  "" "--plane y=30"
scene reference "Shapes to measure grids on" \
  "Their distance is known everywhere. \`palpate accuracy\` holds their grids against it." \
  "" "--plane y=0"
scene sponge "A sponge in jelly" \
  "A gyroid parts space into two mazes. The cut shows its walls in the jelly; the green top is a port, open everywhere." \
  "" "--plane y=0"
scene flag "Sheets without thickness" \
  "A flag hangs into streaming water, half of it in the air. It is felt from both sides; past its edges the way is free. A membrane bulges over the bottom." \
  "" "--plane y=0"
scene lattice "A grid that is felt" \
  "A field of forces pulls the tip from cell to cell: the red arrows turn round twice in every 12 mm of depth." \
  "--insert 0,0,30 0,0,-15" "--plane y=0"
scene crease "A groove between two stiffnesses" \
  "The hand goes round behind the walls (dashed) and gets back what it gave. The tip slides down the stiff wall and stays in the bottom of the groove, held by both walls." \
  "--insert 0,0,6 1.2,0,-2 0,0,-0.8 -1.2,0,-2 0,0,-3.2 1.2,0,-2" "--plane y=0"
scene contrast "A contrast of stiffness" \
  "The floor is ten times as stiff on the right, from one voxel to the next. Felt over the patch of a press 5 mm deep, the force grows over 10 mm, and leans against the stroke while it does." \
  "--insert -12,0,2 -12,0,-5 12,0,-5 --speed 20mm/s" "--plane y=0"
scene lump "Palpation" \
  "A stiff lump under soft skin, on a table. Nothing opens; pressed over the lump, the skin pushes back harder." \
  "--press 0,0,0 --depth 1" "--plane y=0"
scene slab "A needle through a slab" \
  "Skin, fat and muscle give way one after the other, each at the force in brackets; the needle comes out at the far side. The arrows along its way are what the tissues hold the shaft with, in and out." \
  "--insert 0,0,5 0,0,-45 --back" "--plane y=0"
scene flank "A needle held sideways" \
  "Through five layers, and then 3 mm sideways, with each tissue holding the shaft." \
  "--insert 0,0,5 0,0,-45 3,0,-45" "--plane y=0"
scene head "A scanned head" \
  "Skin and brain by threshold, nuclei by label. A needle goes through a burr hole to the thalamus. The cut follows its way, with the scan's gray values; green lines are where it can pass." \
  "--insert -100,-42,60 -12,-18,8 --back" ""
scene head "The same head, seen through" \
  "The needle's way from the patient's left, colored by the force on the hand, through the skin and the brain to the thalamus." \
  "--insert -100,-42,60 -12,-18,8 --back" "--view left --opacity skin=0.15 --opacity brain=0.3" head_through.png
scene needle "A biopsy needle" \
  "The same head, felt by a needle with a shaft: it cuts, is held along its way, and is drawn back." \
  "--insert -100,-42,60 -12,-18,8 --back" ""
scene five_layers "Materials out of a scan" \
  "Stiffness, friction and drag of five layers follow the scan's gray values: brighter tissue is stiffer. Each layer gives way at a force of its own." \
  "--insert -100,-10,30 -26,4,2 --back" ""

size=$(cat "$pictures"/* | wc -c)
[ "$size" -le "$most" ] || { echo "error: the pictures have $size bytes, more than $most" >&2; exit 1; }
echo "$page, whose pictures have $size bytes"
