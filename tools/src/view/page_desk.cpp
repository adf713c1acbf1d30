#include "view/page_desk.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "json_parts.h"
#include "open_device.h"

namespace palpate::tools {
namespace {

constexpr std::size_t kColumns = 1000;  // in the overview of a recorded run

std::string textOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

PageAnswer jsonAnswer(const Json& json) {
  return {"application/json", std::make_shared<const std::string>(textOf(json))};
}

/// Takes a number and the `separator` behind it off the front of `text`; nothing if there is none.
std::optional<std::size_t> numberIn(std::string_view& text, char separator) {
  std::size_t number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
  if (separator == '\0') return text.empty() ? std::optional(number) : std::nullopt;
  if (text.empty() || text.front() != separator) return std::nullopt;
  text.remove_prefix(1);
  return number;
}

std::optional<Vec3> vectorIn(const Json& json) {
  if (!json.is_array() || json.size() != 3) return std::nullopt;
  Vec3 v(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!json[i].is_number()) return std::nullopt;
    v[static_cast<int>(i)] = json[i].get<double>();
  }
  return isFinite(v) ? std::optional(v) : std::nullopt;
}

Json entriesJson(const std::vector<SeenEntry>& entries) {
  Json list = Json::array();
  for (const SeenEntry& e : entries) {
    list.push_back({{"tick", e.tick},
                    {"from", e.from},
                    {"to", e.to},
                    {"port", e.port < 0 ? Json() : Json(e.port)},
                    {"force", e.force}});
  }
  return list;
}

Json holesJson(const std::vector<SeenHole>& holes) {
  Json list = Json::array();
  for (const SeenHole& hole : holes) {
    list.push_back({{"port", hole.port},
                    {"point", vectorJson(hole.point)},
                    {"normal", vectorJson(hole.normal)},
                    {"radius", hole.radius}});
  }
  return list;
}

const char* stateName(SceneEdit::State state) {
  switch (state) {
    case SceneEdit::State::kFelt:
      return "felt";
    case SceneEdit::State::kCompiling:
      return "compiling";
    case SceneEdit::State::kRefused:
      return "refused";
    case SceneEdit::State::kRecorded:
      break;
  }
  return "recorded";
}

}  // namespace

PageDesk::PageDesk(PageSubject subject, std::shared_ptr<const ShownScene> shown)
    : subject_(std::move(subject)),
      told_(handStart(shown->scene())),
      told_in_(shown->number()),
      shown_(std::move(shown)) {
  edit_.text = shown_->text();
}

PageHost PageDesk::host() {
  return {.get = [this](std::string_view path) { return get(path); },
          .snapshot = [this](std::uint64_t& seen,
                             const PagePlace& place) { return snapshot(seen, place); },
          .command = [this](const std::string& message) { command(message); }};
}

std::shared_ptr<const ShownScene> PageDesk::shown() const {
  const std::lock_guard lock(mutex_);
  return shown_;
}

std::shared_ptr<const ShownScene> PageDesk::goTo(std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  for (auto& other : others_) {
    if (static_cast<std::uint64_t>(other->number()) != number) continue;
    if (other->number() < shown_->number()) return other;
    // Leaves the scene before to forgetPast(), because its thread may have to end first.
    std::swap(other, shown_);
    break;
  }
  return shown_;
}

void PageDesk::expect(std::shared_ptr<const ShownScene> shown) {
  std::shared_ptr<const ShownScene> replaced;
  const std::lock_guard lock(mutex_);
  // If the session refused a scene, the next one has the same number and replaces it.
  for (auto& other : others_) {
    if (other->number() == shown->number()) replaced = std::move(other);
  }
  std::erase(others_, nullptr);
  others_.push_back(std::move(shown));
}

void PageDesk::edited(SceneEdit edit) {
  const std::lock_guard lock(mutex_);
  edit_ = std::move(edit);
  ++edits_;
}

void PageDesk::forgetPast() {
  // Follows the loop even if no page is open.
  (void)goTo(subject_.feed->look(0).scene);
  std::vector<std::shared_ptr<const ShownScene>> past;
  {
    const std::lock_guard lock(mutex_);
    for (auto& other : others_) {
      // A scene that an answer still uses is freed at a later call.
      const bool is_past = other->number() < shown_->number() && other.use_count() == 1;
      if (is_past) past.push_back(std::move(other));
    }
    std::erase(others_, nullptr);
  }
}

std::string PageDesk::sceneText() const {
  const std::lock_guard lock(mutex_);
  Json json = {{"edit", edits_},     {"state", stateName(edit_.state)},
               {"text", edit_.text}, {"line", edit_.line > 0 ? Json(edit_.line) : Json()},
               {"problem", Json()},  {"hint", Json()}};
  if (edit_.problem) {
    json["problem"] = edit_.problem->message;
    // If the fault is in another file, the page needs that file's name.
    if (edit_.line == 0 && !edit_.problem->file.empty()) {
      json["problem"] = edit_.problem->file + ": " + edit_.problem->message;
    }
    json["hint"] = edit_.problem->hint;
  }
  return textOf(json);
}

