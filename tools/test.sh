#!/usr/bin/env bash
# Installs what is missing, builds Palpate and passes its tests, lane by lane. Each lane sees what no other does:
#   format    clang-format on every file, and the English: spelling by codespell, phrases by tests/words
#   arrows    no include against the arrows between modules and layers (cmake script, seconds)
#   release   what users get: optimized code, installed and used by an outside project
#   asan      assertions on, memory errors and undefined behavior; every public header compiles alone;
#             lib and devices, and with --all everything: vdb and tools take half an hour more
#   tsan      data races: the devices, and what threads do together (without vdb: TBB is not instrumented)
#   tidy      names and bug patterns, by clang-tidy, in the sources that changed
#   damage    damaged files of every format through the command, with limits (PALPATE_MUTANTS of each kind, default 100);
#             with --all, or if it is asked for
#   fuzz      every reader under libFuzzer with clang, address and undefined behavior (PALPATE_FUZZ_SECONDS each, default
#             60); with --all, or if it is asked for
#   mutants   would the tests see it? Small slips in a copy of the sources of lib and devices, 90 % of which some test
#             must see in each module (PALPATE_MUTANTS_PER_MODULE, default 40; PALPATE_MUTANTS_SEED, default 1);
#             with --all, or if it is asked for
#   page      the page of `palpate view` in a browser without a window (chromium, npm); with --all, or if it is asked for
#   dev       as asan without the sanitizers, quick to build; not run unless it is asked for
# Without options: format, arrows and release, which prove an installation; with progress and the time left.
# Options:
#   --ci            format, arrows, release, asan, tsan and tidy: what has to pass before a change goes in
#   --quick         format, arrows and dev only
#   --lane NAME     only this lane; may be given several times
#   --all           every lane; tidy and asan on everything, and the slow sweeps (PALPATE_SLOW_TESTS=1)
#   --changed REF   what counts as changed for tidy: since REF, origin/main for one. Default: by the newest
#                   commit and since
# Tests of scans that are not part of the repository read them in the folder that PALPATE_SCANS names (default:
# ../shared/data); those whose scans are not there are left out, and named at the end.
# The last line says 'N passed, N failed' over all lanes; the exit status is 0 if none failed.
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root" || exit 1
source tools/setup.sh

lanes=()
default_lanes=(format arrows release)
ci_lanes=("${default_lanes[@]}" asan tsan tidy)
all_lanes=("${ci_lanes[@]}" damage fuzz mutants page dev)
tidy_all=0 changed_since=
usage() { printf 'error: %s; tools/test.sh --help lists the options\n' "$1" >&2; exit 2; }
while [ $# -gt 0 ]; do
  case $1 in
    --ci) lanes+=("${ci_lanes[@]}") ;;
    --quick) lanes+=(format arrows dev) ;;
    --lane)
      [[ " ${all_lanes[*]} " == *" ${2:-none} "* ]] || usage "--lane takes one of: ${all_lanes[*]}"
      lanes+=("$2") && shift ;;
    --all) tidy_all=1 lanes=("${all_lanes[@]}") && export PALPATE_SLOW_TESTS=1 ;;
    --changed) [ -n "${2:-}" ] || usage "--changed takes a commit" ; changed_since=$2 && shift ;;
    -h | --help) sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//;p}' "$0" && exit 0 ;;
    *) usage "unknown option $1" ;;
  esac
  shift
