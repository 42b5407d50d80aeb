// How generators are registered: a description with its parameters, and the function that makes the mesh.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "scene/generators.h"

namespace penumbra {

// Resolved parameters by name; every name that the generator declares is there.
class GeneratorValues {
 public:
  explicit GeneratorValues(std::map<std::string, double> values) : values_(std::move(values)) {}
  double number(const char* name) const { return values_.at(name); }
  int integer(const char* name) const { return static_cast<int>(values_.at(name)); }

 private:
  std::map<std::string, double> values_;
};

struct Generator {
  GeneratorInfo info;
  Mesh (*make)(const GeneratorValues&);
};

// Raise it whenever any generator's output changes: it is part of every scene's content hash.
inline constexpr int generator_version = 1;

// One table per file.
std::vector<Generator> shape_generators();    // plane, box, sphere, torus, torus_knot, columns, city
std::vector<Generator> natural_generators();  // hair_ball, bird_nest, ring_field
std::vector<Generator> study_generators();    // study_*
Generator church_generator();
Generator atrium_generator();

}  // namespace penumbra
