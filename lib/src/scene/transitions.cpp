#include "palpate/scene/transitions.h"

#include "palpate/interior/port_machine.h"

namespace palpate {

std::vector<Transition> transitions(const Scene& scene) {
  std::vector<Transition> all;
  const auto count = static_cast<RegionId>(scene.regions().size());
  for (RegionId from = 0; from < count; ++from) {
    for (RegionId to = 0; to < count; ++to) {
      if (!scene.touches(from, to)) continue;
      if (scene.passages().wall(from, to).absent) {
        all.push_back({from, to});
        continue;
      }
      for (const PortId id : scene.passages().portsOf(from)) {
        const Port& port = scene.ports()[id];
        if (!port.leads(from, to)) continue;
        all.push_back({from, to, id, port.leadsInward(from, to) ? port.opens_at : port.back});
      }
    }
  }
  return all;
}

}  // namespace palpate
