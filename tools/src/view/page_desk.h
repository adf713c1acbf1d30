#pragma once
/// PageDesk: answers the questions of pages about a session or a recorded run, and executes the
/// commands of the page that steers.

#include <memory>
#include <mutex>
#include <string>

#include "palpate/scene/description.h"
#include "view/page_server.h"
#include "view/recorded_run.h"
#include "view/shown_scene.h"
#include "view/steered_hand.h"

namespace palpate::tools {

/// The subject that pages show. All of it outlives the desk.
struct PageSubject {
  LiveFeed* feed = nullptr;          ///< for a running session; null: a recorded run
  SteeredHand* hand = nullptr;       ///< moved by the page; null: another hand holds the device
  const RecordedRun* run = nullptr;  ///< null: a session
  DeviceMapping mapping = {};        ///< for the hand's device
  Json about = {};                   ///< goes into scene.json: device, rate
};

class PageDesk {
 public:
  PageDesk(PageSubject subject, std::shared_ptr<const ShownScene> shown);

  /// The interface for a PageServer; the desk must outlive the server.
  [[nodiscard]] PageHost host();

 private:
  [[nodiscard]] std::optional<PageAnswer> get(std::string_view path);
  [[nodiscard]] std::string snapshot(std::uint64_t& seen, const PagePlace& place);
  void command(const std::string& message);
  void steer(const Vec3& place);
  [[nodiscard]] std::shared_ptr<const ShownScene> shown() const;

  PageSubject subject_;
  Vec3 told_;            ///< [m, world] where the page wants the hand to be
  std::size_t row_ = 0;  ///< in the recorded run
  mutable std::mutex mutex_;
  std::shared_ptr<const ShownScene> shown_;
};

}  // namespace palpate::tools
