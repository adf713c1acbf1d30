#pragma once
/// PageDesk: answers the questions of pages about a session or a recorded run, and executes the
/// commands of the page that steers.

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "view/page_server.h"
#include "view/recorded_run.h"
#include "view/scene_edit.h"
#include "view/shown_scene.h"
#include "view/steered_hand.h"

namespace palpate::tools {

/// The subject that pages show. All of it outlives the desk.
struct PageSubject {
  LiveFeed* feed = nullptr;          ///< for a running session; null: a recorded run
  SteeredHand* hand = nullptr;       ///< moved by the page; null: another hand holds the device
  const RecordedRun* run = nullptr;  ///< null: a session
  Json about = {};                   ///< goes into scene.json: device, rate
};

/// Pages see the scene that the last tick was in. Each message contains that scene's number; when
/// the number changes, a page asks for names and surfaces again.
class PageDesk {
 public:
  PageDesk(PageSubject subject, std::shared_ptr<const ShownScene> shown);

  /// The interface for a PageServer; the desk must outlive the server.
  [[nodiscard]] PageHost host();

  // For the thread that reads edited scenes.

  /// Announces a scene; to be called before the first tick in it.
  void expect(std::shared_ptr<const ShownScene> shown);
  /// Tells pages the present text of the scene's file, and what became of it.
  void edited(SceneEdit edit);
  /// Frees scenes that nobody sees any more, which may take a while.
  void forgetPast();

 private:
  [[nodiscard]] std::optional<PageAnswer> get(std::string_view path);
  [[nodiscard]] std::string snapshot(std::uint64_t& seen, const PagePlace& place);
  void command(const std::string& message);
  void steer(const Vec3& place);
  [[nodiscard]] std::shared_ptr<const ShownScene> shown() const;
  /// The scene `number`, or else the shown one. A newer scene becomes the shown one.
  [[nodiscard]] std::shared_ptr<const ShownScene> goTo(std::uint64_t number);
  [[nodiscard]] std::uint64_t edits() const;
  [[nodiscard]] std::string sceneText() const;
  /// The scene `number`: the shown one, an announced one, or an earlier one that is not freed yet.
  [[nodiscard]] std::shared_ptr<const ShownScene> numbered(std::size_t number) const;
  /// The part of a scene at `path`, which has the scene's number in it: "surface/NUMBER/REGION",
  /// "port/NUMBER/PORT", "slices/NUMBER" and "slice/NUMBER/AXIS/INDEX".
  [[nodiscard]] std::optional<PageAnswer> partOf(std::string_view path) const;

  PageSubject subject_;
  Vec3 told_;            ///< [m, world] where the page wants the hand to be
  int told_in_ = 0;      ///< number of the scene whose mapping was used for it
  std::size_t row_ = 0;  ///< in the recorded run
  mutable std::mutex mutex_;
  std::shared_ptr<const ShownScene> shown_;
  std::vector<std::shared_ptr<const ShownScene>> others_;  ///< announced scenes, and earlier ones
  SceneEdit edit_;
  std::uint64_t edits_ = 0;  ///< how often edit_ changed
};

}  // namespace palpate::tools
