#!/usr/bin/env python3
"""Do the tests see it when the sources are wrong? One small slip at a time in a copy of them; README.md has the rest."""

import argparse
import functools
import hashlib
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from operators import applied, mutants_of

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
LEAST_SHARE = 0.9
MOST_MEMORY = 6 << 30  # [bytes] of a test run; a mutant may ask for any amount

# For each module: its sources, the test executable, and the folders of tests that cover it, its own
# first.
MODULES = {
    "contact": ("lib/src/contact", "lib", ["contact", "render"]),
    "render": ("lib/src/render", "lib", ["render"]),
    "interior": ("lib/src/interior", "lib", ["interior", "render", "scene"]),
    "fields": ("lib/src/fields", "lib", ["fields", "render", "scene"]),
    "scene": ("lib/src/scene", "lib", ["scene", "render"]),
    "devices": ("devices/src", "devices", [""]),
}

# Executables that look at a module too and run whole, last, for what survived the others: they talk to the kernel's
# interfaces, which umockdev stands for.
LAST = {"devices": ["palpate_evdev_tests", "palpate_usb_tests"]}
PRELOADED = "libumockdev-preload.so.0"


def say(text):
    print(text, flush=True)


def sources_of(module):
    return sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / MODULES[module][0]).rglob("*.cpp"))


def write_if_new(path, text):
    if not path.exists() or path.read_text() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def copy_tree(tree):
    """lib and devices by content, so that only what changed is compiled; all else is looked at where it is."""
    for name in ("lib", "devices"):
        wanted = set()
        for path in (ROOT / name).rglob("*"):
            if path.is_file():
                write_if_new(tree / path.relative_to(ROOT), path.read_text())
                wanted.add(path.relative_to(ROOT))
        for path in [p for p in (tree / name).rglob("*") if p.is_file()]:
            if path.relative_to(tree) not in wanted:
                path.unlink()
    for name in ("CMakeLists.txt", "CMakePresets.json", "tests", "tools", "data", "README.md"):
        link = tree / name
        if not link.exists():
            link.symlink_to(ROOT / name)


def configure(tree, build):
    if (build / "build.ninja").exists():
        return
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    linker = ["-DCMAKE_EXE_LINKER_FLAGS=-fuse-ld=gold"] if shutil.which("ld.gold") else []
    subprocess.run(["cmake", "-S", tree, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
                    "-DCMAKE_CXX_FLAGS_DEBUG=", "-DCMAKE_CXX_FLAGS=-O1 -w", "-DPALPATE_VDB=OFF", "-DPALPATE_TESTS=ON",
                    "-DPALPATE_INSTALL=OFF", *launcher, *linker], check=True, stdout=subprocess.DEVNULL)


def compiles(build, target, log):
    """False if it does not compile. Nobody waits longer than ten minutes for one file."""
    with open(log, "w", encoding="utf-8") as out:
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", "2")
        return subprocess.run(["ninja", "-C", build, "-j", jobs, target], stdout=out, stderr=out,
                              check=False).returncode == 0


def run_tests(exe, names, seconds, log, json_file=None, preloaded=None):
    """'passed', 'failed' or 'hung'."""
    flags = log.with_suffix(".flags")
    flags.write_text("--gtest_filter=" + ":".join(names) + "\n")
    environment = {**os.environ, "LD_PRELOAD": preloaded} if preloaded else None
    command = [exe, f"--gtest_flagfile={flags}", "--gtest_brief=1"]
    command += [f"--gtest_output=json:{json_file}"] if json_file else ["--gtest_fail_fast"]
    with open(log, "w", encoding="utf-8") as out:
        process = subprocess.Popen(command, stdout=out, stderr=out, cwd=log.parent, start_new_session=True,
                                   env=environment, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY)))
        try:
            return "passed" if process.wait(seconds) == 0 else "failed"
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return "hung"


def suites_in(folder):
    """The suites that the files of a folder of tests begin, or give parameters to."""
    names = set()
    for path in folder.rglob("*.cpp"):
        text = path.read_text()
        names |= set(re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+)", text, re.M))
        names |= set(re.findall(r"^INSTANTIATE_TEST_SUITE_P\(\s*\w*,\s*(\w+)", text, re.M))
    return names


def suite_of(test):
    """Without the names that parameters put before and after it."""
    return re.sub(r"/\d+$", "", test.split(".")[0]).split("/")[-1]


