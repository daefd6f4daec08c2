#include "loaders/dicom/dicom_file.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/file_numbers.h"
#include "common/load/dicom_mark.h"

namespace palpate {
namespace {

constexpr std::uint32_t kUndefined = 0xFFFFFFFFU;
constexpr DicomTag kItem = 0xFFFEE000U, kItemEnd = 0xFFFEE00DU, kSequenceEnd = 0xFFFEE0DDU;
constexpr int kDeepest = 16;
constexpr DicomTag kTransferSyntax = 0x00020010U;

/// The types of what is asked for (PS3.6), for files that do not say them. Words need none.
std::string_view type_of(DicomTag tag) {
  static constexpr std::array<std::pair<DicomTag, std::string_view>, 38> kTypes{
      {{0x00041220, "SQ"}, {0x00180050, "DS"}, {0x00180088, "DS"}, {0x00189087, "FD"}, {0x00189089, "FD"},
       {0x00200011, "IS"}, {0x00200012, "IS"}, {0x00200013, "IS"}, {0x00200032, "DS"}, {0x00200037, "DS"},
       {0x00200100, "IS"}, {0x00209128, "UL"}, {0x00280002, "US"}, {0x00280006, "US"}, {0x00280008, "IS"},
       {0x00280010, "US"}, {0x00280011, "US"}, {0x00280030, "DS"}, {0x00280100, "US"}, {0x00280101, "US"},
       {0x00280102, "US"}, {0x00280103, "US"}, {0x00281050, "DS"}, {0x00281051, "DS"}, {0x00281052, "DS"},
       {0x00281053, "DS"}, {0x00281101, "US"}, {0x00281102, "US"}, {0x00281103, "US"}, {0x00281201, "OW"},
       {0x00281202, "OW"}, {0x00281203, "OW"}, {0x3004000C, "DS"}, {0x3004000E, "DS"}, {0x52009229, "SQ"},
       {0x52009230, "SQ"}, {0x7FE00010, "OW"}, {0x00189117, "SQ"}}};
  const auto* const found =
      std::find_if(kTypes.begin(), kTypes.end(), [tag](const auto& one) { return one.first == tag; });
  return found == kTypes.end() ? std::string_view() : found->second;
}

class Walk {
 public:
  Walk(const std::string& name, std::string_view bytes) : name_(name), bytes_(bytes) {}

  DicomSet run() {
    if (!is_dicom_start(bytes_)) fail("is no DICOM file");
    if (has_dicom_preamble(bytes_)) at_ = kDicomHeadBytes;
    // File meta information: little endian with types, whatever follows.
    DicomSet all;
    constexpr std::uint32_t kMetaGroup = 0x0002;
    while (at_ + 8 <= bytes_.size() && (peek_tag() >> 16U) == kMetaGroup)
      all.elements.push_back(element(bytes_.size(), 0));
    std::string_view syntax;
    if (const DicomElement* stated = all.find(kTransferSyntax)) syntax = stated->value;
    while (!syntax.empty() && (syntax.back() == '\0' || syntax.back() == ' ')) syntax.remove_suffix(1);
    if (syntax == "1.2.840.10008.1.2.1.99") fail("is deflated as a whole; unpack it with gdcmconv --raw");
    big_endian_ = syntax == "1.2.840.10008.1.2.2";
    implicit_ = at_ + 8 <= bytes_.size() && !has_dicom_type(bytes_.substr(at_));
    while (at_ < bytes_.size()) all.elements.push_back(element(bytes_.size(), 0));
    return all;
  }

 private:
  [[noreturn]] void fail(const std::string& found) const {
    throw input_error(
        {name_, "byte " + std::to_string(at_), found, "", "the file may be cut off or damaged"});
  }

  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size() - at_) fail("the file ends in the middle of an element");
    const std::string_view part = bytes_.substr(at_, count);
    at_ += count;
    return part;
  }
  template <typename T>
  T number() {
    return number_at<T>(take(sizeof(T)), 0, big_endian_);
  }
  DicomTag tag() {
    const auto group = number<std::uint16_t>();
    return DicomTag{group} << 16U | number<std::uint16_t>();
  }
  DicomTag peek_tag() {
    const DicomTag next = tag();
    at_ -= 4;
    return next;
  }
  void check_length(const char* what, std::uint32_t length, std::uint64_t end) const {
    if (length > end - std::min(end, at_))
      fail(std::string(what) + " claims " + std::to_string(length) + " bytes, more than there are");
  }

