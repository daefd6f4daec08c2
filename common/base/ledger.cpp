#include "common/base/ledger.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <mutex>

#include "common/base/text.h"

namespace palpate {
namespace {

struct Book {
  std::mutex mutex;
  std::vector<LedgerEntry> entries;
};

Book& book() {
  static Book the_book;
  return the_book;
}

/// @pre the book is locked.
LedgerEntry& entry_of(Book& in, std::string_view what) {
  const auto found = std::ranges::find(in.entries, what, &LedgerEntry::what);
  if (found != in.entries.end()) return *found;
  return in.entries.emplace_back(LedgerEntry{.what = std::string(what), .why = {}});
}

std::string line_of(const LedgerEntry& entry) {
  std::array<char, 32> text{};
  const std::string bytes = entry.bytes == 0 ? "" : bytes_text(entry.bytes);
  std::snprintf(text.data(), text.size(), "%12s ", bytes.c_str());
  std::string line = text.data();
  if (entry.times > 0) {
    std::snprintf(text.data(), text.size(), "%10.1f ms  ", entry.milliseconds);
    line += text.data();
  } else {
    line += std::string(15, ' ');
  }
  line += entry.what;
  if (entry.times > 1) line += ", " + std::to_string(entry.times) + " times";
  return line + (entry.why.empty() ? "" : ": " + entry.why) + "\n";
}

}  // namespace

void Ledger::enter(std::string_view what, std::string_view why, double milliseconds, std::uint64_t bytes) {
  Book& into = book();
  const std::scoped_lock lock(into.mutex);
  LedgerEntry& entry = entry_of(into, what);
  if (entry.times++ == 0) entry.why = why;  // of an offer: why it would have been left out
  entry.milliseconds += milliseconds;
  entry.bytes = std::max(entry.bytes, bytes);
}

void Ledger::offer(std::string_view what, std::string_view why_not, std::uint64_t bytes) {
  Book& into = book();
  const std::scoped_lock lock(into.mutex);
  LedgerEntry& entry = entry_of(into, what);
  if (entry.times > 0) return;
  entry.why = why_not;
  entry.bytes = bytes;
}

void Ledger::add(const std::vector<LedgerEntry>& entries) {
  Book& into = book();
  const std::scoped_lock lock(into.mutex);
  for (const LedgerEntry& from : entries) {
    LedgerEntry& entry = entry_of(into, from.what);
    if (entry.times == 0) entry.why = from.why;
    entry.times += from.times;
    entry.milliseconds += from.milliseconds;
    entry.bytes = std::max(entry.bytes, from.bytes);
  }
}

std::vector<LedgerEntry> Ledger::entries() {
  Book& of = book();
  const std::scoped_lock lock(of.mutex);
  return of.entries;
}

void Ledger::clear() {
  Book& of = book();
  const std::scoped_lock lock(of.mutex);
  of.entries.clear();
}

std::string ledger_text(const std::vector<LedgerEntry>& entries) {
  std::string done, left_out;
  for (const LedgerEntry& entry : entries) (entry.times > 0 ? done : left_out) += line_of(entry);
  return "done (measured; a part may lie within another):\n" + done + "left out:\n" + left_out;
}

}  // namespace palpate
