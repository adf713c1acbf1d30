// The gallery shows every example scene, all its pictures exist, and they are small enough for a
// repository.

#include <filesystem>

#include "tools/helpers.h"

namespace palpate::testing {
namespace {

namespace fs = std::filesystem;

TEST(Gallery, ShowsEveryExampleScene) {
  const fs::path root = test::sourceFolder();
  const std::string page = textOf((root / "tools/docs/gallery.md").string());
  for (const auto& entry : fs::directory_iterator(root / "data/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string scene = entry.path().filename().string();
    EXPECT_NE(page.find("palpate render data/scenes/" + scene + " "), std::string::npos)
        << scene << " is missing; add it to tools/gallery.sh";
  }
}

TEST(Gallery, ItsPicturesAreThereAndSmall) {
  const fs::path root = test::sourceFolder();
  const std::string page = textOf((root / "tools/docs/gallery.md").string());
  const std::string link = "](gallery/";
  std::uintmax_t bytes = 0;
  int pictures = 0;
  for (std::size_t at = page.find(link); at != std::string::npos; at = page.find(link, at + 1)) {
    const std::size_t begin = at + 2;
    const std::string name = page.substr(begin, page.find(')', begin) - begin);
    const fs::path file = root / "tools/docs" / name;
    ASSERT_TRUE(fs::exists(file)) << name << "; run tools/gallery.sh";
    bytes += fs::file_size(file);
    ++pictures;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(root / "tools/docs/gallery"), {}), pictures)
      << "a picture that is not on the page";
  EXPECT_LE(bytes, 3'000'000U) << "what the gallery may take";
}

}  // namespace
}  // namespace palpate::testing
