"""The check of words sees what it is for, in comments and texts of C++ only."""
import unittest
from pathlib import Path

import check_words


def phrases(text):
    return [number for number, _ in check_words.phrases_found(text, list(check_words.banned_phrases()))]


class Words(unittest.TestCase):
    def test_phrases_that_stop_a_reader(self):
        self.assertEqual(phrases("fine\n'x' is no count\nthe place is told\nfar out of the band"), [2, 3, 4])
        self.assertEqual(phrases("there is no file; it is no longer; told apart; are told from others; is not a count"), [])

    def test_code_is_not_read_but_its_comments_and_texts(self):
        text = 'int colour = 1;  // a note\nf("x is no y");\n/* two\nlines */ char c = \'"\';\ng(R"(raw\ntext)");\n'
        self.assertEqual(check_words.words_of_code(text),
                         ' // a note\n "x is no y"\n /* two\n lines */ \'"\'\n R"(raw\n text)"\n')

    def test_spelling(self):
        self.assertEqual([number for number, _ in check_words.slips_found("a color\na colour\nthe centre\n")], [2, 3])

    def test_words_that_are_wrong_on_purpose_are_left_out(self):
        self.assertEqual(list(check_words.files(["tests/words/banned.txt", "LICENSE"])), [])
        self.assertEqual(list(check_words.files(["README.md"])), [Path("README.md")])


if __name__ == "__main__":
    unittest.main()
