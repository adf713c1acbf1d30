#include "fuzz/seeds.h"

#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "folders/folders.h"
#include "palpate/vdb/mesh.h"
#include "vdb/dicom_writer.h"
#include "vdb/nifti_writer.h"

namespace palpate::fuzz {
namespace {

using vdb::test::Bytes;

std::string text(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

std::string contentOf(const std::filesystem::path& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

std::vector<std::string> scenes() {
  std::vector<std::string> out;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::sourceFolder() + "/data/scenes")) {
    if (entry.path().extension() == ".yaml") out.push_back(contentOf(entry.path()));
  }
  out.emplace_back(
      R"({"palpate": 1, "length": "mm", "layers": [{"name": "ball", "inside": {"sphere": {"center": [0, 0, 0], "radius": 40}}}]})");
  return out;
}

std::vector<std::string> niftis() {
  vdb::test::NiftiFile plain;
  vdb::test::NiftiFile named;
  named.extension_code = 30;
  named.extension =
      "<CaretExtension><LabelTable><Label Key=\"1\" Red=\"1\" Green=\"0\" Blue=\"0\">skin</Label>"
      "</LabelTable></CaretExtension>";
  vdb::test::NiftiFile turned;
  turned.datatype = 16;
  turned.qform_code = 1;
  turned.sform_code = 0;
  turned.quaternion = {0.1, 0.2, 0.3};
  return {text(bytesOf(plain)), text(bytesOf(named)), text(bytesOf(turned))};
}

std::vector<std::string> packedNiftis() {
  std::vector<std::string> out;
  for (const std::string& plain : niftis()) {
    out.push_back(text(vdb::test::gzipped(Bytes(plain.begin(), plain.end()))));
  }
  return out;
}

std::vector<std::string> nrrds() {
  const std::string head =
      "NRRD0005\n# made by a test\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\n"
      "sizes: 2 3 4\nspace directions: (1,0,0) (0,1,0) (0,0,2)\nspace origin: (0,0,0)\n";
  std::string voxels;
  std::string written;
  for (int i = 0; i < 24; ++i) {
    voxels += static_cast<char>(i % 3);
    written += std::to_string(i % 3) + (i % 6 == 5 ? "\n" : " ");
  }
  return {head + "encoding: raw\n\n" + voxels, head + "encoding: text\n\n" + written,
          head +
              "encoding: gzip\nSegment0_ID:=a\nSegment0_Name:=skin\nSegment0_LabelValue:=1\n"
              "Segment0_Color:=1 0 0\n\n" +
              text(vdb::test::gzipped(Bytes(voxels.begin(), voxels.end())))};
}

std::vector<std::string> metaImages() {
  const auto head = [](const std::string& more) {
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n" +
           more +
           "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 1 1 2\n"
           "DimSize = 2 3 4\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
  };
  const std::string voxels(24, '\2');
  std::string packed(200, '\0');
  uLongf size = packed.size();
  if (compress(reinterpret_cast<Bytef*>(packed.data()), &size,
               reinterpret_cast<const Bytef*>(voxels.data()), voxels.size()) != Z_OK) {
    throw std::runtime_error("zlib");
  }
  packed.resize(size);
  return {
      head("") + voxels,
      head("CompressedData = True\nCompressedDataSize = " + std::to_string(size) + "\n") + packed};
}

void put(std::string& to, std::uint32_t number, int bytes) {
  for (int i = 0; i < bytes; ++i) to += static_cast<char>(number >> (8 * i));
}

/// A slice whose pixels are run-length encoded: first the high bytes, then the low ones.
std::string packedDicom() {
  vdb::test::DicomFile file;
  file.with_pixels = false;
  std::string bytes = bytesOf(file);
  const std::string plain = "1.2.840.10008.1.2.1";
  bytes.replace(bytes.find(plain), plain.size(), "1.2.840.10008.1.2.5");
  const auto pixels = static_cast<std::uint32_t>(file.rows * file.columns);
  std::string segments;
  put(segments, 2, 4);
  put(segments, 64, 4);
  put(segments, 66, 4);
  segments.resize(64, '\0');
  for (const char value : {'\0', '\5'}) {
    segments += static_cast<char>(257 - pixels);  // a run: one value, repeated
    segments += value;
  }
  put(bytes, 0x00107FE0, 4);
  bytes += std::string("OB\0\0\xFF\xFF\xFF\xFF", 8);
  for (const std::string& fragment : {std::string(), segments}) {
    put(bytes, 0xE000FFFE, 4);
    put(bytes, static_cast<std::uint32_t>(fragment.size()), 4);
    bytes += fragment;
  }
  put(bytes, 0xE0DDFFFE, 4);
  put(bytes, 0, 4);
  return bytes;
}

std::vector<std::string> dicoms() {
  vdb::test::DicomFile plain;
  vdb::test::DicomFile other;
  other.is_implicit = true;
  other.with_sequence = true;
  other.bits_stored = 12;
  std::vector<std::string> out = segmentSeeds();
  out.insert(out.end(), {bytesOf(plain), bytesOf(other), packedDicom()});
  return out;
}

vdb::Mesh cube() {
  vdb::Mesh mesh;
  mesh.source = "cube";
  for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

std::vector<std::string> stls() {
  return {encodeMesh(cube(), vdb::MeshFormat::kStl, 1.0),
          "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
          "endloop\nendfacet\nendsolid a\n"};
}
std::vector<std::string> objs() {
  return {encodeMesh(cube(), vdb::MeshFormat::kObj, 1.0),
          "# a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .2 .5 0\nvn 0 0 1\nf 1//1 2//1 3 4 -1\n"};
}
std::vector<std::string> plys() {
  return {encodeMesh(cube(), vdb::MeshFormat::kPly, 1.0),
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
          "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
          "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"};
}
std::vector<std::string> vtks() {
  const std::string head = "# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\n";
  return {
      head +
          "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nPOLYGONS 4 16\n3 0 2 1\n3 0 1 3\n3 0 3 2\n"
          "3 1 2 3\n",
      "# vtk DataFile Version 5.1\na\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 0 0 1 0 0 0 1 0\n"
      "POLYGONS 2 3\nOFFSETS vtktypeint64\n0 3\nCONNECTIVITY vtktypeint64\n0 1 2\n"};
}
std::vector<std::string> gltfs() {
  return {R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0, "translation": [1, 2, 3]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
{"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
"buffers": [{"byteLength": 42, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}]})"};
}

}  // namespace

std::vector<std::string> seedsOf(std::string_view reader) {
  if (reader == "yaml") return scenes();
  if (reader == "path") return {"t,x,y,z\n0,0,0,0.1\n0.001,0,1e-3,0.0999\n0.002,0,2e-3,0.0998\n"};
  if (reader == "labels") {
    return {
        "1 skin 255 0 0 255\n2 bone 0 255 0 255\n",
        "LabelValue,Name,Color_R,Color_G,Color_B\n1,\"a, b\",1,2,3\n",
        "################\n# ITK-SnAP Label Description File\n 1 255 0 0 1 1 1 \"left kidney\"\n"};
  }
  if (reader == "nifti") return niftis();
  if (reader == "nifti_gz") return packedNiftis();
  if (reader == "nrrd") return nrrds();
  if (reader == "metaimage") return metaImages();
  if (reader == "dicom") return dicoms();
  if (reader == "stl") return stls();
  if (reader == "obj") return objs();
  if (reader == "ply") return plys();
  if (reader == "vtk") return vtks();
  if (reader == "gltf") return gltfs();
  if (reader == "glb") return {encodeMesh(cube(), vdb::MeshFormat::kGlb, 1.0)};
  if (reader == "vdb") return vdbSeeds();
  throw std::out_of_range("no such reader");
}

}  // namespace palpate::fuzz
