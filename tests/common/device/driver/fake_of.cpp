#include <dlfcn.h>

#include "tests/common/device/driver/fake_dhd.h"
#include "tests/common/device/driver/fake_hd.h"

namespace palpate::test {
namespace {

template <class Fake>
Fake* fake_of(const std::string& file, const char* entry) {
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return nullptr;
  auto* const get = reinterpret_cast<Fake* (*)()>(::dlsym(library, entry));
  return get != nullptr ? get() : nullptr;
}

}  // namespace

FakeDhd* fake_dhd_of(const std::string& file) { return fake_of<FakeDhd>(file, "palpate_fake_dhd"); }
FakeHd* fake_hd_of(const std::string& file) { return fake_of<FakeHd>(file, "palpate_fake_hd"); }

}  // namespace palpate::test
