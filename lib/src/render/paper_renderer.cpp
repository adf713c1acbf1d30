#include "paper_renderer.h"

#include <algorithm>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"

namespace palpate {
namespace {

/// |S| on the surface, as a share of the feature size, but never more than a micrometre of distance.
double epsilonOf(const Field& field) {
  return std::min(1e-6, 1e-4 * field.featureSize()) * field.lipschitz();
}

bool isOneOf(const std::vector<LeafId>& leaves, const std::vector<LeafId>& among) {
  return !leaves.empty() && std::all_of(leaves.begin(), leaves.end(), [&](LeafId leaf) {
    return std::find(among.begin(), among.end(), leaf) != among.end();
  });
}

}  // namespace

PaperRenderer::PaperRenderer(ScenePtr scene, const RendererSettings& settings)
    : HapticRenderer(*scene, settings.limits),
      scene_(std::move(scene)),
      scratch_(scene_->partition().leaves().size()) {
  for (const Port& port : scene_->ports()) {
    if (port.opens_at != 0.0 || port.back != 0.0) {
      throw inputError(
          "render.paper_opening_force",
          "the paper's renderer has no opening forces, and port '" + port.name + "' has one",
          "use the constraint renderer, or leave out opens_at and back");
    }
  }
  if (!scene_->passages().sheets().empty()) {
    throw inputError("render.paper_sheet",
                     "the paper's renderer has no sheets, and the scene has the sheet '" +
                         scene_->passages().sheets().front().name + "'",
                     "use the constraint renderer");
  }
  for (std::size_t i = 1; i < scene_->regions().size(); ++i) {
    const auto region = static_cast<RegionId>(i);
    Table table;
    const FieldPtr& whole = scene_->regions()[i].field;
    if (!whole) {
      throw inputError("render.paper_left_out",
                       "the paper's renderer wants all layers, and '" + scene_->regions()[i].name +
                           "' was left out: " + scene_->regions()[i].left_out,
                       "compile the scene for Purpose::kShow");
    }
    const FieldStructure structure = whole->structure();
    std::vector<FieldPtr> kept;
    if (structure.kind == FieldStructure::Kind::kIntersection) {
      kept.assign(structure.operands.begin(), structure.operands.end());
    } else {
      kept.push_back(whole);
    }
    for (std::size_t id = 0; id < scene_->ports().size(); ++id) {
      const Port& port = scene_->ports()[id];
      const auto names = [&](const std::vector<RegionId>& side) {
        return std::find(side.begin(), side.end(), region) != side.end();
      };
      if (!names(port.from) && !names(port.to)) continue;
      const auto face = std::find_if(kept.begin(), kept.end(), [&](const FieldPtr& part) {
        return kept.size() > 1 && isOneOf(scene_->partition().leavesOf(part.get()), port.on);
      });
      if (face != kept.end()) {
        table.openings.push_back(*face);
        kept.erase(face);
        table.on_face.push_back(static_cast<PortId>(id));
      } else if (!port.on.empty() &&
                 std::any_of(table.openings.begin(), table.openings.end(),
                             [&](const FieldPtr& part) {
                               return isOneOf(scene_->partition().leavesOf(part.get()), port.on);
                             })) {
        table.on_face.push_back(static_cast<PortId>(id));
      } else {
        table.on_wall.push_back(static_cast<PortId>(id));
      }
    }
    table.wall = kept.size() == 1 ? kept.front() : intersect(kept);
    table.surface.field = table.wall.get();
    table.surface.epsilon = epsilonOf(*table.wall);
    table.surface.alpha = settings.alpha;
    table.surface.newton_form =
        settings.alpha_form == AlphaForm::kNewton ||
        (settings.alpha_form == AlphaForm::kByMetric && table.wall->metric() == Metric::kImplicit);
    tables_.push_back(std::move(table));
  }
}

void PaperRenderer::forget() noexcept {
  started_ = false;
  in_contact_ = false;
  passed_.clear();
  for (Table& table : tables_) table.entered = false;
}

TickResult PaperRenderer::step(const HipState& hip) noexcept {
  TickResult out;
  if (!started_) {
    started_ = true;
    last_ = hip.position;
    observe(hip.position);
    // Started inside a region, one has entered it, and whatever it lies in.
    const RegionId start = scene_->startRegion();
    for (std::size_t i = 0; start != kOutside && i < tables_.size(); ++i) {
      const Region& region = scene_->regions()[start];
      tables_[i].entered =
          i + 1 == start || (i + 1 < start && region.has_seed &&
                             scene_->regions()[i + 1].field->value(region.seed) < 0.0);
    }
  }
  for (std::size_t i = 0; i < tables_.size(); ++i) advance(i, hip.position, out);
  observe(hip.position);
  feel(hip, out);
  last_ = hip.position;
  out.region = state();
  return out;
}

void PaperRenderer::observe(const Vec3& hip) noexcept {
  for (Table& table : tables_) {
    table.in_wall = table.wall->value(hip) <= 0.0;
    table.in_openings = std::all_of(table.openings.begin(), table.openings.end(),
                                    [&](const FieldPtr& part) { return part->value(hip) <= 0.0; });
  }
}

RegionId PaperRenderer::state() const noexcept {
  for (std::size_t i = tables_.size(); i > 0; --i) {
    if (tables_[i - 1].entered) return static_cast<RegionId>(i);
  }
  return kOutside;
}

/// Whether one of the ports lets the HIP into (or out of) the layer on its way; records it if so.
bool PaperRenderer::pass(std::size_t layer, bool inward, const std::vector<PortId>& ports,
                         const Vec3& from, const Vec3& to, TickResult& out) noexcept {
  const auto self = static_cast<RegionId>(layer + 1);
  RegionId other = kOutside;
  for (std::size_t i = tables_.size(); i > 0; --i) {
    if (i - 1 != layer && tables_[i - 1].entered) {
      other = static_cast<RegionId>(i);
      break;
    }
  }
  const RegionId a = inward ? other : self;
  const RegionId b = inward ? self : other;
  if (scene_->passages().wall(a, b).absent) {
    passed_.arrive(b, scene_->keepsMemory());
    return true;
  }
  for (const PortId id : ports) {
    const Port& port = scene_->ports()[id];
    if (!port.leads(a, b)) continue;
    // The middle of the tick's motion stands for the crossing point: a tick is short.
    const Vec3 middle = 0.5 * (from + to);
    if (port.mask >= 0) {
      scene_->partition().signsAt(middle, scratch_);
      if (!scene_->partition().maskHolds(static_cast<std::size_t>(port.mask), scratch_)) continue;
    }
    if (!std::all_of(port.after.begin(), port.after.end(),
                     [&](PortId before) { return passed_.contains(before); })) {
      continue;
    }
    passed_.pass(id, a, b, scene_->keepsMemory());
    if (out.event_count < TickResult::kMaxEvents) {
      crossings_[out.event_count] = {
          .port = id, .from = a, .to = b, .point = middle, .normal = unitOr(from - to, Vec3(0.0))};
      out.events[out.event_count++] = id;
    }
    return true;
  }
  return false;
}

/// The transitions of Table I for one layer.
void PaperRenderer::advance(std::size_t layer, const Vec3& hip, TickResult& out) noexcept {
  Table& table = tables_[layer];
  const bool in_wall = table.wall->value(hip) <= 0.0;
  const bool in_openings =
      std::all_of(table.openings.begin(), table.openings.end(),
                  [&](const FieldPtr& part) { return part->value(hip) <= 0.0; });
  if (!table.openings.empty() && in_wall && table.in_wall) {
    const bool came_in = in_openings && !table.in_openings;
    const bool went_out = !in_openings && table.in_openings;
    if (came_in && !table.entered && pass(layer, true, table.on_face, last_, hip, out)) {
      table.entered = true;
    } else if (went_out && table.entered && pass(layer, false, table.on_face, last_, hip, out)) {
      table.entered = false;
    }
  }
  if (in_openings && table.in_openings && in_wall != table.in_wall) {
    if (in_wall && !table.entered && pass(layer, true, table.on_wall, last_, hip, out)) {
      table.entered = true;
    } else if (!in_wall && table.entered && pass(layer, false, table.on_wall, last_, hip, out)) {
      table.entered = false;
    }
  }
}

void PaperRenderer::feel(const HipState& hip, TickResult& out) noexcept {
  out.proxy = hip.position;
  const RegionId here = state();
  if (here != kOutside) {
    const Table& own = tables_[here - 1U];
    if (!own.in_wall) {
      // Row 3, or row 4 where an opening is left as well.
      if (own.in_openings) return touch(here - 1U, -1.0, hip, out);
      in_contact_ = false;
      return;
    }
    if (!own.in_openings) {
      in_contact_ = false;
      return;
    }
  }
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    const Table& table = tables_[i];
    if (!table.entered && table.in_wall && table.in_openings) return touch(i, 1.0, hip, out);
  }
  in_contact_ = false;
  const Vec3& p = hip.position;
  out.force = dragForce(here, p, hip.velocity, 1.0) + latticeForce(here, p);
}

