#include "itk/itk_image.h"

#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkImageSeriesReader.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include <cstring>
#include <stdexcept>

namespace palpate::vdb::test {
namespace {

template <typename T>
void count(const std::vector<char>& bytes, std::map<double, std::size_t>& histogram) {
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    ++histogram[static_cast<double>(value)];
  }
}

/// ITK has LPS.
template <typename Spacing, typename Origin, typename Direction>
std::array<double, 12> affineOf(const Spacing& spacing, const Origin& origin,
                                const Direction& direction) {
  std::array<double, 12> affine{};
  for (std::size_t row = 0; row < 3; ++row) {
    const double sign = row < 2 ? -1.0 : 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      affine[4 * row + axis] = sign * direction(row, axis) * spacing(axis);
    }
    affine[4 * row + 3] = sign * origin(row);
  }
  return affine;
}

}  // namespace

ItkImage readWithItk(const std::string& path) {
  itk::ImageIOBase::Pointer io;
  if (path.ends_with(".nrrd")) io = itk::NrrdImageIO::New();
  if (path.ends_with(".mhd") || path.ends_with(".mha")) io = itk::MetaImageIO::New();
  if (path.ends_with(".nii") || path.ends_with(".nii.gz")) io = itk::NiftiImageIO::New();
  if (!io) throw std::runtime_error("no reader for " + path);
  io->SetFileName(path);
  io->ReadImageInformation();
  if (io->GetNumberOfDimensions() != 3 || io->GetNumberOfComponents() != 1) {
    throw std::runtime_error(path + " is no 3-D image of single numbers");
  }
  ItkImage out;
  out.affine = affineOf([&](std::size_t a) { return io->GetSpacing(static_cast<unsigned>(a)); },
                        [&](std::size_t a) { return io->GetOrigin(static_cast<unsigned>(a)); },
                        [&](std::size_t row, std::size_t axis) {
                          return io->GetDirection(static_cast<unsigned>(axis))[row];
                        });
  for (std::size_t a = 0; a < 3; ++a) {
    out.size[a] = static_cast<int>(io->GetDimensions(static_cast<unsigned>(a)));
  }
  itk::ImageIORegion all(3);
  for (unsigned a = 0; a < 3; ++a) all.SetSize(a, io->GetDimensions(a));
  io->SetIORegion(all);
  std::vector<char> bytes(static_cast<std::size_t>(io->GetImageSizeInBytes()));
  io->Read(bytes.data());
  using Component = itk::IOComponentEnum;
  switch (io->GetComponentType()) {
    case Component::UCHAR:
      count<std::uint8_t>(bytes, out.histogram);
      break;
    case Component::CHAR:
      count<std::int8_t>(bytes, out.histogram);
      break;
    case Component::SHORT:
      count<std::int16_t>(bytes, out.histogram);
      break;
    case Component::USHORT:
      count<std::uint16_t>(bytes, out.histogram);
      break;
    case Component::INT:
      count<std::int32_t>(bytes, out.histogram);
      break;
    case Component::FLOAT:
      count<float>(bytes, out.histogram);
      break;
    case Component::DOUBLE:
      count<double>(bytes, out.histogram);
      break;
    default:
      throw std::runtime_error(path + " has voxels of another type");
  }
  return out;
}

ItkImage readSeriesWithItk(const std::string& folder) {
  using Volume = itk::Image<float, 3>;
  const auto names = itk::GDCMSeriesFileNames::New();
  names->SetDirectory(folder);
  const auto& series = names->GetSeriesUIDs();
  if (series.size() != 1) throw std::runtime_error("not one series in " + folder);
  const auto reader = itk::ImageSeriesReader<Volume>::New();
  reader->SetImageIO(itk::GDCMImageIO::New());
  reader->SetFileNames(names->GetFileNames(series.front()));
  reader->Update();
  const Volume& volume = *reader->GetOutput();
  ItkImage out;
  out.affine = affineOf(
      [&](std::size_t a) { return volume.GetSpacing()[static_cast<unsigned>(a)]; },
      [&](std::size_t a) { return volume.GetOrigin()[static_cast<unsigned>(a)]; },
      [&](std::size_t row, std::size_t axis) {
        return volume.GetDirection()(static_cast<unsigned>(row), static_cast<unsigned>(axis));
      });
  const auto size = volume.GetLargestPossibleRegion().GetSize();
  for (std::size_t a = 0; a < 3; ++a)
    out.size[a] = static_cast<int>(size[static_cast<unsigned>(a)]);
  const std::size_t voxels = volume.GetLargestPossibleRegion().GetNumberOfPixels();
  for (std::size_t i = 0; i < voxels; ++i) {
    ++out.histogram[static_cast<double>(volume.GetBufferPointer()[i])];
  }
  return out;
}

}  // namespace palpate::vdb::test
