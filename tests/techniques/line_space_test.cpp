// Line space against brute force in double precision: it may take a free segment for blocked, never a blocked
// one for free, but for what the start node hides.
#include <random>

#include "core/error.h"
#include "techniques/line_space/device_tracer.h"
#include "techniques/line_space/device_tree.h"
#include "tests/support/host_view.h"
#include "tests/support/stage.h"
#include "tests/techniques/line_space_tree.h"

namespace penumbra::test {
namespace {

using testing::device;
using testing::number;
using testing::Rendered;
using testing::Stage;

const TechniqueInfo info = line_space_technique();

// Checks segments: what is blocked beyond the start node must be blocked for the technique.
class Judge {
 public:
  Judge(const Geometry& geometry, const Tree& tree) : truth_(geometry), tree_(tree) {}

  void check(Vec3f origin, Vec4f light) {
    const Vec3d o(origin), l(light.xyz()), d = light.w > 0 ? l - o : l;
    double leave = 0;
    Vec3f cell;
    if (tree_.tracer.start_cell(origin, cell)) {
      leave = light.w > 0 ? 1 : INFINITY;
      for (int a = 0; a < 3; ++a) {
        const auto [first, last] = tree_.skipped(double(cell[a]));
        if (d[a] != 0) leave = std::min(leave, (tree_.border(a, d[a] > 0 ? last + 1 : first) - o[a]) / d[a]);
      }
    }
    const bool answer = tree_.tracer.blocked(origin, light);
    ++segments, taken_for_blocked += answer;
    if (light.w > 0 && leave >= 1) return;
    const bool blocked = truth_.blocked(o + d * std::max(leave, 0.0), {l.x, l.y, l.z, double(light.w)});
    blocked_beyond += blocked;
    if (blocked && !answer) ++wrong;
  }

  std::size_t segments = 0, blocked_beyond = 0, taken_for_blocked = 0, wrong = 0;

