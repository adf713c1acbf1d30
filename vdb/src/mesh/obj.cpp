#include <algorithm>
#include <optional>
#include <string_view>

#include "mesh/builder.h"
#include "mesh/scanner.h"
#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

class Obj {
 public:
  Obj(std::string_view text, const std::string& path, double meters_per_unit)
      : scanner_{text}, path_(path), builder_(path, meters_per_unit) {}

  Mesh read() {
    for (std::string_view key = scanner_.word(); !key.empty(); key = scanner_.word()) {
      if (key == "v") readVertex();
      if (key == "f") readFace();
      scanner_.skipLine();
    }
    return builder_.take();
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(ErrorKind::kInput,
                {"mesh.unreadable", what, "export the mesh again", path_, scanner_.line});
  }

  /// The next word of this line, or of the next one where this line ends in a backslash; empty at
  /// the end.
  std::string_view wordOfLine() {
    for (;;) {
      std::string_view word = scanner_.wordOfLine();
      if (!word.ends_with('\\') || !endsLine()) return word;
      scanner_.at = std::min(scanner_.text.find('\n', scanner_.at), scanner_.text.size() - 1) + 1;
      ++scanner_.line;
      word.remove_suffix(1);
      if (!word.empty()) return word;
    }
  }

  [[nodiscard]] bool endsLine() const {
    const std::size_t next = scanner_.text.find_first_not_of(" \t\r", scanner_.at);
    return next == std::string_view::npos || scanner_.text[next] == '\n';
  }

  void readVertex() {
    Vec3 p(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = wordOfLine();
      if (word.empty()) refuse("a vertex has fewer than three coordinates");
      const std::optional<double> value = numberOf(word);
      if (!value) refuse("'" + std::string(word.substr(0, 40)) + "' is not a number");
      p[axis] = *value;
    }
    vertices_.push_back(builder_.addVertex(
        p, [&] { return "vertex " + std::to_string(vertices_.size() + 1) + " (from 1)"; },
        scanner_.line));
  }

  /// Corners are `vertex`, `vertex/texture/normal` and the like; negative ones count from the last.
  void readFace() {
    corners_.clear();
    for (std::string_view word = wordOfLine(); !word.empty(); word = wordOfLine()) {
      const std::string_view text = word.substr(0, word.find('/'));
      long long number = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
      if (error == std::errc::invalid_argument || end != text.data() + text.size()) {
        refuse("'" + std::string(word.substr(0, 40)) + "' is not the number of a vertex");
      }
      const auto count = static_cast<long long>(vertices_.size());
      const long long index = number < 0 ? count + number : number - 1;
      if (error != std::errc() || index < 0 || index >= count) {
        throw Error(ErrorKind::kInput,
                    {"mesh.index",
                     "a face names vertex " + std::string(text) + ", but " + std::to_string(count) +
                         " vertices stand before it",
                     "the file is damaged or was written wrongly; export the mesh again", path_,
                     scanner_.line});
      }
      corners_.push_back(vertices_[static_cast<std::size_t>(index)]);
    }
    if (corners_.size() < 3) refuse("a face has fewer than three corners");
    builder_.addPolygon(corners_);
  }

  Scanner scanner_;
  const std::string& path_;
  MeshBuilder builder_;
  std::vector<std::uint32_t> vertices_;  ///< number in the file -> number of the welded vertex
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Mesh readObj(const std::string& path, double meters_per_unit) {
  const std::string bytes = readBytes(path);
  return Obj(bytes, path, meters_per_unit).read();
}

}  // namespace palpate::vdb
