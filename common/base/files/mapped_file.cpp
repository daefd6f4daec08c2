#include "common/base/files/mapped_file.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/base/index.h"

namespace palpate {

MappedFile::MappedFile(const std::string& file) {
  const UniqueFd fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!fd || ::fstat(fd.get(), &status) != 0) {
    throw input_error({file, "", std::string("cannot be read (") + errno_text() + ")"});
  }
  if (!S_ISREG(status.st_mode)) throw input_error({file, "", "is not a regular file"});
  size_ = as_size(status.st_size);
  if (size_ == 0) return;
  void* data = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, fd.get(), 0);
  if (data == MAP_FAILED)
    throw input_error({file, "", std::string("cannot be mapped (") + errno_text() + ")"});
  data_ = static_cast<const char*>(data);
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(const_cast<char*>(data_), size_);
}

}  // namespace palpate
