#!/usr/bin/env python3
"""Holds the English of the project to its own rules: phrases that stop a reader (banned.txt), British spelling and
common slips (codespell, but for the words in ignored.txt).

    check_words.py [FILE...]        default: every file of the repository

Of C++ it reads comments and texts in quotes, of other files everything.
"""
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
READ = {".h", ".cpp", ".md", ".py", ".sh", ".cmake", ".yaml", ".yml", ".txt", ".in", ".cff"}
CODE = {".h", ".cpp"}
# Files that quote wrong words, or contain names that others gave.
LEFT_OUT = ("tests/words/", "data/materials/names.yaml", "LICENSE")
TOKENS = re.compile(
    r'R"([^(\s]*)\((?:.|\n)*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|//[^\n]*|/\*(?:.|\n)*?\*/')


def words_of_code(text):
    """Comments and texts in quotes, on the lines where they stand; the rest is blank."""
    kept = [""] * (text.count("\n") + 1)
    for token in TOKENS.finditer(text):
        line = text.count("\n", 0, token.start())
        for number, part in enumerate(token[0].split("\n")):
            kept[line + number] += " " + part
    return "\n".join(kept)


def readable(path, text):
    return words_of_code(text) if path.suffix in CODE else text


def banned_phrases():
    """(what it looks like, what to write instead) for each line of banned.txt."""
    for line in (HERE / "banned.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            pattern, _, instead = line.partition("  ->  ")
            yield re.compile(pattern), instead


def phrases_found(text, phrases):
    for number, line in enumerate(text.split("\n"), 1):
        for pattern, instead in phrases:
            if match := pattern.search(line):
                yield number, f"'{match[0].strip()}': {instead}"


def slips_found(text):
    """What codespell finds, by line."""
    result = subprocess.run(
        ["codespell", "--builtin", "clear,rare,en-GB_to_en-US", "--ignore-words", str(HERE / "ignored.txt"), "-"],
        input=text, capture_output=True, text=True, check=False)
    for number, slip in re.findall(r"^(\d+): .*\n\t(.+)$", result.stdout, flags=re.MULTILINE):
        yield int(number), slip


def files(given):
    names = given or subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True,
                                    check=True).stdout.splitlines()
    for name in names:
        path = Path(name)
        if path.suffix in READ and not name.startswith(LEFT_OUT) and (ROOT / path).is_file():
            yield path


def main(given):
    phrases, wrong, pages, texts = list(banned_phrases()), 0, [], []
    for path in files(given):
        text = readable(path, (ROOT / path).read_text(errors="replace"))
        for number, finding in phrases_found(text, phrases):
            print(f"{path}:{number}: {finding}")
            wrong += 1
        pages.append((path, text.count("\n") + 1))
        texts.append(text)
    # One run over everything, because codespell takes longer to start than to read a page.
    ends = []
    for path, lines in pages:
        ends.append((path, (ends[-1][1] if ends else 0) + lines))
    for number, slip in slips_found("\n".join(texts)):
        begin = 0
        for path, end in ends:
            if number <= end:
                print(f"{path}:{number - begin}: {slip}")
                break
            begin = end
        wrong += 1
    print(f"{len(pages)} files, {wrong} findings")
    return 1 if wrong or not pages else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
