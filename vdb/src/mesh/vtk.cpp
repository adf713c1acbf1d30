#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "mesh/builder.h"
#include "mesh/scanner.h"
#include "palpate/core/error.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

constexpr ScalarName kScalars[] = {
    {"char", Scalar::kInt8},          {"unsigned_char", Scalar::kUint8},
    {"short", Scalar::kInt16},        {"unsigned_short", Scalar::kUint16},
    {"int", Scalar::kInt32},          {"unsigned_int", Scalar::kUint32},
    {"long", Scalar::kInt64},         {"unsigned_long", Scalar::kUint64},
    {"vtktypeint64", Scalar::kInt64}, {"vtktypeuint64", Scalar::kUint64},
    {"vtkidtype", Scalar::kInt32},    {"float", Scalar::kFloat32},
    {"double", Scalar::kFloat64}};

class Vtk {
 public:
  Vtk(std::string_view bytes, const std::string& path, double meters_per_unit)
      : input_{bytes}, path_(path), builder_(path, meters_per_unit) {}

  Mesh read() {
    readHeader();
    for (;;) {
      const std::string word(nextKeyword());
      // Data of points and cells come last.
      if (word.empty() || word == "POINT_DATA" || word == "CELL_DATA") break;
      if (word == "POINTS") {
        readPoints();
      } else if (word == "POLYGONS") {
        for (const auto& cell : readCells()) builder_.addPolygon(cornersOf(cell));
      } else if (word == "TRIANGLE_STRIPS") {
        for (const auto& cell : readCells()) addStrip(cornersOf(cell));
      } else if (word == "VERTICES" || word == "LINES") {
        static_cast<void>(readCells());
      } else if (word == "METADATA") {
        skipMetadata();
      } else if (word == "FIELD") {
        skipField();
      } else {
        refuse("'" + word.substr(0, 40) + "' means nothing in VTK polydata");
      }
    }
    return builder_.take();
  }

 private:
  using Cell = std::vector<long long>;

  [[noreturn]] void refuse(const std::string& what, const char* code = "mesh.unreadable") const {
    // Line numbers have no meaning once binary data were read.
    throw Error(ErrorKind::kInput,
                {code, what, "export the mesh again", path_, is_text_ ? input_.line : 0});
  }
  [[noreturn]] void refuseEnd() const {
    refuse("the file ends before all that it promises; it was cut short", "mesh.truncated");
  }

