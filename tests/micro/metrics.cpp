// What judging one picture costs: each metric and each file, at 1024 x 1024. `--threads=N` bounds the host
// threads.
#include "metrics/metrics.h"

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "image/image.h"
#include "metrics/error_map.h"

namespace penumbra {
namespace {

constexpr int size = 1024;
constexpr std::size_t pixels = std::size_t{size} * size;
constexpr int light_samples = 256, words = light_samples / 32;

// Soft stripes of 0, 1 and all between, as visibility has them; `shift` moves them by a part of a pixel.
std::vector<float> visibility(float shift) {
  std::vector<float> v(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const float x = static_cast<float>(i % size), y = static_cast<float>(i / size);
    v[i] = std::clamp(0.5f + 1.5f * std::sin(0.05f * (x + shift) + 0.02f * y), 0.0f, 1.0f);
  }
  return v;
}

std::vector<Vec3f> shaded(const std::vector<float>& v) {
  std::vector<Vec3f> rgb;
  for (float f : v) rgb.push_back({0.8f * f, 0.7f * f, 0.6f * f});
  return rgb;
}

const std::vector<float> reference = visibility(0), test = visibility(0.7f);
const std::vector<Vec3f> reference_rgb = shaded(reference), test_rgb = shaded(test);

std::filesystem::path scratch_file(const std::string& extension) {
  return std::filesystem::temp_directory_path() /
         ("penumbra_micro_" + std::to_string(::getpid()) + extension);
}

void per_pixel(benchmark::State& state) {
  state.SetItemsProcessed(static_cast<int64_t>(pixels) * state.iterations());
}

void pixel_errors_1024(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(pixel_errors({size, size, reference, {}}, {size, size, test, {}}));
  per_pixel(state);
}

void ssim_1024(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(ssim({size, size, reference, {}}, {size, size, test, {}}));
  per_pixel(state);
}

void flip_1024(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(flip(reference_rgb, test_rgb, size, size));
  per_pixel(state);
}

void mask_mismatch_1024_256(benchmark::State& state) {
  const std::vector<uint32_t> a(pixels * words, 0x0f0f0f0f), b(pixels * words, 0x0f0f0f0e);
  for (auto _ : state) benchmark::DoNotOptimize(mask_mismatch(a, b, words, light_samples, {}));
  per_pixel(state);
}

void error_map_1024(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(error_map({size, size, reference, {}}, {size, size, test, {}}, 0.25));
  per_pixel(state);
}

void tonemap_1024(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(tonemap(test_rgb, size, size));
  per_pixel(state);
}

void write_exr_gray_1024(benchmark::State& state) {
  const auto path = scratch_file(".exr");
  for (auto _ : state) write_exr_gray(path, size, size, test);
  per_pixel(state);
  std::filesystem::remove(path);
}

void read_exr_gray_1024(benchmark::State& state) {
  const auto path = scratch_file(".exr");
  write_exr_gray(path, size, size, test);
  for (auto _ : state) benchmark::DoNotOptimize(read_exr(path));
  per_pixel(state);
  std::filesystem::remove(path);
}

void write_png_1024(benchmark::State& state) {
  const auto path = scratch_file(".png");
  const Rgb8Image image = tonemap(test_rgb, size, size);
  for (auto _ : state) write_png(path, image);
  per_pixel(state);
  std::filesystem::remove(path);
}

BENCHMARK(pixel_errors_1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(ssim_1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(flip_1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(mask_mismatch_1024_256)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(error_map_1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(tonemap_1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(write_exr_gray_1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(read_exr_gray_1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(write_png_1024)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace penumbra

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc == 2 && std::strncmp(argv[1], "--threads=", 10) == 0)
    penumbra::set_threads(std::max(1, std::atoi(argv[1] + 10))), --argc;
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
