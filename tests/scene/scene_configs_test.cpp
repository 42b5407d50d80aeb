// The scenes under configs/scenes, as they come.
#include <set>

#include "fixtures.h"

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> all_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator("configs/scenes"))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(SceneConfigs, EverySceneLoadsOrSaysWhichCommandGetsItsMesh) {
  for (const std::string& name : all_scenes()) try {
      const Scene s = Scene::load(name, {"configs/scenes"});
      EXPECT_EQ(s.name(), name);
      EXPECT_EQ(s.light_names().front(), "key") << name;
      EXPECT_EQ(s.camera_names().front(), "front") << name;
      EXPECT_EQ(s.light("").kind, LightKind::rectangle) << name;
      EXPECT_FALSE(s.report().description.empty()) << name;
      // The key light shines towards what the front camera looks at.
      EXPECT_GT(dot(s.light("").direction, s.camera("").target - s.light("").center), 0) << name;
    } catch (const InputError& e) {
      EXPECT_CONTAINS(e.what(), "Get it with: ");
    }
}

TEST(SceneConfigs, ScenesThatTheSetUpProvidesAreThere) {
  for (const auto& [name, triangles] : std::vector<std::pair<std::string, std::size_t>>{
           {"bunny", 69668}, {"torus_knot", 12002}, {"columns", 840}, {"bird_nest", 154882}})
    EXPECT_EQ(Scene::load(name, {"configs/scenes"}).report().triangles, triangles) << name;
  EXPECT_TRUE(fs::exists("configs/scenes/dragon.json"));
}

TEST(SceneConfigs, BunnyIsClosed) {
  for (const auto& mesh : Scene::load("bunny", {"configs/scenes"}).report().meshes)
    if (mesh.name == "bunny") {
      EXPECT_TRUE(mesh.hygiene.closed());
    }
}

TEST(SceneConfigs, ReadmeListsEveryScene) {
  const std::vector<char> bytes = file_bytes("configs/scenes/README.md");
  const std::string readme(bytes.begin(), bytes.end());
  for (const std::string& name : all_scenes()) {
    const std::string shown = name.starts_with("study_dragon") ? "study_dragon1" : name;
    EXPECT_CONTAINS(readme, "`" + shown + "`");
  }
}

}  // namespace
}  // namespace penumbra::test
