#include "image/dicom_codes.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb {

std::optional<LabelCode> codeIn(const DicomItem& holder, std::uint32_t sequence) {
  const DicomItem* const code = holder.first(sequence);
  if (code == nullptr || code->text(dicom::kCodeValue).empty()) return {};
  return LabelCode{code->text(dicom::kCodeScheme), code->text(dicom::kCodeValue),
                   code->text(dicom::kCodeMeaning)};
}

LabelColor colorOfLab(const std::vector<int>& lab) {
  // DICOM PS3.3, C.10.7.1.1: L* from 0 to 100, a* and b* from -128 to 127.
  constexpr double kMost = 65535.0;
  const double l = lab[0] * 100.0 / kMost;
  const double a = lab[1] * 255.0 / kMost - 128.0;
  const double b = lab[2] * 255.0 / kMost - 128.0;
  // CIE 15, and the inverse of its linear part near black.
  const auto linear = [](double t) {
    constexpr double kKnee = 6.0 / 29.0;
    return t > kKnee ? t * t * t : 3.0 * kKnee * kKnee * (t - 4.0 / 29.0);
  };
  const double fy = (l + 16.0) / 116.0;
  const double x = 0.95047 * linear(fy + a / 500.0);
  const double y = linear(fy);
  const double z = 1.08883 * linear(fy - b / 200.0);
  // IEC 61966-2-1.
  const auto shown = [](double v) {
    const double clamped = std::clamp(v, 0.0, 1.0);
    return static_cast<float>(clamped <= 0.0031308 ? 12.92 * clamped
                                                   : 1.055 * std::pow(clamped, 1.0 / 2.4) - 0.055);
  };
  return {shown(3.2404542 * x - 1.5371385 * y - 0.4985314 * z),
          shown(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z),
          shown(0.0556434 * x - 0.2040259 * y + 1.0572252 * z)};
}

}  // namespace palpate::vdb
