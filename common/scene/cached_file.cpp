#include "common/scene/cached_file.h"

#include <array>
#include <bit>
#include <system_error>

#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/files/user_folder.h"
#include "common/base/text.h"
#include "common/scene/sha256.h"

namespace palpate {
namespace {

constexpr double kWorthKeeping = 0.5;      // [s]
constexpr std::size_t kDigestDigits = 64;  // hexadecimal
static_assert(std::endian::native == std::endian::little, "numbers are cached as they lie in memory");

/// Makes a folder and those above it, but none in one that is read-only, also where root may write to it.
bool make_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return true;
  if (folder == folder.root_path() || !make_folder(folder.parent_path()) || !may_cache_beside(folder))
    return false;
  return std::filesystem::create_directory(folder, ignored);
}

}  // namespace

Keeping keeping_from_name(const std::string& name) {
  constexpr std::array<std::string_view, 3> kNames{"auto", "always", "off"};
  for (std::size_t n = 0; n < kNames.size(); ++n)
    if (kNames[n] == name) return static_cast<Keeping>(n);
  throw usage_error("--cache " + name + ": auto, always or off is expected");
}

CachedFile::CachedFile(const std::filesystem::path& input, const Kind& kind, Keeping keeping, int threads)
    : kind_(kind), keeping_(keeping), threads_(threads) {
  std::error_code ignored;
  const std::filesystem::path whole = std::filesystem::absolute(input, ignored).lexically_normal();
  from_ = std::string(kind.what) + " of " + printable(whole.string()) + ", kept by Palpate; may be deleted";
  const auto folder = user_folder("XDG_CACHE_HOME", ".cache");
  if (!folder) return;
  std::filesystem::path stem = input.filename();
  if (stem.extension() == ".gz") stem.replace_extension();
  constexpr std::size_t kDigits = 12;  // of the place, so that two hearts of one name have a file each
  file_ = *folder / "palpate" / "hearts" /
          (stem.replace_extension().string() + "-" + sha256_of(whole.string()).substr(0, kDigits) +
           ".palpate." + kind.what);
}

bool CachedFile::there() const {
  std::error_code ignored;
  return keeping_ != Keeping::kOff && std::filesystem::is_regular_file(file_, ignored);
}

std::unique_ptr<const MappedFile> CachedFile::map() const {
  if (!there()) return nullptr;
  try {
    return std::make_unique<const MappedFile>(file_.string());
  } catch (const Error&) {
    return nullptr;  // as if it were not there
  }
}

std::optional<std::string_view> CachedFile::body_of(const MappedFile& mapped, const std::string& key) const {
  const std::string_view text = mapped.text();
  if (key.empty() || text.size() < kDigestDigits) return std::nullopt;
  const std::string_view whole = text.substr(0, text.size() - kDigestDigits);
  std::string_view body = whole;
  if (take_line(body) != from_ || take_line(body) != kind_.version || take_line(body) != key)
    return std::nullopt;
  if (sha256_in_pieces({&whole, 1}, "", threads_) != text.substr(whole.size())) return std::nullopt;
  return body;
}

void CachedFile::note_found(bool found) {
  const std::string what = kind_.what;
  notes_.push_back(found ? what + " taken from " + file_.string() + ", which an earlier opening has left"
                         : file_.string() + " holds " + what +
                               " of other input or options, or is damaged: made anew");
}

bool CachedFile::wants(double seconds) {
  if (keeping_ == Keeping::kOff || (keeping_ == Keeping::kAuto && seconds < kWorthKeeping)) return false;
  if (!file_.empty() && make_folder(file_.parent_path()) && may_cache_beside(file_)) return true;
  notes_.push_back(std::string(kind_.what) + " not cached for the next opening: " +
                   (file_.empty() ? "the user has no folder for it"
                                  : "the folder of " + file_.string() + " is read-only"));
  return false;
}

void CachedFile::keep(const std::string& key, std::string_view body) {
  if (key.empty()) return;
  std::string text;
  text.reserve(from_.size() + key.size() + body.size() + 2 * kDigestDigits);
  text += from_ + "\n" + kind_.version + "\n" + key + "\n";
  text += body;
  const std::string_view whole = text;
  text += sha256_in_pieces({&whole, 1}, "", threads_);
  try {
    OutputFile out(file_, true);
    out.write(text);
    out.finish();
    notes_.push_back(std::string(kind_.what) + " cached in " + file_.string() + " for the next opening (" +
                     bytes_text(text.size()) + ")");
  } catch (const Error& error) {
    notes_.push_back(std::string(kind_.what) + " not cached for the next opening: " + error.what());
  }
}

std::optional<std::string_view> take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

}  // namespace palpate
