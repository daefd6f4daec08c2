#include "loaders/dicom/dicom_check.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <string_view>

#include "common/base/error.h"

namespace palpate {
namespace {

constexpr std::uint32_t kUndefined = 0xFFFFFFFFU;
constexpr std::uint32_t kItem = 0xFFFEE000U, kItemEnd = 0xFFFEE00DU, kSequenceEnd = 0xFFFEE0DDU;
constexpr int kDeepest = 16;
constexpr std::uint32_t kMetaGroup = 0x0002, kTransferSyntax = 0x00020010U;

class Walk {
 public:
  explicit Walk(const std::string& name) : name_(name), in_(name, std::ios::binary) {
    in_.seekg(0, std::ios::end);
    size_ = in_ ? static_cast<std::uint64_t>(in_.tellg()) : 0;
  }

  void run() {
    constexpr std::uint64_t kPreamble = 128;
    at_ = kPreamble;
    if (size_ < kPreamble + 4 || bytes(4) != "DICM") fail("is no DICOM file");
    // File meta information: little endian with types, whatever follows.
    while (at_ + 8 <= size_ && (peek_tag() >> 16U) == kMetaGroup) element(size_, 0);
    if (syntax_ == "1.2.840.10008.1.2.1.99") fail("is deflated as a whole; unpack it with gdcmconv --raw");
    implicit_ = syntax_ == "1.2.840.10008.1.2";
    big_endian_ = syntax_ == "1.2.840.10008.1.2.2";
    while (at_ < size_) element(size_, 0);
  }

 private:
  [[noreturn]] void fail(const std::string& found) const {
    throw input_error(
        {name_, "byte " + std::to_string(at_), found, "", "the file may be cut off or damaged"});
  }

  std::string bytes(std::size_t count) {
    if (at_ + count > size_) fail("the file ends in the middle of an element");
    std::string read(count, '\0');
    in_.seekg(static_cast<std::streamoff>(at_));
    in_.read(read.data(), static_cast<std::streamsize>(count));
    if (!in_) fail("cannot be read");
    at_ += count;
    return read;
  }
  std::uint32_t number(std::string_view text) const {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const std::size_t k = big_endian_ ? i : text.size() - 1 - i;
      value = value << 8U | static_cast<unsigned char>(text[k]);
    }
    return value;
  }
  std::uint32_t tag() {
    const std::string read = bytes(4);
    return number(std::string_view(read).substr(0, 2)) << 16U | number(std::string_view(read).substr(2));
  }
  std::uint32_t peek_tag() {
    const std::uint32_t next = tag();
    at_ -= 4;
    return next;
  }

  /// One element that ends at `end` at the latest.
  void element(std::uint64_t end, int depth) {
    if (depth > kDeepest) fail("sequences are nested more deeply than " + std::to_string(kDeepest));
    const std::uint32_t which = tag();
    std::string type;
    std::uint32_t length = 0;
    if (implicit_) {
      length = number(bytes(4));
    } else {
      type = bytes(2);
      const bool typed = type[0] >= 'A' && type[0] <= 'Z' && type[1] >= 'A' && type[1] <= 'Z';
      if (!typed) fail("an element has no type that DICOM knows");
      static constexpr std::array<std::string_view, 13> kLong{"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                              "SV", "UC", "UN", "UR", "UT", "UV"};
      if (std::find(kLong.begin(), kLong.end(), type) != kLong.end()) {
        (void)bytes(2);
        length = number(bytes(4));
      } else {
        length = number(bytes(2));
      }
    }
    if (length == kUndefined) {
      // A sequence, or the fragments of encapsulated pixels, which are items without elements in them. An
      // unknown type with an undefined length is a sequence without types (PS3.5 section 6.2.2).
      constexpr std::uint32_t kPixels = 0x7FE00010U;
      const bool before = implicit_;
      if (type == "UN") implicit_ = true;
      items(end, depth, which == kPixels);
      implicit_ = before;
      return;
    }
    if (length > end - std::min(end, at_)) {
      fail("an element claims " + std::to_string(length) + " bytes, more than there are");
    }
    const std::uint64_t past = at_ + length;
    const bool sequence = type == "SQ" || (implicit_ && length >= 8 && peek_tag() == kItem);
    if (sequence) {
      while (at_ < past) item(past, depth);
    } else if (which == kTransferSyntax && length <= 64) {
      syntax_ = bytes(length);
      while (!syntax_.empty() && (syntax_.back() == '\0' || syntax_.back() == ' ')) syntax_.pop_back();
    }
    at_ = past;
  }

  /// Items up to the mark that ends their sequence.
  void items(std::uint64_t end, int depth, bool fragments) {
    while (true) {
      if (peek_tag() == kSequenceEnd) {
        (void)bytes(8);
        return;
      }
      if (fragments) {
        if (tag() != kItem) fail("encapsulated pixels are not a row of fragments");
        const std::uint32_t length = number(bytes(4));
        if (length > end - std::min(end, at_))
          fail("a fragment claims " + std::to_string(length) + " bytes, more than there are");
        at_ += length;
      } else {
        item(end, depth);
      }
    }
  }

  void item(std::uint64_t end, int depth) {
    if (tag() != kItem) fail("a sequence holds something that is no item");
    const std::uint32_t length = number(bytes(4));
    if (length != kUndefined) {
      if (length > end - std::min(end, at_))
        fail("an item claims " + std::to_string(length) + " bytes, more than there are");
      const std::uint64_t past = at_ + length;
      while (at_ < past) element(past, depth + 1);
      return;
    }
    while (peek_tag() != kItemEnd) element(end, depth + 1);
    (void)bytes(8);
  }

  const std::string& name_;
  std::ifstream in_;
  std::uint64_t size_ = 0, at_ = 0;
  bool implicit_ = false, big_endian_ = false;
  std::string syntax_;
};

}  // namespace

void check_dicom(const std::string& file) { Walk(file).run(); }

}  // namespace palpate
