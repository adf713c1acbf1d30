#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "palpate/devices/record.h"

namespace palpate::devices {

OutFile::OutFile(const std::string& file, std::string name)
    : name_(std::move(name)),
      number_(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (number_ < 0) throw failure();
}

OutFile::~OutFile() {
  if (number_ >= 0) close(number_);
}

Error OutFile::failure() const {
  return {ErrorKind::kOperation,
          {"record.write", std::string("cannot write: ") + std::strerror(errno),
           "look for room on the disk", name_}};
}

void OutFile::append(const void* bytes, std::size_t count, std::size_t piece) {
  const auto* from = static_cast<const char*>(bytes);
  std::size_t done = 0;
  while (done < count) {
    const ssize_t now =
        pwrite(number_, from + done, count - done, static_cast<off_t>(size_ + done));
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) {
      const int why = now == 0 ? ENOSPC : errno;
      size_ += done - done % piece;
      static_cast<void>(!ftruncate(number_, static_cast<off_t>(size_)));
      errno = why;
      throw failure();
    }
    done += static_cast<std::size_t>(now);
  }
  size_ += count;
}

void OutFile::overwrite(std::uint64_t at, std::string_view bytes) {
  ssize_t done = -1;
  do {
    done = pwrite(number_, bytes.data(), bytes.size(), static_cast<off_t>(at));
  } while (done < 0 && errno == EINTR);
  if (done != static_cast<ssize_t>(bytes.size())) throw failure();
}

}  // namespace palpate::devices
