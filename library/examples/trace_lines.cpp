// Traces lines of a built-in field, prints how far each may be from the true curve, and writes them to a file.

#include <cstdio>

#include <palpate/palpate.h>

int main() {
  namespace palpate = palpate::api;
  const palpate::Field field = palpate::Field::example("abc");
  const palpate::Lines lines = palpate::trace(field, field.seeds("random:10"), {.tolerance = 1e-8});
  for (std::size_t l = 0; l < lines.count(); ++l) {
    const auto last = static_cast<std::size_t>(lines.offsets()[l + 1] - 1);
    std::printf("line %zu: length %.3f, error %.1e, %s\n", l, lines.arc()[last], lines.error()[last],
                palpate::end_names()[lines.end()[l]].c_str());
  }
  lines.save("lines.vtp", true);
}
