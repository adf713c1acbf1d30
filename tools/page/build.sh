#!/usr/bin/env bash
# Builds the page of `palpate view` into build/page/dist, from where CMake builds it into the
# command. Needs npm, and a package registry for packages that are not in npm's cache; does nothing
# if nothing is new.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source=$root/tools/page
out=$root/build/page

command -v npm > /dev/null || { echo "error: npm is not installed" >&2; exit 1; }
# In a separate folder, so that the sources stay clean.
mkdir -p "$out"
stamp=$(cd "$source" && find . -type f | LC_ALL=C sort | xargs sha256sum)
[ "$stamp" != "$(cat "$out/.built" 2> /dev/null)" ] || [ ! -f "$out/dist/index.html" ] || exit 0
rm -rf "$out/src" "$out/dist" "$out/.built"
cp -r "$source/." "$out"
cd "$out"
if ! cmp --quiet package-lock.json node_modules/.installed; then
  npm ci --no-audit --no-fund --ignore-scripts
  cp package-lock.json node_modules/.installed
fi
npm run build
# The licenses of the packages in the page, besides our own.
{ echo "three.js"; cat node_modules/three/LICENSE; } > dist/licenses.txt
printf '%s' "$stamp" > .built
