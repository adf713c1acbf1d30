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

/// The scene that pages see is the one that the last tick was in: with the others of its number, a
/// page asks for names and surfaces anew.
class PageDesk {
 public:
  PageDesk(PageSubject subject, std::shared_ptr<const ShownScene> shown);

  /// The interface for a PageServer; the desk must outlive the server.
  [[nodiscard]] PageHost host();

  // For the thread that reads edited scenes.

  /// Before the first tick in it.
  void expect(std::shared_ptr<const ShownScene> shown);
  /// What the scene's file holds now.
  void edited(SceneEdit edit);
  /// Frees scenes that nobody sees any more, which may take a while.
  void forgetPast();

 private:
  [[nodiscard]] std::optional<PageAnswer> get(std::string_view path);
  [[nodiscard]] std::string snapshot(std::uint64_t& seen, const PagePlace& place);
  void command(const std::string& message);
  void steer(const Vec3& place);
  [[nodiscard]] std::shared_ptr<const ShownScene> shown() const;
  /// The scene `number`, or else the one that is shown. A newer one is shown from now on.
  [[nodiscard]] std::shared_ptr<const ShownScene> goTo(std::uint64_t number);
  [[nodiscard]] std::uint64_t edits() const;
  [[nodiscard]] std::string sceneText() const;
  /// The scene `number`, if it is shown, comes, or was shown before and is not forgotten.
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
  std::vector<std::shared_ptr<const ShownScene>> others_;  ///< that come, and those before
  SceneEdit edit_;
  std::uint64_t edits_ = 0;  ///< how often edit_ changed
};

}  // namespace palpate::tools
