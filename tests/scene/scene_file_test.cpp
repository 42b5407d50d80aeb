// What a scene file means, and what each mistake in one is answered with.
#include "fixtures.h"

namespace penumbra::test {
namespace {

const std::string box = R"("box": {"generator": "box"})";
const std::string one_box = R"({"mesh": "box"})";

class SceneFile : public ::testing::Test {
 protected:
  Scene load(const std::string& text) const { return load_text(folder_, text); }
  std::string error_of(const std::string& text) const {
    return input_error_of([&] { load(text); });
  }
  // Of a scene of one box, with `from` replaced by `to`.
  std::string error_with(const std::string& from, const std::string& to) const {
    std::string text = scene_text(box, one_box);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos);
    return error_of(text.replace(at, from.size(), to));
  }
  Geometry geometry(const std::string& meshes, const std::string& instances) const {
    return load(scene_text(meshes, instances)).frame(0, "", "", -1).geometry;
  }
  TemporaryFolder folder_;
};

TEST_F(SceneFile, MinimalSceneLoads) {
  const Scene s = load("// a comment\n" + scene_text(box, one_box));
  EXPECT_EQ(s.name(), "test");
  EXPECT_EQ(s.light_names(), (std::vector<std::string>{"key", "lamp"}));
  EXPECT_EQ(s.camera_names(), (std::vector<std::string>{"front"}));
  EXPECT_FALSE(s.animated());
  EXPECT_EQ(s.axis_default("resolution"), "");
  const Frame f = s.frame(0, "", "", -1);
  EXPECT_EQ(f.light.name, "key");
  EXPECT_EQ(f.geometry.triangle_count(), 12U);
  EXPECT_TRUE(f.geometry.closed);
  EXPECT_EQ(f.geometry.bounds.lo, (Vec3f{-0.5f, -0.5f, -0.5f}));
}

TEST_F(SceneFile, TransformStepsApplyInTheOrderWritten) {
  const Geometry g = geometry(box, R"({"mesh": "box", "transform": [{"scale": [2, 1, 1]},
      {"rotate": {"axis": [0, 0, 1], "degrees": 90}}, {"translate": [10, 0, 0]}]})");
  EXPECT_NEAR(g.bounds.lo.x, 9.5f, 1e-6f);
  EXPECT_NEAR(g.bounds.hi.x, 10.5f, 1e-6f);
  EXPECT_NEAR(g.bounds.hi.y, 1, 1e-6f);
}

TEST_F(SceneFile, MatrixIsWrittenByRows) {
  const Geometry g = geometry(
      box, R"({"mesh": "box", "transform": [{"matrix": [[1,0,0,5],[0,2,0,0],[0,0,1,0],[0,0,0,1]]}]})");
  EXPECT_EQ(g.bounds.lo, (Vec3f{4.5f, -1, -0.5f}));
}

TEST_F(SceneFile, MirroredInstanceStaysClosedAndFacesOutwards) {
  const Geometry g = geometry(box, R"({"mesh": "box", "transform": [{"scale": [-1, 1, 1]}]})");
  EXPECT_TRUE(g.closed);
  double volume = 0;
  for (std::size_t t = 0; t < g.triangle_count(); ++t) {
    const Vec3d a(g.corner(t, 0)), b(g.corner(t, 1)), c(g.corner(t, 2));
    volume += dot(a, cross(b, c)) / 6;
    EXPECT_GT(dot(cross(b - a, c - a), Vec3d(g.normals[g.indices[3 * t]])), 0);
  }
  EXPECT_NEAR(volume, 1, 1e-6);
}

TEST_F(SceneFile, NormalsFollowNonUniformScale) {
  const Geometry g = geometry(R"("s": {"generator": "sphere", "params": {"columns": 200, "rows": 100}})",
                              R"({"mesh": "s", "transform": [{"scale": [4, 1, 1]}]})");
  for (std::size_t v = 0; v < g.positions.size(); ++v) {
    const Vec3f p = g.positions[v];
    EXPECT_NEAR(length(g.normals[v] - normalize(Vec3f{p.x / 16, p.y, p.z})), 0, 1e-4);
  }
}

