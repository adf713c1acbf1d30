#include <algorithm>
#include <bit>
#include <optional>
#include <sstream>
#include <string_view>

#include "mesh/builder.h"
#include "mesh/scanner.h"
#include "palpate/core/error.h"
#include "palpate/core/stop.h"

namespace palpate::vdb {
namespace {

struct Property {
  std::string name;
  Scalar type = Scalar::kFloat32;
  std::optional<Scalar> count;  ///< only for a list: the type of its length
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

constexpr ScalarName kScalars[] = {
    {"char", Scalar::kInt8},      {"int8", Scalar::kInt8},       {"uchar", Scalar::kUint8},
    {"uint8", Scalar::kUint8},    {"short", Scalar::kInt16},     {"int16", Scalar::kInt16},
    {"ushort", Scalar::kUint16},  {"uint16", Scalar::kUint16},   {"int", Scalar::kInt32},
    {"int32", Scalar::kInt32},    {"uint", Scalar::kUint32},     {"uint32", Scalar::kUint32},
    {"float", Scalar::kFloat32},  {"float32", Scalar::kFloat32}, {"double", Scalar::kFloat64},
    {"float64", Scalar::kFloat64}};

class Ply {
 public:
  Ply(std::string_view bytes, const std::string& path, double meters_per_unit)
      : input_{bytes}, path_(path), builder_(path, meters_per_unit) {}

  Mesh read() {
    readHeader();
    for (const Element& element : elements_) {
      // Such elements take no bytes, however many there are
      if (element.properties.empty()) continue;
      for (std::size_t i = 0; i < element.count; ++i) {
        if (i % 1024 == 0) pollStop();
        if (is_text_) input_.skipBlanks();
        const int line = is_text_ ? input_.line : 0;
        readItem(element);
        if (element.name == "vertex") {
          vertices_.push_back(builder_.addVertex(
              position_, [&] { return "vertex " + std::to_string(i) + " (from 0)"; }, line));
        } else if (element.name == "face") {
          addFace(i, line);
        }
      }
    }
    return builder_.take();
  }

 private:
  [[noreturn]] void refuse(const std::string& what, const char* code = "mesh.unreadable") const {
    throw Error(ErrorKind::kInput,
                {code, what, "export the mesh again", path_, is_text_ ? input_.line : 0});
  }

  [[noreturn]] void refuseEnd() const {
    refuse("the file ends before all that its header promises; it was cut short", "mesh.truncated");
  }

  void addFace(std::size_t face, int line) {
    corners_.clear();
    for (const double number : indices_) {
      if (!(number >= 0.0 && number < static_cast<double>(vertices_.size()))) {
        refuseIndex(path_, face, static_cast<long long>(number), vertices_.size(), line);
      }
      corners_.push_back(vertices_[static_cast<std::size_t>(number)]);
    }
    builder_.addPolygon(corners_);
  }

  void readHeader() {
    bool has_format = false;
    for (;; ++input_.line) {
      std::istringstream words(headerLine());
      std::string key, word;
      words >> key;
      if (key == "end_header") break;
      if (key == "format") {
        words >> word;
        has_format = true;
        format_is_text_ = word == "ascii";
        const bool little = word == "binary_little_endian";
        if (!format_is_text_ && !little && word != "binary_big_endian") {
          refuse("unknown PLY format '" + word + "'");
        }
        swap_ = !format_is_text_ && little != (std::endian::native == std::endian::little);
      } else if (key == "element") {
        Element element;
        if (!(words >> element.name >> element.count)) refuse("an element without name and count");
        elements_.push_back(std::move(element));
      } else if (key == "property") {
        if (elements_.empty()) refuse("a property before any element");
        elements_.back().properties.push_back(propertyOf(words));
      } else if (key != "ply" && key != "comment" && key != "obj_info" && !key.empty()) {
        refuse("'" + key.substr(0, 40) + "' means nothing in the header of a PLY file");
      }
    }
    if (!has_format) refuse("the header does not name the format");
    ++input_.line;
    is_text_ = format_is_text_;
    requireParts();
  }

  void requireParts() const {
    const auto element = [&](const char* name) {
      return std::find_if(elements_.begin(), elements_.end(),
                          [&](const Element& e) { return e.name == name; });
    };
    const auto vertex = element("vertex");
    if (vertex == elements_.end()) refuse("the file has no element 'vertex'");
    for (const char* axis : {"x", "y", "z"}) {
      const auto& list = vertex->properties;
      if (std::none_of(list.begin(), list.end(),
                       [&](const Property& p) { return p.name == axis && !p.count; })) {
        refuse(std::string("the vertices have no property '") + axis + "'");
      }
    }
    if (element("face") < vertex) refuse("the faces come before the vertices");
  }

  Property propertyOf(std::istringstream& words) const {
    Property property;
    std::string type;
    words >> type;
    if (type == "list") {
      std::string count;
      words >> count >> type;
      property.count = scalarCalled(count, kScalars);
      if (!property.count) refuse("unknown type '" + count + "' of a list's length");
    }
    const std::optional<Scalar> scalar = scalarCalled(type, kScalars);
    if (!scalar) refuse("unknown property type '" + type + "'");
    property.type = *scalar;
    if (!(words >> property.name)) refuse("a property without a name");
    return property;
  }

  std::string headerLine() {
    const std::size_t end = input_.text.find('\n', input_.at);
    if (end == std::string_view::npos) refuse("the header has no 'end_header'", "mesh.truncated");
    std::string text(input_.text.substr(input_.at, end - input_.at));
    input_.at = end + 1;
    return text;
  }

  void readItem(const Element& element) {
    indices_.clear();
    for (const Property& property : element.properties) {
      if (!property.count) {
        const double value = readScalar(property.type);
        if (property.name == "x") position_.x = value;
        if (property.name == "y") position_.y = value;
        if (property.name == "z") position_.z = value;
        continue;
      }
      const double count = readScalar(*property.count);
      if (!(count >= 0.0)) refuse("a list of negative length");
      const bool wanted = property.name == "vertex_indices" || property.name == "vertex_index";
      // A file with more would end first
      const auto items = static_cast<std::uint64_t>(std::min(count, 1e15));
      for (std::uint64_t n = 0; n < items; ++n) {
        const double value = readScalar(property.type);
        if (wanted) indices_.push_back(value);
      }
    }
  }

  double readScalar(Scalar type) {
    if (is_text_) return readText();
    const std::optional<double> value = input_.number(type, swap_);
    if (!value) refuseEnd();
    return *value;
  }

  double readText() {
    const std::string_view word = input_.word();
    if (word.empty()) refuseEnd();
    const std::optional<double> value = numberOf(word);
    if (!value) refuse("'" + std::string(word.substr(0, 40)) + "' is not a number");
    return *value;
  }

  Scanner input_;
  const std::string& path_;
  MeshBuilder builder_;
  std::vector<Element> elements_;
  bool format_is_text_ = false;
  bool is_text_ = true;  ///< the header is always text
  bool swap_ = false;
  Vec3 position_{0.0};
  std::vector<double> indices_;
  std::vector<std::uint32_t> vertices_;  ///< number in the file -> number of the welded vertex
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Mesh readPly(const std::string& path, double meters_per_unit) {
  const std::string bytes = readBytes(path);
  if (!bytes.starts_with("ply")) {
    throw inputError("mesh.unreadable", "this is not a PLY file: it does not begin with 'ply'", "",
                     path);
  }
  return Ply(bytes, path, meters_per_unit).read();
}

}  // namespace palpate::vdb