std::shared_ptr<const ShownScene> PageDesk::numbered(std::size_t number) const {
  const std::lock_guard lock(mutex_);
  const auto is_it = [&](const auto& scene) {
    return static_cast<std::size_t>(scene->number()) == number;
  };
  if (is_it(shown_)) return shown_;
  const auto at = std::find_if(others_.begin(), others_.end(), is_it);
  return at == others_.end() ? nullptr : *at;
}

std::uint64_t PageDesk::edits() const {
  const std::lock_guard lock(mutex_);
  return edits_;
}

std::optional<PageAnswer> PageDesk::get(std::string_view path) {
  if (path == "scene.json") {
    Json json = shown()->json();
    if (!subject_.about.is_null()) json.update(subject_.about);
    json["mode"] = subject_.run != nullptr    ? "replay"
                   : subject_.hand != nullptr ? "hand"
                                              : "device";
    json["rows"] = subject_.run != nullptr ? Json(subject_.run->size()) : Json();
    if (subject_.run != nullptr) json["overview"] = subject_.run->overview(kColumns);
    return jsonAnswer(json);
  }
  if (path == "text.json") {
    return PageAnswer{"application/json", std::make_shared<const std::string>(sceneText())};
  }
  return partOf(path);
}

std::optional<PageAnswer> PageDesk::partOf(std::string_view path) const {
  const std::size_t slash = path.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const std::string_view kind = path.substr(0, slash);
  path.remove_prefix(slash + 1);
  const auto number = numberIn(path, kind == "slices" ? '\0' : '/');
  const auto scene = number ? numbered(*number) : nullptr;
  if (!scene) return std::nullopt;
  const auto slices = scene->slices();
  if (kind == "slices") return slices ? std::optional(jsonAnswer(slices->json())) : std::nullopt;
  std::shared_ptr<const std::string> bytes;
  if (kind == "slice") {
    const auto axis = numberIn(path, '/');
    const auto index = numberIn(path, '\0');
    auto slice = slices && axis && index ? slices->slice(*axis, *index) : std::nullopt;
    if (slice) bytes = std::make_shared<const std::string>(std::move(*slice));
  } else if (kind == "surface" || kind == "port") {
    const auto which = numberIn(path, '\0');
    if (which) bytes = kind == "port" ? scene->port(*which) : scene->surface(*which);
  }
  if (!bytes) return std::nullopt;
  return PageAnswer{"application/octet-stream", std::move(bytes)};
}

std::string PageDesk::snapshot(std::uint64_t& seen, const PagePlace& place) {
  // In a recorded run a page may go back, so it always gets all entries up to its row.
  const FeedView view =
      subject_.run != nullptr ? subject_.run->at(row_, 0) : subject_.feed->look(seen);
  const auto scene = subject_.run != nullptr ? shown() : goTo(view.scene);
  // A new scene may have another mapping of the device.
  if (subject_.hand != nullptr && scene->number() != told_in_) steer(told_);
  Json json = {{"scene", scene->number()},
               {"edit", edits()},
               {"surfaces", scene->surfacesDone()},
               {"ports", scene->portsDone()},
               {"slices", scene->slices() != nullptr},
               {"steers", place.steers},
               {"steered", place.is_steered},
               {"pages", place.pages}};
  if (subject_.run != nullptr) json["row"] = row_;
  if (view.ticks == 0) return textOf(json);
  if (!view.entries.empty()) seen = view.entries.back().number;
  const TickResult& result = view.result;
  const FeltWords felt = feltAt(scene->scene(), view.hip, result);
  json["tick"] = {{"n", view.number},
                  {"t", view.time},
                  {"hip", vectorJson(view.hip)},
                  {"proxy", vectorJson(result.proxy)},
                  {"force", vectorJson(result.force)},
                  {"told", subject_.hand != nullptr ? vectorJson(told_) : Json()},
                  {"region", result.region},
                  {"contact", result.contact},
                  {"settled", result.settled},
                  {"strongest", view.strongest},
                  {"work", view.work},
                  {"ns", view.ns},
                  {"worst_ns", view.worst_ns},
                  {"late", view.late},
                  {"passed", view.passed},
                  {"holes", holesJson(view.holes)},
                  {"shaft", view.fulcrum ? vectorJson(*view.fulcrum) : Json()},
                  {"content", felt.content},
                  {"wall", felt.wall},
                  {"entries", entriesJson(view.entries)}};
  return textOf(json);
}

void PageDesk::command(const std::string& message) {
  const Json json = Json::parse(message, nullptr, false);
  if (!json.is_object()) return;
  if (const auto to = json.find("to"); to != json.end()) {
    if (const auto place = vectorIn(*to)) steer(*place);
  }
  if (const auto row = json.find("row"); row != json.end() && row->is_number_unsigned()) {
    if (subject_.run != nullptr) row_ = std::min(row->get<std::size_t>(), subject_.run->size() - 1);
  }
}

void PageDesk::steer(const Vec3& place) {
  if (subject_.hand == nullptr) return;
  const auto scene = shown();
  const Box3 view = viewBox(scene->scene());
  const Box3 room = view.grownBy(glm::length(view.size()));
  told_ = glm::clamp(place, room.lo, room.hi);
  told_in_ = scene->number();
  subject_.hand->steer(toDevice(scene->scene().device(), told_));
}

}  // namespace palpate::tools
