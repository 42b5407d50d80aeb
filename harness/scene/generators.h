// Procedural meshes. Triangle counts are exact and documented in configs/scenes/README.md; a seed fixes all
// randomness (own generator, the same on every platform and standard library).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scene/mesh.h"

namespace penumbra {

struct GeneratorInfo {
  struct Param {
    std::string name, help;
    double fallback, lo, hi;
    bool integer;
  };
  std::string name, help, triangles;  // triangles: the formula, in the parameters' names
  std::vector<Param> params;
};

const std::vector<GeneratorInfo>& generators();

struct GeneratorArgument {
  std::string name;
  double value;
};
// Throws InputError for an unknown generator or parameter (nearest name offered) or a value out of range.
Mesh generate(const std::string& generator, const std::vector<GeneratorArgument>& arguments);
// The same checks without making the mesh.
void check_arguments(const std::string& generator, const std::vector<GeneratorArgument>& arguments);

}  // namespace penumbra
