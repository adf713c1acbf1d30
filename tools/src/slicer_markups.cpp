#include "slicer_markups.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/vdb/text.h"

namespace palpate::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/"
    "Schema/markups-schema-v1.0.3.json#";
constexpr std::size_t kMostBytes = 64U << 20U;
const Vec3 kTurn(-1.0, -1.0, 1.0);  // LPS to RAS and back

class MarkupsReader {
 public:
  explicit MarkupsReader(std::string path) : path_(std::move(path)) {}

  std::vector<Markup> read() {
    const Json file = parsed();
    const Json& list = member(file, "markups", "the file");
    if (!list.is_array()) throw fail("'markups' is not a list");
    std::vector<Markup> out;
    for (std::size_t n = 0; n < list.size(); ++n) {
      out.push_back(markup(list[n], "markup " + std::to_string(n + 1)));
    }
    return out;
  }

 private:
  [[nodiscard]] Error fail(const std::string& message) const {
    return inputError("markups.content", message, "save it again from Slicer's Markups module",
                      path_);
  }

  [[nodiscard]] Json parsed() const {
    std::ifstream in(path_, std::ios::binary);
    if (!in) throw inputError("markups.missing", "the file cannot be opened", {}, path_);
    std::string text;
    constexpr std::size_t kBlock = 1U << 16U;
    for (std::string block(kBlock, '\0'); in.read(block.data(), kBlock) || in.gcount() > 0;) {
      text.append(block, 0, static_cast<std::size_t>(in.gcount()));
      if (text.size() > kMostBytes) {
        throw fail("the file has more than 64 MB, which no list of points needs");
      }
    }
    try {
      return Json::parse(text);
    } catch (const Json::parse_error& error) {
      const auto end =
          text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
      throw inputError(
          "markups.syntax",
          "line " + std::to_string(1 + std::count(text.begin(), end, '\n')) + " is not JSON",
          "save it again from Slicer's Markups module", path_);
    }
  }

  [[nodiscard]] const Json& member(const Json& of, const char* key,
                                   const std::string& place) const {
    if (of.is_object()) {
      if (const auto at = of.find(key); at != of.end()) return *at;
    }
    throw fail(place + " has no '" + key + "'");
  }

  [[nodiscard]] std::string text(const Json& of, const char* key) const {
    const auto at = of.find(key);
    return at != of.end() && at->is_string() ? at->get<std::string>() : std::string();
  }

  Markup markup(const Json& from, const std::string& place) const {
    Markup out;
    const Json& points = member(from, "controlPoints", place);
    if (!points.is_array()) throw fail("'controlPoints' of " + place + " is not a list");
    out.type = text(from, "type");
    out.name = text(from, "name");
    const Vec3 turn = turnOf(from, place);
    const double unit = unitOf(from, place);
    for (std::size_t n = 0; n < points.size(); ++n) {
      const std::string where = "point " + std::to_string(n + 1) + " of " + place;
      const Json& point = points[n];
      if (!point.is_object()) throw fail(where + " is not an object");
      const std::string status = text(point, "positionStatus");
      if (!status.empty() && status != "defined") continue;
      out.points.push_back(
          {text(point, "label"), unit * turn * position(member(point, "position", where), where)});
    }
    return out;
  }

  [[nodiscard]] Vec3 position(const Json& from, const std::string& where) const {
    Vec3 out(0.0);
    bool is_good = from.is_array() && from.size() == 3;
    for (std::size_t axis = 0; is_good && axis < 3; ++axis) {
      is_good = from[axis].is_number() && std::isfinite(from[axis].get<double>());
      if (is_good) out[static_cast<int>(axis)] = from[axis].get<double>();
    }
    if (!is_good) throw fail("the position of " + where + " is not three numbers");
    return out;
  }

  [[nodiscard]] Vec3 turnOf(const Json& from, const std::string& place) const {
    const auto at = from.find("coordinateSystem");
    if (at == from.end() || *at == "LPS") return kTurn;
    if (*at == "RAS") return Vec3(1.0);
    throw fail("the coordinate system of " + place + " is " + at->dump() +
               R"(, permitted are "LPS" and "RAS")");
  }

  /// [m] Slicer writes "mm", or a list of a code, its system and its meaning.
  [[nodiscard]] double unitOf(const Json& from, const std::string& place) const {
    const auto at = from.find("coordinateUnits");
    if (at == from.end()) return 1e-3;
    const Json& code = at->is_array() && !at->empty() ? at->front() : *at;
    if (code == "mm") return 1e-3;
    if (code == "cm") return 1e-2;
    if (code == "m") return 1.0;
    if (code == "um") return 1e-6;
    throw fail("the unit of " + place + " is " + code.dump() +
               R"(, permitted are "mm", "cm", "m" and "um")");
  }

  std::string path_;
};

}  // namespace

bool isMarkupsName(const std::string& path) { return vdb::hasExtension(path, ".mrk.json"); }

std::vector<Markup> readMarkups(const std::string& path) { return MarkupsReader(path).read(); }

std::string markupsText(const std::vector<Markup>& markups) {
  Json file = {{"@schema", kSchema}, {"markups", Json::array()}};
  for (const Markup& markup : markups) {
    Json points = Json::array();
    for (std::size_t n = 0; n < markup.points.size(); ++n) {
      const Vec3 lps = 1e3 * kTurn * markup.points[n].position + 0.0;  // -0 becomes 0
      points.push_back({{"id", std::to_string(n + 1)},
                        {"label", markup.points[n].label},
                        {"position", {lps.x, lps.y, lps.z}},
                        {"selected", true},
                        {"locked", false},
                        {"visibility", true},
                        {"positionStatus", "defined"}});
    }
    file["markups"].push_back({{"type", markup.type},
                               {"name", markup.name},
                               {"coordinateSystem", "LPS"},
                               {"coordinateUnits", "mm"},
                               {"controlPoints", std::move(points)}});
  }
  // Names may hold bytes that are not UTF-8.
  return file.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<Vec3> thinned(const std::vector<Vec3>& points, double tolerance) {
  if (points.size() < 3) return points;
  std::vector<bool> is_kept(points.size(), false);
  is_kept.front() = is_kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const Vec3 along = points[last] - points[first];
    const double square = glm::dot(along, along);
    double most = tolerance;
    std::size_t farthest = first;
    for (std::size_t n = first + 1; n < last; ++n) {
      const Vec3 from = points[n] - points[first];
      const double share =
          square > 0.0 ? std::clamp(glm::dot(from, along) / square, 0.0, 1.0) : 0.0;
      const double off = glm::length(from - share * along);
      if (off > most) {
        most = off;
        farthest = n;
      }
    }
    if (farthest == first) continue;
    is_kept[farthest] = true;
    open.emplace_back(first, farthest);
    open.emplace_back(farthest, last);
  }
  std::vector<Vec3> out;
  for (std::size_t n = 0; n < points.size(); ++n) {
    if (is_kept[n]) out.push_back(points[n]);
  }
  return out;
}

}  // namespace palpate::tools