def listed(exe):
    """The names of all tests."""
    names, suite = [], ""
    told = subprocess.run([exe, "--gtest_list_tests"], check=True, capture_output=True, text=True).stdout
    for line in told.splitlines():
        text = line.split("#")[0].rstrip()
        if text.startswith("  "):
            names.append(suite + text.strip())
        elif text.endswith("."):
            suite = text
    return names


def times_of(exe, work, chosen):
    """[s] of each test that `chosen` picks and that passes as the sources stand; measured once for each build. It picks by
    the times of an earlier build, so that the slow ones, which no mutant waits for, do not run again for a new one."""
    kept = work / "times.json"
    known = json.loads(kept.read_text()) if kept.exists() else {}
    own = known.setdefault(exe.name, {})
    measured = own.setdefault("times", {})
    digest = hashlib.sha256(Path(exe).read_bytes()).hexdigest()
    if own.get("digest") != digest:
        own.update({"digest": digest, "passed": [], "failed": []})
    tried = {*own["passed"], *own["failed"]}
    guessed = {name: measured.get(name, 0.0) for name in listed(exe)}
    wanted = [name for names, _ in chosen(guessed) for name in names if name not in tried]
    if wanted:
        say(f"timing {len(wanted)} tests of {exe.name}")
        result = work / "baseline.json"
        result.unlink(missing_ok=True)
        run_tests(exe, wanted, 3600, work / "baseline.txt", result)
        if not result.exists():
            sys.exit(f"error: the tests do not come to an end as the sources stand, see {work / 'baseline.txt'}")
        for suite in json.loads(result.read_text())["testsuites"]:
            for test in suite["testsuite"]:
                name = suite["name"] + "." + test["name"]
                measured[name] = float(test["time"].rstrip("s"))
                passed = not test.get("failures") and test["result"] == "COMPLETED"
                own["passed" if passed else "failed"].append(name)
        kept.write_text(json.dumps(known))
    return {name: measured[name] for name in own["passed"]}


def stages_of(module, times, seconds):
    """Lists of tests with their time [s]: of each folder the quick ones, then what `seconds` hold of the slow."""
    stages = []
    for folder in MODULES[module][2]:
        suites = suites_in(ROOT / "tests" / MODULES[module][1] / folder)
        tests = sorted((time_, name) for name, time_ in times.items() if suite_of(name) in suites)
        spent = 0.0
        batch, batch_time = [], 0.0
        for time_, name in tests:
            if spent + time_ > seconds:
                break
            spent += time_
            batch.append(name)
            batch_time += time_
            if batch_time > 1.0:
                stages.append((batch, batch_time))
                batch, batch_time = [], 0.0
        if batch:
            stages.append((batch, batch_time))
    # The quickest tests of all folders come first: most mutants are noticed at once.
    return sorted(stages, key=lambda stage: stage[1] / len(stage[0]))


def read_equivalents(path):
    """{(file, line before, line after): reason}, the lines without their indentation."""
    out = {}
    file = before = after = None
    for number, line in enumerate(path.read_text().split("\n"), start=1):
        if not line.strip() or line.startswith("#"):
            continue
        if line.startswith("- "):
            before, after = line[2:].strip(), None
        elif line.startswith("+ "):
            after = line[2:].strip()
        elif line.startswith("= ") and None not in (file, before, after):
            out[(file, before, after)] = line[2:].strip()
        elif line.startswith("  ") and (file, before, after) in out:
            out[(file, before, after)] += " " + line.strip()
        elif re.fullmatch(r"[\w/.]+\.cpp", line):
            file, before, after = line, None, None
        else:
            sys.exit(f"error: {path}:{number}: '{line}' is not a file, '- line', '+ line' or '= reason' in this order")
    return out


def key_of(mutant):
    return (mutant.path, mutant.before.strip(), mutant.after.strip())


