#pragma once
// Random scenes, each felt by a random hand and checked at every tick.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "palpate/render/haptic_renderer.h"
#include "support/random_hand.h"
#include "support/random_scene.h"
#include "support/rest_judge.h"

namespace palpate::test {

/// A faulty tick, with everything needed to reproduce it.
struct CsgFault {
  testing::Fault fault = testing::Fault::kNone;
  std::uint64_t scene = 0;
  int tick = 0;
  double off = 0.0;    ///< [m], or [N] for forces
  double depth = 0.0;  ///< [m]
  std::string cause = {};
  Vec3 hip{0.0};  ///< [m]

  [[nodiscard]] std::string text() const {
    char out[400];
    std::snprintf(out, sizeof out,
                  "  scene %llu tick %d: %s, by %.3g, depth %.3g mm, %s, hand (%.17g, %.17g, "
                  "%.17g)\n",
                  static_cast<unsigned long long>(scene), tick, nameOf(fault), off, 1e3 * depth,
                  cause.c_str(), hip.x, hip.y, hip.z);
    return out;
  }
};

struct CsgCounts {
  int scenes = 0;
  int empty = 0;  ///< scenes whose start region has no point
  long ticks = 0;
  long contacts = 0;
  long oracle_runs = 0;
  long ambiguous = 0;
  long unjudged = 0;
  int given_up = 0;    ///< scenes ended early: the oracle does not converge where the hand is
  long unsettled = 0;  ///< ticks in contact that report it
  int longest_unsettled = 0;  ///< most of these in a row
  long frozen = 0;            ///< times that the hand stood still in contact
  std::array<long, static_cast<std::size_t>(testing::Fault::kCount)> faults{};
  std::vector<CsgFault> list = {};  ///< the first 200

  [[nodiscard]] long of(testing::Fault fault) const {
    return faults[static_cast<std::size_t>(fault)];
  }
  [[nodiscard]] long allFaults() const {
    long sum = 0;
    for (const long each : faults) sum += each;
    return sum;
  }
  [[nodiscard]] std::string text() const {
    std::string out = std::to_string(scenes) + " scenes (" + std::to_string(empty) + " empty), " +
                      std::to_string(ticks) + " ticks, " + std::to_string(contacts) +
                      " in contact, " + std::to_string(oracle_runs) + " oracle runs, " +
                      std::to_string(ambiguous) + " ambiguous, " + std::to_string(unjudged) +
                      " unjudged, " + std::to_string(frozen) + " times frozen, " +
                      std::to_string(unsettled) + " say that they are not settled, at most " +
                      std::to_string(longest_unsettled) + " in a row\n";
    for (std::size_t i = 1; i < faults.size(); ++i) {
      out += "  " + std::string(nameOf(static_cast<testing::Fault>(i))) + ": " +
             std::to_string(faults[i]) + "\n";
    }
    return out;
  }
};

/// One scene, felt for `contacts` ticks of contact or `most` ticks.
class CsgRun {
 public:
  CsgRun(CsgCounts& counts, int contacts, int most)
      : counts_(counts), contacts_(contacts), most_(most) {}

  void run(const RandomScene& scene) {
    try {
      run(scene, scene.compiled());
    } catch (const Error& error) {
      ADD_FAILURE() << "scene " << scene.number << ": " << error.what() << "\n" << scene.yaml;
    }
  }

  /// `compiled` is `scene`, compiled with some of its fields in another form.
  void run(const RandomScene& scene, const ScenePtr& compiled) {
    ++counts_.scenes;
    const testing::RegionTree tree(*compiled, compiled->startRegion());
    const auto start = roomyPoint(tree, scene.number);
    if (!start) {
      ++counts_.empty;
      return;
    }
    feel(scene, compiled, tree, *start);
  }

 private:
  static constexpr double kStiffness = 1000.0;  // [N/m] of the default wall
  static constexpr int kPatience = 5;  // ticks that the oracle may fail to answer in one scene

