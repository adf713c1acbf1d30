#pragma once
/// SceneReloader: compiles a scene's file whenever it is saved, and makes it felt and shown.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "console.h"
#include "loaded_scene.h"
#include "palpate/devices/session.h"
#include "view/live_feed.h"
#include "view/page_desk.h"
#include "view/scene_watch.h"

namespace palpate::tools {

/// The receivers of an edited scene. All outlive the reloader.
struct ReloadTargets {
  devices::Session* session = nullptr;
  LiveFeed* feed = nullptr;
  PageDesk* desk = nullptr;
};

struct ReloadSettings {
  std::string file;
  /// Returns the renderer's settings for a scene. @throws Error.
  std::function<RendererSettings(const LoadedScene&)> renderer;
  bool is_recorded = false;  ///< edits are reported, but not felt
  bool quiet = false;        ///< no notes; the console prints refused edits nevertheless
  std::chrono::milliseconds period{200};  ///< between two looks at the file
};

struct ReloadCounts {
  int felt = 0;
  int refused = 0;
};

/// Has a thread of low priority, which looks at the file, compiles an edit (grids in the cache are
/// not made again), and offers the scene to the session. If an edit cannot be compiled, the console
/// prints the error once, and the scene before is still felt.
class SceneReloader {
 public:
  /// `watch` looks at the file; its first text is the one that the session began with.
  SceneReloader(const ReloadTargets& targets, ReloadSettings settings, SceneWatch watch);
  ~SceneReloader();
  SceneReloader(const SceneReloader&) = delete;
  SceneReloader& operator=(const SceneReloader&) = delete;

  [[nodiscard]] ReloadCounts counts() const noexcept { return {felt_count_, refused_count_}; }

 private:
  void run();
  void take(const SceneSight& sight);
  void compile(const SceneSight& sight);
  void refuse(const Error& error, const std::string& text);

  ReloadTargets targets_;
  ReloadSettings settings_;
  SceneWatch watch_;
  SceneSight felt_;        ///< state of the files that is felt
  int offered_ = 0;        ///< number of scenes that the session took
  std::string last_told_;  ///< last refusal that the console printed
  Console console_;
  std::atomic<int> felt_count_{0};
  std::atomic<int> refused_count_{0};
  std::mutex mutex_;
  std::condition_variable wake_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace palpate::tools
