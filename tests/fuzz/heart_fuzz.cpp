// Hearts in text: EX of every version, openCARP with results, TetGen with directions. An input holds the
// files of a model one after the other, each behind a line "=== ENDING"; the first one is opened.
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "loaders/cardiac/cardiac_loader.h"
#include "tests/fuzz/reader_fuzz.h"
#include "tests/support/temp_folder.h"

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const test::TempFolder folder;
  for (const auto& old : std::filesystem::directory_iterator(folder.path()))
    std::filesystem::remove(old.path());
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  std::filesystem::path first;
  constexpr std::string_view kMark = "=== ";
  while (rest.starts_with(kMark)) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string name = "heart.";
    for (const char c : rest.substr(kMark.size(), end - kMark.size()))
      if (c >= 'a' && c <= 'z') name += c;
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::size_t next = std::min(rest.find("\n=== "), rest.size());
    std::string content(rest.substr(0, next));
    rest.remove_prefix(std::min(next + 1, rest.size()));
    const auto path = folder.write(name, content + "\n");
    if (first.empty()) first = path;
  }
  if (first.empty()) return 0;
  return test::read_files(first, make_cardiac_loader, [](Format format) {
    return format == Format::kEx || format == Format::kCarp || format == Format::kTetgen;
  });
}
