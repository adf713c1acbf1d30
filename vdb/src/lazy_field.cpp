#include "lazy_field.h"

#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "keep/grid_cache.h"
#include "keep/kept_facts.h"
#include "keep/making_lock.h"
#include "named_progress.h"
#include "palpate/core/stop.h"
#include "palpate/core/text.h"
#include "palpate/vdb/grid_memory.h"
#include "palpate/vdb/text.h"
#include "scene_grid.h"

namespace palpate::vdb {
namespace {

using Clock = std::chrono::steady_clock;

/// Longest wait for another process that makes the same grid: that process may have been stopped.
constexpr auto kMostWait = std::chrono::minutes(15);
constexpr std::uint64_t kNoBound = ~std::uint64_t{0};
constexpr auto kWaitStep = std::chrono::milliseconds(20);

std::string widenedNote(double half_width) {
  return "a band of " + shortNumber(half_width, 3) +
         " voxels is too narrow for cubic sampling; it was widened to " +
         shortNumber(kCubicHalfWidth, 6) + ", with distances to the closest points of the surface";
}

/// A grid, with facts and notes about it.
struct Made {
  LevelSet grid;
  KeptFacts facts;
  bool was_kept = false;
};

class Maker {
 public:
  Maker(CommonPtr common, GridSource source)
      : common_(std::move(common)),
        source_(std::move(source)),
        cache_(source_.content ? common_->options.cache_folder : std::string()),
        bundle_(source_.content ? common_->bundle.folder : std::string(), kNoBound,
                GridCache::Owner::kAnyone) {}

  [[nodiscard]] FieldPtr field(const Box3& within, const Progress& progress) const {
    const Progress named = namedProgress(progress, source_.what);
    const auto start = Clock::now();
    Made made;
    try {
      const bool keeps = cache_.isUsable() || bundle_.isUsable();
      GridContent content;
      if (keeps) content = source_.content(named);
      const std::string key = keeps && content.files.isKnown() ? content.grid.text() : "";
      if (!find(key, made)) {
        // Making an exact field takes no longer than reading a grid.
        if (source_.ways.instead) {
          if (FieldPtr exact = source_.ways.instead(named)) return exact;
        }
        if (key.empty()) {
          made = make(named);
        } else {
          makeOrWait(key, content.files, named, made);
        }
      }
      if (common_->bundle.fills && source_.content) {
        requireInBundle(!key.empty() && content.files.isUnchanged() &&
                        bundle_.keep(key, toKeep(made)));
      }
    } catch (const Error& error) {
      throwAt(source_.place, error);
    }
    if (made.was_kept) {
      for (const auto& [about, note] : made.facts.notes) common_->notes->add(about, {note});
    }
    const std::chrono::duration<double> took = Clock::now() - start;
    if (common_->options.on_grid) {
      common_->options.on_grid(
          {source_.what + ": " + source_.summary, made.facts.made, took.count()});
    }
    const std::uint64_t limit = common_->options.max_memory;
    if (!source_.ways.finish) return gridField(made.grid, source_.sampler, within, limit);
    try {
      return source_.ways.finish(gridField(made.grid, source_.sampler, Box3::everything(), limit),
                                 made.grid);
    } catch (const Error& error) {
      throwAt(source_.place, error);
    }
  }

  [[nodiscard]] Box3 box(const Progress& progress) const {
    try {
      if (!cache_.isUsable() && !bundle_.isUsable()) return source_.measure(progress);
      const GridContent content = source_.content(progress);
      if (!content.files.isKnown()) return source_.measure(progress);
      const std::string key = content.box.text();
      std::optional<Box3> box;
      for (const GridCache* kept : {&bundle_, &cache_}) {
        const auto text = box ? std::nullopt : kept->findText(key);
        if (text) box = boxOf(*text);
      }
      const bool is_new = !box;
      if (is_new) box = source_.measure(progress);
      const bool is_sure = content.files.isUnchanged();
      if (is_new && is_sure) cache_.keepText(key, textOf(*box));
      if (common_->bundle.fills) requireInBundle(is_sure && bundle_.keepText(key, textOf(*box)));
      return *box;
    } catch (const Error& error) {
      throwAt(source_.place, error);
    }
  }

