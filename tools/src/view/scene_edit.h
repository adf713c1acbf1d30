#pragma once
/// SceneEdit: the text of a scene's file, and what became of it.

#include <cstdint>
#include <optional>
#include <string>

#include "palpate/core/error.h"

namespace palpate::tools {

struct SceneEdit {
  enum class State : std::uint8_t {
    kFelt,       ///< the text is felt, or about to be
    kCompiling,  ///< the scene before is felt meanwhile
    kRefused,    ///< the scene before is still felt
    kRecorded,   ///< not felt, because the session is recorded in the scene before
  };
  State state = State::kFelt;
  std::string text;
  std::optional<Problem> problem = {};  ///< why it was refused
  int line = 0;                         ///< of `text`, where the problem is; 0: elsewhere
};

}  // namespace palpate::tools
