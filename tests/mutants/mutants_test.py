"""What the runner counts, with a workshop that compiles nothing."""

import argparse
import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import mutants


class Pretended:
    """Says of each mutant what `verdict` says."""

    folder = Path("nowhere")

    def __init__(self, verdict):
        self.verdict = verdict
        self.seen = []

    def make(self, _module):
        return True

    def exe(self, _module):
        return Path("none")

    def verdict_on(self, mutant, _module, _stages):
        self.seen.append(mutant)
        return self.verdict(len(self.seen))


def tried(workshop, number=20, seed="1", equivalents=(), tests=("Cut.A",)):
    options = argparse.Namespace(seed=seed, number=number, seconds=20.0)
    times, mutants.times_of = mutants.times_of, lambda _exe, _folder, _chosen: dict.fromkeys(tests, 0.1)
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            return mutants.try_module(workshop, "contact", options, dict.fromkeys(equivalents, "a reason"))
    finally:
        mutants.times_of = times


class Runner(unittest.TestCase):
    def test_what_does_not_compile_is_not_counted_and_a_hang_is_killed(self):
        verdicts = ["does not compile", "killed", "hung", "survived"]
        workshop = Pretended(lambda i: verdicts[i % 4])
        killed, counted, survivors = tried(workshop)
        self.assertEqual(counted, 20)
        self.assertEqual(killed + len(survivors), 20)
        self.assertEqual(len(workshop.seen), counted + sum(1 for i in range(1, len(workshop.seen) + 1) if i % 4 == 0))
        self.assertAlmostEqual(killed / counted, 2 / 3, delta=0.05)

    def test_nothing_is_tried_without_tests(self):
        workshop = Pretended(lambda _: "survived")
        with self.assertRaises(SystemExit):
            tried(workshop, tests=())
        self.assertEqual(workshop.seen, [])

    def test_the_same_seed_makes_the_same_mutants_and_another_one_others(self):
        runs = [Pretended(lambda _: "killed") for _ in range(3)]
        for workshop, seed in zip(runs, ["1", "1", "2"]):
            tried(workshop, seed=seed)
        self.assertEqual(runs[0].seen, runs[1].seen)
        self.assertNotEqual(runs[0].seen, runs[2].seen)

    def test_a_line_is_changed_once_and_what_is_listed_is_left_out(self):
        first = Pretended(lambda _: "survived")
        tried(first)
        self.assertEqual(len({(m.path, m.line) for m in first.seen}), len(first.seen))
        listed = {mutants.key_of(m) for m in first.seen[:5]}
        second = Pretended(lambda _: "survived")
        tried(second, equivalents=listed)
        self.assertFalse(listed & {mutants.key_of(m) for m in second.seen})

    def test_tests_run_from_the_quick_to_the_slow_within_the_budget(self):
        times = {"Planes.Slow": 30.0, "Sweep.A": 0.5, "Sweep.B": 0.1, "Cut.C": 4.0, "Elsewhere.D": 0.1}
        stages = mutants.stages_of("contact", times, 20.0)
        self.assertEqual([name for names, _ in stages for name in names], ["Sweep.B", "Sweep.A", "Cut.C"])

    def test_of_a_new_build_only_what_may_be_chosen_is_timed_again(self):
        script = """#!/usr/bin/env python3
import json, sys
from pathlib import Path
tests = ["Cut.Quick", "Cut.Slow", "Cut.Broken"]
if "--gtest_list_tests" in sys.argv:
    print("Cut.\\n  Quick\\n  Slow\\n  Broken")
    sys.exit()
flags = dict(word[2:].split("=", 1) for word in sys.argv[1:] if "=" in word)
wanted = Path(flags["gtest_flagfile"]).read_text().split("=")[1].split()[0].split(":")
with open("ran.txt", "a") as out:
    out.write(" ".join(wanted) + "\\n")
of = {"Quick": "0.5s", "Slow": "50s", "Broken": "0.1s"}
rows = [{"name": n, "time": of[n], "result": "COMPLETED", "failures": ["no"] * (n == "Broken")}
        for n in (w.split(".")[1] for w in wanted)]
Path(flags["gtest_output"][5:]).write_text(json.dumps({"testsuites": [{"name": "Cut", "testsuite": rows}]}))
"""
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            work = Path(folder)
            exe = work / "tests"

            def quick(times):
                return [([name for name in sorted(times) if times[name] < 20.0], 1.0)]

            def times():
                exe.chmod(0o755)
                return mutants.times_of(exe, work, quick)

            exe.write_text(script)
            self.assertEqual(times(), {"Cut.Quick": 0.5, "Cut.Slow": 50.0})
            self.assertEqual(times(), {"Cut.Quick": 0.5, "Cut.Slow": 50.0})  # unchanged: nothing runs
            exe.write_text(script + "# another build")
            self.assertEqual(times(), {"Cut.Quick": 0.5})
            ran = (work / "ran.txt").read_text().splitlines()
            self.assertEqual(ran, ["Cut.Broken Cut.Quick Cut.Slow", "Cut.Broken Cut.Quick"])

    def test_suites_are_known_whatever_their_parameters(self):
        self.assertEqual([mutants.suite_of(t) for t in ["A.b", "Part/A.b/3", "A/0.b"]], ["A", "A", "A"])

    def test_suites_that_a_folder_only_gives_parameters_to_are_its_own_too(self):
        self.assertIn("FieldContract", mutants.suites_in(mutants.ROOT / "tests" / "lib" / "fields"))

    def test_the_list_of_equivalent_mutants_is_read_or_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "list.txt"
            path.write_text("# why\nlib/src/a.cpp\n- a < b\n+ a <= b\n= both are\n  the same\n")
            self.assertEqual(mutants.read_equivalents(path), {("lib/src/a.cpp", "a < b", "a <= b"): "both are the same"})
            path.write_text("lib/src/a.cpp\n= no lines\n")
            with self.assertRaises(SystemExit):
                mutants.read_equivalents(path)

    def test_the_committed_list_is_of_lines_that_are_there(self):
        for path, before, after in mutants.read_equivalents(mutants.HERE / "equivalent.txt"):
            text = (mutants.ROOT / path).read_text()
            self.assertIn((before, after), {(m.before.strip(), m.after.strip()) for m in mutants.mutants_of(path, text)})

    def test_every_module_has_sources_and_tests(self):
        for module, (_, tests, folders) in mutants.MODULES.items():
            self.assertTrue(mutants.sources_of(module), module)
            for folder in folders:
                self.assertTrue(mutants.suites_in(mutants.ROOT / "tests" / tests / folder), folder)


if __name__ == "__main__":
    unittest.main()
