#pragma once
/// PageDesk: answers what pages ask about a session or a recorded run, and does what the one that
/// steers says.

#include <memory>
#include <mutex>
#include <string>

#include "palpate/scene/description.h"
#include "view/page_server.h"
#include "view/recorded_run.h"
#include "view/shown_scene.h"
#include "view/steered_hand.h"

namespace palpate::tools {

/// What is shown. All of it outlives the desk.
struct PageSubject {
  LiveFeed* feed = nullptr;          ///< of a session that runs; null: a recorded run
  SteeredHand* hand = nullptr;       ///< that the page moves; null: another hand holds the device
  const RecordedRun* run = nullptr;  ///< null: a session
  DeviceMapping mapping = {};        ///< of the hand's device
  Json about = {};                   ///< goes into scene.json: device, rate
};

class PageDesk {
 public:
  PageDesk(PageSubject subject, std::shared_ptr<const ShownScene> shown);

  /// For a PageServer, which the desk outlives.
  [[nodiscard]] PageHost host();

 private:
  [[nodiscard]] std::optional<PageAnswer> get(std::string_view path);
  [[nodiscard]] std::string snapshot(std::uint64_t& seen, const PagePlace& place);
  void command(const std::string& message);
  void steer(const Vec3& place);
  [[nodiscard]] std::shared_ptr<const ShownScene> shown() const;

  PageSubject subject_;
  Vec3 told_;            ///< [m, world] where the page leads the hand
  std::size_t row_ = 0;  ///< of the recorded run
  mutable std::mutex mutex_;
  std::shared_ptr<const ShownScene> shown_;
};

}  // namespace palpate::tools