TEST_F(SceneFile, GridIsCentredAndMakesOneInstanceEach) {
  const Geometry g = geometry(
      box, R"({"mesh": "box", "albedo": [1, 0.5, 0], "grid": {"counts": [3, 1, 2], "spacing": [2, 1, 4]}})");
  EXPECT_EQ(g.triangle_count(), 72U);
  EXPECT_EQ(g.instance_albedo.size(), 6U);
  EXPECT_EQ(g.instance_albedo[5], (Vec3f{1, 0.5f, 0}));
  EXPECT_EQ(g.triangle_instance.back(), 5U);
  EXPECT_EQ(g.bounds.lo, (Vec3f{-2.5f, -0.5f, -2.5f}));
  EXPECT_EQ(g.bounds.hi, (Vec3f{2.5f, 0.5f, 2.5f}));
}

TEST_F(SceneFile, FitScalesCentresAndStandsTheMesh) {
  const Geometry g =
      geometry(R"("b": {"generator": "box", "params": {"size_x": 4}, "fit": {"size": 2, "ground": 0.5}})",
               R"({"mesh": "b"})");
  EXPECT_EQ(g.bounds.lo, (Vec3f{-1, 0.5f, -0.25f}));
  EXPECT_EQ(g.bounds.hi, (Vec3f{1, 1, 0.25f}));
}

TEST_F(SceneFile, RecomputedNormalsAreSmoothAcrossEdges) {
  const Geometry g = geometry(R"("b": {"generator": "box", "normals": "recompute"})", R"({"mesh": "b"})");
  for (std::size_t v = 0; v < g.positions.size(); ++v) EXPECT_GT(dot(g.normals[v], g.positions[v]), 0.4f);
}

TEST_F(SceneFile, OpenMeshMakesTheSceneOpenInstanceByInstance) {
  const Geometry g = geometry(box + R"(, "p": {"generator": "plane"})", one_box + R"(, {"mesh": "p"})");
  EXPECT_FALSE(g.closed);
  EXPECT_EQ(g.instance_closed, (std::vector<uint8_t>{1, 0}));
}