  /// Whether the grid was kept before. Nothing is made.
  [[nodiscard]] bool isKept() const {
    if (cache_.folder().empty() && bundle_.folder().empty()) return false;
    const GridContent content = source_.content({});
    const std::string key = content.grid.text();
    return content.files.isKnown() && (bundle_.mayHave(key) || cache_.mayHave(key));
  }

 private:
  [[nodiscard]] bool find(const std::string& key, Made& made) const {
    if (key.empty()) return false;
    const Sampler sampler =
        source_.sampler == Sampler::kAccessor ? Sampler::kTrilinear : source_.sampler;
    const std::uint64_t limit = common_->options.max_memory;
    auto kept = bundle_.find(key, sampler, limit);
    if (!kept) kept = cache_.find(key, sampler, limit);
    if (!kept) return false;
    made.was_kept = true;
    made.grid = kept->named(source_.name, source_.metadata);
    made.facts = factsOf(made.grid, source_.what, source_.file);
    return true;
  }

  /// Only one process makes the grid. A process that has waited looks for it again.
  void makeOrWait(const std::string& key, const SourceState& files, const Progress& progress,
                  Made& made) const {
    if (!cache_.isUsable()) {
      made = make(progress);
      return;
    }
    MakingLock lock(cache_.folder(), key);
    const auto start = Clock::now();
    while (!lock.take() && Clock::now() - start < kMostWait) {
      report(progress, "wait for the process that makes it", -1.0);
      pollStop();
      std::this_thread::sleep_for(kWaitStep);
    }
    if (find(key, made)) return;
    made = make(progress);
    if (!files.isUnchanged()) return;
    cache_.keep(key, toKeep(made));
  }

  void requireInBundle(bool is_there) const {
    if (is_there) return;
    throw Error(ErrorKind::kOperation,
                {"pack.write", source_.what + " could not be put into the bundle",
                 "its file must not change meanwhile, and the disk needs room", source_.file});
  }

  /// The grid with its facts, but without the path of its source, which concerns nobody else.
  [[nodiscard]] LevelSet toKeep(const Made& made) const {
    const LevelSet grid = made.grid.named(source_.name, {{"source", fileName(source_.file)}});
    return withFacts(grid, made.facts, source_.what);
  }

  [[nodiscard]] Made make(const Progress& progress) const {
    Made out;
    const Notes::Listener listener(*common_->notes, out.facts.notes);
    Notes& notes = *common_->notes;
    const LevelSet grid = source_.make(progress);
    out.facts.made = grid.info();
    const LevelSetInfo& made = out.facts.made;
    if (made.metadata.contains("lost_parts")) {
      notes.add(source_.what, {"not in the grid: " + made.metadata.at("lost_parts")});
    }
    CertifyOptions certify = source_.certify;
    certify.sampler = source_.sampler;
    certify.cache_folder = common_->options.cache_folder;
    certify.max_memory = common_->options.max_memory;
    CertifiedGrid sure = certified(grid, certify, progress);
    if (source_.sampler == Sampler::kCubic && isTooNarrow(made)) {
      notes.add(source_.what, {widenedNote(made.half_width)});
    }
    if (!sure.notes.empty()) notes.add(source_.what, sure.notes);
    const std::string rough = roughNote(sure.grid, sure.certificate);
    if (!rough.empty()) notes.add(source_.what, {rough});
    out.grid = std::move(sure.grid);
    return out;
  }

  CommonPtr common_;
  GridSource source_;
  GridCache cache_;
  GridCache bundle_;
};

}  // namespace

FieldSourcePtr lazyField(const CommonPtr& common, GridSource source) {
  std::string summary = source.summary;
  const std::string what = source.what;
  const bool may_be_kept = source.content != nullptr;
  const auto maker = std::make_shared<const Maker>(common, std::move(source));
  if (may_be_kept && common->bundle.on_source) {
    common->bundle.on_source(what, [maker] { return maker->isKept(); });
  }
  return std::make_shared<FieldSource>(
      std::move(summary),
      [maker](const Box3& within, const Progress& progress) {
        return maker->field(within, progress);
      },
      [maker](const Progress& progress) { return maker->box(progress); });
}

}  // namespace palpate::vdb
