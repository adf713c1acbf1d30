#include "paper_renderer.h"

#include <algorithm>

#include "palpate/core/error.h"
#include "palpate/interior/partition.h"
#include "palpate/interior/port_machine.h"

namespace palpate {
namespace {

static_assert(PaperSurface{}.max_halvings == PaperParameters::kMaxHalvings);

/// [m] The default epsilon: within this distance of the surface the contact point counts as on it.
double epsilonOf(const Field& field) { return std::min(1e-6, 1e-4 * field.featureSize()); }

void refuseWhatThePaperHasNot(const Scene& scene) {
  for (const Port& port : scene.ports()) {
    if (port.opens_at == 0.0 && port.back == 0.0) continue;
    throw inputError(
        "render.paper_opening_force",
        "the paper's renderer has no opening forces, and port '" + port.name + "' has one",
        "use the constraint renderer, or leave out opens_at and back");
  }
  if (!scene.passages().sheets().empty()) {
    throw inputError("render.paper_sheet",
                     "the paper's renderer has no sheets, and the scene has the sheet '" +
                         scene.passages().sheets().front().name + "'",
                     "use the constraint renderer");
  }
  for (const Region& region : scene.regions()) {
    if (region.left_out.empty()) continue;
    throw inputError("render.paper_left_out",
                     "the paper's renderer needs all layers, and '" + region.name +
                         "' was left out: " + region.left_out,
                     "compile the scene for Purpose::kShow");
  }
}

/// True if all leaves of the face are leaves that the port is on.
bool isOn(const Port& port, const PaperFace& face) {
  return !face.leaves.empty() &&
         std::all_of(face.leaves.begin(), face.leaves.end(), [&](LeafId leaf) {
           return std::find(port.on.begin(), port.on.end(), leaf) != port.on.end();
         });
}

}  // namespace

PaperRenderer::PaperRenderer(ScenePtr scene, const RendererSettings& settings)
    : RendererBase(std::move(scene), RendererKind::kPaper, settings.limits),
      parameters_(settings.paper.over(scene_->paper())),
      now_(scene_->partition().leaves().size()),
      cell_(now_),
      turned_(now_),
      scratch_(now_) {
  refuseWhatThePaperHasNot(*scene_);
  const std::size_t count = scene_->regions().size();
  layers_.reserve(count - 1);
  for (std::size_t i = 1; i < count; ++i) {
    const auto region = static_cast<RegionId>(i);
    PaperWall wall(scene_->regions()[i].field, scene_->partition());
    for (PaperFace& face : wall.faces()) {
      for (std::size_t id = 0; id < scene_->ports().size(); ++id) {
        const Port& port = scene_->ports()[id];
        // A port that is open only in a part of the face leaves it a wall.
        if (port.mask >= 0 || !isOn(port, face)) continue;
        const auto joins = [&](const std::vector<RegionId>& side) {
          return std::find(side.begin(), side.end(), region) != side.end();
        };
        if (joins(port.from) || joins(port.to)) face.ports.push_back(static_cast<PortId>(id));
      }
    }
    layers_.push_back({std::move(wall), {}, 0.0});
  }
  for (Layer& layer : layers_) {
    const double epsilon = parameters_.epsilon.value_or(epsilonOf(layer.wall));
    layer.beneath = std::max(4.0 * epsilon, 1e-6 * layer.wall.featureSize());
    PaperSurface& surface = layer.surface;
    surface.field = &layer.wall;
    surface.epsilon = epsilon * layer.wall.lipschitz();
    surface.max_halvings = parameters_.max_halvings.value_or(PaperParameters::kMaxHalvings);
    surface.alpha = parameters_.alpha.value_or(PaperParameters::kAlpha);
    const AlphaForm form = parameters_.alpha_form.value_or(AlphaForm::kByMetric);
    surface.newton_form = form == AlphaForm::kNewton || (form == AlphaForm::kByMetric &&
                                                         layer.wall.metric() == Metric::kImplicit);
  }
  free_ways_of_.resize(count);
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) {
      const auto from = static_cast<RegionId>(a);
      const auto to = static_cast<RegionId>(b);
      if (a != b && scene_->passages().wall(from, to).absent) free_ways_of_[a].push_back(to);
    }
  }
}

void PaperRenderer::resume() noexcept { openFaces(); }

