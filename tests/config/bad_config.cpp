// Wrong configs: each one gives one message that names the place, what was found and what was expected.
#include <gtest/gtest.h>

#include "fixture.h"

namespace penumbra {
namespace {

using test::error_of_config;

// A valid config of one line with `members` in front of the rest.
std::string with(const std::string& members) {
  return "{" + members + R"(, "scene": "area", "techniques": ["gears"]})";
}

struct BadConfig {
  std::string text, message;
};

class BadConfigs : public testing::TestWithParam<BadConfig> {};

TEST_P(BadConfigs, AreRefusedWithPlaceFoundAndExpected) {
  EXPECT_EQ(error_of_config(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Structure, BadConfigs,
    testing::Values(
        BadConfig{"[]", "c.json:1:1: /: found an empty array, expected an object: a sweep config."},
        BadConfig{R"({"techniques": ["gears"]})",
                  "c.json:1:1: /: found no key \"scene\", expected it in a sweep config."},
        BadConfig{R"({"scene": "area"})",
                  "c.json:1:1: /: found no key \"techniques\", expected it in a sweep config."},
        BadConfig{with(R"("mask_sizes": 4)"),
                  "c.json:1:2: /mask_sizes: found the key \"mask_sizes\", expected a key of a sweep config."
                  " Did you mean 'mask_size'?"},
        BadConfig{"{\n  \"scene\": \"area\",\n  \"techniques\": [\n    \"gear\"\n  ]\n}",
                  "c.json:4:5: /techniques/0: found \"gear\", expected a technique. Did you mean 'gears'?"},
        BadConfig{R"({"scene": "area", "techniques": []})",
                  "c.json:1:33: /techniques: found an empty array, expected at least one value."},
        BadConfig{
            R"({"scene": "area", "techniques": [7]})",
            "c.json:1:34: /techniques/0: found 7, expected a technique's name, or {\"technique\": name, "
            "\"params\": {...}}."},
        BadConfig{R"({"scene": "area", "techniques": [{"name": "gears"}]})",
                  "c.json:1:35: /techniques/0/name: found the key \"name\", expected a key of an entry of "
                  "techniques."
                  " Valid: technique, params, scene, light, camera, title, caption."},
        BadConfig{R"({"scene": "aera", "techniques": ["gears"]})",
                  "c.json:1:11: /scene: unknown scene 'aera'."},
        BadConfig{R"({"scene": 3, "techniques": ["gears"]})",
                  "c.json:1:11: /scene: found 3, expected a name."},
        BadConfig{R"({"scene": "area", "scene": "lamp", "techniques": ["gears"]})",
                  "c.json:1:19: /scene: found this key a second time, expected it once (first at line 1)."}));

INSTANTIATE_TEST_SUITE_P(
    Axes, BadConfigs,
    testing::Values(
        BadConfig{with(R"("resolution": 0)"),
                  "c.json:1:16: /resolution: found 0, expected an integer from 1 to 16384."},
        BadConfig{with(R"("resolution": [[0, 0]])"),
                  "c.json:1:18: /resolution/0/0: found 0, expected an integer from 1 to 16384."},
        BadConfig{with(R"("resolution": [[100000, 100000]])"),
                  "c.json:1:18: /resolution/0/0: found 100000, expected an integer from 1 to 16384."},
        BadConfig{
            with(R"("resolution": 16384)"),
            "c.json:1:16: /resolution: found 16384 x 16384 pixels, expected at most 67108864 pixels in all."},
        BadConfig{with(R"("resolution": "512x512")"),
                  "c.json:1:16: /resolution: found \"512x512\", expected an integer from 1 to 16384, or "
                  "[width, height]."},
        BadConfig{with(R"("resolution": [[640, 480, 3]])"),
                  "c.json:1:17: /resolution/0: found [640,480,3], expected [width, height] (a list of values "
                  "needs a "
                  "list around it: [[16, 8]])."},
        BadConfig{with(R"("mask_size": 2.5)"),
                  "c.json:1:15: /mask_size: found 2.5, expected an integer from 1 to 256."},
        BadConfig{with(R"("mask_size": [4, -1])"),
                  "c.json:1:19: /mask_size/1: found -1, expected an integer from 1 to 256."},
        BadConfig{with(R"("mask_size": [])"),
                  "c.json:1:15: /mask_size: found an empty array, expected at least one value."},
        BadConfig{
            with(R"("mask_size": null)"),
            "c.json:1:15: /mask_size: found null, expected an integer from 1 to 256, or [width, height]."},
        BadConfig{with(R"("light_samples": 0)"),
                  "c.json:1:19: /light_samples: found 0, expected an integer from 1 to 65536."},
        BadConfig{with(R"("light_size": -1)"),
                  "c.json:1:16: /light_size: found -1, expected a number from 0 to 1000000000."},
        BadConfig{with(R"("light_size": true)"),
                  "c.json:1:16: /light_size: found true, expected a number from 0 to 1000000000."},
        BadConfig{with(R"("light_pattern": "haltom")"),
                  "c.json:1:19: /light_pattern: found \"haltom\", expected a light pattern. Did you mean "
                  "'halton'?"},
        BadConfig{
            with(R"("light": "kye")"),
            "c.json:1:11: /light: found \"kye\", expected a light of the scene 'area'. Did you mean 'key'?"},
        BadConfig{with(R"("camera": ["front", "sid"])"),
                  "c.json:1:22: /camera/1: found \"sid\", expected a camera of the scene 'area'. Did you "
                  "mean 'side'?"},
        BadConfig{with(R"("grid_size": 4)"),
                  "c.json:1:15: /grid_size: found 4, expected an integer from 8 to 1024 for the parameter "
                  "'grid_size'."}));

INSTANTIATE_TEST_SUITE_P(
    Parameters, BadConfigs,
    testing::Values(
        BadConfig{
            R"({"scene": "area", "techniques": [{"technique": "gears", "params": {"asignment": "triangles"}}]})",
            "c.json:1:68: /techniques/0/params/asignment: found the key \"asignment\", expected a key of the "
            "parameters of gears. Did you mean 'assignment'?"},
        BadConfig{
            R"({"scene": "area", "techniques": [{"technique": "gears", "params": {"assignment": ["clusters", "triangle"]}}]})",
            "c.json:1:95: /techniques/0/params/assignment/1: found \"triangle\", expected one of triangles, "
            "clusters for the parameter 'assignment'. Did you mean 'triangles'?"},
        BadConfig{
            R"({"scene": "area", "techniques": [{"technique": "ray_tracing", "params": {"dynamic": 1}}]})",
            "c.json:1:85: /techniques/0/params/dynamic: found 1, expected true or false for the parameter "
            "'dynamic'."},
        BadConfig{
            R"({"scene": "area", "techniques": [{"technique": "shadow_map", "params": {"map_size": 1024.5}}]})",
            "c.json:1:85: /techniques/0/params/map_size: found 1024.5, expected an integer from 16 to 16384 "
            "for "
            "the parameter 'map_size'."},
        BadConfig{
            R"({"scene": "area", "techniques": [{"technique": "shadow_map", "params": {"map_size": {}}}]})",
            "c.json:1:85: /techniques/0/params/map_size: found an empty object, expected an integer from 16 "
            "to "
            "16384 for the parameter 'map_size'."}));

INSTANTIATE_TEST_SUITE_P(
    Settings, BadConfigs,
    testing::Values(
        BadConfig{with(R"("images": ["shadow"])"),
                  "c.json:1:13: /images/0: found \"shadow\", expected an image. Did you mean 'shaded'?"},
        BadConfig{with(R"("images": "shaded")"),
                  "c.json:1:12: /images: found \"shaded\", expected an array."},
        BadConfig{with(R"("measure": {"repititions": 3})"),
                  "c.json:1:14: /measure/repititions: found the key \"repititions\", expected a key of "
                  "measure. Did you "
                  "mean 'repetitions'?"},
        BadConfig{with(R"("measure": {"repetitions": 0})"),
                  "c.json:1:29: /measure/repetitions: found 0, expected an integer from 1 to 100000."},
        BadConfig{with(R"("measure": {"min_time_s": 5, "max_time_s": 1})"),
                  "c.json:1:13: /measure: found max_time_s 1 below min_time_s 5, expected it above."},
        BadConfig{with(R"("measure": {"target_interval": 2})"),
                  "c.json:1:33: /measure/target_interval: found 2, expected a number from 0 to 1."},
        BadConfig{with(R"("measure": {"counters": 1})"),
                  "c.json:1:26: /measure/counters: found 1, expected true or false."},
        BadConfig{with(R"("reference": {"samples": 9})"),
                  "c.json:1:16: /reference/samples: found the key \"samples\", expected a key of reference."
                  " Valid: light_samples."},
        BadConfig{with(R"("frames": 0)"),
                  "c.json:1:12: /frames: found 0, expected an integer from 1 to 100000."},
        BadConfig{with(R"("seed": -1)"),
                  "c.json:1:10: /seed: found -1, expected an integer from 0 to 4294967295."},
        BadConfig{with(R"("name": "../up")"),
                  "c.json:1:10: /name: found \"../up\", expected a name of at most 100 letters, digits, '_', "
                  "'-' and "
                  "'.'."}));

TEST(Limits, ASweepOfMoreThanAMillionPointsIsRefused) {
  std::string list = "1";
  for (int i = 2; i <= 256; ++i) list += "," + std::to_string(i);
  EXPECT_NE(error_of_config(with("\"mask_size\": [" + list + "], \"resolution\": [" + list +
                                 "], \"light_size\": [" + list + "]"))
                .find("expected at most 1000000"),
            std::string::npos);
}

TEST(Limits, TheLargestSizesAreAccepted) {
  EXPECT_EQ(error_of_config(with(R"("resolution": [1, 4096, 8192, [16384, 1]], "mask_size": 256)")),
            "accepted");
}

}  // namespace
}  // namespace penumbra