  void feel(const RandomScene& scene, const ScenePtr& compiled, const testing::RegionTree& tree,
            const Vec3& start) {
    const testing::RestJudge judge(tree, compiled->startRegion(), kStiffness);
    const auto renderer = makeRenderer(compiled);
    path_.assign(1, start);
    RandomHand hand(scene.number, start);
    TickResult before = renderer->update({start, Vec3(0.0)});
    Vec3 last = start;
    int contacts = 0;
    int still = 0;
    int unsettled = 0;
    int lost = 0;
    Vec3 settled_force(0.0);
    for (int tick = 1; tick <= most_ && contacts < contacts_; ++tick) {
      const Vec3 hip = hand.next(before.proxy, tree);
      path_.push_back(hip);
      const TickResult now = renderer->update({hip, (hip - last) / 1e-3});
      testing::Verdict verdict = judge.judge(before, last, now, hip, tick % 16 == 0);
      still = hand.isFrozen() ? still + 1 : 0;
      if (still == 1 && verdict.is_contact) ++counts_.frozen;
      if (still == 30) settled_force = now.force;
      unsettled = testing::saysSettled(now) ? 0 : unsettled + 1;
      counts_.unsettled += unsettled > 0 ? 1 : 0;
      counts_.longest_unsettled = std::max(counts_.longest_unsettled, unsettled);
      const bool is_frozen_fault =
          still > 30 &&
          (glm::length(now.force - settled_force) > 1e-3 || unsettled > 0 ||
           (still == RandomHand::kFrozenTicks && verdict.fault == testing::Fault::kPlace));
      if (is_frozen_fault) {
        verdict.fault = testing::Fault::kFrozen;
        verdict.off = glm::length(now.force - settled_force);
      }
      note(scene, verdict, tick, now, hip);
      if (verdict.is_contact) ++contacts;
      // An oracle that does not converge takes seconds for a tick.
      if (verdict.ran_oracle && verdict.is_unjudged && ++lost == kPatience) {
        ++counts_.given_up;
        return;
      }
      before = now;
      last = hip;
    }
  }

  void note(const RandomScene& scene, const testing::Verdict& verdict, int tick,
            const TickResult& now, const Vec3& hip) {
    ++counts_.ticks;
    counts_.contacts += verdict.is_contact ? 1 : 0;
    counts_.oracle_runs += verdict.ran_oracle ? 1 : 0;
    counts_.ambiguous += verdict.is_ambiguous ? 1 : 0;
    counts_.unjudged += verdict.is_unjudged ? 1 : 0;
    if (verdict.fault == testing::Fault::kNone) return;
    ++counts_.faults[static_cast<std::size_t>(verdict.fault)];
    if (counts_.list.size() < 200) {
      counts_.list.push_back({verdict.fault, scene.number, tick, verdict.off,
                              glm::length(now.proxy - hip), causeOf(verdict), hip});
      // Printed at once: a long run may be killed before its end.
      std::fprintf(stderr, "%s", counts_.list.back().text().c_str());
    }
    if (const char* folder = std::getenv("PALPATE_CSG_KEEP")) keep(folder, scene);
  }

  /// Stores the scene file and the hand's path so far, for `palpate touch SCENE --path FILE.csv`.
  void keep(const std::string& folder, const RandomScene& scene) const {
    const std::string name = folder + "/csg" + std::to_string(scene.number);
    std::ofstream(name + ".yaml") << scene.yaml;
    std::ofstream csv(name + ".csv");
    csv.precision(17);
    csv << "t,x,y,z\n";
    for (std::size_t i = 0; i < path_.size(); ++i) {
      csv << 1e-3 * static_cast<double>(i) << "," << path_[i].x << "," << path_[i].y << ","
          << path_[i].z << "\n";
    }
  }

  CsgCounts& counts_;
  int contacts_;
  int most_;
  std::vector<Vec3> path_;
};

}  // namespace palpate::test
