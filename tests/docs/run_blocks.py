#!/usr/bin/env python3
"""Runs the command blocks of a document, in the order in which a reader would, and compares what they print.

    run_blocks.py DOCUMENT.md [--source FOLDER] [--build FOLDER] [--prefix FOLDER] [--only-show]

tests/docs/README.md says how a document marks what varies, which file a block is, and what is only shown.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?: \d{3})*(?:\.\d+)?(?:e[-+]?\d+)?")
# A time or an amount of memory depends on the machine, and so does its unit.
VARYING = {
    "times": re.compile(r"(?<![\w.])\d[\d ]*(?:\.\d+)?(?:e[-+]?\d+)? (?:ns|us|ms|s|min)\b"),
    "sizes": re.compile(r"(?<![\w.])\d[\d ]*(?:\.\d+)?(?:e[-+]?\d+)? (?:B|kB|KB|MB|GB|KiB|MiB|GiB|bytes)(?!\w)"),
}
RUN = ("sh", "console")


@dataclass
class Block:
    language: str
    line: int
    text: str
    marks: dict = field(default_factory=dict)


class Mismatch(Exception):
    pass


def blocks_of(text):
    """The fenced blocks of a document, each with the marks of the comments that stand right before it."""
    blocks, marks, block = [], {}, None
    for number, line in enumerate(text.split("\n"), 1):
        if block is not None:
            if line == "```":
                blocks.append(block)
                block, marks = None, {}
            else:
                block.text += line + "\n"
            continue
        fence = re.fullmatch(r"```(\w*)", line)
        mark = re.fullmatch(r"<!-- (file|varies|shown only|exits with): (.+) -->", line)
        if fence:
            block = Block(fence[1], number, "", marks)
        elif mark:
            marks[mark[1]] = mark[2]
        elif line.strip():
            marks = {}
    if block is not None:
        raise Mismatch(f"line {block.line}: the block has no end")
    return blocks


def commands_of(text):
    """The commands of a console block, each with the lines that it prints."""
    commands = []
    for line in text.rstrip("\n").split("\n"):
        if line.startswith("$ "):
            commands.append([line[2:], []])
        elif not commands:
            raise Mismatch("a console block begins with a line '$ COMMAND'")
        elif commands[-1][0].endswith("\\") and not commands[-1][1]:
            commands[-1][0] += "\n" + line.removeprefix("> ")
        else:
            commands[-1][1].append(line)
    return commands


def number_of(text):
    return float(text.replace(" ", ""))


def last_digit(text):
    """The value of one step of the last digit: 0.01 for 3.14; 0 for a count, which is exact."""
    mantissa, _, exponent = text.replace(" ", "").partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - decimals) if decimals or exponent else 0.0


def same_line(printed, promised, varies):
    """Whether a printed line is the promised one: '...' stands for anything, and a number with decimals may differ by one
    in its last digit, because the last bit of a sum depends on the processor's instructions."""
    for kind in varies:
        printed, promised = (VARYING[kind].sub(kind, line) for line in (printed, promised))
    printed, promised = (" ".join(line.split()) for line in (printed, promised))
    if "..." in promised:
        pattern = ".*".join(re.escape(part.strip()) for part in promised.split("..."))
        return re.fullmatch(pattern, printed) is not None
    if NUMBER.sub("#", printed) != NUMBER.sub("#", promised):
        return False
    for one, other in zip(NUMBER.findall(printed), NUMBER.findall(promised)):
        step = max(last_digit(one), last_digit(other))
        if abs(number_of(one) - number_of(other)) > 1.000001 * step:
            return False
    return True


def first_difference(printed, promised, varies):
    """The first promised line that is not printed, or None. A line '...' alone stands for any number of lines."""
    while printed and not printed[-1].strip():
        printed = printed[:-1]
    at, skipping = 0, False
    for line in promised:
        if line.strip() == "...":
            skipping = True
            continue
        if skipping:
            while at < len(printed) and not same_line(printed[at], line, varies):
                at += 1
            skipping = False
        if at >= len(printed) or not same_line(printed[at], line, varies):
            return line
        at += 1
    return None if skipping or at == len(printed) else "(nothing more)"


def shell(command, folder, environment):
    script = "shopt -s expand_aliases\nset -e -o pipefail\n" + command
    return subprocess.run(["bash", "-c", script], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, check=False)


def run_block(block, folder, environment):
    wanted = int(block.marks.get("exits with", "0"))
    varies = [kind.strip() for kind in block.marks.get("varies", "").split(",") if kind.strip()]
    if unknown := [kind for kind in varies if kind not in VARYING]:
        raise Mismatch(f"'varies' takes {', '.join(VARYING)}, not {unknown[0]}")
    commands = [[block.text, None]] if block.language == "sh" else commands_of(block.text)
    for command, promised in commands:
        result = shell(command, folder, environment)
        if result.returncode != wanted:
            raise Mismatch(f"exit code {result.returncode} instead of {wanted} of\n{command}\n{result.stdout}{result.stderr}")
        if promised is None:
            continue
        difference = first_difference(result.stdout.split("\n"), promised, varies)
        if difference is not None:
            raise Mismatch(f"{command}\nprinted\n{result.stdout}\nwhere the document says\n  {difference}\n{result.stderr}")


def run_document(document, folder, environment):
    """Runs the blocks in `folder`; returns how many ran."""
    ran = 0
    for block in blocks_of(document.read_text()):
        try:
            if "file" in block.marks:
                target = folder / block.marks["file"]
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_text(block.text)
            elif block.language in RUN and "shown only" not in block.marks:
                run_block(block, folder, environment)
                ran += 1
        except Mismatch as mismatch:
            raise Mismatch(f"{document}:{block.line}: {mismatch}") from None
    return ran


def lay_out(folder, source, build):
    """A folder that looks like the repository's root with a release build in it, and can be written to."""
    for entry in source.iterdir():
        if entry.name not in ("build", ".git"):
            (folder / entry.name).symlink_to(entry)
    (folder / "build").mkdir()
    (folder / "build" / "release").symlink_to(build)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("document", type=Path)
    parser.add_argument("--source", type=Path, default=Path(__file__).resolve().parents[2])
    parser.add_argument("--build", type=Path, help="build folder, default SOURCE/build/release")
    parser.add_argument("--prefix", type=Path, help="where an installed palpate is, for blocks that build against it")
    given = parser.parse_args()
    source = given.source.resolve()
    build = (given.build or source / "build" / "release").resolve()
    environment = dict(os.environ, LC_ALL="C.UTF-8", PALPATE_CACHE="off", PATH=f"{build / 'bin'}:{os.environ['PATH']}")
    if given.prefix:
        environment["CMAKE_PREFIX_PATH"] = str(given.prefix.resolve())
    with tempfile.TemporaryDirectory(prefix="palpate_docs_") as folder:
        lay_out(Path(folder), source, build)
        try:
            ran = run_document(given.document.resolve(), Path(folder), environment)
        except Mismatch as mismatch:
            print(mismatch)
            return 1
    print(f"{given.document.name}: {ran} blocks ran")
    return 0 if ran else 1


if __name__ == "__main__":
    sys.exit(main())