 private:
  testing::BruteForce truth_;
  const Tree& tree_;
};

// --- segments
// ---------------------------------------------------------------------------------------------------------

TEST(LineSpace, NeverLightsWhatIsBlockedBeyondTheStartNode) {
  const Geometry g = soup(300, 0.15f, 1);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto point = [&](float reach) { return Vec3f{unit(random), unit(random), unit(random)} * reach; };
  for (const auto [n, d] : {std::array{4, 4}, {5, 4}, {6, 3}, {7, 3}, {8, 3}, {2, 5}, {10, 2}, {3, 1}})
    for (const auto& [cells, start] :
         {std::pair{line_space::Params::Cells::cubic, line_space::Params::Start::node},
          {line_space::Params::Cells::fitted, line_space::Params::Start::node},
          {line_space::Params::Cells::cubic, line_space::Params::Start::neighbours},
          {line_space::Params::Cells::fitted, line_space::Params::Start::coarse}}) {
      line_space::Params params = params_of(n, d);
      params.cells = cells, params.start = start;
      const Tree tree(g, params);
      Judge judge(g, tree);
      for (int i = 0; i < 6000; ++i) {
        // From inside and outside of the tree to lights inside, outside and at infinity.
        const Vec3f from = point(i % 3 == 0 ? 3.0f : 0.9f), to = point(i % 5 == 0 ? 0.8f : 4.0f);
        judge.check(from, {to.x, to.y, to.z, i % 7 == 0 ? 0.0f : 1.0f});
      }
      EXPECT_EQ(judge.wrong, 0U) << n << ", " << d;
      EXPECT_GT(judge.blocked_beyond, 30U);
      EXPECT_LT(judge.taken_for_blocked, judge.segments);
    }
}

// Axis-parallel segments, and such through edges and corners of cells, on them and within rounding of them.
TEST(LineSpace, NeverLightsWhatIsBlockedOnDegenerateLines) {
  Geometry g = soup(200, 0.2f, 2);
  const Tree first(g, params_of(4, 3));
  // Triangles whose corners lie on cells' corners.
  std::mt19937 random(9);
  const auto cell = [&] { return static_cast<double>(random() % 17); };
  const auto corner = [&](const Tree& t) {
    return Vec3f{static_cast<float>(t.border(0, cell())), static_cast<float>(t.border(1, cell())),
                 static_cast<float>(t.border(2, cell()))};
  };
  for (int i = 0; i < 60; ++i) testing::add_triangle(g, corner(first), corner(first), corner(first));
  const Tree tree(g, params_of(4, 3));
  Judge judge(g, tree);
  const auto nudged = [&](Vec3f p) {
    for (int a = 0; a < 3; ++a) {
      const auto way = random() % 4;
      if (way < 2) p[a] = std::nextafter(p[a], way ? 10.0f : -10.0f);
    }
    return p;
  };
  for (int i = 0; i < 30000; ++i) {
    Vec3f from = nudged(corner(tree)), to = nudged(corner(tree));
    for (int a = 0; a < 3; ++a)
      if (random() % 2) to[a] = from[a];  // in planes, along axes, or of no length
    if (i % 2) from = from - (to - from) * 3.0f, to = to + (to - from) * 2.0f;
    judge.check(from, {to.x, to.y, to.z, 1});
    const Vec3f along = to - from;
    if (dot(along, along) > 0) judge.check(from, {along.x, along.y, along.z, 0});
  }
  EXPECT_EQ(judge.wrong, 0U);
  EXPECT_GT(judge.blocked_beyond, 3000U);
}

// Triangles of a few rounding steps, as far from corners of cells: what rounding makes a walk miss, it misses
// here.
TEST(LineSpace, NeverLightsWhatSpecksNearCornersBlock) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto vector = [&](float length) { return Vec3f{unit(random), unit(random), unit(random)} * length; };
  Geometry g;
  testing::add_triangle(g, {-1, -1, -1}, {-0.999f, -1, -1}, {-1, -0.999f, -1});
  testing::add_triangle(g, {1, 1, 1}, {0.999f, 1, 1}, {1, 0.999f, 1});
  const Tree first(g, params_of(4, 3));
  std::vector<Vec3f> targets;
  for (int i = 0; i < 400; ++i) {
    const auto place = [&](int axis) {
      return static_cast<float>(first.border(axis, double(1 + random() % 15)));
    };
    const Vec3f c = Vec3f{place(0), place(1), place(2)} + vector(6e-7f);
    testing::add_triangle(g, c + vector(3e-7f), c + vector(3e-7f), c + vector(3e-7f));
    targets.push_back(c);
  }
  const Tree tree(g, params_of(4, 3));
  Judge judge(g, tree);
  for (int i = 0; i < 200000; ++i) {
    const Vec3f to = targets[random() % targets.size()] + vector(2e-7f), towards = vector(1);
    const Vec3f light = to + towards, from = to - towards;
    judge.check(from, {light.x, light.y, light.z, 1});
  }
  EXPECT_EQ(judge.wrong, 0U);
  EXPECT_GT(judge.blocked_beyond, 2000U);
}

TEST(LineSpace, AnEmptyTreeBlocksNothing) {
  Geometry g;
  testing::add_ground(g, 2);
  const Tree tree(g, {}, params_of(5, 3));
  for (const Vec3f to : {Vec3f{0, -3, 0}, Vec3f{1, 1, 1}, Vec3f{-4, 0, 0}})
    EXPECT_FALSE(tree.tracer.blocked({0.1f, 2, 0.3f}, {to.x, to.y, to.z, 1}));
}

TEST(LineSpace, LeavesOutOnlyFacesThatCannotBlock) {
  Geometry g;
  testing::add_ground(g, 2);
  testing::add_box(g, {-0.5f, 0.5f, -0.5f}, {0.5f, 1, 0.5f});
  LightSamples above, below;
  above.points = {{0, 3, 0, 1}, {0.3f, 0.8f, 0, 0}}, below.points = {{0, 3, 0, 1}, {0, -1, 0, 1}};
  EXPECT_EQ(faces_before_light(g.bounds, above) >> 2 & 3, 1U);
  EXPECT_EQ(faces_before_light(g.bounds, below) >> 2 & 3, 0U);
  EXPECT_EQ(select_casters(g, 1U << 2).size(), 12U);
  EXPECT_EQ(select_casters(g, 0).size(), 14U);
  testing::add_box(g, {0.6f, -1e-7f, 0}, {0.8f, 0.3f, 0.2f});  // stands on the ground, but for rounding
  EXPECT_EQ(select_casters(g, 1U << 2).size(), 22U) << "nor the box's own bottom";
  testing::add_box(g, {0.6f, -1e-3f, 0.4f}, {0.8f, 0.3f, 0.6f});  // sticks in it
  EXPECT_EQ(select_casters(g, 1U << 2).size(), 36U) << "the ground could block what is below it";
}

// --- pictures
// ---------------------------------------------------------------------------------------------------------

Frame scene_of(const Light& light) {
  Frame f;
  testing::add_ground(f.geometry, 3);
  testing::add_soup(f.geometry, {-1, 0.5f, -1}, {1, 1.5f, 1}, 150, 0.3f, 11);
  f.light = light;
  f.camera = testing::camera_at({2, 4, 6}, {0, 0.5f, 0});
  return f;
}

std::vector<Light> all_lights() {
  std::vector<Light> lights{
      testing::point_light({1.5f, 5, 1}), testing::directional_light({-0.4f, -1, -0.3f}),
      testing::spot_light({1, 5, 2}, {0, 0, 0}, 25), testing::rectangle_light({1, 4, 2}, {0, 0, 0}, 1.5f, 1),
      testing::rectangle_light({0, 0.8f, 0}, {1, 0, 0}, 1.5f, 1)};  // within the tree
  Light sphere = testing::point_light({1.5f, 4, 1});
  sphere.kind = LightKind::sphere, sphere.radius = 0.7f;
  lights.push_back(sphere);
  Light textured = lights[3];
  textured.kind = LightKind::textured_rectangle;
  textured.texture_width = 2, textured.texture_height = 1, textured.weights = {1, 3};
  lights.push_back(textured);
  return lights;
}

TEST(LineSpace, DeviceAndHostGiveTheSamePictureForEveryLight) {
  for (const Light& light : all_lights()) {
    SCOPED_TRACE(to_string(light.kind));
    Stage stage(scene_of(light), 61, 47);
    stage.light_samples = make_light_samples(light, {7, 6});  // more than a word
    const ParamValues common{{"branching", int64_t{5}}, {"depth", int64_t{3}}};
    ParamValues cpu = common, on_device = common;
    cpu["backend"] = std::string("cpu"), on_device["build"] = std::string("device");
    const Rendered a = stage.render(info, common), b = stage.render(info, cpu),
                   c = stage.render(info, on_device);
    EXPECT_EQ(a.mask, c.mask);
    EXPECT_EQ(a.mask, b.mask);
    for (std::size_t i = 0; i < stage.pixels(); ++i) EXPECT_NEAR(a.visibility[i], b.visibility[i], 1e-6);
  }
}

TEST(LineSpace, PoolsReadByAddressGiveThePictureOfPoolsReadFromImages) {
  Stage stage(scene_of(testing::rectangle_light({1, 4, 2}, {0, 0, 0}, 1.5f, 1)), 61, 47);
  stage.light_samples = make_light_samples(stage.frame.light, {7, 6});
  const Rendered expected = stage.render(info, {{"branching", int64_t{5}}, {"depth", int64_t{3}}});
  const Geometry& g = stage.frame.geometry;
  const Tree host(g, select_casters(g, faces_before_light(g.bounds, stage.light_samples)), params_of(5, 3));
  DeviceTree tree;
  tree.refuse_images();
  tree.upload(host.pools, stage.passes);
  ASSERT_FALSE(tree.has_images());
  DeviceTracer tracer;
  tracer.setup(device(), 5, 3);
  RenderInput in;
  in.scene_case = &stage.the_case, in.view_samples = &stage.view;
  in.device = {&stage.visibility, &stage.mask};
  std::vector<uint32_t> mask(expected.mask.size(), 0);
  gpu::upload(stage.passes, "clear", stage.mask, mask.data(), mask.size() * 4);
  tracer.run(in, host.grid, tree, stage.passes);
  gpu::download(stage.passes, "download", stage.mask, mask.data(), mask.size() * 4);
  stage.passes.finish();
  EXPECT_EQ(mask, expected.mask);
}

// Every bit of a picture that is clear is clear for the oracle, or only the start node blocks it.
TEST(LineSpace, PicturesErrTowardsShadowButForTheStartNode) {
  for (const Light& light : all_lights()) {
    SCOPED_TRACE(to_string(light.kind));
    Stage stage(scene_of(light), 40, 30);
    stage.light_samples = make_light_samples(light, {4, 3});
    const Rendered r = stage.render(info, {{"branching", int64_t{6}}, {"depth", int64_t{3}}});
    const Geometry& g = stage.frame.geometry;
    const std::vector<uint32_t> casters =
        select_casters(g, faces_before_light(g.bounds, stage.light_samples));
    const Tree tree(g, casters, params_of(6, 3));
    Judge judge(g, tree);
    const ViewSamplesHost& view = stage.view.host();
    std::size_t dark_by_horizon = 0;
    for (std::size_t i = 0; i < stage.pixels(); ++i) {
      if (view.triangle[i] == no_triangle) continue;
      for (std::size_t s = 0; s < stage.light_samples.points.size(); ++s) {
        const Vec4f l = stage.light_samples.points[s];
        const testing::HorizonJudgement h =
            testing::judge_horizon(light, Vec3d(view.position[i].xyz()),
                                   Vec3d(view.geometric_normal[i].xyz()), {l.x, l.y, l.z, l.w});
        const bool bit = r.mask[i * stage.mask_words() + s / 32] >> (s % 32) & 1;
        if (h.distance < 1e-5) continue;
        EXPECT_TRUE(bit || !h.blocked);
        dark_by_horizon += h.blocked;
        if (h.blocked) continue;
        judge.check(view.origin[i].xyz(), l);
        EXPECT_EQ(bit, tree.tracer.blocked(view.origin[i].xyz(), l));
      }
    }
    EXPECT_EQ(judge.wrong, 0U);
    EXPECT_GT(judge.blocked_beyond + dark_by_horizon, 25U);
  }
}

double error_of(Stage& stage, int branching, int depth) {
  const Rendered r = stage.render(info, {{"branching", int64_t{branching}}, {"depth", int64_t{depth}}});
  const MatchedReference& truth = stage.reference(ReferenceOrigin::offset);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < stage.pixels(); ++i)
    if (truth.evaluated[i]) sum += std::abs(double(r.visibility[i]) - double(truth.visibility[i])), ++count;
  return sum / count;
}

