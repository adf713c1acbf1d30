#pragma once
/// RecordedRun: a trace or a record that a page shows tick by tick.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "palpate/scene/scene.h"
#include "view/live_feed.h"

namespace palpate::tools {

class RecordedRun {
 public:
  /// Reads a `touch --record` (.npy) or a `touch --trace` (.csv), with the names of `scene`.
  /// @throws Error (kInput) for another kind of file, or for a region or port that the scene does
  /// not have.
  RecordedRun(const std::string& file, const Scene& scene);

  [[nodiscard]] std::size_t size() const noexcept { return rows_.size(); }
  /// The tick in row `row`, which must exist, in the form of a session at that tick.
  [[nodiscard]] FeedView at(std::size_t row, std::uint64_t seen) const;
  /// [N] The largest force in each of at most `columns` intervals of equal length.
  [[nodiscard]] std::vector<double> overview(std::size_t columns) const;

 private:
  struct Row {
    std::uint64_t tick = 0;
    double t = 0.0;
    Vec3 hip{0.0, 0.0, 0.0};
    Vec3 proxy{0.0, 0.0, 0.0};
    Vec3 force{0.0, 0.0, 0.0};
    std::int64_t ns = 0;
    double work = 0.0;          ///< [J] so far
    std::int64_t worst_ns = 0;  ///< [ns] so far
    std::uint64_t late = 0;     ///< ticks so far
    RegionId region = kOutside;
    bool contact = false;
    bool settled = true;
    bool is_late = false;
    std::vector<PortId> events;
  };

  void readRecord(const std::string& file, const Scene& scene);
  void readTrace(const std::string& file, const Scene& scene);
  void addUp(const Scene& scene);
  /// The entry into a region in row `row`, as far as the rows show it.
  [[nodiscard]] RegionEntry entryOf(std::size_t row, RegionId from, int port,
                                    const Scene& scene) const;

  std::vector<Row> rows_;
  struct Passing {
    std::size_t row = 0;
    SeenEntry entry;
    std::vector<int> passed;      ///< after this row
    std::vector<SeenHole> holes;  ///< the same
    std::optional<Vec3> fulcrum;  ///< [m] the same
  };
  std::vector<Passing> passings_;
  std::size_t ports_ = 0;
};

}  // namespace palpate::tools