class Workshop:
    def __init__(self, folder):
        self.folder = folder
        self.tree = folder / "tree"
        self.build = folder / "build"
        folder.mkdir(parents=True, exist_ok=True)
        self.tree.mkdir(exist_ok=True)
        copy_tree(self.tree)
        configure(self.tree, self.build)

    def exe(self, module):
        return self.build / "tests" / f"palpate_{MODULES[module][1]}_tests"

    def make(self, module):
        return compiles(self.build, self.exe(module).name, self.folder / "build.txt")

    def verdict_on(self, mutant, module, stages):
        """'survived', 'killed', 'hung' or 'does not compile'."""
        path = self.tree / mutant.path
        original = path.read_text()
        path.write_text(applied(mutant, original))
        try:
            if not self.make(module):
                return "does not compile"
            for names, seconds in stages:
                told = run_tests(self.exe(module), names, 20.0 + 10.0 * seconds, self.folder / "tests.txt")
                if told != "passed":
                    return "killed" if told == "failed" else "hung"
            for told in map(self.whole, LAST.get(module, [])):
                if told != "passed":
                    return "killed" if told == "failed" else "hung"
            return "survived"
        finally:
            path.write_text(original)

    def whole(self, name):
        """What all tests of an executable say."""
        if not compiles(self.build, name, self.folder / "build.txt"):
            sys.exit(f"error: {name} does not compile, see {self.folder / 'build.txt'}")
        return run_tests(self.build / "tests" / name, ["*"], 120.0, self.folder / "tests.txt", preloaded=PRELOADED)


def try_module(workshop, module, options, equivalents):
    """How many were killed, how many count, and who survived."""
    if not workshop.make(module):
        sys.exit(f"error: the sources do not compile as they stand, see {workshop.folder / 'build.txt'}")
    for name in LAST.get(module, []):
        if workshop.whole(name) != "passed":
            sys.exit(f"error: {name} fails as the sources stand, see {workshop.folder / 'tests.txt'}")
    choose = functools.partial(stages_of, module, seconds=options.seconds)
    stages = choose(times_of(workshop.exe(module), workshop.folder, choose))
    if not stages:
        sys.exit(f"error: no test of {module} passes as the sources stand, see {workshop.folder / 'baseline.txt'}")
    candidates = [m for path in sources_of(module) for m in mutants_of(path, (ROOT / path).read_text())]
    chance = random.Random(f"{options.seed} {module}")
    chance.shuffle(candidates)
    killed, counted, survivors, lines = 0, 0, [], set()
    for mutant in candidates:
        if counted == options.number:
            break
        if (mutant.path, mutant.line) in lines or key_of(mutant) in equivalents:
            continue
        lines.add((mutant.path, mutant.line))
        began = time.monotonic()
        verdict = workshop.verdict_on(mutant, module, stages)
        say(f"  {verdict:16} {time.monotonic() - began:5.0f} s  {mutant.path}:{mutant.line} {mutant.kind}: "
            f"{mutant.before.strip()}  ->  {mutant.after.strip()}")
        if verdict == "does not compile":
            continue
        counted += 1
        killed += verdict != "survived"
        if verdict == "survived":
            survivors.append(mutant)
    return killed, counted, survivors


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    number = int(os.environ.get("PALPATE_MUTANTS_PER_MODULE", "40"))
    parser.add_argument("--seed", default=os.environ.get("PALPATE_MUTANTS_SEED", "1"))
    parser.add_argument("--number", type=int, default=number, help="mutants of each module that compile")
    parser.add_argument("--seconds", type=float, default=60.0, help="of tests of each folder for one mutant, at most")
    parser.add_argument("--module", action="append", choices=MODULES, help="only this one; may be given several times")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "mutants")
    options = parser.parse_args()
    equivalents = read_equivalents(HERE / "equivalent.txt")
    workshop = Workshop(options.folder.resolve())
    rows, failed, all_survivors = [], [], []
    for module in options.module or MODULES:
        say(f"{module}, seed {options.seed}")
        began = time.monotonic()
        killed, counted, survivors = try_module(workshop, module, options, equivalents)
        share = killed / counted if counted else 0.0
        rows.append(f"{module:10} {killed:4} of {counted:4} killed, {100 * share:5.1f} %  "
                    f"{time.monotonic() - began:6.0f} s")
        all_survivors += survivors
        if share < LEAST_SHARE:
            failed.append(module)
    say("")
    for row in rows:
        say(row)
    for mutant in all_survivors:
        say(f"survived: {mutant.path}:{mutant.line} ({mutant.kind})\n  - {mutant.before.strip()}\n  + {mutant.after.strip()}")
    if failed:
        say(f"less than {100 * LEAST_SHARE:.0f} % killed: {', '.join(failed)}")
    say(f"{len(rows) - len(failed)} of {len(rows)} modules passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
