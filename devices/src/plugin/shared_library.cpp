#include "plugin/shared_library.h"

#include <dlfcn.h>

#include "palpate/core/error.h"

namespace palpate::devices::plugin {

SharedLibrary::SharedLibrary(const std::vector<std::string>& names, const std::string& hint) {
  std::string reasons;
  for (const std::string& name : names) {
    handle_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle_ != nullptr) {
      name_ = name;
      return;
    }
    const char* reason = dlerror();
    reasons += (reasons.empty() ? "" : "; ") + std::string(reason != nullptr ? reason : name);
  }
  throw Error(ErrorKind::kDevice,
              {"device.library", "the maker's library cannot be loaded: " + reasons, hint});
}

bool SharedLibrary::isThere(const std::vector<std::string>& names) {
  try {
    const SharedLibrary library(names, "");
    return true;
  } catch (const Error&) {
    return false;
  }
}

SharedLibrary::~SharedLibrary() {
  if (handle_ != nullptr) dlclose(handle_);
}

void* SharedLibrary::addressOf(const char* name) const {
  void* address = dlsym(handle_, name);
  if (address != nullptr) return address;
  throw Error(ErrorKind::kDevice,
              {"device.library", name_ + " has no function " + std::string(name),
               "it is another library, or a version that Palpate does not know"});
}

}  // namespace palpate::devices::plugin
