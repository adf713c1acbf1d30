#pragma once
// The thread that talks to the Inverse Service. Needs PALPATE_INVERSE3.

#include <memory>
#include <string>

#include "palpate/devices/inverse3.h"
#include "plugin/mailbox.h"

namespace palpate::devices::inverse3 {

class Link {
 public:
  /// Connects, and waits until the service has reported the device's position. `mail` must outlive
  /// the link.
  /// @throws Error (kDevice).
  Link(const Inverse3Settings& settings, plugin::Mailbox& mail);
  /// Sends zero force and ends.
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Call this after the mailbox got a new force. Real time: one write to the kernel, which never
  /// blocks.
  void wake() noexcept;

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace palpate::devices::inverse3
