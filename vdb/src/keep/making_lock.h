#pragma once
/// Lets one process make something while others wait for it.

#include <string>

namespace palpate::vdb {

/// A lock on a byte of the file `locks` in a folder, which the kernel releases however the process
/// ends. It belongs to the object, so that threads of one process wait for each other too. Where
/// locks are impossible (a folder that cannot be written to, a file system without locks), the work
/// is done without one.
class MakingLock {
 public:
  /// `key`: at least 16 hexadecimal digits. Does not take the lock yet.
  MakingLock(const std::string& folder, const std::string& key);
  ~MakingLock();
  MakingLock(const MakingLock&) = delete;
  MakingLock& operator=(const MakingLock&) = delete;

  /// True if the lock is held now, or locks are impossible; false if another process has it. Does
  /// not wait.
  [[nodiscard]] bool take();

 private:
  int file_ = -1;
  long long byte_ = 0;
};

}  // namespace palpate::vdb
