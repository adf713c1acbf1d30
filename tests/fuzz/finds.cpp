// Files that once did harm, made here so that nothing large or strange has to be stored.

#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "fuzz/seeds.h"
#include "vdb/dicom_writer.h"
#include "vdb/nifti_writer.h"

namespace palpate::fuzz {
namespace {

template <typename Number>
Number numberAt(const std::string& bytes, std::size_t at) {
  Number value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}
template <typename Number>
std::string with(std::string bytes, std::size_t at, Number value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
  return bytes;
}

/// The places of the lengths of Blosc chunks: they are repeated at the end of the chunk's own
/// header.
std::vector<std::size_t> bloscLengths(const std::string& bytes) {
  std::vector<std::size_t> places;
  for (std::size_t at = 0; at + 24 < bytes.size(); ++at) {
    const auto length = numberAt<std::int64_t>(bytes, at);
    if (length >= 16 && length < (1 << 20) && bytes[at + 8] == '\2' &&
        numberAt<std::uint32_t>(bytes, at + 20) == static_cast<std::uint64_t>(length)) {
      places.push_back(at);
    }
  }
  if (places.empty()) throw std::runtime_error("no chunk in the seed");
  return places;
}

void addGrids(std::vector<Find>& out) {
  const std::string sphere = vdbSeeds().front();
  const std::vector<std::size_t> places = bloscLengths(sphere);
  const std::size_t last = places.back();
  // A negative length means: not packed. OpenVDB reads that many bytes into a leaf of 2048.
  out.push_back({"vdb_blosc_length_all_ones", "vdb", with<std::int64_t>(sphere, last, -1)});
  for (std::size_t before = 1; before < 8; ++before) {
    out.push_back({"vdb_blosc_length_ones_before_" + std::to_string(before), "vdb",
                   with<std::uint64_t>(sphere, last - before, ~std::uint64_t{0})});
  }
  out.push_back(
      {"vdb_blosc_length_below_zero", "vdb", with<std::int64_t>(sphere, places.front(), -300'000)});
  out.push_back({"vdb_blosc_length_of_gigabytes", "vdb",
                 with<std::int64_t>(sphere, last, std::int64_t{3} << 30U)});
  out.push_back({"vdb_blosc_head_beyond_its_chunk", "vdb",
                 with<std::uint32_t>(sphere, last + 20, 0x00FFFFFF)});
  // A text of three gigabytes in the metadata.
  const std::size_t unit = sphere.find("length_unit");
  const std::size_t size = unit + std::strlen("length_unit") + 4 + std::strlen("string");
  out.push_back({"vdb_text_of_gigabytes", "vdb", with<std::uint32_t>(sphere, size, 0xB8000000)});
  out.push_back(
      {"vdb_name_of_gigabytes", "vdb", with<std::uint32_t>(sphere, unit - 4, 0xB8000000)});
}

void addDicom(std::vector<Find>& out) {
  const vdb::test::DicomFile file;
  const std::string slice = bytesOf(file);
  constexpr std::size_t kMeta = 132;
  const std::size_t end = slice.find("1.2.840.10008.1.2.1") + 30;
  for (std::size_t at = kMeta; at < end; ++at) {
    for (const char value : {'\0', '\x7F', '\xFF'}) {
      std::string damaged = slice;
      damaged[at] = value;
      out.push_back({"dicom_meta_byte_" + std::to_string(at), "dicom", std::move(damaged)});
    }
  }
  std::string strange = slice;
  const std::size_t vr = strange.find("DS");
  strange.replace(vr, 2, "ES");
  out.push_back({"dicom_vr_es", "dicom", std::move(strange)});
}

void addMeshes(std::vector<Find>& out) {
  out.push_back({"gltf_deep_brackets", "gltf", std::string(200'000, '[')});
  out.push_back({"gltf_deep_braces", "gltf", [] {
                   std::string text;
                   for (int i = 0; i < 100'000; ++i) text += R"({"extras":)";
                   return text;
                 }()});
  // Found by the fuzzer: a reader that trusts the stated total length sees no chunk, while Assimp
  // allocates the gigabytes that the first one states.
  const std::string glb = seedsOf("glb").front();
  for (const std::uint32_t promised : {1U, 12U, 19U}) {
    out.push_back({"glb_promises_" + std::to_string(promised), "glb",
                   with<std::uint32_t>(with<std::uint32_t>(glb, 8, promised), 12, 0xFC0200F0)});
  }
  const std::size_t second = 20 + numberAt<std::uint32_t>(glb, 12);
  out.push_back(
      {"glb_promises_its_first_part", "glb",
       with<std::uint32_t>(with<std::uint32_t>(glb, 8, static_cast<std::uint32_t>(second)), second,
                           0xFC0200F0)});
  // Every second corner is pulled inwards, so that two ears are never adjacent for long.
  std::string star = "v 0 0 0\n";
  const int corners = 60'000;
  std::string face = "f";
  for (int i = 0; i < corners; ++i) {
    const double x = i;
    star += "v " + std::to_string(x) + " " + std::to_string(i % 2 == 0 ? 0.0 : 1e4 + x) + " 0\n";
    face += " " + std::to_string(i + 2);
  }
  out.push_back({"obj_comb_of_60000_corners", "obj", star + face + "\n"});
  out.push_back({"ply_elements_of_nothing", "ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                 "property float z\nelement nothing 9000000000000000000\nelement face 1\n"
                 "property list uchar int vertex_indices\nend_header\n"
                 "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"});
}

void addImages(std::vector<Find>& out) {
  vdb::test::NiftiFile file;
  vdb::test::Bytes content = bytesOf(file);
  content.resize(content.size() + (std::size_t{64} << 20U));
  const vdb::test::Bytes packed = vdb::test::gzipped(content);
  out.push_back({"gz_that_unpacks_to_far_more", "nifti_gz", {packed.begin(), packed.end()}});
  out.push_back({"nrrd_text_of_nothing", "nrrd",
                 "NRRD0005\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\n"
                 "sizes: 900 900 900\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
                 "space origin: (0,0,0)\nencoding: text\n\n1 2 3"});
  out.push_back(
      {"labels_in_latin_1", "labels", "1 l\xE9sion 255 0 0 255\n2 k\xF6rper 0 0 0 255\n"});
}

void addScenes(std::vector<Find>& out) {
  for (const int layers : {5'000, 100'000}) {
    std::string scene = "palpate: 1\nlength: mm\nlayers:\n";
    for (int i = 0; i < layers; ++i) {
      scene += " - {name: l" + std::to_string(i) +
               ", inside: {sphere: {center: [0, 0, 0], radius: 1}}}\n";
    }
    out.push_back({"yaml_" + std::to_string(layers) + "_layers", "yaml", std::move(scene)});
  }
  std::string list = "[";
  for (int i = 0; i < 4'000'000; ++i) list += "1,";
  out.push_back({"yaml_four_million_numbers", "yaml", list + "1]"});
}

}  // namespace

std::vector<Find> finds() {
  std::vector<Find> out;
  addGrids(out);
  addDicom(out);
  addMeshes(out);
  addImages(out);
  addScenes(out);
  return out;
}

}  // namespace palpate::fuzz
