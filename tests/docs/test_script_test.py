"""tools/test.sh: CI runs all that has to pass, and progress hides no line that tells of a failure."""
import re
import subprocess
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = (ROOT / "tools/test.sh").read_text()


def progress_of(lines):
    function = re.search(r"^progress\(\).*?^}", SCRIPT, flags=re.MULTILINE | re.DOTALL)[0]
    script = function + '\nset -uo pipefail\n{ printf "%s\\n" "$@"; false; } | progress built'
    result = subprocess.run(["bash", "-c", script, "progress", *lines], capture_output=True, text=True, check=False)
    return result.returncode, result.stdout.splitlines()


class TestScript(unittest.TestCase):
    def test_ci_runs_the_lanes_that_have_to_pass(self):
        self.assertIn("tools/test.sh\" --ci", (ROOT / ".ci/run").read_text())
        lanes = dict(re.findall(r"^(\w+_lanes)=\((.*)\)$", SCRIPT, flags=re.MULTILINE))
        self.assertEqual(lanes["default_lanes"].split(), ["format", "arrows", "release"])
        self.assertEqual(lanes["ci_lanes"].split()[1:], ["asan", "tsan", "tidy"])

    def test_counted_lines_become_the_time_left(self):
        status, printed = progress_of(["[0/2] Re-checking", "[1/2] Building a", "[2/2] Linking b"])
        self.assertEqual(printed, ["built 2 of 2, about 0:00 min left"])
        self.assertEqual(status, 1, "the status of what was run is kept")

    def test_everything_else_is_passed_on(self):
        lines = ["a.cpp:3: error: no", "FAILED: a.o", " 2/3 Test #2: b ......***Failed  1.0 sec", "", "expected 1"]
        self.assertEqual(progress_of(lines)[1], lines)
        self.assertEqual(progress_of(["      Start   1: a", " 1/9 Test #1: a ....   Passed  0.1 sec"])[1], [])


if __name__ == "__main__":
    unittest.main()
