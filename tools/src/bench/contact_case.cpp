#include "bench/contact_case.h"

#include <algorithm>
#include <utility>

#include "support/oracle/oracle.h"

namespace palpate::tools {

ScenePtr solidScene(FieldPtr field, StartIn start) {
  SceneDescription scene;
  Material wall;
  wall.name = "wall";
  wall.stiffness = kWallStiffness;
  scene.materials.push_back(wall);
  LayerDescription layer;
  layer.name = "solid";
  layer.inside = std::make_shared<FieldSource>(std::move(field));
  layer.wall.material = wall.name;
  scene.layers.push_back(std::move(layer));
  if (start == StartIn::kSolid) scene.start_region = "solid";
  return compile(scene);
}

ContactCase along(ScenePtr scene, const Vec3& start, const Curve& curve, double from, double to,
                  double speed, Judge judge) {
  PathMaker maker(start);
  maker.go(curve(from), std::min(kApproachSpeed, speed));
  ContactCase out;
  out.first = maker.size();
  maker.follow(curve, from, to, speed);
  out.end = maker.size();
  out.scene = std::move(scene);
  out.path = maker.take();
  out.judge = std::move(judge);
  return out;
}

Judge judgeByFormula(std::function<oracle::Minima(const Vec3& hip)> minima) {
  return [minima = std::move(minima)](std::span<const Vec3> path, std::span<const TickResult>,
                                      const Progress& progress) {
    report(progress, "judging", 0.0);
    Truth truth(path.size());
    Vec3 previous = path.front();
    for (std::size_t i = 0; i < path.size(); ++i) {
      const oracle::Minima found = minima(path[i]);
      if (found.empty()) continue;
      previous = oracle::nearestTo(found, previous);
      truth[i] = previous;
    }
    return truth;
  };
}

Judge judgeByOracle(oracle::FeasibleSet allowed, std::size_t stride) {
  return
      [allowed = std::move(allowed), stride](
          std::span<const Vec3> path, std::span<const TickResult> run, const Progress& progress) {
        Truth truth(path.size());
        for (std::size_t i = stride; i < path.size(); i += stride) {
          report(progress, "asking the oracle",
                 static_cast<double>(i) / static_cast<double>(path.size()));
          const auto found = oracle::solveOracle(allowed, run[i - 1].proxy, path[i]);
          if (found.converged && !found.ambiguous) truth[i] = found.proxy;
        }
        return truth;
      };
}

}  // namespace palpate::tools
