"""What the operators make of lines, and which lines they leave alone."""

import unittest

from operators import applied, blanked, code_lines, mutants_of

SOURCE = """#include <cmath>
// if (a < b) in a comment
namespace palpate {
namespace {

constexpr int kMost = 3;

struct Part {
  double size = 1.0;
  int count() const { return count_ + 1; }
  int count_ = 0;
};

}  // namespace

double Shape::value(const Vec3& p) const noexcept {
  assert(p.x < 1.0);
  const double r = glm::length(p) - radius_;  // + 1
  if (r < 0.0 && is_open_) {
    return -r;
  }
  report("a < b");
  total_ += r;
  std::vector<double> list;
  for (std::size_t i = 0; i < list.size(); ++i) {
    best = std::min(best, list[i]);
  }
  return r;
}

void Shape::forget() noexcept {
  started_ = false;
  walker_.forget();
}

}  // namespace palpate
"""


def made_of(text):
    return {(m.kind, m.after.strip()) for m in mutants_of("a.cpp", text)}


class Operators(unittest.TestCase):
    def setUp(self):
        self.made = made_of(SOURCE)
        self.lines = {m.line for m in mutants_of("a.cpp", SOURCE)}

    def line_of(self, part):
        return next(i for i, line in enumerate(SOURCE.split("\n"), start=1) if part in line)

    def test_each_makes_its_slip(self):
        for wanted in [
                ("comparison", "if (r >= 0.0 && is_open_) {"),
                ("logic", "if (r < 0.0 || is_open_) {"),
                ("condition", "if (!(r < 0.0 && is_open_)) {"),
                ("constant", "if (r < 1.0 && is_open_) {"),
                ("sign", "return r;"),
                ("arithmetic", "const double r = glm::length(p) + radius_;  // + 1"),
                ("arithmetic", "total_ -= r;"),
                ("arithmetic", "int count() const { return count_ - 1; }"),
                ("constant", "int count() const { return count_ + 2; }"),
                ("off by one", "for (std::size_t i = 0; i <= list.size(); ++i) {"),
                ("function", "best = std::max(best, list[i]);"),
                ("removed statement", "{}"),
                ("returned nothing", "return {};"),
                ("returned early", "return;"),
                ("constant", "started_ = true;"),
        ]:
            self.assertIn(wanted, self.made)

    def test_only_code_is_changed(self):
        for part in ["#include", "in a comment", "kMost = 3", "double size", "int count_", "assert(", "namespace {",
                     "std::vector<double> list"]:
            self.assertNotIn(self.line_of(part), self.lines, part)
        self.assertFalse(any("a >= b" in after or "- 1\n" in after for _, after in self.made))

    def test_template_brackets_are_no_comparisons(self):
        made = made_of("void f() {\n  const std::array<double, 3> a = g<int>(std::vector<Vec3>(n));\n}\n")
        self.assertEqual([m for m in made if m[0] == "comparison"], [])

    def test_declarations_are_not_removed(self):
        made = made_of("void f() {\n  double a = 2.0;\n  const Vec3 b(a);\n  auto c = b;\n  Vec3 d;\n  d = b;\n  x.y->z(1);\n  ++n;\n}\n")
        removed = {line for line in mutants_of("a.cpp", "void f() {\n  double a = 2.0;\n  Vec3 d;\n  d = b;\n}\n")
                   if line.kind == "removed statement"}
        self.assertEqual({m.before.strip() for m in removed}, {"d = b;"})
        self.assertEqual(sum(1 for m in made if m[0] == "removed statement"), 1)  # three lines, one text: {}

    def test_a_lambda_keeps_its_own_return(self):
        text = "double f() {\n  const auto g = [&](int i) {\n    h(i);\n    return i;\n  };\n  k();\n  return 1.5;\n}\n"
        early = [m.line for m in mutants_of("a.cpp", text) if m.kind == "returned early"]
        self.assertEqual(early, [6])

    def test_what_is_within_literals_and_comments_is_blanked_in_place(self):
        text = "a = 'x'; b = \"//\"; /* c\nd */ e = R\"(f\n\")\"; g = 1'000;"
        self.assertEqual(blanked(text), "a =    ; b =     ;     \n     e =     \n   ; g = 1'000;")
        self.assertEqual(len(blanked(text)), len(text))

    def test_every_mutant_differs_in_its_line_alone(self):
        for mutant in mutants_of("a.cpp", SOURCE):
            changed = applied(mutant, SOURCE).split("\n")
            differing = [i for i, (a, b) in enumerate(zip(SOURCE.split("\n"), changed), start=1) if a != b]
            self.assertEqual(differing, [mutant.line])

    def test_code_is_what_stands_in_bodies(self):
        first = code_lines(SOURCE)[0]
        self.assertEqual(first.number, self.line_of("int count() const"))
        self.assertEqual(first.code.strip(), "return count_ + 1; }")


if __name__ == "__main__":
    unittest.main()
