#include "asked_fields.h"

#include "palpate/scene/scene_file.h"
#include "palpate/scene/suggestion.h"

namespace palpate::tools {

std::vector<AskedField> chooseFields(const Scene& scene, const std::string& name,
                                     const char* code) {
  std::vector<AskedField> all;
  for (const Region& region : scene.regions()) {
    if (region.field) all.push_back({region.name, region.field, true, region.source});
  }
  if (name.empty()) return all;
  for (const NamedField& named : scene.fields()) {
    all.push_back({named.name, named.source->get(), false, named.source->summary()});
  }
  for (const AskedField& a : all) {
    if (a.name == name) return {a};
  }
  throw inputError(code, "there is no field or layer '" + name + "'",
                   suggestionFor(name, all, "palpate info lists them", &AskedField::name));
}

const char* metricName(Metric metric) {
  switch (metric) {
    case Metric::kExact:
      return "exact";
    case Metric::kBound:
      return "bound";
    case Metric::kImplicit:
      return "implicit";
  }
  return "";
}

}  // namespace palpate::tools
