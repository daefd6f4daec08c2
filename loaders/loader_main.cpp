/// The helper program of a loader: serves what PALPATE_MAKE_LOADER() of its library makes.
#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

[[nodiscard]] std::unique_ptr<Loader> PALPATE_MAKE_LOADER();

}  // namespace palpate

int main() { return palpate::serve_loader(*palpate::PALPATE_MAKE_LOADER()); }
