// The study's scenes against numbers recorded from the study's own program (double precision, degenerate
// triangles left out): sums over all corners of the object, surface, volume, and single triangles.
#include <cmath>

#include "fixtures.h"

namespace penumbra::test {
namespace {

struct Triangle {
  std::size_t index;
  double corners[9];
};
struct Recorded {
  const char* scene;
  std::size_t triangles;
  double area, volume;
  double sum[3], squares[3];
  Triangle samples[3];
};

const Recorded recorded[] = {
    {"study_city",
     4800,
     63.7451873285,
     1.46506765125,
     {-1.04673603118e-10, 2340.00770219, -4.47730741371e-12},
     {12297.8862851, 1224.51665849, 12297.8862851},
     {{0, {-1.56568348, 0, -1.56568348, -1.56568348, 0.100399906, -1.56568348, -1.47431652, 0, -1.56568348}},
      {1600, {-0.615738923, 0, 0.504261077, -0.504261077, 0, 0.504261077, -0.615738923, 0, 0.615738923}},
      {4799,
       {1.56056991, 0.745434455, 1.47943009, 1.56056991, 0.745434455, 1.56056991, 1.56056991, 0,
        1.56056991}}}},
    {"study_knots",
     69120,
     11.4551336225,
     0.282432120816,
     {-4.60448346118e-10, 190080, -27648},
     {195424.502063, 195794.922923, 54421.4070141},
     {{0,
       {-0.3802771, 0.790499513, 0.0783021508, -0.392840763, 0.793619105, 0.0766308112, -0.380697099,
        0.800669699, 0.0972741286}},
      {23040,
       {0.728875285, 1.276192, -0.631308096, 0.717326563, 1.28009494, -0.635973392, 0.727858699, 1.31002754,
        -0.603019864}},
      {69119,
       {1.74863808, 0.733660376, 0.0641967895, 1.82076511, 0.788567725, 0.0758889872, 1.83182972, 0.782696403,
        0.0795595047}}}},
    {"study_nest",
     170000,
     62.1058980869,
     0.130751630354,
     {301.297626469, 190012.203719, 770.608361283},
     {83594.8384099, 85561.9060526, 84295.1436368},
     {{0,
       {0.538326543, 0.551588008, -0.0871612203, 0.530728612, 0.547874679, -0.087855929, 0.532451017,
        0.547341494, -0.000271608274}},
      {56666,
       {0.415512152, 0.606029328, 0.63182216, 0.413559278, 0.613793713, 0.629011357, 0.278130067, 0.595547351,
        0.686701029}},
      {169999,
       {-0.52864509, 0.275689231, 0.0641330384, -0.519700254, 0.267697919, 0.0637740769, -0.527740487,
        0.267586396, 0.0664837318}}}},
    {"study_hair",
     476000,
     80.9994106577,
     0.0856104124846,
     {6241.77232366, 1420868.28233, 1409.11008383},
     {155756.337156, 1571448.95785, 155170.77466},
     {{0,
       {0.0164936601, 0.832005385, 0.107306889, 0.0124387772, 0.831107222, 0.106440154, 0.0228982341,
        0.759977444, 0.151983807}},
      {158666,
       {-0.178685583, 1.11838754, 0.301714681, -0.179325333, 1.12205343, 0.299677043, -0.226960671,
        1.14687234, 0.365799287}},
      {475999,
       {-0.349064277, 0.965710816, 0.768225579, -0.350936841, 0.960380468, 0.766205457, -0.347159684,
        0.962087259, 0.767110966}}}},
    {"study_bunny",
     69666,
     6.14598836621,
     0.819105081581,
     {-21099.4176093, 137151.063312, 22615.2855997},
     {39227.1647763, 127686.682889, 19833.3255665},
     {{0,
       {0.2372016, 0.0866416, 0.3601208, 0.2520912, 0.0820888, 0.3486936, 0.2596136, 0.0766632, 0.3550952}},
      {23222, {0.490788, 0.23576, -0.13578, 0.496748, 0.2365304, -0.1251952, 0.4897192, 0.221044, -0.125524}},
      {69665,
       {-0.4199128, 0.2886208, 0.238532, -0.4224512, 0.2898536, 0.2283792, -0.3925472, 0.2699488,
        0.1903984}}}},
    {"study_dragon1",
     871306,
     6.91715807184,
     0.444845790118,
     {-147562.687138, 1534334.14565, -86000.0245032},
     {654245.782783, 1311785.96645, 84946.9683577},
     {{0,
       {0.373428305, 0.0574346845, -0.446425451, 0.37001184, 0.0541207144, -0.445530338, 0.37001184,
        0.0575371784, -0.446688031}},
      {290435,
       {-0.0908877047, 0.840210044, -0.129976934, -0.0919126439, 0.838287063, -0.12924093, -0.0894078877,
        0.838492051, -0.128383886}},
      {871305,
       {-0.542184058, 0.214694524, 0.445528385, -0.542184058, 0.218110988, 0.44394217, -0.545600522,
        0.218110988, 0.443850414}}}},
    {"study_dragon2",
     202520,
     6.93534442605,
     0.446441090522,
     {-29806.8345883, 347933.293947, -21343.8326977},
     {151151.684834, 289838.431117, 19771.8532412},
     {{0,
       {0.380554287, 0.0578583557, -0.444961294, 0.371396648, 0.0667589013, -0.445779499, 0.380709717,
        0.0665624148, -0.447139264}},
      {67506,
       {0.344967746, 0.701806229, -0.135410975, 0.350591561, 0.696302652, -0.135554674, 0.352105778,
        0.69561837, -0.127730405}},
      {202519,
       {-0.55003612, 0.208422741, 0.447139264, -0.538793377, 0.20867006, 0.446840135, -0.548709592,
        0.215471817, 0.44558008}}}},
    {"study_dragon3",
     47794,
     7.03414068503,
     0.450971732859,
     {-6830.17995158, 81683.6594053, -5168.52371695},
     {35996.0453904, 67878.8765498, 4677.77857934},
     {{0,
       {0.377974079, 0.0531265299, -0.44531967, 0.359923989, 0.0514639182, -0.444867926, 0.376734731,
        0.0714515935, -0.446230031}},
      {15931,
       {-0.147028192, 0.675535451, -0.141076475, -0.157283746, 0.676016656, -0.132823322, -0.159648524,
        0.693624822, -0.131710658}},
      {47793,
       {-0.558063494, 0.209927598, 0.446230031, -0.535043247, 0.190823769, 0.44322692, -0.533985579,
        0.211568605, 0.44513799}}}},
    {"study_dragon4",
     11102,
     6.95819940381,
     0.449979734373,
     {-1138.54325032, 18907.1361862, -1246.7669839},
     {8333.18165814, 15623.4278287, 1092.41215176},
     {{0,
       {0.394969054, 0.0582061594, -0.445243508, 0.373560983, 0.0490877608, -0.447006642, 0.402811449,
        0.0862871196, -0.445186315}},
      {3700,
       {-0.294347175, 1.37386477, -0.142936101, -0.28904101, 1.41079394, -0.146771015, -0.323898399,
        1.40391101, -0.14075585}},
      {11101,
       {-0.522108937, 0.200722185, 0.435048296, -0.557112267, 0.210021038, 0.447006642, -0.566067961,
        0.201989314, 0.432495303}}}},
};

bool mesh_is_missing(const Recorded& r) {
  if (!std::string(r.scene).starts_with("study_dragon")) return false;
  const std::string resolution(r.scene + std::string("study_dragon").size());
  return !std::filesystem::exists("meshes/dragon_vrip" + (resolution == "1" ? "" : "_res" + resolution) +
                                  ".ply.gz");
}

// Corner order within a triangle may be turned.
double distance(const Geometry& g, std::size_t t, const double* corners) {
  double best = INFINITY;
  for (int turn = 0; turn < 3; ++turn) {
    double worst = 0;
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        worst = std::max(worst, std::abs(double{g.corner(t, (k + turn) % 3)[j]} - corners[3 * k + j]));
    best = std::min(best, worst);
  }
  return best;
}

class Study : public ::testing::TestWithParam<Recorded> {};

TEST_P(Study, GeometryIsTheStudys) {
  const Recorded& r = GetParam();
  if (mesh_is_missing(r)) GTEST_SKIP() << "the dragon is not here: scripts/fetch_scenes dragon";
  const Frame f = Scene::load(r.scene, {"configs/scenes"}).frame(0, "", "", -1);
  const Geometry& g = f.geometry;
  ASSERT_EQ(g.triangle_count(), r.triangles + 2);  // and the ground
  double area = 0, volume = 0, sum[3] = {}, squares[3] = {};
  for (std::size_t t = 0; t < r.triangles; ++t) {
    const Vec3d a(g.corner(t, 0)), b(g.corner(t, 1)), c(g.corner(t, 2));
    area += length(cross(b - a, c - a)) / 2;
    volume += dot(a, cross(b, c)) / 6;
    for (int k = 0; k < 9; ++k) {
      const double v{g.corner(t, k / 3)[k % 3]};
      sum[k % 3] += v, squares[k % 3] += v * v;
    }
  }
  // Corners differ by rounding to float (3e-8 for values up to 1, unbiased), so sums agree far closer than
  // this.
  EXPECT_NEAR(area / r.area, 1, 1e-6);
  EXPECT_NEAR(volume / r.volume, 1, 1e-5);
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(sum[j], r.sum[j], 1e-7 * double(r.triangles) + 1e-6 * std::abs(r.sum[j])) << j;
    EXPECT_NEAR(squares[j] / r.squares[j], 1, 1e-6) << j;
  }
  for (const Triangle& s : r.samples) {
    double nearest = INFINITY;  // a box's triangles stand in another order
    for (std::size_t t = s.index - std::min<std::size_t>(s.index, 12);
         t < std::min(s.index + 13, r.triangles); ++t)
      nearest = std::min(nearest, distance(g, t, s.corners));
    EXPECT_LT(nearest, 3e-7) << "triangle " << s.index;
  }
}

TEST_P(Study, GroundLightAndCameraAreTheStudys) {
  const Recorded& r = GetParam();
  if (mesh_is_missing(r)) GTEST_SKIP() << "the dragon is not here: scripts/fetch_scenes dragon";
  const Frame f = Scene::load(r.scene, {"configs/scenes"}).frame(0, "", "", -1);
  const double ground[2][9] = {{-12, 0, -12, 12, 0, 12, 12, 0, -12}, {-12, 0, -12, -12, 0, 12, 12, 0, 12}};
  for (const auto& corners : ground)
    EXPECT_EQ(
        std::min(distance(f.geometry, r.triangles, corners), distance(f.geometry, r.triangles + 1, corners)),
        0);
  const double corner[3] = {1.5671307945205171, 3.3738668254665303, -2.0174779248495174};
  const double u[3] = {0.683941129, 0, 0.729537204}, v[3] = {-0.601768115, 0.565332936, 0.564157608};
  const double n[3] = {-0.41243141, -0.82486282, 0.386654447};
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(f.light.at(0, 0)[j], corner[j], 1e-6);
    EXPECT_NEAR(f.light.edge_u[j], 0.8 * u[j], 1e-6);
    EXPECT_NEAR(f.light.edge_v[j], 0.8 * v[j], 1e-6);
    EXPECT_NEAR(f.light.direction[j], n[j], 1e-6);
  }
  EXPECT_EQ(f.camera.eye, (Vec3f{-0.3f, 1.9f, 2.5f}));
  EXPECT_EQ(f.camera.target, (Vec3f{-0.25f, 0.4f, 0.15f}));
  EXPECT_EQ(f.camera.vertical_fov_degrees, 45);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Study, ::testing::ValuesIn(recorded),
                         [](const auto& param_info) { return std::string(param_info.param.scene); });

}  // namespace
}  // namespace penumbra::test
