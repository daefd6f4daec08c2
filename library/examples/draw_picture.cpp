// Draws lines of a built-in flow without a display, and writes the picture.

#include <cstdio>

#include <palpate/picture.h>

int main() {
  namespace palpate = palpate::api;
  const palpate::Field field = palpate::Field::example("abc");
  const palpate::Lines lines = palpate::trace(field, field.seeds("random:50"));
  const palpate::Picture picture =
      palpate::draw(field, lines, {.width = 600, .height = 400, .camera = "30,20,0,1"});
  picture.save("lines.png", true);
  std::printf("%d x %d pixels by %s\n", picture.width(), picture.height(), picture.renderer().c_str());
}
