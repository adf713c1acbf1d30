#!/usr/bin/env bash
# Renews the files that are generated from the declarations of scene files and of the command line;
# tests compare them:
#   data/schema/scene-1.json, and between the marks of tools/docs/scene.md and lib/README.md the tables of keys
#   tools/README.md (its reference), tools/docs/palpate.1, tools/completion
#   tools/generate.sh [PALPATE]   PALPATE: the command, build/release/bin/palpate if not given
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
palpate=${1:-build/release/bin/palpate}

# Replaces the text between "<!-- MARK ARGUMENT -->" and "<!-- end -->" in standard input by the
# output of COMMAND ARGUMENT.
between_marks() { # MARK COMMAND...
  local mark=$1 line is_kept=yes
  shift
  while IFS= read -r line; do
    [ "$line" = '<!-- end -->' ] && is_kept=yes
    [ $is_kept = yes ] && printf '%s\n' "$line"
    if [[ $line =~ ^'<!-- '$mark' '([a-z_]+)' -->'$ ]]; then
      "$@" "${BASH_REMATCH[1]}"
      is_kept=no
    fi
  done
}
table() { "$palpate" help scene "$1" --markdown; }
reference() { "$palpate" help --markdown; }
rewrite() { # FILE COMMAND...
  "${@:2}" < "$1" > "$1.new"
  mv "$1.new" "$1"
}

"$palpate" help scene --schema > data/schema/scene-1.json
rewrite tools/docs/scene.md between_marks 'keys of' table
rewrite lib/README.md between_marks 'keys of' table
rewrite tools/README.md between_marks 'reference of' reference
"$palpate" help --man > tools/docs/palpate.1
for shell in bash zsh fish; do
  "$palpate" help --completion $shell > tools/completion/palpate.$shell
done
