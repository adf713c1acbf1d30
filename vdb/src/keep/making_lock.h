#pragma once
/// One process makes something while others wait for it.

#include <string>

namespace palpate::vdb {

/// A lock on a byte of the file `locks` in a folder, which the kernel gives back whatever ends the
/// process. It belongs to the object, so that threads of one process wait for each other too. Where
/// there can be none (a folder that cannot be written to, a file system without locks) there is
/// none, and the work is done as if alone.
class MakingLock {
 public:
  /// `key`: 16 hexadecimal digits or more. Takes nothing yet.
  MakingLock(const std::string& folder, const std::string& key);
  ~MakingLock();
  MakingLock(const MakingLock&) = delete;
  MakingLock& operator=(const MakingLock&) = delete;

  /// True if it is held now, or there can be none; false if another has it. Does not wait.
  [[nodiscard]] bool take();

 private:
  int file_ = -1;
  long long byte_ = 0;
};

}  // namespace palpate::vdb
