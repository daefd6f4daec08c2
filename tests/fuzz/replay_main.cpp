// Runs a fuzz target without a fuzzer: over its seeds and over a few thousand damaged copies of them, the
// same ones every time. Where the compiler has libFuzzer, that takes this file's place. For libraries that allocate
// what a damaged file says, under a limit of memory, as helpers have one; for those that lose some of it with each, in
// several runs of other random numbers.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include <sys/resource.h>

#include "common/base/sanitizers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Input = std::vector<std::uint8_t>;

Input read(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Changes, removes or repeats some bytes.
void damage(Input& input, std::mt19937& random) {
  const auto below = [&random](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  const std::size_t changes = 1 + below(6);
  for (std::size_t i = 0; i < changes && !input.empty(); ++i) {
    const std::size_t at = below(input.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(16, input.size() - at));
    const auto first = input.begin() + static_cast<std::ptrdiff_t>(at);
    switch (below(4)) {
      case 0:
        *first = static_cast<std::uint8_t>(random());
        break;
      case 1:
        *first = static_cast<std::uint8_t>('0' + below(10));
        break;
      case 2:
        input.erase(first, first + static_cast<std::ptrdiff_t>(length));
        break;
      default: {
        const Input part(first, first + static_cast<std::ptrdiff_t>(length));
        input.insert(first, part.begin(), part.end());
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 5) {
    std::fputs("usage: replay SEED_FOLDER DAMAGED_COPIES_OF_EACH [MEMORY_IN_MIB [RANDOM_START]]\n", stderr);
    return 2;
  }
#if !PALPATE_UNDER_ASAN  // whose shadow of memory counts
  if (argc > 3) {
    const rlimit memory{static_cast<rlim_t>(std::atoi(argv[3])) << 20U, RLIM_INFINITY};
    if (::setrlimit(RLIMIT_AS, &memory) != 0) return 2;
  }
#endif
  std::vector<std::filesystem::path> seeds;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) seeds.push_back(entry.path());
  std::sort(seeds.begin(), seeds.end());
  const int copies = std::atoi(argv[2]);
  std::mt19937 random(argc > 4 ? static_cast<unsigned>(std::atoi(argv[4])) : 1U);
  long runs = 0;
  for (const auto& path : seeds) {
    const Input seed = read(path);
    (void)LLVMFuzzerTestOneInput(seed.data(), seed.size());
    for (int copy = 0; copy < copies; ++copy, ++runs) {
      Input input = seed;
      damage(input, random);
      (void)LLVMFuzzerTestOneInput(input.data(), input.size());
    }
  }
  std::printf("%zu seeds, %ld damaged copies\n", seeds.size(), runs);
  return seeds.empty() ? 1 : 0;
}