done
is_default=
if [ ${#lanes[@]} = 0 ]; then
  lanes=("${default_lanes[@]}") is_default=1
fi

# Tests run in another folder, so make the path absolute; and a folder that is named has to exist.
if [ -n "${PALPATE_SCANS:-}" ]; then
  [ -d "$PALPATE_SCANS" ] || usage "PALPATE_SCANS names $PALPATE_SCANS, which is not a folder"
  PALPATE_SCANS=$(cd "$PALPATE_SCANS" && pwd) && export PALPATE_SCANS
fi

asan_options=(-DPALPATE_VDB=OFF)
[ $tidy_all = 0 ] || asan_options=(-DPALPATE_VDB=ON)

results=$root/build/test-results
mkdir -p "$results"
passed=0 failed=0 skipped=0 failed_lanes=() report=() left_out=()

# Every C++ file of ours.
sources() { find lib vdb devices tools tests -name '*.h' -o -name '*.cpp' | sort; }

count_check() { # STATUS: counts a lane that is one check
  if [ "$1" = 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
  return "$1"
}

count_tests() { # JUNIT_FILE: adds up what ctest ran; false if it ran nothing or something failed
  local head tests fails skips disabled
  head=$(tr '\n\t' '  ' < "$1" | grep --only-matching '<testsuite [^>]*>')
  number() { sed -n "s/.* $1=\"\([0-9]*\)\".*/\1/p" <<< "$head"; }
  tests=$(number tests) fails=$(number failures) skips=$(number skipped) disabled=$(number disabled)
  skips=$((${skips:-0} + ${disabled:-0}))
  [ "${tests:-0}" -gt 0 ] && [ -n "$fails" ] || { lane_note="no test ran"; return 1; }
  passed=$((passed + tests - fails - skips)) failed=$((failed + fails)) skipped=$((skipped + skips))
  mapfile -t -O ${#left_out[@]} left_out < <(skipped_tests "$1")
  lane_note="$((tests - fails - skips)) passed, $fails failed"
  [ "$skips" = 0 ] || lane_note+=", $skips skipped"
  [ "$fails" = 0 ]
}

skipped_tests() { # JUNIT_FILE: prints a line for each skipped test: its name, a tab, and the reason
  awk '
    /<testcase / { name = $0; sub(/.* name="/, "", name); sub(/".*/, "", name); skipped = 0; why = "" }
    /<skipped/ { skipped = 1 }
    # GoogleTest prints the place, and on the next line the reason.
    said { why = why == "" ? $0 : why; said = 0 }
    / *: Skipped$/ { said = 1 }
    /<\/testcase>/ && skipped { print name "\t" why }' "$1" |
    sed 's/&lt;/</g;s/&gt;/>/g;s/&quot;/"/g;s/&apos;/\x27/g;s/&amp;/\&/g'
}

tell_left_out() { # prints the tests that lanes skipped, each test once, grouped by the file that it needs
  local tests scans
  [ ${#left_out[@]} -gt 0 ] || return 0
  tests=$(printf '%s\n' "${left_out[@]}" | sort --unique --field-separator=$'\t' --key=1,1)
  scans=$(grep --count $'\tabsent: ' <<< "$tests")
  echo "Left out: $(wc -l <<< "$tests") tests"
  # 'absent: FILE in FOLDER; ...'; a test may also give another reason, or none.
  awk -F '\t' '{
      why = $2 == "" ? " without a reason" : ": " $2
      if (sub(/^: absent: /, "", why)) { sub(/ in [^;]*; .*/, "", why); why = " for want of " why }
      else sub(/^: /, " for another reason: ", why)
      count[why]++
    } END { for (why in count) printf "  %4d%s\n", count[why], why }' <<< "$tests" | sort --key=2
  [ "$scans" = 0 ] || cat << EOF
These scans and meshes are not part of the repository; nearly all that they show is shown by other tests, on scans that
Debian packages carry or that the tests make. To run these too: PALPATE_SCANS=FOLDER tools/test.sh --lane release, where
FOLDER holds the files above (now ${PALPATE_SCANS:-$(dirname "$root")/shared/data}).
EOF
}

progress() { # WHAT: passes lines on; of those that count ('[3/40] Building', '3/40 Test ... Passed') only one in ten seconds, with the time left
  local line at of began=$SECONDS shown=$SECONDS left
  while IFS= read -r line; do
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\] || $line =~ ^\ *([0-9]+)/([0-9]+)\ Test.*(Passed|Skipped) ]]; then
      at=${BASH_REMATCH[1]} of=${BASH_REMATCH[2]}
      [ "$at" -gt 0 ] && { [ $((SECONDS - shown)) -ge 10 ] || [ "$at" = "$of" ]; } || continue
      shown=$SECONDS left=$(((SECONDS - began) * (of - at) / at))
      printf '%s %d of %d, about %d:%02d min left\n' "$1" "$at" "$of" $((left / 60)) $((left % 60))
    elif ! [[ $line =~ ^\ *Start\ +[0-9]+: ]]; then
      printf '%s\n' "$line"
    fi
  done
}

build_and_test() { # PRESET [CONFIGURE_OPTION...]
  local preset=$1 junit=$results/$1.xml
  shift
  rm -f "$junit"
  if ! configure "$preset" -DPALPATE_TESTS=ON "$@" || ! cmake --build --preset "$preset" -- -k 0 | progress built; then
    lane_note="does not build"
    count_check 1
    return
  fi
  ctest --preset "$preset" --output-junit "$junit" | progress tested
  local status=$?
  count_tests "$junit" && [ $status = 0 ]
}

lane_format() {
  local status=0
  sources | xargs --no-run-if-empty clang-format --dry-run --Werror || status=1
  python3 -B tests/words/check_words.py || status=1
  # Conflict marks that a merge left behind.
  if git -C "$root" grep -nE '^(<<<<<<<|>>>>>>>)( |$)'; then status=1; fi
  count_check $status
}
lane_arrows() { cmake -D ROOT="$root" -P tests/architecture/check_arrows.cmake; count_check $?; }
lane_dev() { build_and_test dev; }
lane_release() { build_and_test release; }
lane_asan() { build_and_test asan "${asan_options[@]}"; }
lane_tsan() { build_and_test tsan; }

lane_damage() { # uses the command of the release lane
  configure release -DPALPATE_TESTS=ON &&
    cmake --build --preset release --target palpate_damage_sweep || {
    lane_note="does not build"; count_check 1; return; }
  (cd "$results" && "$root/build/release/tests/fuzz/palpate_damage_sweep" "${PALPATE_MUTANTS:-100}") |
    tee "$results/damage.txt"
  local status=${PIPESTATUS[0]}
  lane_note=$(tail -n 1 "$results/damage.txt")
  count_check "$status"
}

lane_fuzz() { # each reader starts from the corpus that the last run left
  local corpus=$root/build/fuzz/corpus fuzzer reader all=0
  install_packages "${fuzz_packages[@]}"
  configure fuzz && cmake --build --preset fuzz -- -k 0 || {
    lane_note="does not build"; count_check 1; return; }
  "$root/build/fuzz/tests/fuzz/palpate_fuzz_corpus" "$corpus" || { count_check 1; return; }
  for fuzzer in "$root"/build/fuzz/tests/fuzz/palpate_fuzz_*; do
    reader=${fuzzer##*/palpate_fuzz_}
    [ -d "$corpus/$reader" ] && [ -x "$fuzzer" ] || continue
    ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=0 "$fuzzer" -max_total_time="${PALPATE_FUZZ_SECONDS:-60}" -timeout=20 \
      -rss_limit_mb=2048 -print_final_stats=1 -artifact_prefix="$results/fuzz_${reader}_" "$corpus/$reader" \
      > "$results/fuzz_$reader.txt" 2>&1
    count_check $? || { all=1; tail -n 30 "$results/fuzz_$reader.txt"; }
  done
  return $all
}

lane_mutants() { # lists the mutants that no test noticed
  python3 -B tests/mutants/mutants.py | tee "$results/mutants.txt"
  local status=${PIPESTATUS[0]}
  lane_note=$(tail -n 1 "$results/mutants.txt")
  count_check "$status"
}

lane_page() { # writes pictures to build/test-results/page
  # Debian's npm conflicts with Node from elsewhere: a machine that has one keeps it.
  command -v npm > /dev/null || install_packages npm
  install_packages "${page_packages[@]}"
  tools/page/build.sh && configure release -DPALPATE_TESTS=ON &&
    cmake --build --preset release --target palpate_command || {
    lane_note="does not build"; count_check 1; return; }
  node tests/page/page_test.mjs "$root/build/release/bin/palpate" build/page "$results/page" | tee "$results/page.txt"
  local status=${PIPESTATUS[0]}
  lane_note=$(tail -n 1 "$results/page.txt")
  count_check "$status"
}

# The sources that clang-tidy has to check: all that changed, and for each changed header one source
# that includes it.
tidy_sources() {
  local base=$changed_since file
  if [ -z "$base" ]; then
    base=$(git rev-parse --verify --quiet HEAD^) || base=HEAD  # a shallow clone knows no more
  fi
  if [ $tidy_all = 1 ] || git diff --name-only "$base" | grep --quiet '^\.clang-tidy$'; then
    sources | grep '\.cpp$'
    return
  fi
  { git diff --name-only --diff-filter=d "$base"; git ls-files --others --exclude-standard; } |
    grep -E '^(lib|vdb|devices|tools|tests)/.*\.(h|cpp)$' | while read -r file; do
      case $file in
        *.cpp) echo "$file" ;;
        *) # prefer the source of the same name
          grep --recursive --files-with-matches --include='*.cpp' --fixed-strings \
            "$(sed -E 's,^.*/(include|private)/,,' <<< "$file")\"" lib vdb devices tools tests |
            awk -v stem="/$(basename "$file" .h).cpp" '{ if (index($0, stem)) { print; found = 1; exit } last = $0 }
              END { if (!found && last) print last }' ;;
      esac
    done | sort --unique
}

lane_tidy() {
  configure tidy -DPALPATE_TESTS=ON || { lane_note="does not configure"; count_check 1; return; }
  local list=$results/tidy.txt
  tidy_sources > "$list"
  lane_note="$(wc -l < "$list") files"
  # shellcheck disable=SC2016
  xargs --no-run-if-empty --max-procs="$(nproc)" --max-args=1 --arg-file="$list" sh -c \
    'echo "tidy $1"; exec clang-tidy -p build/tidy --quiet --extra-arg=-Wno-unknown-warning-option "$1" 2> /dev/null' tidy
  count_check $?
}

install_packages "${build_packages[@]}" "${test_packages[@]}"
use_ccache

for lane in "${lanes[@]}"; do
  say "$lane"
  began=$SECONDS lane_note=
  failed_before=$failed
  if "lane_$lane"; then
    word=ok
  else
    word=FAILED failed_lanes+=("$lane")
    # A lane that failed for whatever reason counts as at least one failure.
    [ "$failed" -gt "$failed_before" ] || failed=$((failed + 1))
  fi
  report+=("$(printf '%-8s %-7s %5d s  %s' "$lane" $word $((SECONDS - began)) "$lane_note")")
  printf '%s\n' "${report[-1]}"
done

say "Summary after $(elapsed)"
printf '%s\n' "${report[@]}"
tell_left_out
if [ -n "$is_default" ]; then
  echo "Not run: sanitizers and clang-tidy (tools/test.sh --ci), fuzzers, damaged files and mutants (--all); --help lists the lanes."
fi
[ ${#failed_lanes[@]} = 0 ] || echo "Failed: ${failed_lanes[*]}"
echo "$passed passed, $failed failed$([ $skipped = 0 ] || echo ", $skipped skipped")"
[ ${#failed_lanes[@]} = 0 ]
