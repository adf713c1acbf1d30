#include "wall_notes.h"

#include "json_parts.h"
#include "palpate/render/contrast.h"
#include "palpate/render/shading_gap.h"
#include "text.h"

namespace palpate::tools {
namespace {

/// Share of the wall's force above which a hand feels the sideways force as a pull.
constexpr double kMuchSideways = 0.5;

}  // namespace

std::vector<WallNote> wallNotes(const Scene& scene) {
  std::vector<WallNote> notes;
  const double unit = scene.metersPerUnit();
  const auto lengthText = [&](double meters) {
    return formatNumber(meters / unit, 3) + " " + scene.lengthUnit();
  };
  const auto placeText = [&](const Vec3& place) {
    return formatVector(place / unit, 3) + " " + scene.lengthUnit();
  };
  for (const Contrast& each : contrastsOf(scene)) {
    const std::string& name = scene.materials()[static_cast<std::size_t>(each.material)].name;
    WallNote note;
    note.code = "scene.contrast";
    note.place = each.at;
    note.is_warning = each.sideways > kMuchSideways;
    note.text = "the stiffness of " + name + " changes by its own size within " +
                lengthText(each.length) + ", near " + placeText(each.at) +
                ": there it pushes sideways up to " + formatNumber(each.sideways, 2) +
                " times as hard as the wall pushes back";
    note.json = {{"material", name},
                 {"at_m", vectorJson(each.at)},
                 {"length_m", each.length},
                 {"sideways", each.sideways}};
    notes.push_back(std::move(note));
  }
  for (const ShadingGap& each : shadingGaps(scene)) {
    const std::string& name = scene.materials()[static_cast<std::size_t>(each.material)].name;
    const std::string& layer = scene.regions()[each.region].name;
    WallNote note;
    note.code = "scene.shading_band";
    note.place = each.at;
    note.is_warning = true;
    note.text =
        "the shading of " + name + " needs " + lengthText(each.needed) +
        " beside the surface, and the grid of " + layer + " knows only " + lengthText(each.known) +
        " (near " + placeText(each.at) +
        "): it feels less round than it was asked for; give the grid a wider band (half_width) "
        "or use less shading";
    note.json = {{"material", name},
                 {"layer", layer},
                 {"at_m", vectorJson(each.at)},
                 {"needed_m", each.needed},
                 {"known_m", each.known}};
    notes.push_back(std::move(note));
  }
  return notes;
}

}  // namespace palpate::tools