TEST_F(SceneFile, MeshFilesAreFoundBesideTheSceneAndInPenumbraMeshes) {
  write_file(folder_ / "here.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(geometry(R"("m": {"file": "here.obj"})", R"({"mesh": "m"})").triangle_count(), 1U);
  TemporaryFolder other;
  write_file(other / "there.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  setenv("PENUMBRA_MESHES", ("/nonexistent:" + other.path().string()).c_str(), 1);
  EXPECT_EQ(geometry(R"("m": {"file": "there.obj"})", R"({"mesh": "m"})").triangle_count(), 1U);
  unsetenv("PENUMBRA_MESHES");
}

TEST_F(SceneFile, HashFollowsTheFileAndTheMeshBytes) {
  const std::string text = scene_text(R"("m": {"file": "m.obj"})", R"({"mesh": "m"})");
  write_file(folder_ / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string first = load(text).content_hash();
  EXPECT_EQ(load(text).content_hash(), first);
  EXPECT_EQ(load("// only a comment\n" + text).content_hash(), first);
  write_file(folder_ / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  EXPECT_NE(load(text).content_hash(), first);
  write_file(folder_ / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  std::string moved = text;
  moved.replace(moved.find("[0, 5, 0]"), 9, "[0, 6, 0]");
  EXPECT_NE(load(moved).content_hash(), first);
}

TEST_F(SceneFile, ReportCountsWhatWasWrongWithEachMesh) {
  write_file(folder_ / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n");
  const SceneReport r = load(scene_text(R"("m": {"file": "m.obj"})", R"({"mesh": "m"})")).report();
  ASSERT_EQ(r.meshes.size(), 1U);
  EXPECT_EQ(r.meshes[0].hygiene.dropped_degenerate, 1U);
  EXPECT_EQ(r.meshes[0].hygiene.open_edges, 3U);
  EXPECT_EQ(r.triangles, 1U);
  EXPECT_EQ(r.fidelity, "procedural");
}

TEST_F(SceneFile, AxisDefaultsAreGivenAsJson) {
  std::string text = scene_text(box, one_box);
  text.replace(text.rfind('}'), 1,
               R"(, "defaults": {"resolution": [640, 480], "mask_size": 8, "light_size": 1.5}})");
  const Scene s = load(text);
  EXPECT_EQ(s.axis_default("resolution"), "[640,480]");
  EXPECT_EQ(s.axis_default("mask_size"), "8");
  EXPECT_EQ(s.axis_default("light_size"), "1.5");
}

TEST_F(SceneFile, EveryKindOfLightIsRead) {
  std::string text = scene_text(box, one_box);
  const std::string lights = R"("lights": [
    {"name": "r", "kind": "rectangle", "center": [0, 5, 0], "edge_u": [2, 0, 0], "edge_v": [0, 0, 1]},
    {"name": "d", "kind": "directional", "direction": [0, -2, 0]},
    {"name": "s", "kind": "spot", "center": [0, 5, 0], "target": [0, 0, 0], "cone_degrees": 20},
    {"name": "b", "kind": "sphere", "center": [0, 5, 0], "radius": 0.5},
    {"name": "t", "kind": "textured_rectangle", "center": [0, 5, 0], "direction": [0, -1, 0], "width": 1, "height": 2,
     "texture": {"width": 2, "height": 1, "weights": [0, 3]}},
    {"name": "v", "kind": "volume", "points": [[0, 5, 0], [0, 7, 0]], "weights": [1, 2]},
    {"name": "e", "kind": "volume", "ellipsoid": {"center": [0, 6, 0], "half_axes": [1, 2, 0.5], "count": 200}}, )";
  text.replace(text.find("\"lights\": ["), 11, lights);
  const Scene s = load(text);
  EXPECT_EQ(s.light("r").direction, (Vec3f{0, -1, 0}));
  EXPECT_EQ(s.light("d").direction, (Vec3f{0, -1, 0}));
  EXPECT_EQ(s.light("s").cone_degrees, 20);
  EXPECT_FLOAT_EQ(s.light("b").size(), 1);
  EXPECT_EQ(s.light("t").weights, (std::vector<float>{0, 3}));
  EXPECT_NEAR(s.light("t").size(), std::sqrt(5.0), 1e-6);
  EXPECT_EQ(s.light("v").center, (Vec3f{0, 6, 0}));
  const Light& ellipsoid = s.light("e");
  EXPECT_EQ(ellipsoid.points.size(), 200U);
  EXPECT_EQ(ellipsoid.weights, std::vector<float>(200, 1));
  EXPECT_LT(length(ellipsoid.center - Vec3f{0, 6, 0}), 0.05F);
  Vec3f reach{};
  for (const Vec3f& p : ellipsoid.points) {
    const Vec3f unit{p.x, (p.y - 6) / 2, p.z / 0.5F};
    EXPECT_LE(length(unit), 1.0001F);
    reach = max(reach, Vec3f{std::abs(unit.x), std::abs(unit.y), std::abs(unit.z)});
  }
  EXPECT_GT(std::min({reach.x, reach.y, reach.z}), 0.9F);
  const Light& key = s.light("key");
  EXPECT_NEAR(length(normalize(cross(key.edge_u, key.edge_v)) - key.direction), 0, 1e-6);
}

TEST_F(SceneFile, LightAndCameraNamesOfferTheNearest) {
  const Scene s = load(scene_text(box, one_box));
  EXPECT_CONTAINS(input_error_of([&] { (void)s.light("keys"); }),
                  "scene 'test' has no light 'keys'. Did you mean 'key'?");
  EXPECT_CONTAINS(input_error_of([&] { (void)s.camera("frnt"); }), "Did you mean 'front'?");
}

TEST_F(SceneFile, UnknownSceneNameOffersTheNearest) {
  EXPECT_CONTAINS(input_error_of([] { Scene::load("bunnny", {"configs/scenes"}); }), "Did you mean 'bunny'?");
  EXPECT_CONTAINS(input_error_of([] { Scene::load("no/such.json", {}); }),
                  "no/such.json: no such scene file");
}

TEST_F(SceneFile, SyntaxErrorsNameLineAndColumn) {
  EXPECT_CONTAINS(error_of("{\n  \"name\": \"x\",\n  \"meshes\": }\n"), "test.json:3:");
}

struct Mistake {
  const char* from;  // in the scene of one box
  const char* to;
  std::vector<const char*> message;
};

TEST_F(SceneFile, EachMistakeIsAnsweredWithPlaceFindingAndExpectation) {
  const std::vector<Mistake> mistakes = {
      {"\"instances\"", "\"instance\"", {"test.json:4:3", "/instance", "Did you mean 'instances'?"}},
      {"\"eye\"", "\"eyes\"", {"/cameras/0/eyes", "Did you mean 'eye'?"}},
      {"\"name\": \"test\"", "\"name\": \"\"", {"/name", "expected a name that is not empty"}},
      {"\"generator\": \"box\"", "\"generator\": \"bax\"", {"/meshes/box/generator", "Did you mean 'box'?"}},
      {"\"generator\": \"box\"", "\"generator\": \"box\", \"file\": \"a.obj\"", {"/meshes/box", "either"}},
      {"\"generator\": \"box\"", "\"flip\": true", {"/meshes/box", "either"}},
      {"\"generator\": \"box\"",
       "\"generator\": \"box\", \"params\": {\"size_w\": 1}",
       {"/meshes/box", "size_x"}},
      {"\"generator\": \"box\"",
       "\"generator\": \"box\", \"params\": {\"size_x\": -1}",
       {"expected a number from"}},
      {"\"generator\": \"box\"", "\"generator\": \"box\", \"fit\": {\"size\": 0}", {"/meshes/box/fit/size"}},
      {"\"generator\": \"box\"",
       "\"generator\": \"box\", \"keyframes\": {\"count\": 2}",
       {"only mesh files"}},
      {"{\"mesh\": \"box\"}", "{\"mesh\": \"bx\"}", {"/instances/0/mesh", "Did you mean 'box'?"}},
      {"{\"mesh\": \"box\"}", "", {"/instances", "at least one instance"}},
      {"{\"mesh\": \"box\"}", "{\"mesh\": \"box\"}, {\"mesh\": \"box\"}", {"/instances/1", "'box' is taken"}},
      {"{\"mesh\": \"box\"}",
       "{\"mesh\": \"box\", \"albedo\": [1, 1, 2]}",
       {"/instances/0/albedo/2", "from 0 to 1"}},
      {"{\"mesh\": \"box\"}", "{\"mesh\": \"box\", \"transform\": [{\"scale\": 0}]}", {"flattens the mesh"}},
      {"{\"mesh\": \"box\"}",
       "{\"mesh\": \"box\", \"transform\": [{\"rotate\": {\"axis\": [0,0,0], \"degrees\": 1}}]}",
       {"/instances/0/transform/0/rotate/axis", "not zero"}},
      {"{\"mesh\": \"box\"}",
       "{\"mesh\": \"box\", \"grid\": {\"counts\": [0, 1, 1], \"spacing\": [1, 1, 1]}}",
       {"/instances/0/grid/counts/0"}},
      {"{\"mesh\": \"box\"}",
       "{\"mesh\": \"box\", \"grid\": {\"counts\": [10000, 10000, 10000], \"spacing\": [1, 1, 1]}}",
       {"more than"}},
      {"\"kind\": \"rectangle\"", "\"kind\": \"rectangel\"", {"/lights/0/kind", "Did you mean 'rectangle'?"}},
      {"\"kind\": \"point\"", "\"kind\": \"point\", \"radius\": 1", {"/lights/1/radius", "a point light"}},
      {"\"target\": [0, 0, 0], \"width\"",
       "\"target\": [0, 5, 0], \"width\"",
       {"/lights/0/target", "away from"}},
      {"\"width\": 1", "\"width\": 0", {"/lights/0/width"}},
      {"\"name\": \"lamp\"", "\"name\": \"key\"", {"/lights/1", "'key' is taken"}},
      {"[0, 4, 0]", "[0, 4]", {"/lights/1/center", "an array of 3 numbers"}},
      {"[0, 4, 0]", "[0, 1e30, 0]", {"/lights/1/center/1"}},
      {"[0, 4, 0]", "[0.1, 0.2, 0]", {"/lights/1", "'lamp' lies inside the mesh 'box'"}},
      {"\"target\": [0, 0, 0]}", "\"target\": [0, 1, 5]}", {"/cameras/0/target", "away from the eye"}},
      {"\"target\": [0, 0, 0]}", "\"target\": [0, -3, 5]}", {"/cameras/0/target", "along its up direction"}},
      {"\"eye\"", "\"vertical_fov_degrees\": 180, \"eye\"", {"/cameras/0/vertical_fov_degrees"}},
      {"\"eye\"", "\"near_plane\": 0, \"eye\"", {"/cameras/0/near_plane"}},
      {"\"cameras\"", "\"defaults\": {\"grid\": 1}, \"cameras\"", {"/defaults/grid", "grid_size"}},
      {"\"cameras\"", "\"fidelity\": \"exakt\", \"cameras\"", {"/fidelity", "Did you mean 'exact'?"}},
      {"\"cameras\"",
       "\"animation\": {\"camera\": []}, \"cameras\"",
       {"/animation/camera", "Did you mean 'cameras'?"}},
  };
  for (const Mistake& m : mistakes) {
    const std::string message = error_with(m.from, m.to);
    EXPECT_CONTAINS(message, "test.json:");
    for (const char* part : m.message) EXPECT_CONTAINS(message, part);
  }
}

TEST_F(SceneFile, BadMeshFilesAreNamedWithTheirPlaceInTheScene) {
  write_file(folder_ / "point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n");
  const std::string message = error_of(scene_text(R"("m": {"file": "point.obj"})", R"({"mesh": "m"})"));
  EXPECT_CONTAINS(message, "test.json:3:");
  EXPECT_CONTAINS(message, "/meshes/m");
  EXPECT_CONTAINS(message, "point.obj: no triangle is left");
}

TEST_F(SceneFile, MissingMeshSaysWhichCommandGetsIt) {
  const auto message_for = [&](const std::string& file) {
    return error_of(scene_text("\"m\": {\"file\": \"" + file + "\"}", R"({"mesh": "m"})"));
  };
  // A file that the repository's own meshes/ cannot hold, and one that only fetch_scenes brings.
  EXPECT_CONTAINS(message_for("no_such.obj"), "/meshes/m: the mesh file 'no_such.obj' is not found");
  EXPECT_CONTAINS(message_for("no_such.obj"), "Looked in:");
  if (!std::filesystem::exists("meshes/cow.off")) {
    EXPECT_CONTAINS(message_for("cow.off"), "Get it with: scripts/fetch_scenes cgal");
  }
}

TEST_F(SceneFile, FlippedRoomMayHoldItsLight) {
  const Scene s = load(scene_text(
      R"("room": {"generator": "box", "params": {"size_x": 20, "size_y": 20, "size_z": 20}, "flip": true})",
      R"({"mesh": "room"})"));
  EXPECT_TRUE(s.frame(0, "", "", -1).geometry.closed);
  EXPECT_LT(dot(s.frame(0, "", "", -1).geometry.normals[0], s.frame(0, "", "", -1).geometry.positions[0]), 0);
}

}  // namespace
}  // namespace penumbra::test
