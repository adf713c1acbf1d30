#pragma once
// A library that is looked for when it is needed.

#include <string>
#include <vector>

namespace palpate::devices::plugin {

/// Stays loaded while this lives.
class SharedLibrary {
 public:
  /// Loads the first of `names` that is found. @throws Error (kDevice), with `hint`, if none is.
  SharedLibrary(const std::vector<std::string>& names, const std::string& hint);
  ~SharedLibrary();
  SharedLibrary(const SharedLibrary&) = delete;
  SharedLibrary& operator=(const SharedLibrary&) = delete;

  /// Whether one of `names` can be loaded.
  [[nodiscard]] static bool isThere(const std::vector<std::string>& names);

  /// Fills in the function's address. @throws Error (kDevice) if the library has none of that name.
  template <typename Function>
  void find(const char* name, Function*& function) const {
    function = reinterpret_cast<Function*>(addressOf(name));
  }

 private:
  [[nodiscard]] void* addressOf(const char* name) const;

  std::string name_;
  void* handle_ = nullptr;
};

}  // namespace palpate::devices::plugin
