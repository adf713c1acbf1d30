// palpate_fuzz_corpus FOLDER: writes the files that fuzzers start from to FOLDER/READER/, anew each
// time.

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "fuzz/readers.h"
#include "fuzz/seeds.h"

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  if (argc != 2) {
    std::fputs("usage: palpate_fuzz_corpus FOLDER\n", stderr);
    return 2;
  }
  constexpr std::size_t kLargest = std::size_t{1} << 18U;  // larger ones only slow a fuzzer down
  const auto save = [&](const std::string& reader, const std::string& name,
                        const std::string& bytes) {
    if (bytes.size() > kLargest) return;
    const fs::path folder = fs::path(argv[1]) / reader;
    fs::create_directories(folder);
    std::ofstream(folder / name, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  };
  for (const palpate::fuzz::Reader& reader : palpate::fuzz::readers()) {
    int number = 0;
    for (const std::string& seed : palpate::fuzz::seedsOf(reader.name)) {
      save(reader.name, "seed" + std::to_string(number++), seed);
    }
  }
  int number = 0;
  for (const palpate::fuzz::Find& find : palpate::fuzz::finds()) {
    save(find.reader, find.name + "_" + std::to_string(number++), find.bytes);
  }
}
