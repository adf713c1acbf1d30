#pragma once
// A library that is loaded when it is needed.

#include <string>
#include <vector>

namespace palpate::devices::plugin {

/// The library stays loaded while this object exists.
class SharedLibrary {
 public:
  /// Loads the first of `names` that is found. @throws Error (kDevice), with `hint`, if none is.
  SharedLibrary(const std::vector<std::string>& names, const std::string& hint);
  ~SharedLibrary();
  SharedLibrary(const SharedLibrary&) = delete;
  SharedLibrary& operator=(const SharedLibrary&) = delete;

  /// Whether one of `names` can be loaded.
  [[nodiscard]] static bool isThere(const std::vector<std::string>& names);

  /// Sets `out` to the function's address. @throws Error (kDevice) if the library has no function
  /// of that name.
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
