/// A loader of several formats that leaves the work to the reader of the one that a file has.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/load/helper/serve.h"

namespace palpate {

class ChosenLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format format) override {
    reader_ = choose(request, format);
    reader_->on_progress = on_progress;
    return reader_->open(request, format);
  }
  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    if (!reader_) throw work_error("nothing was opened");
    return reader_->read(names, step);
  }

 protected:
  /// Never null. @throws Error (bad input) where no reader takes what is asked for.
  [[nodiscard]] virtual std::unique_ptr<Loader> choose(const LoadRequest& request, Format format) = 0;

 private:
  std::unique_ptr<Loader> reader_;
};

}  // namespace palpate