void PaperRenderer::start(const HipState& hip) noexcept {
  state_.hip = hip.position;
  state_.place.sides = Signs(scene_->partition().leaves().size());
  state_.place.region = scene_->startRegion();
  scene_->partition().signsAt(hip.position, state_.place.sides);
  openFaces();
}

TickResult PaperRenderer::step(const HipState& hip) noexcept {
  TickResult out;
  if (!state_.has_begun) start(hip);
  advance(hip.position, out);
  feel(hip, out);
  state_.place.point = hip.position;
  out.region = state_.place.region;
  return out;
}

void PaperRenderer::feel(const HipState& hip, TickResult& out) noexcept {
  const Vec3& p = hip.position;
  out.proxy = p;
  if (out.event_count > 0)
    return;  // "ENTER_PORT, else if ...": no force in the tick that passes a port
  if (state_.place.region != kOutside) {
    const PaperWall& own = layers_[state_.place.region - 1U].wall;
    const bool in_openings = own.isWithinOpenings(p);
    const bool in_walls = own.value(p) <= 0.0;
    if (!in_walls && in_openings) return touch(state_.place.region - 1U, -1.0, hip, out);  // row 3
    if (!in_walls || !in_openings) {  // rows 4 and 2
      state_.paper.holds = false;
      return;
    }
  }
  // Only later layers take space from the region of the state.
  for (std::size_t i = state_.place.region; i < layers_.size(); ++i) {
    const PaperWall& wall = layers_[i].wall;
    if (!wall.hasWalls() || !(wall.value(p) <= 0.0) || !wall.isWithinOpenings(p)) continue;
    if (scene_->passages().wall(state_.place.region, static_cast<RegionId>(i + 1)).absent) continue;
    return touch(i, 1.0, hip, out);
  }
  state_.paper.holds = false;
  feelContent(hip, out);
}

void PaperRenderer::feelContent(const HipState& hip, TickResult& out) noexcept {
  const Vec3 force = dragForce(state_.place.region, hip.position, hip.velocity, 1.0) +
                     latticeForce(state_.place.region, hip.position);
  if (isFinite(force)) out.force += force;
}

void PaperRenderer::touch(std::size_t layer, double side, const HipState& hip,
                          TickResult& out) noexcept {
  PaperSurface surface = layers_[layer].surface;
  surface.side = side;
  const bool goes_on =
      state_.paper.holds && state_.paper.layer == layer && state_.paper.side == side;
  state_.paper.contact = goes_on
                             ? trackContact(surface, state_.paper.contact, state_.hip, hip.position)
                             : firstContact(surface, state_.hip, hip.position);
  state_.paper.holds = true;
  state_.paper.layer = static_cast<std::uint16_t>(layer);
  state_.paper.side = side;

  out.proxy = state_.paper.contact.surface_point;
  out.contact = true;
  const Wall& wall = scene_->passages().wall(state_.place.region, regionBehind(layer, side));
  if (wall.material >= 0) {
    const Material& material = scene_->materials()[static_cast<std::size_t>(wall.material)];
    const Vec3& x = state_.paper.contact.surface_point;
    const Vec3 force = material.stiffness.at(x) * (x - state_.paper.contact.interaction_point) -
                       material.damping.at(x) * hip.velocity;
    if (isFinite(force)) out.force = force;
  }
  if (parameters_.interior.value_or(PaperInterior::kTogether) == PaperInterior::kTogether) {
    feelContent(hip, out);
  }
}

/// The region on the far side of the touched wall.
RegionId PaperRenderer::regionBehind(std::size_t layer, double side) noexcept {
  const PaperSurface& surface = layers_[layer].surface;
  const Vec3& x = state_.paper.contact.surface_point;
  const Vec3 inward = -side * unitOr(surface.field->sample(x).gradient, Vec3(0.0));
  scene_->partition().signsAt(x + layers_[layer].beneath * inward, scratch_);
  const auto is_wall = [&](RegionId region) {
    return region != state_.place.region &&
           !scene_->passages().wall(state_.place.region, region).absent;
  };
  const RegionId behind = scene_->partition().regionOf(scratch_);
  if (is_wall(behind)) return behind;
  // At a rim there may be no wall: then the region that the probe itself is in.
  const RegionId here = scene_->partition().regionOf(now_);
  if (is_wall(here)) return here;
  return side > 0.0 ? static_cast<RegionId>(layer + 1) : kOutside;
}

}  // namespace palpate
