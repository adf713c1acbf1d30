#include "vdb/made_scans.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "vdb/dicom_writer.h"
#include "vdb/nifti_writer.h"

namespace palpate::vdb::test {
namespace {

std::string text(double number) {
  char out[32];
  std::snprintf(out, sizeof out, "%.12g", number);
  return out;
}

/// The patient's axes of DICOM and NRRD: x and y run in the opposite directions. [mm]
Vec3 lps(const Vec3& ras) { return Vec3(-ras.x, -ras.y, ras.z); }

std::string listed(const Vec3& v, const std::string& between) {
  return text(v.x) + between + text(v.y) + between + text(v.z);
}

std::string headOf(const Image& image, const std::string& axes_before) {
  std::string directions = axes_before;
  for (int a = 0; a < 3; ++a) directions += "(" + listed(lps(image.axes[a]) * 1e3, ",") + ") ";
  directions.pop_back();
  return "space: left-posterior-superior\nspace directions: " + directions + "\nspace origin: (" +
         listed(lps(image.origin) * 1e3, ",") + ")\nencoding: raw\nendian: little\n";
}

std::string sizesOf(const Image& image) {
  return std::to_string(image.size[0]) + " " + std::to_string(image.size[1]) + " " +
         std::to_string(image.size[2]) + "\n";
}

}  // namespace

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return unitOr(Vec3(normal(random), normal(random), normal(random)), Vec3(1, 0, 0));
}

Image imageAround(const Vec3& center, const Mat3& axes, double side,
                  const std::function<double(const Vec3&)>& value) {
  Image image;
  image.source = "made.nii";
  image.axes = axes * 1e-3;
  Vec3 last(0.0);
  for (int a = 0; a < 3; ++a) {
    const int size = static_cast<int>(std::ceil(side / glm::length(axes[a])));
    image.size[static_cast<std::size_t>(a)] = size;
    last[a] = size - 1.0;
  }
  // The middle is between voxels, and nearer to one of them.
  image.origin = (center - axes * (0.5 * last + Vec3(0.3, 0.1, -0.2))) * 1e-3;
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i) {
        image.values.push_back(static_cast<float>(value(image.toWorld(Vec3(i, j, k)) * 1e3)));
      }
    }
  }
  return image;
}

Mat3 obliqueAxes(const Vec3& spacing, double angle) {
  Mat3 axes = rotationAbout(Vec3(1, 2, 3), angle);
  for (int a = 0; a < 3; ++a) axes[a] *= spacing[a];
  return axes;
}

Vec3 Limb::outwards(double angle) const {
  return std::cos(angle) * across + std::sin(angle) * glm::cross(axis, across);
}

double Limb::radius(const Vec3& mm) const { return glm::length(glm::cross(mm - center, axis)); }

double Limb::label(const Vec3& mm) const {
  const double r = radius(mm);
  if (std::abs(glm::dot(mm - center, axis)) > kHalf || r > kBody) return 0.0;
  return r < kBone ? 1.0 : r < kMuscle ? 2.0 : 3.0;
}

double Limb::ct(const Vec3& mm) const {
  const double r = radius(mm);
  const double beyond = std::abs(glm::dot(mm - center, axis)) - kHalf;
  const auto share = [](double distance) { return std::clamp(0.5 - distance / 3.0, 0.0, 1.0); };
  double hu = kFatHu + (kMuscleHu - kFatHu) * share(r - kMuscle);
  hu += (kBoneHu - kMuscleHu) * share(r - kBone);
  return std::round(kAirHu + (hu - kAirHu) * std::min(share(r - kBody), share(beyond)));
}

Image Limb::labels(const Mat3& axes) const {
  return imageAround(center, axes, 66.0, [this](const Vec3& mm) { return label(mm); });
}

Image Limb::scan(const Mat3& axes) const {
  return imageAround(center, axes, 66.0, [this](const Vec3& mm) { return ct(mm); });
}

std::string writeNifti(const Image& image, const palpate::testing::TempFolder& folder,
                       const std::string& name) {
  NiftiFile file;
  file.dim = {image.size[0], image.size[1], image.size[2]};
  file.values.assign(image.values.begin(), image.values.end());
  const auto [least, most] = std::minmax_element(image.values.begin(), image.values.end());
  file.datatype = *least >= 0.0F && *most < 256.0F ? 2 : 4;
  for (std::size_t row = 0; row < 3; ++row) {
    const int r = static_cast<int>(row);
    for (int a = 0; a < 3; ++a) {
      file.sform[row][static_cast<std::size_t>(a)] = image.axes[a][r] * 1e3;
      file.pixdim[static_cast<std::size_t>(a) + 1] = glm::length(image.axes[a]) * 1e3;
    }
    file.sform[row][3] = image.origin[r] * 1e3;
  }
  const Bytes bytes = name.ends_with(".gz") ? gzipped(bytesOf(file)) : bytesOf(file);
  return folder.file(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string writeNrrd(const Image& image, const palpate::testing::TempFolder& folder,
                      const std::string& name) {
  std::string bytes = "NRRD0004\ntype: short\ndimension: 3\nsizes: " + sizesOf(image) +
                      "kinds: domain domain domain\n" + headOf(image, "") + "\n";
  for (const float value : image.values) {
    const auto number = static_cast<unsigned>(static_cast<int>(value));
    bytes += static_cast<char>(number & 0xFFU);
    bytes += static_cast<char>(number >> 8U & 0xFFU);
  }
  return folder.file(name, bytes);
}

std::string writeDicom(const Image& image, const palpate::testing::TempFolder& folder,
                       const std::string& name) {
  const auto plane = static_cast<std::size_t>(image.size[0] * image.size[1]);
  const auto slice = [&](DicomFile& file, int k) {
    file.rows = image.size[1];
    file.columns = image.size[0];
    file.position = listed(lps(image.toWorld(Vec3(0, 0, k))) * 1e3, "\\");
    file.orientation = listed(lps(glm::normalize(image.axes[0])), "\\") + "\\" +
                       listed(lps(glm::normalize(image.axes[1])), "\\");
    file.spacing =
        text(glm::length(image.axes[1]) * 1e3) + "\\" + text(glm::length(image.axes[0]) * 1e3);
    for (std::size_t n = 0; n < plane; ++n) {
      // The writer's intercept is -1000.
      file.pixels.push_back(
          static_cast<int>(image.values[n + plane * static_cast<std::size_t>(k)]) + 1000);
    }
  };
  return writeSeries(folder, name, image.size[2], {0, 0, 0}, slice);
}

std::string writeSegments(const std::vector<Segment>& segments,
                          const palpate::testing::TempFolder& folder, const std::string& name) {
  const Image& image = segments.front().voxels;
  std::string bytes =
      "NRRD0004\ntype: unsigned char\ndimension: 4\nsizes: " + std::to_string(segments.size()) +
      " " + sizesOf(image) + "kinds: list domain domain domain\n" + headOf(image, "none ");
  for (std::size_t n = 0; n < segments.size(); ++n) {
    const std::string key = "Segment" + std::to_string(n);
    bytes += key + "_Name:=" + segments[n].name + "\n";
    bytes += key + "_LabelValue:=1\n";
    bytes += key + "_Layer:=" + std::to_string(n) + "\n";
  }
  bytes += "\n";
  for (std::size_t v = 0; v < image.values.size(); ++v) {
    for (const Segment& segment : segments) bytes += segment.voxels.values[v] != 0.0F ? '\1' : '\0';
  }
  return folder.file(name, bytes);
}

}  // namespace palpate::vdb::test
