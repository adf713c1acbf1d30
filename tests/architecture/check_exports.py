"""check_exports.py ROOT LIBRARY...

Fails on a function of a public header (<module>/include) that a library made with BUILD_SHARED_LIBS would hide: its user could not
link it. The libraries, static or shared, are asked, so that what is inline or in no library does not count. Without libraries the
check is tested on headers and symbols of its own.
"""
import pathlib
import re
import subprocess
import sys


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)


def declared(text):
    """Names at namespace level: classes that are defined, and functions, each with its namespaces."""
    text = re.sub(r"^#.*(?:\\\n.*)*$", "", without_comments(text), flags=re.M)
    spaces, classes, functions = [], set(), set()
    statement = ""
    depth = 0  # depth of braces that do not open a namespace
    for char in text:
        if depth == 0 and char == "{":
            space = re.search(r"\bnamespace\s+([\w:]+)\s*$", statement)
            if space:
                spaces.append(space.group(1))
                statement = ""
                continue
        if char == "{":
            if depth == 0:
                kind = re.search(r"^\s*(?:template\s*<[^{]*>\s*)?(?:class|struct)\s+"
                                 r"(?:PALPATE_EXPORT\s+)?(\w+)", statement)
                if kind:
                    classes.add("::".join(spaces + [kind.group(1)]))
            depth += 1
        elif char == "}" and depth > 0:
            depth -= 1
            continue
        elif char == "}":
            spaces.pop()
            statement = ""
            continue
        elif char == ";" and depth == 0:
            function = re.search(r"([\w:]+)\s*\(", re.sub(r"\[\[.*?\]\]", "", statement))
            if function and not re.match(r"\s*(?:using|typedef|static_assert)\b", statement):
                functions.add("::".join(spaces + [function.group(1)]))
            statement = ""
            continue
        if depth == 0:
            # After a body a new statement begins.
            statement = "" if char == "{" else statement + char
    return classes, functions


def wrong(classes, functions, symbols):
    """Hidden functions among `symbols`, lines (visibility, demangled name), that the declarations promise."""
    out = []
    for visibility, name in symbols:
        if visibility == "DEFAULT":
            continue
        head = re.sub(r"\(.*$|\[.*$", "", name)
        if "<" in head:
            continue
        owner = head.rpartition("::")[0]
        if head in functions or owner in classes:
            out.append(name)
    return sorted(set(out))


def symbols_of(library):
    read = subprocess.run(["readelf", "--symbols", "--wide", library], check=True,
                          stdout=subprocess.PIPE, text=True)
    rows = [line.split() for line in read.stdout.splitlines()]
    # Defined in the library and not inline: inline ones are WEAK.
    rows = [row for row in rows
            if len(row) == 8 and row[3] == "FUNC" and row[4] != "WEAK" and row[6] != "UND"]
    names = subprocess.run(["c++filt"], input="\n".join(row[7] for row in rows), check=True,
                           stdout=subprocess.PIPE, text=True).stdout.splitlines()
    # Functions that only their own file knows need not be linkable.
    return [(row[5], name) for row, name in zip(rows, names)
            if row[4] == "GLOBAL" or row[5] == "HIDDEN"]


def test():
    header = """
#define PALPATE_EXPORT __attribute__((visibility("default")))
namespace palpate {
struct Plain { double x = 0.0; };  // no functions
class PALPATE_EXPORT Shown { public: void step() noexcept; };
class Hidden {
 public:
  explicit Hidden(double x) : x_(x) {}
  [[nodiscard]] double step(int n = f(2)) noexcept;
 private:
  double x_;
};
[[nodiscard]] PALPATE_EXPORT double
shown(double x);
namespace devices {
/// never(): is in a comment
[[nodiscard]] double hidden(const Plain& plain,
                            double x = 1.0);
[[nodiscard]] inline double made(double x) { return hidden({}, x); }
}  // namespace devices
}  // namespace palpate
"""
    classes, functions = declared(header)
    assert classes == {"palpate::Plain", "palpate::Shown", "palpate::Hidden"}, classes
    assert functions == {"palpate::shown", "palpate::devices::hidden"}, functions
    symbols = [("DEFAULT", "palpate::Shown::step()"), ("HIDDEN", "palpate::Hidden::step(int)"),
               ("DEFAULT", "palpate::shown(double)"), ("HIDDEN", "palpate::never()"),
               ("HIDDEN", "palpate::devices::hidden(palpate::Plain const&, double)"),
               ("HIDDEN", "palpate::inner::Hidden::step(int)")]
    found = wrong(classes, functions, symbols)
    assert found == ["palpate::Hidden::step(int)",
                     "palpate::devices::hidden(palpate::Plain const&, double)"], found


def main():
    if len(sys.argv) == 1:
        test()
        return 0
    classes, functions = set(), set()
    for header in sorted(pathlib.Path(sys.argv[1]).glob("*/include/palpate/**/*.h")):
        more = declared(header.read_text(encoding="utf-8"))
        classes |= more[0]
        functions |= more[1]
    symbols = [symbol for library in sys.argv[2:] for symbol in symbols_of(library)]
    shown = sum(1 for visibility, name in symbols
                if visibility == "DEFAULT" and re.sub(r"\(.*$", "", name) in functions)
    found = wrong(classes, functions, symbols)
    for name in found:
        print(f"{name} is declared in a public header and hidden in a shared library: PALPATE_EXPORT is missing")
    print(f"{len(classes)} classes and {len(functions)} functions of public headers, "
          f"{shown} of the functions are shown, {len(found)} hidden")
    return 1 if found or shown == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
