#include "view/shown_scene.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <utility>

#include "explain/scene_words.h"
#include "json_parts.h"
#include "palpate/scene/transitions.h"
#include "palpate/vdb/text.h"
#include "picture/picture.h"
#include "view/port_patches.h"

namespace palpate::tools {
namespace {

constexpr double kFallbackSize = 0.2;  // [m] size of the view of an unbounded scene
constexpr double kMargin = 0.06;       // share of the longest side, around everything bounded

/// Colors that color-blind readers can tell apart: P. Tol's scheme "light".
constexpr std::array<const char*, 8> kLayerColors = {"#ee8866", "#77aadd", "#eedd88", "#44bb99",
                                                     "#ffaabb", "#99ddff", "#bbcc33", "#aaaa00"};

double longest(const Box3& box) {
  const Vec3 size = box.size();
  return std::max({size.x, size.y, size.z});
}

std::string colorOf(const LoadedScene& loaded, const std::string& name, std::size_t region) {
  const auto own = loaded.colors().find(name);
  if (own == loaded.colors().end()) return kLayerColors[(region - 1) % kLayerColors.size()];
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "#";
  for (std::size_t i = 0; i < 3; ++i) {
    const auto byte =
        static_cast<unsigned>(std::lround(255.0 * std::clamp<double>(own->second[i], 0.0, 1.0)));
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

Json regionsJson(const Scene& scene, const LoadedScene& loaded) {
  Json list = Json::array();
  for (std::size_t i = 0; i < scene.regions().size(); ++i) {
    const Region& region = scene.regions()[i];
    const Material* content = materialOf(scene, region.content);
    const Wall wall{.absent = region.wall_absent, .material = region.wall};
    list.push_back({{"name", region.name},
                    {"color", i == kOutside ? Json() : Json(colorOf(loaded, region.name, i))},
                    {"wall", i == kOutside ? "-" : wallText(scene, wall)},
                    {"content", content == nullptr ? "-" : contentText(*content)},
                    {"reach", reachName(region.reach)}});
  }
  return list;
}

Json transitionsJson(const Scene& scene, const SceneDescription& description) {
  Json list = Json::array();
  for (const Transition& t : transitions(scene)) {
    list.push_back({{"from", t.from},
                    {"to", t.to},
                    {"port", t.port ? Json(*t.port) : Json()},
                    {"when", conditionsOf(t, scene, description)}});
  }
  return list;
}

/// `material` with the values that it has at `p` [m].
Material materialAt(const Material& material, const Vec3& p) {
  Material here = material;
  for (Parameter* parameter : {&here.stiffness, &here.viscosity, &here.lattice.force, &here.cutting,
                               &here.shaft.in.kinetic_force}) {
    *parameter = parameter->at(p);
  }
  return here;
}

/// The first other region on the way from the proxy to the hand, which may be several walls deep.
RegionId regionBeyond(const Scene& scene, const TickResult& result, const Vec3& hip) {
  constexpr double kFirst = 1.0 / 4096.0;  // of the way
  for (double share = kFirst; share <= 1.0; share *= 2.0) {
    const RegionId region = scene.regionAt(result.proxy + share * (hip - result.proxy));
    if (region != result.region) return region;
  }
  return result.region;
}

}  // namespace

Box3 viewBox(const Scene& scene) {
  Box3 box = scene.bounds();
  if (!box.isBounded() || !(longest(box) > 0.0)) {
    box = {Vec3(-0.5 * kFallbackSize), Vec3(0.5 * kFallbackSize)};
  }
  return box.grownBy(kMargin * longest(box));
}

Vec3 handStart(const Scene& scene) {
  const Region& start = scene.regions()[scene.startRegion()];
  if (scene.startRegion() != kOutside && start.has_seed) return start.seed;
  const Box3 box = viewBox(scene);
  return {box.center().x, box.center().y, box.hi.z};
}

FeltWords feltAt(const Scene& scene, const Vec3& hip, const TickResult& result) {
  FeltWords words;
  if (result.region >= scene.regions().size()) return words;
  const Material* content = materialOf(scene, scene.regions()[result.region].content);
  if (content != nullptr) words.content = contentText(materialAt(*content, result.proxy));
  if (!result.contact || !isFinite(hip)) return words;
  const RegionId beyond = regionBeyond(scene, result, hip);
  if (beyond == result.region) {
    words.wall = "a wall";
    return words;
  }
  const Wall& wall = scene.passages().wall(result.region, beyond);
  const Material* material = wall.absent ? nullptr : materialOf(scene, wall.material);
  words.wall = material == nullptr ? wallText(scene, wall)
                                   : materialText(materialAt(*material, result.proxy));
  return words;
}

ShownScene::ShownScene(ScenePtr scene, const LoadedScene& loaded, std::string text, int number)
    : scene_(std::move(scene)),
      number_(number),
      text_(std::move(text)),
      images_(loaded.images()),
      surfaces_(scene_->regions().size()),
      ports_(scene_->ports().size()) {
  const SceneDescription& description = loaded.description();
  json_ = {{"schema", "palpate.view/1"},
           {"number", number},
           {"file", vdb::fileName(description.file)},
           {"unit", {{"name", scene_->lengthUnit()}, {"meters", scene_->metersPerUnit()}}},
           {"box", boxJson(viewBox(*scene_))},
           {"start", vectorJson(handStart(*scene_))},
           {"start_region", scene_->startRegion()},
           {"regions", regionsJson(*scene_, loaded)},
           {"ports", Json::array()},
           {"transitions", transitionsJson(*scene_, description)}};
  for (const Port& port : scene_->ports()) json_["ports"].push_back(port.name);
  thread_ = std::thread([this] { make(); });
}

ShownScene::~ShownScene() {
  stop_.store(true);
  thread_.join();
}

std::shared_ptr<const std::string> ShownScene::surface(std::size_t region) const {
  const std::lock_guard lock(mutex_);
  return region < surfaces_.size() ? surfaces_[region] : nullptr;
}

std::shared_ptr<const std::string> ShownScene::port(std::size_t port) const {
  const std::lock_guard lock(mutex_);
  return port < ports_.size() ? ports_[port] : nullptr;
}

std::shared_ptr<const GraySlices> ShownScene::slices() const {
  const std::lock_guard lock(mutex_);
  return slices_;
}

void ShownScene::make() {
  // Applies to this thread only: the loop has priority.
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, 0, kNice);
  makePorts(makeSurfaces());
  makeSlices();
}

std::vector<ShownScene::LayerNet> ShownScene::makeSurfaces() {
  std::vector<LayerNet> nets;
  const Box3 view = viewBox(*scene_);
  const double tolerance = kTolerance * glm::length(view.size());
  for (std::size_t i = 0; i < surfaces_.size() && !stop_.load(); ++i) {
    const FieldPtr& field = scene_->regions()[i].field;
    if (field) {
      const Box3 bounds = field->bounds();
      const Box3 box = bounds.isBounded()
                           ? bounds.grownBy(kMargin * longest(bounds)).intersectedWith(view)
                           : view;
      if (!box.isEmpty() && longest(box) > 0.0) {
        SurfaceNet net = surfaceWithin(*field, box, tolerance);
        auto bytes = std::make_shared<const std::string>(surfaceBytes(net));
        if (!scene_->ports().empty()) nets.push_back({static_cast<RegionId>(i), std::move(net)});
        const std::lock_guard lock(mutex_);
        surfaces_[i] = std::move(bytes);
      }
    }
    done_.store(static_cast<int>(i) + 1);
  }
  return nets;
}

void ShownScene::makePorts(const std::vector<LayerNet>& nets) {
  PortPatches patches(scene_, glm::length(viewBox(*scene_).size()));
  for (const LayerNet& layer : nets) {
    patches.add(layer.region, layer.net, [this] { return !stop_.load(); });
  }
  for (std::size_t i = 0; i < ports_.size(); ++i) {
    if (patches.patches()[i].triangles.empty()) continue;
    auto bytes = std::make_shared<const std::string>(surfaceBytes(patches.patches()[i]));
    const std::lock_guard lock(mutex_);
    ports_[i] = std::move(bytes);
  }
  are_ports_done_.store(true);
}

void ShownScene::makeSlices() {
  if (stop_.load()) return;
  std::shared_ptr<const vdb::Image> image;
  try {
    image = pictureImage(images_, {});
  } catch (const std::exception&) {
    // The image cannot be read any more. The scene does without it; the page gets no slices.
  }
  if (!image) return;
  auto slices =
      std::make_shared<const GraySlices>(image, viewBox(*scene_), [this] { return !stop_.load(); });
  if (slices->isEmpty()) return;
  const std::lock_guard lock(mutex_);
  slices_ = std::move(slices);
}

}  // namespace palpate::tools
