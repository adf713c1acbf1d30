#include <algorithm>

#include "doctor/device_findings.h"
#include "doctor/realtime_rights.h"
#include "verbs.h"

namespace palpate::tools {

Report run(const DoctorOptions& /*options*/, const GeneralOptions& /*general*/,
           Console& /*console*/) {
  Report report;
  report.json = {{"schema", "palpate.doctor/1"}, {"machine", Json::array()}};
  constexpr std::size_t kColumn = 20;
  for (const Finding& f : realtimeFindings()) {
    report.json["machine"].push_back({{"what", f.what},
                                      {"found", f.found},
                                      {"good", f.is_good},
                                      {"remedy", f.remedy.empty() ? Json() : Json(f.remedy)}});
    report.text +=
        f.what + std::string(kColumn - std::min(kColumn - 1, f.what.size()), ' ') + f.found + "\n";
    if (!f.remedy.empty()) {
      report.text += std::string(kColumn, ' ') + (f.is_good ? "" : "-> ") + f.remedy + "\n";
    }
    report.is_yes = report.is_yes && f.is_good;
  }
  const auto devices = deviceFindings();
  report.json["devices"] = findingsJson(devices);
  report.json["good"] = report.is_yes;
  report.text +=
      "\n" + findingsText(devices) + "\nHow late this machine wakes a loop: palpate bench servo\n";
  return report;
}

}  // namespace palpate::tools