TEST(LineSpace, ErrorFallsAsBranchingOrDepthGrow) {
  for (const char* scene : {"torus_knot", "bunny"}) {
    Stage stage(Scene::load(scene, {"configs/scenes"}).frame(0, "key", "front", -1), 96, 96);
    stage.light_samples = make_light_samples(stage.frame.light, {5, 5});
    double last = 1;
    for (int n : {4, 6, 8}) {
      const double error = error_of(stage, n, 3);
      std::printf("[measured] %s (%d, 3): mean error %.4f\n", scene, n, error);
      EXPECT_LT(error, last);
      last = error;
    }
    last = 1;
    for (int d : {2, 3, 4}) {
      const double error = error_of(stage, 5, d);
      std::printf("[measured] %s (5, %d): mean error %.4f\n", scene, d, error);
      EXPECT_LT(error, last);
      last = error;
    }
  }
}

// Pools larger than the 128 MiB that a storage buffer need hold, and walks longer than 65,535 turns for 32
// samples.
TEST(LineSpace, LargeTreesAndLongWalksGiveThePictureOfTheHost) {
  Frame frame = scene_of(testing::rectangle_light({1, 4, 2}, {0, 0, 0}, 1.5f, 1));
  testing::add_soup(frame.geometry, {-1, 0.5f, -1}, {1, 1.5f, 1}, 12000, 0.06f, 13);
  Stage stage(std::move(frame), 48, 32);
  stage.light_samples = make_light_samples(stage.frame.light, {6, 6});
  const ParamValues large{{"branching", int64_t{8}}, {"depth", int64_t{3}}};
  ParamValues cpu = large;
  cpu["backend"] = std::string("cpu");
  const Rendered a = stage.render(info, large), b = stage.render(info, cpu);
  EXPECT_GT(number(a.counters, "line_space_bytes"), double(128 << 20));
  EXPECT_EQ(a.mask, b.mask);

  Stage thin(scene_of(testing::directional_light({-0.9f, -0.1f, -0.4f})), 32, 24);
  Geometry& g = thin.frame.geometry;
  g = {};
  testing::add_triangle(g, {-1, 0, -1}, {1, 1.5f, 1}, {-0.9f, 0.1f, -1});
  testing::add_triangle(g, {-1, 1.5f, 1}, {1, 1.4f, -1}, {-1, 1.4f, 0.9f});
  thin.geometry.update(device(), thin.frame, thin.passes);
  const Rendered c = thin.render(info, {{"branching", int64_t{8}}, {"depth", int64_t{4}}});
  const Rendered e =
      thin.render(info, {{"branching", int64_t{8}}, {"depth", int64_t{4}}, {"backend", std::string("cpu")}});
  EXPECT_EQ(c.mask, e.mask);
}

TEST(LineSpace, SaysWhatItCannotDo) {
  Stage stage(scene_of(testing::point_light({1, 5, 1})), 16, 16);
  const auto reason =
      Stage::make(info, {{"branching", int64_t{10}}, {"depth", int64_t{4}}})->supports(stage.the_case);
  ASSERT_TRUE(reason.has_value());
  EXPECT_NE(reason->find("4096 leaves"), std::string::npos);
}

TEST(LineSpace, SecondFrameAllocatesNothingAndGivesTheSameBits) {
  Stage stage(scene_of(testing::rectangle_light({1, 4, 2}, {0, 0, 0}, 1.5f, 1)), 50, 30);
  stage.light_samples = make_light_samples(stage.frame.light, {7, 5});
  const std::unique_ptr<Technique> t = stage.built(info, {});
  const Rendered first = stage.render(*t, true);
  const uint64_t held = device().allocated_bytes();
  EXPECT_GT(t->structure_bytes(), 0U);
  stage.render_only(*t, true);
  EXPECT_EQ(device().allocated_bytes(), held);
  EXPECT_EQ(stage.render(*t, true).mask, first.mask);
}

}  // namespace
}  // namespace penumbra::test