  std::string_view takeLine() {
    const std::size_t begin = input_.at;
    const std::size_t end = input_.text.find('\n', begin);
    if (end == std::string_view::npos) refuseEnd();
    input_.at = end + 1;
    ++input_.line;
    std::string_view line = input_.text.substr(begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  void readHeader() {
    version_ = numberOf(takeLine().substr(std::string_view("# vtk DataFile Version ").size()))
                   .value_or(0.0);
    takeLine();  // the title
    const std::string_view kind = takeLine();
    if (!kind.starts_with("ASCII") && !kind.starts_with("BINARY")) {
      refuse("the third line must be ASCII or BINARY, not '" + std::string(kind.substr(0, 40)) +
             "'");
    }
    binary_ = kind.starts_with("BINARY");
    const std::string_view data = takeWord();
    const std::string_view set = takeWord();
    if (data != "DATASET" || set != "POLYDATA") {
      refuse("a data set of kind '" + std::string(set.substr(0, 40)) + "'; POLYDATA is read");
    }
    is_text_ = !binary_;
  }

  std::string_view takeWord() {
    const std::string_view word = input_.word();
    if (word.empty()) refuseEnd();
    return word;
  }

  std::string_view nextKeyword() { return input_.word(); }

  std::size_t takeCount() {
    const std::string word(takeWord());
    const std::optional<double> value = numberOf(word);
    if (!value || !(*value >= 0.0) || *value != std::floor(*value) ||
        *value > static_cast<double>(input_.text.size())) {
      // Each number takes at least one byte.
      if (value && *value > static_cast<double>(input_.text.size())) refuseEnd();
      refuse("'" + word.substr(0, 40) + "' is not a count");
    }
    return static_cast<std::size_t>(*value);
  }

  Scalar takeScalar() {
    const std::string name = lowerCase(takeWord());
    const std::optional<Scalar> scalar = scalarCalled(name, kScalars);
    if (!scalar) refuse("unknown type '" + name.substr(0, 40) + "'");
    return *scalar;
  }

  /// Binary data begin after the line that announces them.
  void beginData() {
    if (binary_) takeLine();
  }

  double takeNumber(Scalar type) {
    if (!binary_) {
      const std::string_view word = takeWord();
      const std::optional<double> value = numberOf(word);
      if (value) return *value;
      if (word == "nan" || word == "-nan" || word == "NaN") {
        return std::numeric_limits<double>::quiet_NaN();
      }
      refuse("'" + std::string(word.substr(0, 40)) + "' is not a number");
    }
    // Always big endian.
    const std::optional<double> value =
        input_.number(type, std::endian::native == std::endian::little);
    if (!value) refuseEnd();
    return *value;
  }

  void readPoints() {
    const std::size_t count = takeCount();
    const Scalar type = takeScalar();
    beginData();
    for (std::size_t i = 0; i < count; ++i) {
      Vec3 p(0.0);
      for (int axis = 0; axis < 3; ++axis) p[axis] = takeNumber(type);
      points_.push_back(builder_.addVertex(
          p, [&] { return "point " + std::to_string(i) + " (from 0)"; },
          is_text_ ? input_.line : 0));
    }
  }

  /// Corners of each cell, as numbers of points.
  std::vector<Cell> readCells() {
    const std::size_t first = takeCount();
    const std::size_t second = takeCount();
    return version_ >= 5.0 ? readOffsets(first, second) : readCounted(first, second);
  }

  std::vector<Cell> readCounted(std::size_t cells, std::size_t numbers) {
    beginData();
    std::vector<Cell> out;
    std::size_t taken = 0;
    for (std::size_t i = 0; i < cells; ++i) {
      const double count = takeNumber(Scalar::kInt32);
      taken += 1;
      if (!(count >= 0.0) || static_cast<double>(numbers - std::min(taken, numbers)) < count) {
        refuse("a cell of " + std::to_string(static_cast<long long>(count)) +
               " points where the list has no more than " +
               std::to_string(numbers - std::min(taken, numbers)) + " numbers");
      }
      Cell cell(static_cast<std::size_t>(count));
      for (long long& corner : cell) corner = static_cast<long long>(takeNumber(Scalar::kInt32));
      taken += cell.size();
      out.push_back(std::move(cell));
    }
    if (taken != numbers) {
      refuse("a list of cells has " + std::to_string(taken) + " numbers, and promises " +
             std::to_string(numbers));
    }
    return out;
  }

  /// The format of version 5: where each cell begins, then all corners.
  std::vector<Cell> readOffsets(std::size_t offsets, std::size_t corners) {
    const auto numbers = [&](std::string_view name, std::size_t count) {
      if (takeWord() != name) refuse("a list of cells has no " + std::string(name));
      const Scalar type = takeScalar();
      beginData();
      Cell list(count);
      for (long long& number : list) number = static_cast<long long>(takeNumber(type));
      return list;
    };
    const Cell begins = numbers("OFFSETS", offsets);
    const Cell all = numbers("CONNECTIVITY", corners);
    std::vector<Cell> out;
    for (std::size_t i = 1; i < begins.size(); ++i) {
      if (begins[i - 1] < 0 || begins[i] < begins[i - 1] ||
          begins[i] > static_cast<long long>(all.size())) {
        refuse("offset " + std::to_string(begins[i]) + " falls outside of a list of " +
               std::to_string(all.size()) + " corners, or behind the offset before it");
      }
      out.emplace_back(all.begin() + begins[i - 1], all.begin() + begins[i]);
    }
    return out;
  }

  std::vector<std::uint32_t> cornersOf(const Cell& cell) {
    std::vector<std::uint32_t> corners;
    for (const long long number : cell) {
      if (number < 0 || number >= static_cast<long long>(points_.size())) {
        refuseIndex(path_, cells_, number, points_.size(), is_text_ ? input_.line : 0);
      }
      corners.push_back(points_[static_cast<std::size_t>(number)]);
    }
    ++cells_;
    return corners;
  }

  /// Every other triangle of a strip winds the other way.
  void addStrip(const std::vector<std::uint32_t>& strip) {
    for (std::size_t i = 2; i < strip.size(); ++i) {
      const bool odd = i % 2 == 1;
      const std::uint32_t corners[3] = {strip[odd ? i - 1 : i - 2], strip[odd ? i - 2 : i - 1],
                                        strip[i]};
      builder_.addPolygon(corners);
    }
  }

  /// Skips to the empty line that ends it.
  void skipMetadata() {
    takeLine();
    while (input_.at < input_.text.size() && !takeLine().empty()) {
    }
  }

  void skipField() {
    takeWord();  // its name
    const std::size_t arrays = takeCount();
    for (std::size_t i = 0; i < arrays; ++i) {
      takeWord();
      const std::size_t components = takeCount();
      const std::size_t tuples = takeCount();
      const Scalar type = takeScalar();
      beginData();
      for (std::size_t n = 0; n < components * tuples; ++n) takeNumber(type);
    }
  }

  Scanner input_;
  const std::string& path_;
  MeshBuilder builder_;
  double version_ = 0.0;
  bool binary_ = false;
  bool is_text_ = true;                ///< the header is always text
  std::vector<std::uint32_t> points_;  ///< number in the file -> number of the welded vertex
  std::size_t cells_ = 0;
};

}  // namespace

Mesh readVtk(const std::string& path, double meters_per_unit) {
  const std::string bytes = readBytes(path);
  if (!bytes.starts_with("# vtk DataFile Version ")) {
    throw inputError(
        "mesh.unreadable",
        "this is not a legacy VTK file: it does not begin with '# vtk DataFile Version'", "", path);
  }
  return Vtk(bytes, path, meters_per_unit).read();
}

}  // namespace palpate::vdb