  void check_end(const char* what, std::uint64_t past) const {
    if (at_ != past) fail(std::string(what) + " holds more than its length");
  }

  /// One element that ends at `end` at the latest.
  DicomElement element(std::uint64_t end, int depth) {
    if (depth > kDeepest) fail("sequences are nested more deeply than " + std::to_string(kDeepest));
    DicomElement made{.tag = tag(), .big_endian = big_endian_};
    std::uint32_t length = 0;
    if (implicit_) {
      length = number<std::uint32_t>();
    } else {
      made.type = take(2);
      const auto letter = [&](std::size_t i) { return made.type[i] >= 'A' && made.type[i] <= 'Z'; };
      if (!letter(0) || !letter(1)) fail("an element has no type that DICOM knows");
      static constexpr std::array<std::string_view, 13> kLong{"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                              "SV", "UC", "UN", "UR", "UT", "UV"};
      if (std::find(kLong.begin(), kLong.end(), made.type) != kLong.end()) {
        (void)take(2);
        length = number<std::uint32_t>();
      } else {
        length = number<std::uint16_t>();
      }
    }
    // What is of an unknown type was of none in the file from which it came: little endian, without types in it
    // (PS3.5 section 6.2.2).
    const bool unknown = made.type == "UN";
    const bool before = implicit_;
    if (unknown) implicit_ = true;
    if (implicit_) made.type = type_of(made.tag);
    if (length == kUndefined) {
      made.packed = made.tag == kDicomPixels;
      if (made.packed) {
        pass_fragments(end);
      } else {
        sequence(end, depth, made);
      }
    } else {
      check_length("an element", length, end);
      const std::uint64_t past = at_ + length;
      const bool may_nest =
          implicit_ && length >= 8 && made.tag != kDicomPixels && (made.tag >> 16U) % 2 == 0;
      if (made.type == "SQ" || (may_nest && peek_tag() == kItem)) {
        while (at_ < past) made.items.push_back(item(past, depth));
        check_end("a sequence", past);
      } else {
        made.value = bytes_.substr(at_, length);
      }
      at_ = past;
    }
    implicit_ = before;
    return made;
  }

  /// Items up to the mark that ends them.
  void sequence(std::uint64_t end, int depth, DicomElement& made) {
    while (peek_tag() != kSequenceEnd) made.items.push_back(item(end, depth));
    (void)take(8);
  }
  void pass_fragments(std::uint64_t end) {
    while (peek_tag() != kSequenceEnd) {
      if (tag() != kItem) fail("encapsulated pixels are not a row of fragments");
      const auto length = number<std::uint32_t>();
      check_length("a fragment", length, end);
      at_ += length;
    }
    (void)take(8);
  }

  DicomSet item(std::uint64_t end, int depth) {
    DicomSet made;
    if (tag() != kItem) fail("a sequence holds something that is no item");
    const auto length = number<std::uint32_t>();
    if (length != kUndefined) {
      check_length("an item", length, end);
      const std::uint64_t past = at_ + length;
      while (at_ < past) made.elements.push_back(element(past, depth + 1));
      check_end("an item", past);
      return made;
    }
    while (peek_tag() != kItemEnd) made.elements.push_back(element(end, depth + 1));
    (void)take(8);
    return made;
  }

  const std::string& name_;
  std::string_view bytes_;
  std::uint64_t at_ = 0;
  bool implicit_ = false, big_endian_ = false;
};

}  // namespace

const DicomElement* DicomSet::find(DicomTag tag) const noexcept {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [tag](const auto& e) { return e.tag == tag; });
  return found == elements.end() ? nullptr : &*found;
}

DicomFile::DicomFile(const std::string& file) : mapped_(file), elements_(Walk(file, mapped_.text()).run()) {}

std::optional<std::uint64_t> DicomFile::pixels_at() const noexcept {
  const DicomElement* const pixels = elements_.find(kDicomPixels);
  if (pixels == nullptr || pixels->packed) return std::nullopt;
  return static_cast<std::uint64_t>(pixels->value.data() - mapped_.text().data());
}

}  // namespace palpate
