"""The runner of documents sees a command that fails and a result that is not the printed one, and nothing else."""
import os
import tempfile
import unittest
from pathlib import Path

import run_blocks


def run(text):
    with tempfile.TemporaryDirectory() as folder:
        document = Path(folder) / "document.md"
        document.write_text(text)
        return run_blocks.run_document(document, Path(folder), dict(os.environ))


class Blocks(unittest.TestCase):
    def test_a_command_that_fails_fails(self):
        self.assertEqual(run("```sh\ntrue\n```\n"), 1)
        with self.assertRaisesRegex(run_blocks.Mismatch, "document.md:1: exit code 1"):
            run("```sh\nfalse\ntrue\n```\n")

    def test_the_promised_lines_are_those_printed(self):
        self.assertEqual(run("```console\n$ printf 'a\\nb\\n'\na\nb\n$ echo c\nc\n```\n"), 1)
        for wrong in ("a", "a\nc", "a\nb\nc", "b\na"):
            with self.assertRaises(run_blocks.Mismatch, msg=wrong):
                run(f"```console\n$ printf 'a\\nb\\n'\n{wrong}\n```\n")

    def test_dots_stand_for_anything(self):
        run("```console\n$ seq 5\n1\n...\n4\n5\n```\n")
        run("```console\n$ seq 5\n1\n...\n```\n")
        run("```console\n$ echo from here to there\nfrom ... to there\n```\n")
        with self.assertRaises(run_blocks.Mismatch):
            run("```console\n$ seq 5\n1\n...\n6\n```\n")

    def test_numbers_may_differ_in_their_last_digit_only(self):
        run("```console\n$ echo 'force 1.23 N'\nforce 1.24 N\n```\n")
        run("```console\n$ echo 'force -0.0 N'\nforce 0.0 N\n```\n")
        run("```console\n$ echo '1 720 065  voxels'\n1 720 065 voxels\n```\n")
        with self.assertRaises(run_blocks.Mismatch):  # counts must match exactly
            run("```console\n$ echo '4 ports'\n5 ports\n```\n")
        for wrong in ("force 1.25 N", "force 1.23 mN", "force 11.23 N", "force -1.23 N"):
            with self.assertRaises(run_blocks.Mismatch, msg=wrong):
                run(f"```console\n$ echo 'force 1.23 N'\n{wrong}\n```\n")

    def test_times_and_sizes_vary_where_the_document_says_so(self):
        block = "```console\n$ echo 'took 1.2 us, 3 MB, 5 N'\ntook 350 ns, 1.4 GB, 5 N\n```\n"
        run("<!-- varies: times, sizes -->\n" + block)
        for marks in ("", "<!-- varies: times -->\n", "<!-- varies: times, sizes -->\nwords between\n\n"):
            with self.assertRaises(run_blocks.Mismatch, msg=marks):
                run(marks + block)
        with self.assertRaisesRegex(run_blocks.Mismatch, "not forces"):
            run("<!-- varies: forces -->\n" + block)

    def test_a_block_can_be_a_file(self):
        run("<!-- file: sub/a.txt -->\n```text\nhello\n```\n\n```console\n$ cat sub/a.txt\nhello\n```\n")

    def test_an_exit_code_that_is_promised_is_held_to(self):
        run("<!-- exits with: 3 -->\n```sh\nexit 3\n```\n")
        with self.assertRaises(run_blocks.Mismatch):
            run("<!-- exits with: 3 -->\n```sh\ntrue\n```\n")

    def test_what_is_only_shown_does_not_run(self):
        self.assertEqual(run("<!-- shown only: needs a device -->\n```sh\nfalse\n```\n"), 0)

    def test_long_commands_go_on_behind_a_backslash(self):
        run("```console\n$ echo a \\\n>   b\na b\n```\n")

    def test_a_block_without_end_is_an_error(self):
        with self.assertRaisesRegex(run_blocks.Mismatch, "no end"):
            run("```sh\ntrue\n")


if __name__ == "__main__":
    unittest.main()
