#include "doctor/realtime_rights.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <set>
#include <system_error>
#include <thread>

#include "palpate/core/text.h"
#include "palpate/devices/device.h"

namespace palpate::tools {
namespace {

constexpr const char* kLimits = "/etc/security/limits.d/95-haptics.conf";

std::string firstLine(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

std::string errorText(int error) { return std::generic_category().message(error); }

/// Asks for real-time priority in another thread, so that this one keeps its own.
int tryPriority() {
  int error = 0;
  std::thread probe([&error] {
    sched_param wanted{};
    wanted.sched_priority = devices::kServoPriority;
    error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
  });
  probe.join();
  return error;
}

Finding priority() {
  const int error = tryPriority();
  if (error == 0)
    return {"Real-time priority",
            "granted (SCHED_FIFO " + std::to_string(devices::kServoPriority) + ")", true, ""};
  rlimit limit{};
  (void)getrlimit(RLIMIT_RTPRIO, &limit);
  return {"Real-time priority",
          "refused: " + errorText(error) + " (limit " + std::to_string(limit.rlim_cur) + ")", false,
          std::string("write `@plugdev - rtprio 80` to ") + kLimits + " and log in anew"};
}

Finding memory() {
  if (mlockall(MCL_CURRENT) == 0) {
    (void)munlockall();
    return {"Locked memory", "granted", true, ""};
  }
  const int error = errno;
  rlimit limit{};
  (void)getrlimit(RLIMIT_MEMLOCK, &limit);
  return {
      "Locked memory",
      "refused: " + errorText(error) + " (limit " + std::to_string(limit.rlim_cur / 1024) + " kB)",
      false,
      std::string("write `@plugdev - memlock unlimited` to ") + kLimits + " and log in anew"};
}

Finding kernel() {
  utsname about{};
  (void)uname(&about);
  const bool is_realtime = firstLine("/sys/kernel/realtime") == "1";
  return {"Kernel",
          std::string(about.release) + (is_realtime ? ", PREEMPT_RT" : ", not PREEMPT_RT"), true,
          is_realtime ? "" : "steadier: apt-get install linux-image-rt-amd64"};
}

Finding throttle() {
  const std::string runtime = firstLine("/proc/sys/kernel/sched_rt_runtime_us");
  const std::string period = firstLine("/proc/sys/kernel/sched_rt_period_us");
  if (runtime.empty()) return {"Real-time share", "not known", true, ""};
  return {"Real-time share", runtime + " of " + period + " us", runtime != "0",
          runtime != "0" ? "" : "sysctl kernel.sched_rt_runtime_us=950000"};
}

Finding governor() {
  std::set<std::string> names;
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  for (unsigned i = 0; i < cores; ++i) {
    const std::string name =
        firstLine("/sys/devices/system/cpu/cpu" + std::to_string(i) + "/cpufreq/scaling_governor");
    if (!name.empty()) names.insert(name);
  }
  if (names.empty()) return {"Governor", "none to be seen (a virtual machine?)", true, ""};
  const bool is_good = names.size() == 1 && *names.begin() == "performance";
  return {"Governor", joined(names), is_good,
          is_good ? "" : "cpupower frequency-set --governor performance"};
}

Finding cores() {
  const unsigned count = std::thread::hardware_concurrency();
  return {"Cores", std::to_string(count), count >= 2,
          count >= 2 ? "" : "with one core, the servo loop leaves no time for its watchdog thread"};
}

}  // namespace

std::vector<Finding> realtimeFindings() {
  return {kernel(), cores(), priority(), memory(), throttle(), governor()};
}

}  // namespace palpate::tools
