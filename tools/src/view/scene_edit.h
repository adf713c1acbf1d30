#pragma once
/// SceneEdit: what a scene's file holds, and what became of it.

#include <cstdint>
#include <optional>
#include <string>

#include "palpate/core/error.h"

namespace palpate::tools {

struct SceneEdit {
  enum class State : std::uint8_t {
    kFelt,       ///< or about to be
    kCompiling,  ///< the scene before goes on meanwhile
    kRefused,    ///< the scene before goes on
    kRecorded,   ///< not taken: the record is of the scene before
  };
  State state = State::kFelt;
  std::string text;
  std::optional<Problem> problem = {};  ///< why it was refused
  int line = 0;                         ///< of `text`, where the problem is; 0: elsewhere
};

}  // namespace palpate::tools