void PaperRenderer::touch(std::size_t layer, double side, const HipState& hip,
                          TickResult& out) noexcept {
  PaperSurface surface = tables_[layer].surface;
  surface.side = side;
  const bool goes_on = in_contact_ && contact_layer_ == layer && contact_side_ == side;
  contact_ = goes_on ? trackContact(surface, contact_, last_, hip.position)
                     : firstContact(surface, last_, hip.position);
  in_contact_ = true;
  contact_layer_ = layer;
  contact_side_ = side;

  auto beyond = static_cast<RegionId>(layer + 1);
  RegionId here = state();
  if (side < 0.0) {
    here = beyond;
    beyond = kOutside;
    for (std::size_t i = layer; i > 0; --i) {
      if (tables_[i - 1].entered) {
        beyond = static_cast<RegionId>(i);
        break;
      }
    }
  }
  const Wall& wall = scene_->passages().wall(here, beyond);
  out.proxy = contact_.surface_point;
  out.contact = true;
  if (wall.material < 0) return;
  const Material& material = scene_->materials()[static_cast<std::size_t>(wall.material)];
  const Vec3& x = contact_.surface_point;
  const Vec3 force = material.stiffness.at(x) * (x - contact_.interaction_point) -
                     material.damping.at(x) * hip.velocity;
  if (isFinite(force)) out.force = force;
}

}  // namespace palpate
