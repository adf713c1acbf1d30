#pragma once
/// SceneReloader: what is saved in the editor is felt and shown, as soon as it compiles.

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

/// Who gets an edited scene. All outlive the reloader.
struct ReloadTargets {
  devices::Session* session = nullptr;
  LiveFeed* feed = nullptr;
  PageDesk* desk = nullptr;
};

struct ReloadSettings {
  std::string file;
  /// With which a scene is felt. @throws Error.
  std::function<RendererSettings(const LoadedScene&)> renderer;
  bool is_recorded = false;  ///< then edits are noted, and not taken
  bool quiet = false;        ///< no notes; the console prints what is refused all the same
  std::chrono::milliseconds period{200};  ///< between two looks at the file
};

struct ReloadCounts {
  int felt = 0;
  int refused = 0;
};

/// In a thread of its own, at low priority: looks at the file, compiles what changed (grids that
/// are in the cache are not made again), and offers it to the session. What cannot be compiled is
/// printed once, and the scene before goes on.
class SceneReloader {
 public:
  /// `watch`: of the file, with the text that the session began with.
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
  SceneSight felt_;        ///< as it was offered last
  int offered_ = 0;        ///< scenes
  std::string last_told_;  ///< on the console, that was refused
  Console console_;
  std::atomic<int> felt_count_{0};
  std::atomic<int> refused_count_{0};
  std::mutex mutex_;
  std::condition_variable wake_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace palpate::tools
