#include "view/scene_reloader.h"

#include <sys/resource.h>

#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "palpate/vdb/text.h"
#include "stop_signal.h"

namespace palpate::tools {

SceneReloader::SceneReloader(const ReloadTargets& targets, ReloadSettings settings,
                             SceneWatch watch)
    : targets_(targets),
      settings_(std::move(settings)),
      watch_(std::move(watch)),
      felt_(watch_.first()),
      console_(settings_.quiet) {
  thread_ = std::thread([this] { run(); });
}

SceneReloader::~SceneReloader() {
  {
    const std::lock_guard lock(mutex_);
    stop_.store(true);
  }
  wake_.notify_all();
  thread_.join();
}

void SceneReloader::run() {
  // Applies to this thread only: the loop has priority.
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, 0, kNice);
  std::unique_lock lock(mutex_);
  while (!stop_.load()) {
    lock.unlock();
    targets_.desk->forgetPast();
    if (const auto sight = watch_.look()) take(*sight);
    lock.lock();
    wake_.wait_for(lock, settings_.period, [this] { return stop_.load(); });
  }
}

void SceneReloader::take(const SceneSight& sight) {
  if (!sight.text) {
    const std::string text = felt_.text.value_or(std::string());
    return refuse(inputError("view.gone", "the scene's file is not there any more",
                             "the scene goes on as it was; save the file again", settings_.file),
                  text);
  }
  using State = SceneEdit::State;
  if (sight == felt_) {  // an edit was taken back
    last_told_.clear();
    return targets_.desk->edited({.state = State::kFelt, .text = *sight.text});
  }
  if (settings_.is_recorded) {
    console_.note(
        "the scene's file has changed; the session is recorded, and goes on in the scene "
        "as it was (without --record, edits are felt)");
    return targets_.desk->edited({.state = State::kRecorded, .text = *sight.text});
  }
  targets_.desk->edited({.state = State::kCompiling, .text = *sight.text});
  try {
    compile(sight);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kCancelled) refuse(error, *sight.text);
  } catch (const std::exception& error) {
    refuse(Error(ErrorKind::kOperation,
                 {"view.failed", std::string("the scene could not be made: ") + error.what()}),
           *sight.text);
  }
}

void SceneReloader::compile(const SceneSight& sight) {
  Console silent(true);
  // Compiles the text that was seen, not the present one. For an empty text, LoadedScene would read
  // the file.
  const std::string text = sight.text->empty() ? "\n" : *sight.text;
  const LoadedScene loaded(settings_.file, silent, 0, text);
  const Progress progress = [this](std::string_view, double) {
    return !stop_.load() && !stopRequested().load();
  };
  const ScenePtr scene = palpate::compile(loaded.description(), progress, Purpose::kShow);
  const RendererSettings renderer = settings_.renderer(loaded);
  const int number = offered_ + 1;
  targets_.feed->expect(static_cast<std::uint64_t>(number), scene);
  targets_.desk->expect(std::make_shared<const ShownScene>(scene, loaded, *sight.text, number));
  const devices::SceneOffer offer = targets_.session->offer(scene, renderer);
  offered_ = number;
  felt_ = sight;
  last_told_.clear();
  ++felt_count_;
  targets_.desk->edited({.state = SceneEdit::State::kFelt, .text = *sight.text});
  std::string note = "edit " + std::to_string(number) + " of " + vdb::fileName(settings_.file) +
                     " is felt" + (offer.goes_on ? "" : "; the probe begins anew");
  for (const std::string& lost : offer.lost) note += "; lost: " + lost;
  console_.note(note);
}

void SceneReloader::refuse(const Error& error, const std::string& text) {
  const Problem& problem = error.problem();
  const bool is_here = problem.file == settings_.file;
  targets_.desk->edited({.state = SceneEdit::State::kRefused,
                         .text = text,
                         .problem = problem,
                         .line = is_here ? problem.line : 0});
  ++refused_count_;
  // If a file is saved again with the same fault, the fault is not printed again.
  const std::string told = formatProblem(problem);
  if (told != std::exchange(last_told_, told)) {
    console_.say(told + "\nthe scene goes on as it was");
  }
}

}  // namespace palpate::tools
