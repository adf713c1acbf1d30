"""What a visitor finds first is true: versions agree, links lead somewhere, command blocks are run or say why not, issue forms
and workflows can be read, and the workflows call scripts and lanes that exist."""
import re
import subprocess
import unittest
from pathlib import Path

import run_blocks
import yaml

ROOT = Path(__file__).resolve().parents[2]


def text_of(name):
    return (ROOT / name).read_text()


def documents():
    return [path for path in ROOT.rglob("*.md") if "build" not in path.relative_to(ROOT).parts[:1]]


def anchors_of(text):
    """The anchors that a host of Markdown makes from the headings of a page."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    headings = re.findall(r"^#+ (.+)$", text, flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken_links(path):
    text = path.read_text()
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    for target in re.findall(r"\]\(([^)\s]+)\)", prose):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        page = (path.parent / name) if name else path
        if not page.exists():
            yield target
        elif anchor and page.suffix == ".md" and anchor not in anchors_of(page.read_text()):
            yield target


def is_run(page):
    """Whether a test runs the command blocks of a page (CMakeLists.txt), or the script that writes the page does."""
    name = str(page.relative_to(ROOT))
    return name in ("README.md", "data/README.md", "tools/docs/gallery.md") or (
        name.startswith(("tools/docs/tutorials/", "tools/docs/theory/")) and page.name != "README.md")


def blocks_nobody_runs(page):
    for block in run_blocks.blocks_of(page.read_text()):
        if block.language in run_blocks.RUN and not {"shown only", "file"} & block.marks.keys():
            yield f"line {block.line}: {block.text.splitlines()[0]}"


class Face(unittest.TestCase):
    def test_versions_agree(self):
        version = re.search(r"project\(palpate VERSION (\S+)", text_of("CMakeLists.txt"))[1]
        self.assertEqual(yaml.safe_load(text_of("CITATION.cff"))["version"], version)
        self.assertIn(f"\n## {version}", text_of("CHANGELOG.md"))

    def test_citation_has_all_that_the_format_requires(self):
        citation = yaml.safe_load(text_of("CITATION.cff"))
        for key in ("cff-version", "message", "title", "authors", "license"):
            self.assertIn(key, citation)

    def test_links_lead_somewhere(self):
        pages = documents()
        self.assertGreater(len(pages), 10)
        for page in pages:
            self.assertEqual(list(broken_links(page)), [], page)

    def test_a_broken_link_is_seen(self):
        page = ROOT / "tests/docs/README.md"
        self.assertEqual(anchors_of("# One `two`, 3\n```sh\n# no heading\n```\n"), {"one-two-3"})
        self.assertEqual(list(broken_links(page)), [])

    def test_each_command_block_is_run_or_says_why_not(self):
        for page in documents():
            if not is_run(page):
                self.assertEqual(list(blocks_nobody_runs(page)), [], page)

    def test_a_block_that_nobody_runs_is_seen(self):
        self.assertGreater(len(list(blocks_nobody_runs(ROOT / "tools/docs/gallery.md"))), 10)

    def test_issue_forms_have_all_that_they_require(self):
        forms = [form for form in (ROOT / ".github/ISSUE_TEMPLATE").glob("*.yml") if form.name != "config.yml"]
        self.assertGreater(len(forms), 1)
        for path in forms:
            form = yaml.safe_load(path.read_text())
            self.assertTrue(form["name"] and form["description"], path)
            ids = [part["id"] for part in form["body"] if part["type"] != "markdown"]
            self.assertEqual(len(ids), len(set(ids)), path)
            for part in form["body"]:
                self.assertIn("value" if part["type"] == "markdown" else "label", part["attributes"], path)

    def test_workflows_call_lanes_that_exist(self):
        help_text = subprocess.run(["bash", ROOT / "tools/test.sh", "--help"], capture_output=True, text=True,
                                   check=True).stdout
        lanes = set(re.findall(r"^  ([a-z]+)\s{2,}", help_text, flags=re.MULTILINE))
        workflows = list((ROOT / ".github/workflows").glob("*.yml"))
        self.assertGreater(len(workflows), 0)
        for path in workflows:
            for name, job in yaml.safe_load(path.read_text())["jobs"].items():
                commands = [step["run"] for step in job["steps"] if "run" in step]
                self.assertTrue(any("tools/test.sh" in command for command in commands), f"{path}: {name}")
                for lane in job.get("strategy", {}).get("matrix", {}).get("lane", []):
                    self.assertIn(lane, lanes, path)


if __name__ == "__main__":
    unittest.main()
