#include <array>
#include <fstream>
#include <string_view>

#include "mesh/builder.h"

namespace palpate::vdb {

// 3D Slicer writes SPACE=RAS or SPACE=LPS into the title of VTK files, the header of STL files and
// comments of PLY and OBJ files, always among the first lines.
Space statedSpace(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 1024> head{};
  file.read(head.data(), head.size());
  const std::string_view text(head.data(), static_cast<std::size_t>(file.gcount()));
  const bool lps = text.find("SPACE=LPS") != std::string_view::npos;
  const bool ras = text.find("SPACE=RAS") != std::string_view::npos;
  if (lps == ras) return Space::kStated;
  return lps ? Space::kLps : Space::kRas;
}

}  // namespace palpate::vdb
