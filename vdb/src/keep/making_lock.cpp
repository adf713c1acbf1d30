#include "keep/making_lock.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace palpate::vdb {
namespace {

/// Each key locks one of the possible byte positions of a file; none of these bytes is ever
/// written.
long long byteOf(const std::string& key) {
  constexpr unsigned long long kBytes = (1ULL << 62) - 1;
  return static_cast<long long>(std::strtoull(key.substr(0, 16).c_str(), nullptr, 16) & kBytes);
}

}  // namespace

MakingLock::MakingLock(const std::string& folder, const std::string& key) : byte_(byteOf(key)) {
  file_ = open((folder + "/locks").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
}

MakingLock::~MakingLock() {
  if (file_ >= 0) close(file_);
}

bool MakingLock::take() {
  if (file_ < 0) return true;
  struct flock lock = {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte_;
  lock.l_len = 1;
  if (fcntl(file_, F_OFD_SETLK, &lock) == 0) return true;
  return errno != EAGAIN && errno != EACCES && errno != EINTR;
}

}  // namespace palpate::vdb
