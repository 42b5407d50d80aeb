#include "tests/fuzz/mutate.h"

#include <vector>

namespace penumbra::test {

std::string mutated(std::string text, std::mt19937& random) {
  static const std::vector<std::string> pieces = {
      "null",       "-1",      "0",    "1e999", "-0.0", "1e-320",      "18446744073709551616",
      "[]",         "{}",      "[[]]", "\"\"",  "true", "\"\\u0000\"", "\"\xff\"",
      "}",          "]",       ",",    ":",     "//",   "/*",          "\"id\"",
      "\"params\"", "[1,2,3]", "\"*\""};
  const auto place = [&] { return text.empty() ? 0 : random() % text.size(); };
  for (auto n = 1 + random() % 3; n > 0; --n) {
    const std::size_t at = place(), length = 1 + random() % 12;
    switch (random() % 6) {
      case 0:
        text.insert(at, pieces[random() % pieces.size()]);
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.replace(at, length, pieces[random() % pieces.size()]);
        break;
      case 3:
        if (!text.empty()) text[at] = static_cast<char>(random() % 256);
        break;
      case 4:
        text.insert(place(), text.substr(at, length * 4));
        break;
      default:  // a whole value by another: from a colon to the next comma
        if (const std::size_t colon = text.find(':', at), comma = text.find_first_of(",}]", colon);
            comma != std::string::npos)
          text.replace(colon + 1, comma - colon - 1, pieces[random() % pieces.size()]);
    }
  }
  if (random() % 20 == 0) text.resize(place());
  return text;
}

}  // namespace penumbra::test
